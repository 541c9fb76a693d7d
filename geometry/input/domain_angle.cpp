// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which entities of a Domain touch, and at what angle. Cosines are formed in double-double, so that an angle of exactly
// 60 or 90 degrees is not reported as less.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "input/entities.hpp"
#include "input/sharp_angles.hpp"
#include "numbers/dihedral_sign.hpp"
#include "numbers/double_double.hpp"
#include "pgdr/domain.hpp"
#include "space/triangle.hpp"

namespace pgdr {
namespace {

using detail::cross;
using detail::dot;
using detail::DoubleDouble;
using Vector = detail::DoubleDoubles<3>;

// q - p, brought to size 1; z = 0 in the plane.
template <int D>
Vector direction(const Point<D>& p, const Point<D>& q) {
  Vector v;
  double m = 0;
  for (int i = 0; i < D; ++i) {
    auto& x = v[static_cast<std::size_t>(i)];
    x = detail::difference(0.5 * q[i], 0.5 * p[i]);  // half: no overflow
    m = std::max(m, std::fabs(x.hi));
  }
  const int e = m == 0 ? 0 : std::ilogb(m);
  for (auto& x : v) x = {std::ldexp(x.hi, -e), std::ldexp(x.lo, -e)};
  return v;
}

// The angle whose sine and cosine these are, times something, in degrees; sine >= 0. Of operations that IEEE 754 defines alone,
// since meshes rest on it: std::atan2 differs from library to library.
double degrees(double sine, double cosine) {
  if (cosine < 0) return 180 - degrees(sine, -cosine);
  const double most = std::max(sine, cosine);
  if (most == 0) return 0;
  if (cosine == 0) return 90;
  const double s = sine / most, c = cosine / most;
  double t = s / (c + std::sqrt(s * s + c * c));                                  // the tangent of half the angle, at most 1
  for (int halved = 0; halved < 3; ++halved) t = t / (1 + std::sqrt(1 + t * t));  // of a 16th in the end, below 0.0985
  const double t2 = t * t;
  double sum = 0;  // arctan t = t - t^3 / 3 + t^5 / 5 - ...; the next term is below 2^-67 t
  for (int k = 17; k > 1; k -= 2) sum = t2 * (1.0 / k - sum);
  return 16 * (t - t * sum) * (180 / std::numbers::pi);
}

double angle_between(const Vector& u, const Vector& w) {
  const DoubleDouble cosine = dot(u, w);
  const Vector n = cross(u, w);
  double a = degrees(std::sqrt(dot(n, n).hi), cosine.hi);
  const auto settle = [&a](double limit, bool below) {  // rounding must not contradict the better cosine
    a = below ? std::min(a, std::nextafter(limit, 0.0)) : std::max(a, limit);
  };
  settle(90, cosine.hi > 0);
  settle(60, cosine.hi > 0 && (DoubleDouble(4) * cosine * cosine - dot(u, u) * dot(w, w)).hi > 0);
  return a;
}

// The smallest angle between r and a direction into the corner from b to c. Such a direction is a positive combination of b and
// c, so that it is acute only if that to b or to c is: rounding must not say otherwise, where the checker decides exactly.
double angle_to_corner(const Vector& r, const Vector& b, const Vector& c) {
  const double rays = std::min(angle_between(r, b), angle_between(r, c));
  if (rays >= 90) return rays;
  const Vector n = cross(b, c);
  if (!(dot(cross(n, b), r).hi > 0 && dot(cross(c, n), r).hi > 0)) return rays;
  const Vector along = cross(n, r);
  return std::min(rays, degrees(std::fabs(dot(n, r).hi), std::sqrt(dot(along, along).hi)));
}

struct Corner {
  Vector b, c;
};

std::vector<Corner> corners_at(const Domain<3>& domain, EntityId f, std::uint32_t v, CountedTriangles counted) {
  std::vector<Corner> out;
  const auto p = domain.points();
  for (const std::uint32_t k : domain.triangles_at(f, v)) {
    if (!counted.empty() && counted[k] == 0) continue;
    const auto& t = domain.triangles(f)[k - domain.facets()[f].first_triangle];
    for (std::size_t i = 0; i < 3; ++i)
      if (t[i] == v) out.push_back({direction(p[v], p[t[(i + 1) % 3]]), direction(p[v], p[t[(i + 2) % 3]])});
  }
  return out;
}

// A triangle at a segment: its third corner, and the normal of its half-plane; angles of half-planes are angles of these.
struct HalfPlane {
  std::uint32_t apex;
  Vector normal;
};

std::vector<HalfPlane> half_planes(const Domain<3>& domain, EntityId f, const DomainSegment& s, CountedTriangles counted) {
  std::vector<HalfPlane> out;
  const auto p = domain.points();
  const auto [a, b] = s.points;
  for (const std::uint32_t k : domain.triangles_at(f, a)) {
    if (!counted.empty() && counted[k] == 0) continue;
    const auto& t = domain.triangles(f)[k - domain.facets()[f].first_triangle];
    if (std::find(t.begin(), t.end(), b) == t.end()) continue;
    const std::uint32_t c = detail::corner_beside(t, a, b);
    out.push_back({c, cross(direction(p[a], p[b]), direction(p[a], p[c]))});
  }
  return out;
}

// The angle of two half-planes at the segment. The product of their normals has more digits than two doubles: near 90 degrees
// its sign is had exactly. What is near is far more than the angle is off, which is less than 2^-40 of a degree; so how much
// more changes nothing.
double dihedral_angle(const Domain<3>& domain, const DomainSegment& s, const HalfPlane& u, const HalfPlane& w) {
  constexpr double near = 1e-6;
  const double angle = angle_between(u.normal, w.normal);
  if (std::fabs(angle - 90) > near) return angle;
  const auto p = domain.points();
  const Sign sign = detail::dihedral_sign(p[s.points[0]], p[s.points[1]], p[u.apex], p[w.apex]);
  return sign == Sign::positive ? std::min(angle, std::nextafter(90.0, 0.0)) : std::max(angle, 90.0);
}

// Of two sorted ranges, one of which may be much longer.
std::vector<std::uint32_t> common(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a.size() > b.size()) std::swap(a, b);
  std::vector<std::uint32_t> out;
  std::copy_if(a.begin(), a.end(), std::back_inserter(out),
               [b](std::uint32_t id) { return std::binary_search(b.begin(), b.end(), id); });
  return out;
}

template <int D>
double segment_angle(const Domain<D>& domain, EntityId s, EntityId t) {
  const auto p = domain.points();
  const auto &a = domain.segments()[s].points, &b = domain.segments()[t].points;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      if (a[i] == b[j]) return angle_between(direction(p[a[i]], p[a[1 - i]]), direction(p[b[j]], p[b[1 - j]]));
  return 180;
}

double segment_facet_angle(const Domain<3>& domain, EntityId s, EntityId f, CountedTriangles counted) {
  const auto own = domain.facet_segments(f);
  if (std::binary_search(own.begin(), own.end(), s)) return 180;  // part of it
  const auto points = domain.facet_points(f);
  const auto& ends = domain.segments()[s].points;
  double least = 180;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::binary_search(points.begin(), points.end(), ends[i])) continue;
    const Vector r = direction(domain.points()[ends[i]], domain.points()[ends[1 - i]]);
    for (const Corner& k : corners_at(domain, f, ends[i], counted)) least = std::min(least, angle_to_corner(r, k.b, k.c));
  }
  return least;
}

