// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The same question of many pieces, on all threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "given/findings.hpp"
#include "nearness/near_set.hpp"
#include "space/bulk.hpp"

namespace pgdr::checking {

/// Of each of so many items what look(i) says, which may take long for some of them. In their order, whatever the threads do.
/// @throws CancelledError
template <class Look>
std::vector<std::optional<FarPlace>> look_at_all(const Findings& findings, std::size_t count, const Look& look) {
  constexpr std::size_t block = 32;
  std::vector<std::optional<FarPlace>> out(count);
  detail::Bulk(true, findings.stop()).parts((count + block - 1) / block, [&](std::size_t part) {
    for (std::size_t i = part * block; i < std::min(count, (part + 1) * block); ++i) out[i] = look(i);
  });
  findings.heed_stop();
  return out;
}

}  // namespace pgdr::checking
