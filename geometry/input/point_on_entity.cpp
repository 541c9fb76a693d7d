// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points of segments and facets: computed from the input entity alone, in double-double, and rounded once, so that the
// error (half an ulp a coordinate) does not grow with the depth of refinement. Coordinates of extreme size are brought
// to about 1 by a power of two first; between 2^-300 and 2^300 nothing is scaled, and the results scale with the input.
#include <algorithm>
#include <cmath>
#include <limits>

#include "input/bent_facets.hpp"
#include "input/entities.hpp"
#include "input/numbers.hpp"
#include "input/triangle_shapes.hpp"
#include "numbers/double_double.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using detail::DoubleDouble;
using detail::DoubleDoubles;

template <int D>
double largest(std::initializer_list<Point<D>> points) {
  double m = 0;
  for (const Point<D>& p : points)
    for (const double x : p.x) m = std::max(m, std::fabs(x));
  return m;
}

// Exponent to take out before squares of squares are formed.
int excess_exponent(double magnitude) {
  if (magnitude == 0) return 0;
  const int e = std::ilogb(magnitude);
  return e < -300 || e > 300 ? e : 0;
}

template <int D>
Point<D> scaled(Point<D> p, int exponent) {
  if (exponent == 0) return p;
  for (double& x : p.x) x = std::ldexp(x, exponent);
  return p;
}

template <int D>
auto difference(const Point<D>& p, const Point<D>& q) {
  DoubleDoubles<static_cast<std::size_t>(D)> d;
  for (int i = 0; i < D; ++i) d[static_cast<std::size_t>(i)] = detail::difference(p[i], q[i]);
  return d;
}

// (b - a) x (c - a) with both brought to size 1: its length is of no use, its direction is.
DoubleDoubles<3> unit_normal(const Point3& a, const Point3& b, const Point3& c) {
  auto u = difference(b, a), w = difference(c, a);
  for (auto* v : {&u, &w}) {
    double m = 0;
    for (const DoubleDouble& x : *v) m = std::max(m, std::fabs(x.hi));
    const int e = m == 0 ? 0 : std::ilogb(m);
    for (DoubleDouble& x : *v) x = {std::ldexp(x.hi, -e), std::ldexp(x.lo, -e)};
  }
  return detail::cross(u, w);
}

Point3 project(const Point3& a, const Point3& b, const Point3& c, Point3 x) {
  for (int i = 0; i < 3; ++i)
    if (a[i] == b[i] && a[i] == c[i]) {
      x[i] = a[i];
      return x;
    }
  const int e = excess_exponent(largest({a, b, c, x}));
  const Point3 origin = scaled(a, -e), y = scaled(x, -e);
  const auto n = unit_normal(origin, scaled(b, -e), scaled(c, -e));
  const DoubleDouble s = detail::dot(n, difference(y, origin)) / detail::dot(n, n);
  Point3 p;
  for (int i = 0; i < 3; ++i) p[i] = (DoubleDouble(y[i]) - n[static_cast<std::size_t>(i)] * s).rounded();
  return scaled(p, e);
}

// Distance of x from the edge a-b in the projection.
double projected_distance(Point3 a, Point3 b, Point3 x, int axis) {
  const int e = excess_exponent(largest({a, b, x}));
  for (Point3* p : {&a, &b, &x}) *p = scaled(*p, -e);
  const int u = (axis + 1) % 3, w = (axis + 2) % 3;
  const double du = b[u] - a[u], dw = b[w] - a[w];
  const double t = std::clamp(((x[u] - a[u]) * du + (x[w] - a[w]) * dw) / (du * du + dw * dw), 0.0, 1.0);
  const double ru = x[u] - (a[u] + t * du), rw = x[w] - (a[w] + t * dw);
  return std::ldexp(std::sqrt(ru * ru + rw * rw), e);
}

bool holds(const Point3& a, const Point3& b, const Point3& c, const Point3& x, int axis) {
  for (const int i : {(axis + 1) % 3, (axis + 2) % 3})
    if (x[i] < std::min({a[i], b[i], c[i]}) || x[i] > std::max({a[i], b[i], c[i]})) return false;
  return orient_projected(a, b, x, axis) != Sign::negative && orient_projected(b, c, x, axis) != Sign::negative &&
         orient_projected(c, a, x, axis) != Sign::negative;
}

