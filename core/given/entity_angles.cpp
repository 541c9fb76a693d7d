// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A direction into a facet at one of its points is a positive combination of the edges of its triangles there, and the product of
// two positive combinations is positive for some choice iff it is for a pair of edges: so edges decide whether an angle is small.
#include "given/entity_angles.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "given/edge_net.hpp"
#include "numbers/angle_bounds.hpp"
#include "numbers/dihedral_sign.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/equal_rows.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;
using detail::Vector;

constexpr double in_degrees = 180 / std::numbers::pi;
constexpr double doubles = 0x1p-48;      // radians: a direction and a product of two in doubles are off by some 2^-52
constexpr double known_at_all = 0x1p-6;  // radians: an angle that may be off by more tells nothing

template <std::size_t N>
double length(const Vector<N>& u) {
  return std::sqrt(dot(u, u));
}

/// The difference of two points, brought to size 1: no product of such ones overflows.
template <int D>
struct Scaled {
  Vector<D> v;
  double size;  ///< a power of two
};

template <int D>
Scaled<D> scaled(const Point<D>& from, const Point<D>& to) {
  Scaled<D> u{difference(to, from), 1};
  double most = 0;
  for (const double x : u.v) most = std::max(most, std::abs(x));
  if (!(most > 0) || !std::isfinite(most)) return u;
  const int e = std::ilogb(most);
  u.size = std::ldexp(1.0, e);
  for (double& x : u.v) x = std::ldexp(x, -e);
  return u;
}

template <int D>
double angle_of(const Vector<D>& u, const Vector<D>& w) {
  if constexpr (D == 2)
    return std::atan2(std::abs(u[0] * w[1] - u[1] * w[0]), dot(u, w));
  else
    return std::atan2(length(cross(u, w)), dot(u, w));
}

/// A direction, or a normal, and by how much it may be turned, in radians.
template <int D>
struct Direction {
  Vector<D> along;
  double off;
};

/// asin x <= pi / 2 x
double turned_by(double sine) { return sine < 1 ? std::numbers::pi / 2 * sine + doubles : std::numbers::pi; }

template <int D>
Direction<D> direction(const Point<D>& from, const Point<D>& to, double off) {
  const auto u = scaled(from, to);
  return {u.v, turned_by(2 * (off / u.size) / length(u.v))};
}

/// Of the plane of a point and two others. The area of their parallelogram is off by no more than the lengths of its sides times
/// what their ends are off, and by rounding.
Direction<3> normal(const Point3& at, const Point3& p, const Point3& q, double off) {
  const auto u = scaled(at, p), w = scaled(at, q);
  const auto n = cross(u.v, w.v);
  const double error = 2 * (off / w.size) * length(u.v) + 2 * (off / u.size) * length(w.v) + 0x1p-50 * length(u.v) * length(w.v);
  return {n, turned_by(error / length(n))};
}

AngleRange range(double radians, double off) {
  return {(radians - off - doubles) * in_degrees, (radians + off + doubles) * in_degrees};
}

template <int D>
std::span<const typename NamedEntity<D>::AtEdge> edges_at(const NamedEntity<D>& e, const detail::PlanarEdge& ends) {
  using AtEdge = typename NamedEntity<D>::AtEdge;
  return detail::equal_rows(std::span<const AtEdge>(e.edges), ends, &AtEdge::ends);
}

/// A facet that has the segment, or a piece of it, makes no angle with it.
template <int D>
bool has_segment(const NamedEntity<D>& facet, const NamedEntity<D>& segment) {
  return !edges_at<D>(facet, sorted_edge(segment.ends[0], segment.ends[1])).empty() ||
         std::ranges::any_of(segment.edges, [&](const auto& piece) { return !edges_at<D>(facet, piece.ends).empty(); });
}

/// Pairs of points: what is between the directions to these is of the entity about v. Twice the same one of a segment.
using Rays = std::vector<std::array<std::uint32_t, 2>>;

template <int D>
Rays rays_at(const NamedEntity<D>& e, std::uint32_t v) {
  Rays out;
  if (e.kind == EntityKind::segment)
    for (std::size_t k = 0; k < 2; ++k)
      if (e.ends[k] == v) out.push_back({e.ends[1 - k], e.ends[1 - k]});
  using At = std::pair<std::uint32_t, std::uint32_t>;
  for (const auto& [point, number] : detail::equal_rows(std::span<const At>(e.at), v, &At::first)) {
    auto t = e.triangles[number];
    std::rotate(t.begin(), std::find(t.begin(), t.end(), v), t.end());
    out.push_back({t[1], t[2]});
  }
  return out;
}

