// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumspheres and diametral balls. The corners are put into lexicographic order first, so that results are functions
// of the vertex set, bit for bit; then doubles relative to the first corner with a bound on the error, and rationals
// rounded to nearest where that bound is poor.
#include "pgdr/circumsphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "numbers/circum_terms.hpp"
#include "numbers/determinants.hpp"
#include "numbers/predicate_stages.hpp"

namespace pgdr {
namespace {

using detail::unit_roundoff;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Lexicographic order. Branches on random corners would be mispredicted half of the time, so corners are ranked by the
// first coordinate without any; where two are equal there the full comparison decides.
template <std::size_t N, int D>
std::array<Point<D>, N> sorted(const std::array<Point<D>, N>& s) {
  std::array<unsigned, N> rank{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i + 1; j < N; ++j) {
      const unsigned before = s[i][0] < s[j][0];
      rank[j] += before;
      rank[i] += 1 - before;
    }
  std::array<Point<D>, N> result;
  for (std::size_t i = 0; i < N; ++i) result[rank[i]] = s[i];
  bool strict = true;
  for (std::size_t i = 1; i < N; ++i) strict &= result[i - 1][0] < result[i][0];
  if (!strict)  // an insertion sort, which std::sort is not always
    for (std::size_t i = 1; i < N; ++i)
      for (std::size_t j = i; j > 0 && lex_less(result[j], result[j - 1]); --j) std::swap(result[j], result[j - 1]);
  return result;
}

using detail::one_norm;
template <int D>
using Offset = detail::CircumOffset<D>;

template <int D>
Offset<D> simplex_offset(const std::array<std::array<double, D>, D>& d) {
  const detail::CircumTerms<D> t = detail::circum_terms(d);
  Offset<D> o = detail::circum_offset<D>(t);
  if (!detail::in_safe_range(t.longest2)) o.error = infinity;
  return o;
}

// The circumcentre of a triangle with edges b, c at the first corner: (|c|^2 n x b + |b|^2 c x n) / (2 |n|^2), n = b x c.
// With q = M^2 / |n|: n is off by 5.7u M^2, the numerator by (11.4 q + 23) u M^3 |n|, |n|^2 by (11.4 q + 5) u |n|^2;
// with M <= 2r the quotient is off by u r (11.4 q^2 + 35 q + 7) < 54u q^2 r. That is below 2^-20 r for q^2 < 2^27.
Offset<3> triangle_offset(const std::array<std::array<double, 3>, 2>& d) {
  const auto &b = d[0], &c = d[1];
  const auto n = detail::cross(b, c), nb = detail::cross(n, b), cn = detail::cross(c, n);
  const double b2 = detail::norm2(b), c2 = detail::norm2(c), n2 = detail::norm2(n), m2 = std::max(b2, c2);
  if (!(0x1p27 * n2 > m2 * m2) || !detail::in_safe_range(m2)) return {{}, infinity};
  const double inverse = 0.5 / n2;
  Offset<3> o{};
  for (std::size_t i = 0; i < 3; ++i) o.w[i] = (c2 * nb[i] + b2 * cn[i]) * inverse;
  return o;
}

template <int D>
bool accurate(const Offset<D>& o) {
  double largest = 0;  // at most r, and within sqrt(D) of it; no squares, which might underflow
  for (const double x : o.w) largest = std::max(largest, std::fabs(x));
  return o.error <= detail::accepted_error * largest && largest < infinity;
}

/// The centre first + o.w, rounded, and what bounds its error.
template <int D>
struct Center {
  Point<D> point;
  double error;
};

template <int D>
double error_with_last_rounding(const Point<D>& center, double error) {
  const double sum = detail::error_with_last_rounding(center.x, error);
  return sum < infinity ? sum : infinity;
}

template <int D>
Center<D> add_offset(const Point<D>& first, const Offset<D>& o) {
  Center<D> c;
  for (int i = 0; i < D; ++i) c.point[i] = first[i] + o.w[static_cast<std::size_t>(i)];
  c.error = error_with_last_rounding(c.point, o.error);
  return c;
}

// What the plain evaluation leaves: edges of extreme length, which are scaled by a power of two, and back; and the
// ill-conditioned, in rationals.
template <int D, std::size_t N, std::size_t Corners, class Function>
[[gnu::noinline]] Center<D> difficult_center(const std::array<Point<D>, Corners>& corners,
                                             std::array<std::array<double, D>, N> edges, Function offset) {
  double largest = 0;
  for (const auto& v : edges)
    for (const double x : v) largest = std::max(largest, std::fabs(x));
  if (largest > 0 && largest < infinity) {
    const int k = std::ilogb(largest);
    for (auto& v : edges)
      for (double& x : v) x = std::scalbn(x, -k);
    Offset<D> o = offset(edges);
    if (accurate<D>(o)) {
      for (double& x : o.w) x = std::scalbn(x, k);
      o.error = std::scalbn(o.error, k) + 0x1p-1070;
      return add_offset<D>(corners[0], o);
    }
  }
  const Point<D> c = detail::circumcenter_exact(corners);
  return {c, error_with_last_rounding(c, 0x1p-1070)};
}

template <int D, std::size_t N, std::size_t Corners, class Function>
Center<D> center_of(const std::array<Point<D>, Corners>& corners, const std::array<std::array<double, D>, N>& edges,
                    Function offset) {
  const Offset<D> o = offset(edges);
  if (accurate<D>(o)) [[likely]]
    return add_offset<D>(corners[0], o);
  return difficult_center<D, N>(corners, edges, offset);
}

}  // namespace

template <int D>
Circumsphere<D> circumsphere(const Simplex<D>& s) {
  const Simplex<D> corners = sorted<D + 1, D>(s);
  const Center<D> c = center_of<D>(corners, detail::edges_from_first<D>(corners),
                                   [](const auto& d) { return simplex_offset<D>(d); });
  return {c.point, squared_distance(c.point, corners[0]), c.error};
}

template <int D>
double shortest_edge_squared(const Simplex<D>& s) {
  double shortest = squared_distance(s[0], s[1]);
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t j = std::max<std::size_t>(i + 1, 2); j <= D; ++j)
      shortest = std::min(shortest, squared_distance(s[i], s[j]));
  return shortest;
}

