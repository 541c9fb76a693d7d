// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The colours that pictures and pages have in common.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace pgdr::tool {

struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
};

inline constexpr Color ink{45, 50, 60};            ///< of edges
inline constexpr Color plain_cell{120, 160, 205};  ///< of a surface that shows nothing

/// From red (poor) through pale to blue (good): ColorBrewer's RdBu, which people tell apart who see no green. Evenly spaced.
inline constexpr std::array<Color, 6> quality_stops{
    {{178, 24, 43}, {239, 138, 98}, {253, 219, 199}, {209, 229, 240}, {103, 169, 207}, {33, 102, 172}}};

/// Between the classes of angles, in degrees, and the colours of these, from red to blue: ColorBrewer's RdYlBu.
inline constexpr std::array<double, 6> angle_limits{5, 10, 15, 20, 30, 40};
inline constexpr std::array<Color, 7> angle_classes{
    {{215, 48, 39}, {252, 141, 89}, {254, 224, 144}, {255, 255, 191}, {224, 243, 248}, {145, 191, 219}, {69, 117, 180}}};

/// The n-th of colours whose hues are far apart.
Color region_color(std::size_t n);

/// "#rrggbb".
std::string hex(const Color& c);

}  // namespace pgdr::tool
