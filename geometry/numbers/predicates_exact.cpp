// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last arithmetic stage: the same polynomials in rationals (CGAL's Exact_rational over GMP), of any exponent, and the
// bounds. Slow (microseconds, allocates), so only what the other stages leave.
#include <algorithm>

#include "numbers/determinants.hpp"
#include "numbers/predicate_stages.hpp"
#include "numbers/rational.hpp"

namespace pgdr::detail {
namespace {

using Number = Rational::Number;

template <int D>
std::array<Rational, D> difference(const Point<D>& a, const Point<D>& b) {
  std::array<Rational, D> d;
  for (std::size_t i = 0; i < D; ++i) d[i] = rational_difference(a.x[i], b.x[i]);
  return d;
}

template <int D>
Matrix<Rational, D, D> edges(const Simplex<D>& s) {
  Matrix<Rational, D, D> m;
  for (std::size_t i = 0; i < D; ++i) m[i] = difference<D>(s[i + 1], s[0]);
  return m;
}

}  // namespace

template <int D>
Sign orient_exact(const Simplex<D>& s) {
  return sign(orient_det(edges<D>(s)));
}

template <int D>
Sign in_sphere_exact(const Simplex<D>& s, const Point<D>& p) {
  Matrix<Rational, D, D + 1> m;
  for (std::size_t i = 0; i <= D; ++i) m[i] = difference<D>(s[i], p);
  return sign(in_sphere_det(m));
}

Sign in_circle_exact(const Triangle3& t, const Point3& p, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  Matrix<Rational, 2, 3> d;
  std::array<Rational, 3> drop, drop_sum;
  for (std::size_t k = 0; k < 3; ++k) {
    d[k] = {rational_difference(t[k][i], p[i]), rational_difference(t[k][j], p[j])};
    drop[k] = rational_difference(t[k][axis], p[axis]);
    drop_sum[k] = rational_difference(t[k][axis], -p[axis]);
  }
  return sign(in_circle_det(d, drop, drop_sum));
}

template <int D>
Sign dot_exact(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  return sign(dot(difference<D>(a, v), difference<D>(b, v)));
}

template <int D>
Sign angle_60_exact(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  return sign(angle_60_det(difference<D>(a, v), difference<D>(b, v)));
}

namespace {

template <int D>
Number shortest_edge_squared_exact(const Simplex<D>& s) {
  Number shortest = squared_norm(difference<D>(s[1], s[0])).q;
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t j = i + 1; j <= D; ++j) shortest = std::min(shortest, squared_norm(difference<D>(s[j], s[i])).q);
  return shortest;
}

// r^2 <= limit, with r^2 = |numerator|^2 / (2 det)^2. A flat simplex has an infinite radius.
template <int D>
bool squared_radius_within(const Simplex<D>& s, const Number& limit) {
  const auto m = edges<D>(s);
  const Number det = orient_det(m).q;
  if (det.sign() == 0) return false;
  return squared_norm(circum_numerator(m)).q <= 4 * det * det * limit;
}

}  // namespace

template <int D>
bool radius_edge_exact(const Simplex<D>& s, double bound) {
  const Number b(bound);
  return squared_radius_within<D>(s, Number(b * b * shortest_edge_squared_exact<D>(s)));
}

template <int D>
bool circumradius_exact(const Simplex<D>& s, double size) {
  const Number b(size);
  return squared_radius_within<D>(s, Number(b * b));
}

template <int D>
bool measure_exact(const Simplex<D>& s, double bound) {
  return abs(orient_det(edges<D>(s)).q) <= Number(bound) * (D == 3 ? 6 : 2);
}

template Sign orient_exact<2>(const Simplex<2>&);
template Sign orient_exact<3>(const Simplex<3>&);
template Sign in_sphere_exact<2>(const Simplex<2>&, const Point2&);
template Sign in_sphere_exact<3>(const Simplex<3>&, const Point3&);
template Sign dot_exact<2>(const Point2&, const Point2&, const Point2&);
template Sign dot_exact<3>(const Point3&, const Point3&, const Point3&);
template Sign angle_60_exact<2>(const Point2&, const Point2&, const Point2&);
template Sign angle_60_exact<3>(const Point3&, const Point3&, const Point3&);
template bool radius_edge_exact<2>(const Simplex<2>&, double);
template bool radius_edge_exact<3>(const Simplex<3>&, double);
template bool circumradius_exact<2>(const Simplex<2>&, double);
template bool circumradius_exact<3>(const Simplex<3>&, double);
template bool measure_exact<2>(const Simplex<2>&, double);
template bool measure_exact<3>(const Simplex<3>&, double);

}  // namespace pgdr::detail
