// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The ladder of the predicates: floating-point filters with their error bounds, the calls of the exact stages, and the
// symbolic perturbation. u = 2^-53 is the unit roundoff; an error of "n u" stands for a factor within (1 +- u)^n, and the
// 0.01 added to every constant pays for terms in u^2, for the rounding of the permanent, and of the bound itself.
// Overflow makes a permanent infinite or NaN, and then no comparison holds.
#include "pgdr/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numbers/bounded.hpp"
#include "numbers/determinants.hpp"
#include "numbers/predicate_stages.hpp"

namespace pgdr {
namespace detail {

constinit thread_local PredicateCounts counts;

namespace {

constexpr double u = unit_roundoff;

// Products may underflow, each by at most 2^-1075, multiplied by whatever factors follow. With the factors held below
// 2^150 (orientation) and 2^250 (heights; so differences are below 2^125) the sum of all these is below the term here.
constexpr double orient_underflow = 0x1p-900, orient_max = 0x1p150;
constexpr double in_sphere_underflow = 0x1p-650, in_sphere_max = 0x1p250;

MaybeSign decide(double value, double bound) {
  if (value > bound) return Sign::positive;
  if (value < -bound) return Sign::negative;
  return std::nullopt;
}

// Runs the stages in turn. Kept in one place so that a call is counted once.
template <class Filter, class Middle, class Exact>
inline Sign ladder(Filter filter, Middle middle, Exact exact) {
  if (const MaybeSign s = filter()) {
    ++counts.filter;
    return *s;
  }
  if (const MaybeSign s = middle()) {
    ++counts.expansion;
    return *s;
  }
  ++counts.exact;
  return exact();
}

}  // namespace

// Differences 1u, product 3u, their difference 4u: 4u (|l| + |r|).
template <>
MaybeSign orient_filter<2>(const Simplex<2>& s) {
  const double l = (s[1][0] - s[0][0]) * (s[2][1] - s[0][1]);
  const double r = (s[1][1] - s[0][1]) * (s[2][0] - s[0][0]);
  return decide(l - r, 4.01 * u * (std::fabs(l) + std::fabs(r)) + orient_underflow);
}

// 2x2 minors 4u (as above), times a difference 6u, sum of three 8u.
template <>
MaybeSign orient_filter<3>(const Simplex<3>& s) {
  const double ax = s[1][0] - s[0][0], ay = s[1][1] - s[0][1], az = s[1][2] - s[0][2];
  const double bx = s[2][0] - s[0][0], by = s[2][1] - s[0][1], bz = s[2][2] - s[0][2];
  const double cx = s[3][0] - s[0][0], cy = s[3][1] - s[0][1], cz = s[3][2] - s[0][2];
  const double bxcy = bx * cy, bycx = by * cx, cxay = cx * ay, cyax = cy * ax, axby = ax * by, aybx = ay * bx;
  const double det = az * (bxcy - bycx) + bz * (cxay - cyax) + cz * (axby - aybx);
  const double za = std::fabs(az), zb = std::fabs(bz), zc = std::fabs(cz);
  const double permanent = (std::fabs(bxcy) + std::fabs(bycx)) * za + (std::fabs(cxay) + std::fabs(cyax)) * zb +
                           (std::fabs(axby) + std::fabs(aybx)) * zc;
  if (!(za + zb + zc < orient_max)) return std::nullopt;
  return decide(det, 8.01 * u * permanent + orient_underflow);
}

template <>
MaybeSign in_sphere_filter<2>(const Simplex<2>& s, const Point2& p) {
  const Sign sign = in_circle_quickly(s[0], s[1], s[2], p);
  return sign == Sign::zero ? std::nullopt : MaybeSign(sign);
}

namespace {

// A sum of products with its permanent.
struct Signed {
  double value, magnitude;
};

inline Signed minor(double ax, double ay, double bx, double by) {
  const double l = ax * by, r = ay * bx;
  return {l - r, std::fabs(l) + std::fabs(r)};
}

}  // namespace

// Heights: squares 3u, sum of three 5u. 2x2 minors 4u, 3x3 minors 8u. Product 14u, sum of four in pairs 16u.
template <>
MaybeSign in_sphere_filter<3>(const Simplex<3>& s, const Point3& p) {
  const double ax = s[0][0] - p[0], ay = s[0][1] - p[1], az = s[0][2] - p[2];
  const double bx = s[1][0] - p[0], by = s[1][1] - p[1], bz = s[1][2] - p[2];
  const double cx = s[2][0] - p[0], cy = s[2][1] - p[1], cz = s[2][2] - p[2];
  const double dx = s[3][0] - p[0], dy = s[3][1] - p[1], dz = s[3][2] - p[2];
  const Signed ab = minor(ax, ay, bx, by), ac = minor(ax, ay, cx, cy), ad = minor(ax, ay, dx, dy);
  const Signed bc = minor(bx, by, cx, cy), bd = minor(bx, by, dx, dy), cd = minor(cx, cy, dx, dy);
  const double za = std::fabs(az), zb = std::fabs(bz), zc = std::fabs(cz), zd = std::fabs(dz);
  const double ha = ax * ax + ay * ay + az * az, hb = bx * bx + by * by + bz * bz;
  const double hc = cx * cx + cy * cy + cz * cz, hd = dx * dx + dy * dy + dz * dz;
  const double det =
      (ha * (cd.value * bz - bd.value * cz + bc.value * dz) - hb * (cd.value * az - ad.value * cz + ac.value * dz)) +
      (hc * (bd.value * az - ad.value * bz + ab.value * dz) - hd * (bc.value * az - ac.value * bz + ab.value * cz));
  const double permanent = (ha * (cd.magnitude * zb + bd.magnitude * zc + bc.magnitude * zd) +
                            hb * (cd.magnitude * za + ad.magnitude * zc + ac.magnitude * zd)) +
                           (hc * (bd.magnitude * za + ad.magnitude * zb + ab.magnitude * zd) +
                            hd * (bc.magnitude * za + ac.magnitude * zb + ab.magnitude * zc));
  if (!(ha + hb + hc + hd < in_sphere_max)) return std::nullopt;
  return decide(det, 16.01 * u * permanent + in_sphere_underflow);
}

// Differences 1u each, product 3u, sum of D (D-1)u.
template <int D>
MaybeSign dot_filter(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  double sum = 0, permanent = 0;
  for (int i = 0; i < D; ++i) {
    const double product = (a[i] - v[i]) * (b[i] - v[i]);
    sum += product;
    permanent += std::fabs(product);
  }
  return decide(sum, (2.01 + D) * u * permanent + orient_underflow);
}

namespace {

Bounded rounded_difference(double a, double b) {
  const double d = a - b;
  return {d, u * std::fabs(d)};
}

}  // namespace

MaybeSign in_circle_filter(const Triangle3& t, const Point3& p, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto row = [&](const Point3& q) { return std::array{rounded_difference(q[i], p[i]), rounded_difference(q[j], p[j])}; };
  const auto drop = [&](const Point3& q) { return rounded_difference(q[axis], p[axis]); };
  const auto sum = [&](const Point3& q) { return rounded_difference(q[axis], -p[axis]); };
  return sign(in_circle_det<Bounded>({row(t[0]), row(t[1]), row(t[2])}, {drop(t[0]), drop(t[1]), drop(t[2])},
                                     {sum(t[0]), sum(t[1]), sum(t[2])}));
}

template <int D>
Sign dot_sign(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  return ladder([&] { return dot_filter(v, a, b); }, [&] { return dot_middle(v, a, b); }, [&] { return dot_exact(v, a, b); });
}

template <int D>
MaybeSign angle_60_filter(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  std::array<Bounded, D> p, q;
  for (std::size_t i = 0; i < D; ++i) {
    p[i] = rounded_difference(a.x[i], v.x[i]);
    q[i] = rounded_difference(b.x[i], v.x[i]);
  }
  return sign(angle_60_det(p, q));
}

template MaybeSign dot_filter<2>(const Point2&, const Point2&, const Point2&);
template MaybeSign dot_filter<3>(const Point3&, const Point3&, const Point3&);
template Sign dot_sign<2>(const Point2&, const Point2&, const Point2&);
template Sign dot_sign<3>(const Point3&, const Point3&, const Point3&);
template MaybeSign angle_60_filter<2>(const Point2&, const Point2&, const Point2&);
template MaybeSign angle_60_filter<3>(const Point3&, const Point3&, const Point3&);

}  // namespace detail

template <int D>
Sign orient(const Simplex<D>& s) {
  return detail::ladder([&] { return detail::orient_filter<D>(s); }, [&] { return detail::orient_middle<D>(s); },
                        [&] { return detail::orient_exact<D>(s); });
}

template <int D>
Sign in_sphere(const Simplex<D>& s, const Point<D>& p) {
  return detail::ladder([&] { return detail::in_sphere_filter<D>(s, p); }, [&] { return detail::in_sphere_middle<D>(s, p); },
                        [&] { return detail::in_sphere_exact<D>(s, p); });
}

Sign orient_projected(const Point3& a, const Point3& b, const Point3& c, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto flat = [&](const Point3& q) { return Point2{{q[i], q[j]}}; };
  return orient2d(flat(a), flat(b), flat(c));
}

namespace {

// The height at p of the plane through the lifted corners is the sum of lambda_i h(s_i), where lambda_i has the sign of
// the orientation of s with s_i replaced by p (s itself being positive). So the in-sphere sign depends on eps(s_i) with
// that sign, and on eps(p) with a minus. Of the points whose coefficient is not zero the lexicographically first, which
// has the largest eps, decides; p's coefficient never is zero.
template <int N, class P, class Coefficient>
Sign perturbed_sign(const std::array<P, N>& corners, const P& p, Coefficient coefficient) {
  std::array<int, N> rank;
  for (int i = 0; i < N; ++i) rank[static_cast<std::size_t>(i)] = i;
  std::sort(rank.begin(), rank.end(),
            [&](int i, int j) { return lex_less(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(j)]); });
  for (const int i : rank) {
    const auto k = static_cast<std::size_t>(i);
    if (lex_less(p, corners[k])) return Sign::negative;
    std::array<P, N> replaced = corners;
    replaced[k] = p;
    if (const Sign s = coefficient(replaced); s != Sign::zero) return s;
  }
  return Sign::negative;
}

}  // namespace

