// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last arithmetic stage: the same polynomials in rationals (CGAL's Exact_rational over GMP), of any exponent; the
// bounds, and circumcentres rounded to nearest. Slow (microseconds, allocates), so only what the other stages leave.
#include <cmath>
#include <limits>
#include <utility>

#include "detail/determinants.hpp"
#include "detail/predicates_internal.hpp"
#include "detail/rational.hpp"

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

std::array<Rational, 3> cross(const std::array<Rational, 3>& a, const std::array<Rational, 3>& b) {
  return {det2(a[1], a[2], b[1], b[2]), det2(a[2], a[0], b[2], b[0]), det2(a[0], a[1], b[0], b[1])};
}

// Twice the determinant times (centre - s[0]).
std::array<Rational, 2> circum_numerator(const Matrix<Rational, 2, 2>& m) {
  const Rational a2 = squared_norm(m[0]), b2 = squared_norm(m[1]);
  return {det2(a2, m[0][1], b2, m[1][1]), det2(m[0][0], a2, m[1][0], b2)};
}

std::array<Rational, 3> circum_numerator(const Matrix<Rational, 3, 3>& m) {
  const Rational a2 = squared_norm(m[0]), b2 = squared_norm(m[1]), c2 = squared_norm(m[2]);
  const auto bc = cross(m[1], m[2]), ca = cross(m[2], m[0]), ab = cross(m[0], m[1]);
  std::array<Rational, 3> n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = add(add(mul(a2, bc[i]), mul(b2, ca[i])), mul(c2, ab[i]));
  return n;
}

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

// The double nearest to q: one conversion is within an ulp or so, exact comparisons settle the rest.
double round_to_nearest(const Number& q) {
  constexpr double inf = std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::max();
  const Number limit = Number(max) + Number(0x1p970) / 2;  // from here on, nearest is infinity
  if (q >= limit) return inf;
  if (q <= -limit) return -inf;
  double d = CGAL::to_double(q);
  if (!std::isfinite(d)) d = std::copysign(max, d);
  const auto distance = [&](double x) { return Number(abs(Number(Number(x) - q))); };
  for (bool moved = true; moved;) {
    moved = false;
    for (const double target : {-inf, inf}) {
      const double next = std::nextafter(d, target);
      if (std::isfinite(next) && distance(next) < distance(d)) {
        d = next;
        moved = true;
      }
    }
  }
  return d;
}

template <int D>
Point<D> rounded_circumcenter(const Simplex<D>& s) {
  const auto m = edges<D>(s);
  const Number det = orient_det(m).q;
  const auto n = circum_numerator(m);
  Point<D> c;
  for (std::size_t i = 0; i < D; ++i)
    c.x[i] = det.sign() == 0 ? std::numeric_limits<double>::quiet_NaN()
                             : round_to_nearest(Number(Number(s[0].x[i]) + n[i].q / (2 * det)));
  return c;
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

Point2 circumcenter_exact(const Simplex<2>& s) { return rounded_circumcenter<2>(s); }
Point3 circumcenter_exact(const Simplex<3>& s) { return rounded_circumcenter<3>(s); }

// With B = b-a, C = c-a, N = B x C: centre - a = (|C|^2 N x B + |B|^2 C x N) / (2 |N|^2).
Point3 circumcenter_exact(const Triangle3& t) {
  const auto& [a, b, c] = t;
  const auto ab = difference<3>(b, a), ac = difference<3>(c, a);
  const auto normal = cross(ab, ac);
  const auto nb = cross(normal, ab), cn = cross(ac, normal);
  const Rational b2 = squared_norm(ab), c2 = squared_norm(ac);
  const Number n2 = squared_norm(normal).q;
  Point3 center;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational n = add(mul(c2, nb[i]), mul(b2, cn[i]));
    center.x[i] = n2.sign() == 0 ? std::numeric_limits<double>::quiet_NaN()
                                 : round_to_nearest(Number(Number(a.x[i]) + n.q / (2 * n2)));
  }
  return center;
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