// Each coordinate is summed from its least value to its largest: a sorting network, without branches.
template <int D>
Point<D> centroid(const Simplex<D>& s) {
  Point<D> c;
  for (int k = 0; k < D; ++k) {
    std::array<double, D + 1> v;
    for (std::size_t i = 0; i <= D; ++i) v[i] = s[i][k];
    auto order = [&v](std::size_t i, std::size_t j) {
      const double low = std::min(v[i], v[j]), high = std::max(v[i], v[j]);
      v[i] = low;
      v[j] = high;
    };
    order(0, 1);
    if constexpr (D == 2) {
      order(1, 2);
      order(0, 1);
    } else {
      order(2, 3);
      order(0, 2);
      order(1, 3);
      order(1, 2);
    }
    c[k] = std::accumulate(v.begin() + 1, v.end(), v[0]) / (D + 1);
  }
  return c;
}

template <int D>
Ball<D> diametral_ball(const Point<D>& a, const Point<D>& b) {
  Ball<D> ball;
  for (int i = 0; i < D; ++i) ball.center[i] = 0.5 * (a[i] + b[i]);
  ball.squared_radius = 0.25 * squared_distance(a, b);
  return ball;
}

Ball<3> equatorial_ball(const Point3& a, const Point3& b, const Point3& c) {
  const std::array<Point3, 3> p = sorted<3, 3>({a, b, c});
  const auto edge = [&](std::size_t i) { return std::array{p[i][0] - p[0][0], p[i][1] - p[0][1], p[i][2] - p[0][2]}; };
  const Center<3> center = center_of<3, 2>(p, {edge(1), edge(2)}, triangle_offset);
  return {center.point, squared_distance(center.point, p[0])};
}

template <int D>
bool in_diametral_ball(const Point<D>& a, const Point<D>& b, const Point<D>& x) {
  return detail::dot_sign<D>(x, a, b) == Sign::negative;
}

bool in_equatorial_ball(const Ball<3>& ball, const Point3& x) { return squared_distance(ball.center, x) < ball.squared_radius; }

template PGDR_API Circumsphere<2> circumsphere<2>(const Simplex<2>&);
template PGDR_API Circumsphere<3> circumsphere<3>(const Simplex<3>&);
template PGDR_API double shortest_edge_squared<2>(const Simplex<2>&);
template PGDR_API double shortest_edge_squared<3>(const Simplex<3>&);
template PGDR_API Point2 centroid<2>(const Simplex<2>&);
template PGDR_API Point3 centroid<3>(const Simplex<3>&);
template PGDR_API Ball<2> diametral_ball<2>(const Point2&, const Point2&);
template PGDR_API Ball<3> diametral_ball<3>(const Point3&, const Point3&);
template PGDR_API bool in_diametral_ball<2>(const Point2&, const Point2&, const Point2&);
template PGDR_API bool in_diametral_ball<3>(const Point3&, const Point3&, const Point3&);

}  // namespace pgdr