template <int D>
Sign in_sphere_perturbed(const Simplex<D>& s, const Point<D>& p) {
  if (const Sign sign = in_sphere<D>(s, p); sign != Sign::zero) return sign;
  ++detail::counts.perturbed;
  return perturbed_sign<D + 1>(s, p, [](const Simplex<D>& t) { return orient<D>(t); });
}

Sign in_circle_perturbed(const Point3& a, const Point3& b, const Point3& c, const Point3& p, int axis) {
  const detail::Triangle3 t{a, b, c};
  const Sign sign = detail::ladder([&] { return detail::in_circle_filter(t, p, axis); },
                                   [&] { return detail::in_circle_middle(t, p, axis); },
                                   [&] { return detail::in_circle_exact(t, p, axis); });
  if (sign != Sign::zero) return sign;
  ++detail::counts.perturbed;
  return perturbed_sign<3>(t, p, [&](const detail::Triangle3& r) { return orient_projected(r[0], r[1], r[2], axis); });
}

template <int D>
bool angle_below_90(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  return detail::dot_sign(v, a, b) == Sign::positive;
}

// cos > 1/2: dot > 0 and 4 dot^2 > |a-v|^2 |b-v|^2.
template <int D>
bool angle_below_60(const Point<D>& v, const Point<D>& a, const Point<D>& b) {
  if (detail::dot_sign(v, a, b) != Sign::positive) return false;
  return Sign::positive == detail::ladder([&] { return detail::angle_60_filter(v, a, b); },
                                          [&] { return detail::angle_60_middle(v, a, b); },
                                          [&] { return detail::angle_60_exact(v, a, b); });
}

