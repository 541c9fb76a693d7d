// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers out of the bytes of a file, in either byte order. Pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string_view>

namespace pgdr::detail {

/// The number whose bytes begin at `at`. @pre they lie within `bytes`
template <class Number>
Number load(std::string_view bytes, std::size_t at, std::endian order = std::endian::little) {
  std::array<char, sizeof(Number)> raw{};
  bytes.copy(raw.data(), raw.size(), at);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

}  // namespace pgdr::detail
