// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What ranks that do the same make sure of when they meet.
#pragma once

#include <cstdint>

#include "transport/collectives.hpp"

namespace pgdr::detail {

/// @throws ResourceError unlike_ranks
[[noreturn]] inline void fail_unlike_ranks() {
  throw ResourceError({.code = Errc::unlike_ranks,
                       .message = "the ranks did not make the same mesh: their inputs, options, callbacks or builds differ"});
}

/// All ranks call it. @throws ResourceError unlike_ranks, on all, if one has another hash
inline void require_alike(Collectives& ranks, std::uint64_t hash) {
  if (ranks.min(hash) != ranks.max(hash)) fail_unlike_ranks();
}

/// Ranks meet: here if their runs go on, and in has_another_gone_on() if they have ended. False: that of another has ended.
/// @throws what another rank has thrown on its way
inline bool do_all_go_on(Collectives& ranks) {
  ranks.together([] {});
  return ranks.sum(std::uint64_t{0}) == 0;
}
/// This rank's run has ended without the ranks having parted. Did that of another go on?
inline bool has_another_gone_on(Collectives& ranks) {
  ranks.together([] {});
  return ranks.sum(std::uint64_t{1}) != static_cast<std::uint64_t>(ranks.size());
}

}  // namespace pgdr::detail
