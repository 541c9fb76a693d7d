// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumcentre as a quotient, with bounds on the rounding errors of numerator and denominator: shared by the
// circumsphere and by the filters of the bounds on radii. Private to the layer; pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "bounded.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// centre - s[0] = numerator / (2 det); longest2: the largest squared length of an edge at s[0].
template <int D>
struct CircumTerms {
  std::array<double, D> numerator;
  double det, longest2;
};

// Error bounds, with u = 2^-53 and M the length of the longest edge at s[0]. The 2D case counts the same way.
// Differences are off by (1+u); 2x2 minors by 4u times the sum p of the magnitudes of their products. For vectors B, C
// the vector of the three p's is at most sqrt(2)|B||C| long. Squared lengths (5u), times minors (4u + 1u), and the sum of
// three (2u): 12u * 3 * sqrt(2) M^4 < 51u M^4 for the length of the numerator's error. The determinant: 4u, 1u for the
// difference, 1u for the product, 2u for the sum: 8 sqrt(2) u M^3 < 11.4u M^3. In 2D: 7u * 2 M^3, and 4u |B||C|, where
// |Bx Cy| + |By Cx| <= |B||C|. The constants below leave room for terms in u^2 and the rounding of M.
template <int D> inline constexpr double numerator_error = (D == 3 ? 52 : 14.5) * unit_roundoff;  ///< times M^(D+1)
template <int D> inline constexpr double det_error = (D == 3 ? 12 : 4.5) * unit_roundoff;         ///< times M^D

/// Where M^2 lies in this range, nothing overflows and what underflows is far below the bounds above.
inline bool in_safe_range(double longest2) { return longest2 >= 0x1p-200 && longest2 <= 0x1p200; }

inline double norm2(const Point3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

inline Point3 cross(const Point3& v, const Point3& w) {
  return {{v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]}};
}

inline CircumTerms<2> circum_terms(const std::array<Point2, 2>& d) {
  const Point2 &a = d[0], &b = d[1];
  const double a2 = a[0] * a[0] + a[1] * a[1], b2 = b[0] * b[0] + b[1] * b[1];
  return {{a2 * b[1] - b2 * a[1], b2 * a[0] - a2 * b[0]}, a[0] * b[1] - a[1] * b[0], std::max(a2, b2)};
}

inline CircumTerms<3> circum_terms(const std::array<Point3, 3>& d) {
  const Point3 &a = d[0], &b = d[1], &c = d[2];
  const double a2 = norm2(a), b2 = norm2(b), c2 = norm2(c);
  const Point3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const auto component = [&](int i) { return a2 * bc[i] + b2 * ca[i] + c2 * ab[i]; };
  return {{component(0), component(1), component(2)},
          a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2],
          std::max({a2, b2, c2})};
}

/// The edges from s[0], rounded.
template <int D>
std::array<Point<D>, D> edges_from_first(const Simplex<D>& s) {
  std::array<Point<D>, D> d;
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) d[static_cast<std::size_t>(i)][k] = s[static_cast<std::size_t>(i) + 1][k] - s[0][k];
  return d;
}

}  // namespace pgdr::detail
