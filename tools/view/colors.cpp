// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "view/colors.hpp"

#include <algorithm>
#include <cmath>

namespace pgdr::tool {

Color region_color(std::size_t n) {
  const double hue = 6 * std::fmod(0.58 + 0.61803398875 * static_cast<double>(n), 1.0);
  const auto channel = [hue](double shift) {
    const double k = std::fmod(hue + shift, 6.0);
    return static_cast<std::uint8_t>(std::lround(225 - 100 * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

std::string hex(const Color& c) {
  constexpr const char* digit = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t v : {c.red, c.green, c.blue}) {
    text += digit[v >> 4];
    text += digit[v & 15];
  }
  return text;
}

}  // namespace pgdr::tool