template <int D>
bool collinear(const Point<D>& a, const Point<D>& b, const Point<D>& c) {
  if constexpr (D == 2) {
    return orient2d(a, b, c) == Sign::zero;
  } else {
    for (int axis = 0; axis < 3; ++axis)
      if (orient_projected(a, b, c, axis) != Sign::zero) return false;
    return true;
  }
}

PredicateCounts& PredicateCounts::operator+=(const PredicateCounts& o) {
  filter += o.filter;
  expansion += o.expansion;
  exact += o.exact;
  perturbed += o.perturbed;
  return *this;
}

PredicateCounts PredicateCounts::operator-(const PredicateCounts& o) const {
  return {filter - o.filter, expansion - o.expansion, exact - o.exact, perturbed - o.perturbed};
}

PredicateCounts predicate_counts() { return detail::counts; }

template PGDR_API Sign orient<2>(const Simplex<2>&);
template PGDR_API Sign orient<3>(const Simplex<3>&);
template PGDR_API Sign in_sphere<2>(const Simplex<2>&, const Point2&);
template PGDR_API Sign in_sphere<3>(const Simplex<3>&, const Point3&);
template PGDR_API Sign in_sphere_perturbed<2>(const Simplex<2>&, const Point2&);
template PGDR_API Sign in_sphere_perturbed<3>(const Simplex<3>&, const Point3&);
template PGDR_API bool angle_below_60<2>(const Point2&, const Point2&, const Point2&);
template PGDR_API bool angle_below_60<3>(const Point3&, const Point3&, const Point3&);
template PGDR_API bool angle_below_90<2>(const Point2&, const Point2&, const Point2&);
template PGDR_API bool angle_below_90<3>(const Point3&, const Point3&, const Point3&);
template PGDR_API bool collinear<2>(const Point2&, const Point2&, const Point2&);
template PGDR_API bool collinear<3>(const Point3&, const Point3&, const Point3&);

}  // namespace pgdr