template <int D>
std::vector<std::uint32_t> common_points(const NamedEntity<D>& a, const NamedEntity<D>& b) {
  std::vector<std::uint32_t> common;
  std::set_intersection(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), std::back_inserter(common));
  return common;
}

void merge(std::vector<AngleRange>& ranges) {
  std::ranges::sort(ranges, {}, &AngleRange::low);
  std::vector<AngleRange> merged;
  for (const AngleRange& r : ranges)
    if (!merged.empty() && r.low <= merged.back().high)
      merged.back().high = std::max(merged.back().high, r.high);
    else
      merged.push_back(r);
  ranges = std::move(merged);
}

template <int D>
class Meetings {
 public:
  Meetings(const NamedEntities<D>& entities, const NamedEntity<D>& a, const NamedEntity<D>& b, const AngleBounds& bounds)
      : entities_(entities), a_(a), b_(b), bounds_(bounds) {}

  EntityMeeting run() {
    if (are_one(a_, b_)) return {};
    if (a_.kind == EntityKind::segment && b_.kind == EntityKind::segment)
      meet_segments();
    else if (a_.kind == EntityKind::facet && b_.kind == EntityKind::facet)
      meet_facets();
    else
      meet_at_points({});
    merge(out_.small);
    return std::move(out_);
  }

 private:
  const Point<D>& point(std::uint32_t p) const { return entities_.point(p); }
  /// Of the mesh's own surface a facet may have been one of other triangles, through other points of its slab, for whom it was
  /// named by.
  double off(const NamedEntity<D>& e, std::uint32_t p) const {
    if (e.kind == EntityKind::segment) return 0;
    return entities_.are_own() ? e.off : entities_.slack(e, p);
  }

  void meet_segments() {
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) {
        if (a_.ends[i] != b_.ends[k]) continue;
        const Point<D>&v = point(a_.ends[i]), &p = point(a_.ends[1 - i]), &q = point(b_.ends[1 - k]);
        take(true, angle_below_60<D>(v, p, q), angle_of<D>(scaled(v, p).v, scaled(v, q).v), 0, 60);
        if constexpr (D == 3) out_.is_sharp = out_.is_sharp || detail::is_too_sharp<3>(v, p, q, bounds_.radius_edge);
      }
  }

  /// @param below  exactly, of these points. @param turned by how much the angle may be off, in radians, unless it is exact
  void take(bool is_exact, bool below, double angle, double turned, double limit) {
    const bool known = turned <= known_at_all;
    if (!below && (is_exact || !known || (angle - turned) * in_degrees >= limit)) return;
    out_.is_small = true;
    out_.small.push_back(known ? range(angle, turned) : AngleRange{0, limit});
  }

  void meet_facets() {
    std::vector<std::uint32_t> on_common;  // at their ends two facets with a common segment make no other angle
    for (std::size_t i = 0, j; i < a_.edges.size(); i = j) {
      for (j = i + 1; j < a_.edges.size() && a_.edges[j].ends == a_.edges[i].ends;) ++j;
      const auto& ends = a_.edges[i].ends;
      const auto beyond = edges_at<D>(b_, ends);
      if (beyond.empty()) continue;
      on_common.insert(on_common.end(), ends.begin(), ends.end());
      for (std::size_t k = i; k < j; ++k)
        for (const auto& other : beyond) meet_at_edge(ends, a_.edges[k].apex, other.apex);
    }
    detail::make_set(on_common);
    meet_at_points(on_common);
  }

  void meet_at_edge(const detail::PlanarEdge& ends, std::uint32_t c, std::uint32_t d) {
    if constexpr (D == 3) {
      const Point3 &p = point(ends[0]), &q = point(ends[1]), &x = point(c), &y = point(d);
      const double of_a = std::max({off(a_, ends[0]), off(a_, ends[1]), off(a_, c)});
      const double of_b = std::max({off(b_, ends[0]), off(b_, ends[1]), off(b_, d)});
      const auto u = normal(p, q, x, of_a), w = normal(p, q, y, of_b);
      const bool is_exact = of_a == 0 && of_b == 0;
      const bool below = (is_exact || entities_.are_own()) && detail::dihedral_sign(p, q, x, y) == Sign::positive;
      take(is_exact, below, angle_of<3>(u.along, w.along), u.off + w.off, 90);
      out_.is_sharp = out_.is_sharp || (bounds_.largest_cosine < 1 && detail::dihedral_below(p, q, x, y, bounds_.largest_cosine));
    }
  }

  /// At common points, but for some.
  void meet_at_points(const std::vector<std::uint32_t>& but) {
    for (const std::uint32_t v : common_points<D>(a_, b_)) {
      if (std::binary_search(but.begin(), but.end(), v)) continue;
      const auto of_a = rays_at<D>(a_, v), of_b = rays_at<D>(b_, v);
      look(a_, b_, v, of_a, of_b);
      look(b_, a_, v, of_b, of_a);
    }
  }

  void look(const NamedEntity<D>& from, const NamedEntity<D>& to, std::uint32_t v, const Rays& rays, const Rays& sectors) {
    for (const auto& ray : rays)
      for (std::size_t i = 0; i < (ray[0] == ray[1] ? 1u : 2u); ++i)
        for (const auto& [c, d] : sectors) look_at(from, to, v, ray[i], c, d);
  }

  /// The smallest angle of the ray to r, and a direction between those to c and d.
  void look_at(const NamedEntity<D>& from, const NamedEntity<D>& to, std::uint32_t v, std::uint32_t r, std::uint32_t c,
               std::uint32_t d) {
    if constexpr (D == 3) {
      const Point3& o = point(v);
      const double of_ray = std::max(off(from, v), off(from, r)), of_sector = std::max({off(to, v), off(to, c), off(to, d)});
      const auto x = direction(o, point(r), of_ray), y = direction(o, point(c), of_sector), z = direction(o, point(d), of_sector);
      double angle = std::min(angle_of<3>(x.along, y.along), angle_of<3>(x.along, z.along));
      double turned = x.off + std::max(y.off, z.off);
      const auto n = normal(o, point(c), point(d), of_sector);
      if (c != d && dot(cross(n.along, y.along), x.along) > 0 && dot(cross(z.along, n.along), x.along) > 0) {
        angle = std::min(angle, std::numbers::pi / 2 -
                                    std::min(angle_of<3>(n.along, x.along), std::numbers::pi - angle_of<3>(n.along, x.along)));
        turned = std::max(turned, x.off + n.off);
      }
      const bool is_exact = of_ray == 0 && of_sector == 0;
      const bool below = (is_exact || entities_.are_own()) &&
                         (angle_below_90<3>(o, point(r), point(c)) || angle_below_90<3>(o, point(r), point(d)));
      take(is_exact, below, angle, turned, 90);
    }
  }

  const NamedEntities<D>& entities_;
  const NamedEntity<D>&a_, &b_;
  AngleBounds bounds_;
  EntityMeeting out_;
};

}  // namespace

