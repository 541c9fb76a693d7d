// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pgdr::detail {

/// Numbers from 0 to 1 that look like chance, the same in every run.
class Chance {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace pgdr::detail
