// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumcentre as a quotient, with bounds on the rounding errors of numerator and denominator: shared by the
// circumsphere and by the filters of the bounds on radii. Private to the layer; pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numbers/bounded.hpp"
#include "numbers/lanes.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// centre - s[0] = numerator / (2 det); longest2: the largest squared length of an edge at s[0]. T: a number, or several side
/// by side; the operations and their order are the same.
template <int D, class T = double>
struct CircumTerms {
  std::array<T, D> numerator;
  T det, longest2;
};

// Error bounds, with u = 2^-53 and M the length of the longest edge at s[0]. The 2D case counts the same way.
// Differences are off by (1+u); 2x2 minors by 4u times the sum p of the magnitudes of their products. For vectors B, C
// the vector of the three p's is at most sqrt(2)|B||C| long. Squared lengths (5u), times minors (4u + 1u), and the sum of
// three (2u): 12u * 3 * sqrt(2) M^4 < 51u M^4 for the length of the numerator's error. The determinant: 4u, 1u for the
// difference, 1u for the product, 2u for the sum: 8 sqrt(2) u M^3 < 11.4u M^3. In 2D: 7u * 2 M^3, and 4u |B||C|, where
// |Bx Cy| + |By Cx| <= |B||C|. The constants below leave room for terms in u^2 and the rounding of M.
template <int D>
inline constexpr double numerator_error = (D == 3 ? 52 : 14.5) * unit_roundoff;  ///< times M^(D+1)
template <int D>
inline constexpr double det_error = (D == 3 ? 12 : 4.5) * unit_roundoff;  ///< times M^D

/// Where M^2 lies in this range, nothing overflows and what underflows is far below the bounds above.
inline constexpr double least_safe = 0x1p-200, most_safe = 0x1p200;
inline bool in_safe_range(double longest2) { return longest2 >= least_safe && longest2 <= most_safe; }

template <class T>
[[gnu::always_inline]] inline T norm2(const std::array<T, 3>& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}
inline double norm2(const Point3& v) { return norm2(v.x); }

template <class T>
[[gnu::always_inline]] inline std::array<T, 3> cross(const std::array<T, 3>& v, const std::array<T, 3>& w) {
  return {v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]};
}
inline Point3 cross(const Point3& v, const Point3& w) { return {cross(v.x, w.x)}; }

template <class T>
[[gnu::always_inline]] inline CircumTerms<2, T> circum_terms(const std::array<std::array<T, 2>, 2>& d) {
  const std::array<T, 2>&a = d[0], &b = d[1];
  const T a2 = a[0] * a[0] + a[1] * a[1], b2 = b[0] * b[0] + b[1] * b[1];
  return {{a2 * b[1] - b2 * a[1], b2 * a[0] - a2 * b[0]}, a[0] * b[1] - a[1] * b[0], larger(a2, b2)};
}

template <class T>
[[gnu::always_inline]] inline CircumTerms<3, T> circum_terms(const std::array<std::array<T, 3>, 3>& d) {
  const std::array<T, 3>&a = d[0], &b = d[1], &c = d[2];
  const T a2 = norm2(a), b2 = norm2(b), c2 = norm2(c);
  const std::array<T, 3> bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  CircumTerms<3, T> t;
  for (std::size_t i = 0; i < 3; ++i) t.numerator[i] = a2 * bc[i] + b2 * ca[i] + c2 * ab[i];
  t.det = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
  t.longest2 = larger(larger(a2, b2), c2);
  return t;
}

/// The edges from s[0], rounded.
template <int D>
std::array<std::array<double, D>, D> edges_from_first(const Simplex<D>& s) {
  std::array<std::array<double, D>, D> d;
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t k = 0; k < D; ++k) d[i][k] = s[i + 1].x[k] - s[0].x[k];
  return d;
}

/// Offset of the circumcentre from the first corner and a bound on its error, not counting the last addition; what the
/// bound is worth where the edges are too long or too short (in_safe_range) is for the caller to see.
template <int D, class T = double>
struct CircumOffset {
  std::array<T, D> w;
  T error;
};

template <class T, std::size_t N>
[[gnu::always_inline]] inline T one_norm(const std::array<T, N>& v) {
  T sum = magnitude(v[0]);
  for (std::size_t i = 1; i < N; ++i) sum += magnitude(v[i]);
  return sum;
}

// With w = n / (2 d), computed n and d off by e_n and e_d: the computed quotient is off by at most
// (e_n/2 + e_d |w|) / |d| but for a factor 1 + 2^-20 (where the bound is accepted) and 3u|w| of its own. |w| is at most
// the sum s of the magnitudes. 3D: u (26 M^4 + 12 M^3 s) / |d|, where M^3 s <= (M^4 + M^2 s^2) / 2 saves a root:
// u (32 M^4 + 6 M^2 s^2) / |d|. 2D: u (7.25 M^3 + 4.5 M^2 s) / |d|. (M <= 2s must not be used here: where the computed
// determinant is all error, s may be far below the radius.)
template <int D, class T>
[[gnu::always_inline]] inline CircumOffset<D, T> circum_offset(const CircumTerms<D, T>& t) {
  const T inverse = 0.5 / t.det;
  CircumOffset<D, T> o;
  for (std::size_t i = 0; i < D; ++i) o.w[i] = t.numerator[i] * inverse;
  const T s = one_norm(o.w), m2 = t.longest2;
  T scaled;
  if constexpr (D == 3) {
    scaled = m2 * (33.0 * m2 + 6.5 * (s * s));
  } else {
    scaled = m2 * (7.5 * root(m2) + 5.0 * s);
  }
  o.error = unit_roundoff * (scaled * magnitude(2.0 * inverse) + 4.0 * s);
  return o;
}

/// What the offset may be off by at most, in units of its largest component, for it to be used.
inline constexpr double accepted_error = rounding::of_circumcenter;

/// The last rounding of the centre is at most u times each coordinate.
template <class T, std::size_t N>
[[gnu::always_inline]] inline T error_with_last_rounding(const std::array<T, N>& center, const T& error) {
  return error + (1 + 8 * unit_roundoff) * unit_roundoff * one_norm(center);
}

}  // namespace pgdr::detail
