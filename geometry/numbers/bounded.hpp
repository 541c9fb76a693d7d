// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A double with a bound on its distance from the exact value (running error analysis): the filter of the predicates
// that are not hot enough for a bound derived by hand. Overflow makes the bound infinite or NaN, either of which leaves
// the sign undecided. Private to the layer; pure functions, any thread.
#pragma once

#include <cmath>
#include <optional>

#include "pgdr/types.hpp"

namespace pgdr::detail {

inline constexpr double unit_roundoff = 0x1p-53;

/// |value - exact| <= error. Each operation adds its own rounding, at most u|value| (and 2^-1075 where a product
/// underflows, for which 2^-1000 is added: no denormals), and the factor 1 + 8u covers the roundings of the bound itself.
struct Bounded {
  double value = 0, error = 0;

  Bounded() = default;
  explicit Bounded(double v) : value(v) {}
  Bounded(double v, double e) : value(v), error(e * (1 + 8 * unit_roundoff)) {}
};

inline Bounded add(const Bounded& a, const Bounded& b) {
  const double v = a.value + b.value;
  return {v, a.error + b.error + unit_roundoff * std::fabs(v)};
}

inline Bounded sub(const Bounded& a, const Bounded& b) {
  const double v = a.value - b.value;
  return {v, a.error + b.error + unit_roundoff * std::fabs(v)};
}

inline Bounded mul(const Bounded& a, const Bounded& b) {
  const double v = a.value * b.value;
  return {v, std::fabs(a.value) * b.error + (std::fabs(b.value) + b.error) * a.error + unit_roundoff * std::fabs(v) + 0x1p-1000};
}

inline std::optional<Sign> sign(const Bounded& a) {
  if (a.value > a.error) return Sign::positive;
  if (a.value < -a.error) return Sign::negative;
  return std::nullopt;
}

}  // namespace pgdr::detail
