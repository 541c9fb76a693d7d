// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The polynomials of the predicates, each written once and evaluated in three arithmetics: doubles with running error
// bounds, expansions, rationals. An arithmetic offers add, sub and mul; results are `const auto` because an expansion's
// type depends on its capacity. Private to the layer; pure functions, any thread.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "pgdr/types.hpp"

namespace pgdr::detail {

template <class T, int D, int Rows>
using Matrix = std::array<std::array<T, D>, Rows>;

/// a*d - b*c.
template <class T>
auto det2(const T& a, const T& b, const T& c, const T& d) {
  return sub(mul(a, d), mul(b, c));
}

/// Determinant of the rows p1-p0, ..., pD-p0.
template <class T>
auto orient_det(const Matrix<T, 2, 2>& m) {
  return det2(m[0][0], m[0][1], m[1][0], m[1][1]);
}

template <class T>
auto orient_det(const Matrix<T, 3, 3>& m) {
  const auto yz = det2(m[1][1], m[1][2], m[2][1], m[2][2]);
  const auto zx = det2(m[1][2], m[1][0], m[2][2], m[2][0]);
  const auto xy = det2(m[1][0], m[1][1], m[2][0], m[2][1]);
  return add(add(mul(yz, m[0][0]), mul(zx, m[0][1])), mul(xy, m[0][2]));
}

template <class T>
auto squared_norm(const std::array<T, 2>& v) {
  return add(mul(v[0], v[0]), mul(v[1], v[1]));
}

template <class T>
auto squared_norm(const std::array<T, 3>& v) {
  return add(add(mul(v[0], v[0]), mul(v[1], v[1])), mul(v[2], v[2]));
}

template <class T>
requires(!std::is_same_v<T, double>)  // numbers/vectors.hpp has these
    auto dot(const std::array<T, 2>& v, const std::array<T, 2>& w) {
  return add(mul(v[0], w[0]), mul(v[1], w[1]));
}

template <class T>
requires(!std::is_same_v<T, double>)  // numbers/vectors.hpp has these
    auto dot(const std::array<T, 3>& v, const std::array<T, 3>& w) {
  return add(add(mul(v[0], w[0]), mul(v[1], w[1])), mul(v[2], w[2]));
}

template <class T, class U>
auto cross(const std::array<T, 3>& a, const std::array<U, 3>& b) {
  const auto minor = [&](std::size_t i, std::size_t j) { return sub(mul(a[i], b[j]), mul(a[j], b[i])); };
  return std::array{minor(1, 2), minor(2, 0), minor(0, 1)};
}

/// Twice the determinant of the rows p1-p0, ..., pD-p0 times (circumcentre - p0).
template <class T>
auto circum_numerator(const Matrix<T, 2, 2>& m) {
  const auto a2 = squared_norm(m[0]), b2 = squared_norm(m[1]);
  return std::array{sub(mul(a2, m[1][1]), mul(b2, m[0][1])), sub(mul(b2, m[0][0]), mul(a2, m[1][0]))};
}

template <class T>
auto circum_numerator(const Matrix<T, 3, 3>& m) {
  const auto a2 = squared_norm(m[0]), b2 = squared_norm(m[1]), c2 = squared_norm(m[2]);
  const auto bc = cross(m[1], m[2]), ca = cross(m[2], m[0]), ab = cross(m[0], m[1]);
  const auto of = [&](std::size_t i) { return add(add(mul(a2, bc[i]), mul(b2, ca[i])), mul(c2, ab[i])); };
  return std::array{of(0), of(1), of(2)};
}

// In-sphere: with p as the origin, sum of h(s_i) * orient(s with s_i replaced by p), which divided by orient(s) is the
// height at p of the plane through the lifted corners: positive iff the lifted p is below it. Moving p from place i to
// the front is a cycle of i+1 places, hence the alternating signs.
template <class T, class Height>
auto lifted_det(const Matrix<T, 2, 3>& d, const Height& h0, const Height& h1, const Height& h2) {
  const auto m12 = det2(d[1][0], d[1][1], d[2][0], d[2][1]);
  const auto m20 = det2(d[2][0], d[2][1], d[0][0], d[0][1]);
  const auto m01 = det2(d[0][0], d[0][1], d[1][0], d[1][1]);
  return add(add(mul(m12, h0), mul(m20, h1)), mul(m01, h2));
}

template <class T>
auto in_sphere_det(const Matrix<T, 2, 3>& d) {
  return lifted_det(d, squared_norm(d[0]), squared_norm(d[1]), squared_norm(d[2]));
}

template <class T>
auto in_sphere_det(const Matrix<T, 3, 4>& d) {
  const auto minor = [&](int i, int j) { return det2(d[i][0], d[i][1], d[j][0], d[j][1]); };
  const auto m01 = minor(0, 1), m02 = minor(0, 2), m03 = minor(0, 3);
  const auto m12 = minor(1, 2), m13 = minor(1, 3), m23 = minor(2, 3);
  const auto cofactor = [&](const auto& jk, int i, const auto& ik, int j, const auto& ij, int k) {
    return add(sub(mul(jk, d[i][2]), mul(ik, d[j][2])), mul(ij, d[k][2]));
  };
  const auto t0 = mul(cofactor(m23, 1, m13, 2, m12, 3), squared_norm(d[0]));
  const auto t1 = mul(cofactor(m23, 0, m03, 2, m02, 3), squared_norm(d[1]));
  const auto t2 = mul(cofactor(m13, 0, m03, 1, m01, 3), squared_norm(d[2]));
  const auto t3 = mul(cofactor(m12, 0, m02, 1, m01, 2), squared_norm(d[3]));
  return add(sub(t0, t1), sub(t2, t3));
}

/// In-circle of a plane in space. d: differences to p in the two kept axes; drop, drop_sum: difference and sum of the
/// dropped coordinates. |x|^2 - |p|^2 = |d|^2 + 2 p.d + drop * drop_sum, and 2 p.d is linear in the kept axes, hence
/// without influence: so the heights are truly |x|^2, also of points that are coplanar only within rounding.
template <class T>
auto in_circle_det(const Matrix<T, 2, 3>& d, const std::array<T, 3>& drop, const std::array<T, 3>& drop_sum) {
  const auto height = [&](int i) { return add(squared_norm(d[i]), mul(drop[i], drop_sum[i])); };
  return lifted_det(d, height(0), height(1), height(2));
}

/// 4 (v.w)^2 - |v|^2 |w|^2: zero where the angle between v and w is 60 or 120 degrees. Four times by two sums.
template <class T, std::size_t D>
auto angle_60_det(const std::array<T, D>& v, const std::array<T, D>& w) {
  const auto d = dot(v, w);
  const auto twice = add(d, d);
  return sub(mul(twice, twice), mul(squared_norm(v), squared_norm(w)));
}

}  // namespace pgdr::detail
