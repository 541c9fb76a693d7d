// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of about 106 bits as an unevaluated sum of two doubles (Dekker 1971), for points that are computed once and
// rounded once. Relative error of an operation about 2^-104 (of the larger operand for sums of opposite sign, as ever).
// No fused multiply-add, which not every machine has: the result is the same everywhere. Operands must be of magnitude
// 2^-400 to 2^400, or zero. Pure functions, any thread.
#pragma once

#include <array>

#include "numbers/expansion.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

struct DoubleDouble {
  double hi = 0, lo = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double h) : hi(h) {}
  constexpr DoubleDouble(double h, double l) : hi(h), lo(l) {}
  DoubleDouble(Twice t) : hi(t.hi), lo(t.lo) {}
  /// The nearest double.
  constexpr double rounded() const { return hi; }
};

inline DoubleDouble operator-(DoubleDouble a) { return {-a.hi, -a.lo}; }

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const Twice s = two_sum(a.hi, b.hi), t = two_sum(a.lo, b.lo);
  const Twice u = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(u.hi, u.lo + t.lo);
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const Twice p = two_product(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

/// @pre b != 0.
inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double q = a.hi / b.hi;
  const DoubleDouble rest = a - b * DoubleDouble(q);
  const double r = rest.hi / b.hi;
  const DoubleDouble rest2 = rest - b * DoubleDouble(r);
  return DoubleDouble(fast_two_sum(q, r)) + DoubleDouble(rest2.hi / b.hi);
}

// The arithmetic of determinants.hpp.
inline DoubleDouble add(DoubleDouble a, DoubleDouble b) { return a + b; }
inline DoubleDouble sub(DoubleDouble a, DoubleDouble b) { return a - b; }
inline DoubleDouble mul(DoubleDouble a, DoubleDouble b) { return a * b; }

/// The difference of two doubles, exactly.
inline DoubleDouble difference(double a, double b) { return two_diff(a, b); }

template <std::size_t N>
using DoubleDoubles = std::array<DoubleDouble, N>;

/// The difference of two points, exactly.
inline DoubleDoubles<2> exact_difference(const Point2& a, const Point2& b) {
  return {difference(a[0], b[0]), difference(a[1], b[1])};
}

inline DoubleDoubles<3> exact_difference(const Point3& a, const Point3& b) {
  return {difference(a[0], b[0]), difference(a[1], b[1]), difference(a[2], b[2])};
}

template <std::size_t N>
DoubleDouble dot(const DoubleDoubles<N>& a, const DoubleDoubles<N>& b) {
  DoubleDouble s = a[0] * b[0];
  for (std::size_t i = 1; i < N; ++i) s = s + a[i] * b[i];
  return s;
}

inline DoubleDoubles<3> cross(const DoubleDoubles<3>& a, const DoubleDoubles<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace pgdr::detail
