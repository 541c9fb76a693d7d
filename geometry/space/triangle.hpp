// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace pgdr::detail {

/// The corner of a triangle that is neither a nor b. @pre it has both
constexpr std::uint32_t corner_beside(const std::array<std::uint32_t, 3>& t, std::uint32_t a, std::uint32_t b) {
  return t[0] ^ t[1] ^ t[2] ^ a ^ b;
}

}  // namespace pgdr::detail