/// In the projection.
std::size_t nearest_triangle(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const Point3> points,
                             const Point3& x, int axis) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Point3 &a = points[triangles[k][0]], &b = points[triangles[k][1]], &c = points[triangles[k][2]];
    const double d = std::min(
        {projected_distance(a, b, x, axis), projected_distance(b, c, x, axis), projected_distance(c, a, x, axis)});
    if (d < least) {
      least = d;
      best = k;
    }
  }
  return best;
}

}  // namespace

double detail::plane_distance(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
  const int e = excess_exponent(largest({a, b, c, p}));
  const Point3 origin = scaled(a, -e);
  const auto n = unit_normal(origin, scaled(b, -e), scaled(c, -e));
  const double distance = std::fabs(dot(n, pgdr::difference(scaled(p, -e), origin)).rounded());
  return std::ldexp(distance / std::sqrt(dot(n, n).rounded()), e);
}

template <int D>
Point<D> point_on_segment(const Domain<D>& domain, EntityId s, double t) {
  const auto& ends = domain.segments()[s].points;
  Point<D> p = domain.points()[ends[0]], q = domain.points()[ends[1]];
  const int e = excess_exponent(largest({p, q}));
  p = scaled(p, -e);
  q = scaled(q, -e);
  for (int i = 0; i < D; ++i)
    if (p[i] != q[i]) p[i] = (DoubleDouble(p[i]) + detail::difference(q[i], p[i]) * DoubleDouble(t)).rounded();
  return scaled(p, e);
}

template <int D>
double segment_parameter(const Domain<D>& domain, EntityId s, const Point<D>& x) {
  const auto& ends = domain.segments()[s].points;
  const Point<D>&p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
  const int e = excess_exponent(largest({p, q, x}));
  const auto d = difference(scaled(q, -e), scaled(p, -e));
  const DoubleDouble length2 = detail::dot(d, d);
  if (!(length2.hi > 0)) return 0.5;  // underflow: the segment is a rounding error of its coordinates
  return std::clamp((detail::dot(difference(scaled(x, -e), scaled(p, -e)), d) / length2).rounded(), 0.0, 1.0);
}

// Of a bent facet, the projection to the plane of the triangle that has x may lie in another triangle: then that one's
// plane is meant, and so on; on either side of a fold each may send to the other, but the point is on both planes there.
Point<3> point_on_facet(const Domain<3>& domain, EntityId f, const Point<3>& x) {
  const DomainFacet& facet = domain.facets()[f];
  const auto points = domain.points();
  const auto triangles = domain.triangles(f);
  const auto projected = [&](const Point3& p, std::size_t k) {
    return project(points[triangles[k][0]], points[triangles[k][1]], points[triangles[k][2]], p);
  };
  if (facet.planar) return projected(x, 0);
  const auto has = [&](std::size_t k, const Point3& p) {
    return holds(points[triangles[k][0]], points[triangles[k][1]], points[triangles[k][2]], p, facet.axis);
  };
  const auto holding = [&](const Point3& p) {
    return domain.bent_facets_->find(f)->first(p, [&](std::uint32_t k) { return has(k, p); });
  };
  const auto first = holding(x);
  std::size_t at = first ? *first : nearest_triangle(triangles, points, x, facet.axis);
  Point3 p = projected(x, at);
  for (int n = 0; n < numbers::projections_onto_bent && !has(at, p); ++n) {
    const auto next = holding(p);
    if (!next) break;
    at = *next;
    p = projected(p, at);
  }
  return p;
}

template PGDR_API Point2 point_on_segment<2>(const Domain<2>&, EntityId, double);
template PGDR_API Point3 point_on_segment<3>(const Domain<3>&, EntityId, double);
template double segment_parameter<2>(const Domain<2>&, EntityId, const Point2&);
template double segment_parameter<3>(const Domain<3>&, EntityId, const Point3&);

}  // namespace pgdr