template <int D>
bool are_one(const NamedEntity<D>& a, const NamedEntity<D>& b) {
  if (a.kind == b.kind) return a.kind == EntityKind::segment ? a.ends == b.ends : a.parts == b.parts;
  return a.kind == EntityKind::segment ? has_segment(b, a) : has_segment(a, b);
}

void EntityMeeting::join(const EntityMeeting& other) {
  is_small = is_small || other.is_small;
  is_sharp = is_sharp || other.is_sharp;
  small.insert(small.end(), other.small.begin(), other.small.end());
  merge(small);
}

template <int D>
EntityMeeting meeting_of(const NamedEntities<D>& entities, const NamedEntity<D>& a, const NamedEntity<D>& b,
                         const AngleBounds& bounds) {
  return Meetings<D>(entities, a, b, bounds).run();
}

bool share_segment_at(const NamedEntity<3>& a, const NamedEntity<3>& b, std::uint32_t point) {
  if (are_one(a, b)) return true;
  if (a.kind == EntityKind::segment || b.kind == EntityKind::segment) return false;
  for (const auto& [c, d] : rays_at<3>(a, point))
    for (const std::uint32_t x : {c, d})
      if (!edges_at<3>(b, sorted_edge(point, x)).empty()) return true;
  return false;
}

std::vector<Sector> sectors_at(const NamedEntities<3>& entities, const NamedEntity<3>& e, std::uint32_t point) {
  std::vector<Sector> out;
  for (const auto& [c, d] : rays_at<3>(e, point)) out.push_back({entities.point(c), entities.point(d)});
  return out;
}

AngleRange dihedral_range(const std::array<Point3, 4>& p) {
  const auto u = normal(p[0], p[1], p[2], 0), w = normal(p[0], p[1], p[3], 0);
  return range(angle_of<3>(u.along, w.along), u.off + w.off);
}

template bool are_one(const NamedEntity<2>&, const NamedEntity<2>&);
template bool are_one(const NamedEntity<3>&, const NamedEntity<3>&);
template EntityMeeting meeting_of(const NamedEntities<2>&, const NamedEntity<2>&, const NamedEntity<2>&, const AngleBounds&);
template EntityMeeting meeting_of(const NamedEntities<3>&, const NamedEntity<3>&, const NamedEntity<3>&, const AngleBounds&);

}  // namespace pgdr::checking
