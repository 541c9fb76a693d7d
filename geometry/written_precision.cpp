// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/written_precision.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "pgdr/plc.hpp"

namespace pgdr {
namespace {

constexpr int exact_digits = 4;  // and less: as people choose coordinates
constexpr double of_floats = 0x1p-22;

/// Of the shortest decimal number that is this double: d.ddde+xx.
int significant_digits(double value) {
  char text[32];
  const std::string_view number(text, std::to_chars(text, text + sizeof text, value, std::chars_format::scientific).ptr);
  return static_cast<int>(std::ranges::count_if(number.substr(0, number.find('e')), [](char c) { return c >= '0' && c <= '9'; }));
}

}  // namespace

double written_precision(std::span<const Point3> points) {
  int most = 0;
  bool floats = true;
  for (const Point3& p : points)
    for (const double c : p.x) {
      floats = floats && static_cast<double>(static_cast<float>(c)) == c;
      if (most <= 9) most = std::max(most, significant_digits(c));
      if (most > 9 && !floats) return Plc<3>{}.precision;
    }
  switch (most) {
    case 5: return 1e-4;
    case 6: return 1e-5;
    case 7: return 1e-6;
    default: return most <= exact_digits ? Plc<3>{}.precision : of_floats;
  }
}

}  // namespace pgdr