double facet_angle(const Domain<3>& domain, EntityId f, EntityId g, CountedTriangles counted) {
  double least = 180;
  std::vector<std::uint32_t> done;
  for (const EntityId s : common(domain.facet_segments(f), domain.facet_segments(g))) {
    const DomainSegment& segment = domain.segments()[s];
    done.insert(done.end(), segment.points.begin(), segment.points.end());
    const auto with = half_planes(domain, g, segment, counted);
    for (const HalfPlane& u : half_planes(domain, f, segment, counted))
      for (const HalfPlane& w : with) least = std::min(least, dihedral_angle(domain, segment, u, w));
  }
  for (const std::uint32_t v : common(domain.facet_points(f), domain.facet_points(g))) {
    if (std::find(done.begin(), done.end(), v) != done.end()) continue;  // along the segment the angle is 0
    const auto with = corners_at(domain, g, v, counted);
    for (const Corner& k : corners_at(domain, f, v, counted))
      for (const Corner& l : with)
        least = std::min({least, angle_to_corner(k.b, l.b, l.c), angle_to_corner(k.c, l.b, l.c), angle_to_corner(l.b, k.b, k.c),
                          angle_to_corner(l.c, k.b, k.c)});
  }
  return least;
}

// The input vertices of a vertex (twice the same) or a segment.
template <int D>
std::array<std::uint32_t, 2> few_points(const Domain<D>& domain, EntityRef e) {
  if (e.kind == EntityKind::vertex) return {e.id, e.id};
  return domain.segments()[e.id].points;
}

}  // namespace

double dihedral_degrees(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector edge = direction(a, b);
  return angle_between(cross(edge, direction(a, c)), cross(edge, direction(a, d)));
}

template <int D>
bool entities_touch(const Domain<D>& domain, EntityRef a, EntityRef b) {
  if (a.kind == EntityKind::volume || b.kind == EntityKind::volume) return false;
  if (a.kind == EntityKind::facet) std::swap(a, b);
  if constexpr (D == 3) {
    if (b.kind == EntityKind::facet) {
      if (a.kind == EntityKind::facet) return domain.facets_touch(a.id, b.id);
      const auto points = domain.facet_points(b.id);
      return std::ranges::any_of(few_points(domain, a),
                                 [&](std::uint32_t v) { return std::binary_search(points.begin(), points.end(), v); });
    }
  }
  const auto p = few_points(domain, a), q = few_points(domain, b);
  return p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
}

template <int D>
double entity_angle(const Domain<D>& domain, EntityRef a, EntityRef b) {
  return counted_angle<D>(domain, a, b, {});
}

template <int D>
double counted_angle(const Domain<D>& domain, EntityRef a, EntityRef b, CountedTriangles counted) {
  if (a == b) return 180;
  if (a.kind > b.kind) std::swap(a, b);
  if (a.kind == EntityKind::segment && b.kind == EntityKind::segment) return segment_angle(domain, a.id, b.id);
  if constexpr (D == 3) {
    if (a.kind == EntityKind::segment && b.kind == EntityKind::facet) return segment_facet_angle(domain, a.id, b.id, counted);
    if (a.kind == EntityKind::facet && b.kind == EntityKind::facet) return facet_angle(domain, a.id, b.id, counted);
  }
  return 180;
}

template bool entities_touch<2>(const Domain<2>&, EntityRef, EntityRef);
template bool entities_touch<3>(const Domain<3>&, EntityRef, EntityRef);
template double counted_angle<2>(const Domain<2>&, EntityRef, EntityRef, CountedTriangles);
template double counted_angle<3>(const Domain<3>&, EntityRef, EntityRef, CountedTriangles);
template PGDR_API double entity_angle<2>(const Domain<2>&, EntityRef, EntityRef);
template PGDR_API double entity_angle<3>(const Domain<3>&, EntityRef, EntityRef);

}  // namespace pgdr
