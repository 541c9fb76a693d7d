// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/plane_meetings.hpp"

#include <algorithm>
#include <cmath>

#include "input/triangle_shapes.hpp"
#include "join/build_pieces.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {
namespace {

/// Edges that leave a corner steeply, beside the triangle but for rounding, have a part inside that is as short as the distance
/// over the sine of their angle with it: this is that of one degree.
constexpr double least_length = 64;
/// What is not as wide as this lies within the distance of a line, from both of its sides, and is no area.
constexpr double least_width = 2;

/// A point seen inside of a triangle, and what tells its counterpart there.
struct SeenPoint {
  Point3 at;
  std::uint32_t corner = no_entity;  ///< the point of the input that it is
  int edge = -1;                     ///< of the triangle, opposite this corner, on which it is seen
};

class Search {
 public:
  Search(const BuildInput<3>& in, const FacetTriangles& faces, std::span<const Piece> pieces, const PlaneWidth& width)
      : in_(in), faces_(faces), pieces_(pieces), width_(width), shapes_(in.points, in.scale) {
    find_normals();
    for (const TriangulatedFacet& f : faces.facets)
      if (f.count > 1)
        for (const PlanarTriangle& t : faces.of(f))
          for (const std::uint32_t v : t) corners_.emplace_back(static_cast<std::uint32_t>(&f - faces.facets.data()), v);
    in.stop.sort(in.bulk, corners_);
  }

  PlaneMeetings run() const;

 private:
  void find_normals();
  void look_at(std::uint32_t i, std::uint32_t j, PlaneMeetings& found) const;
  bool look_at_edges(const Piece& piece, std::uint32_t t, PlaneMeetings& found) const;
  bool runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const;
  bool runs_near(std::uint32_t a, std::uint32_t b, std::uint32_t t, double width) const;
  bool overlap(std::uint32_t t, std::uint32_t u) const;
  bool overlap_nearly(std::uint32_t t, std::uint32_t u, double width) const;
  std::vector<SeenPoint> common_polygon(std::uint32_t t, std::uint32_t u) const;
  double height(const SeenPoint& q, std::uint32_t t) const;
  bool has_point(std::uint32_t t, std::uint32_t v) const;

  Sign turn(std::uint32_t u, std::uint32_t v, std::uint32_t w, int axis) const {
    const auto& p = in_.points;
    return u == v || v == w || w == u ? Sign::zero : orient_projected(p[u], p[v], p[w], axis);
  }
  /// Twice the area of the triangle in the projection.
  static double area(const Point3& p, const Point3& q, const Point3& r, int axis) {
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    return (q[u] - p[u]) * (r[w] - p[w]) - (q[w] - p[w]) * (r[u] - p[u]);
  }
  int axis_of(std::uint32_t t) const { return faces_.facets[faces_.facet_of[t]].axis; }

  const BuildInput<3>& in_;
  const FacetTriangles& faces_;
  std::span<const Piece> pieces_;
  const PlaneWidth& width_;
  TriangleShapes shapes_;
  std::vector<Vector<3>> normals_;                                // of each facet, of length 1: that of its largest triangle
  std::vector<std::pair<std::uint32_t, std::uint32_t>> corners_;  // facets of several triangles, and their points
};

void Search::find_normals() {
  for (const TriangulatedFacet& facet : faces_.facets) {
    Vector<3> largest{};
    double square = -1;
    for (const PlanarTriangle& t : faces_.of(facet)) {
      const Vector<3> n = shapes_.normal(t);
      if (const double s = dot(n, n); s > square) {
        square = s;
        largest = n;
      }
    }
    if (square > 0)
      for (double& x : largest) x /= std::sqrt(square);
    normals_.push_back(largest);
  }
}

PlaneMeetings Search::run() const {
  auto parts = look_at_pairs<PlaneMeetings, 3>(
      pieces_, in_.points, width_.largest(), in_.bulk, in_.stop,
      [&](std::uint32_t i, std::uint32_t j, PlaneMeetings& found) { look_at(i, j, found); });
  PlaneMeetings all{joined(parts, &PlaneMeetings::inner), joined(parts, &PlaneMeetings::overlaps)};
  make_set(all.inner);
  make_set(all.overlaps);
  return all;
}

void Search::look_at(std::uint32_t i, std::uint32_t j, PlaneMeetings& found) const {
  const Piece &a = pieces_[i], &b = pieces_[j];
  if (a.count < 3) return;  // triangles come first
  if (b.count < 3) {
    look_at_edges(b, i, found);
    return;
  }
  const std::uint32_t f = faces_.facet_of[i], g = faces_.facet_of[j];
  if (f == g) return;
  const bool same = std::ranges::all_of(a.corners, [&](std::uint32_t v) { return b.has(v); });
  if (!same) {
    const bool first = look_at_edges(b, i, found), second = look_at_edges(a, j, found);
    if ((!first && !second) || !overlap(i, j)) return;
  }
  found.overlaps.emplace_back(std::min(f, g), std::max(f, g));
}

/// True if any edge of the piece runs inside the triangle.
bool Search::look_at_edges(const Piece& piece, std::uint32_t t, PlaneMeetings& found) const {
  bool any = false;
  for (std::size_t k = 0; k < (piece.count == 3 ? 3u : piece.count - 1u); ++k) {
    const std::uint32_t a = piece.corners[k], b = piece.corners[(k + 1) % piece.count];
    if (!runs_inside(a, b, t)) continue;
    found.inner.emplace_back(t, edge_key(a, b));
    any = true;
  }
  return any;
}

// In the plane of the triangle (or near it), and no line through an edge of either has them on different sides.
bool Search::runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
  const PlanarTriangle& s = faces_.triangles[t];
  const int axis = axis_of(t);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = s[i], v = s[(i + 1) % 3];
    if (turn(u, v, a, axis) != Sign::positive && turn(u, v, b, axis) != Sign::positive) return false;
  }
  bool left = false, right = false;
  for (const std::uint32_t v : s) {
    const Sign side = turn(a, b, v, axis);
    left |= side == Sign::positive;
    right |= side == Sign::negative;
  }
  if (!left || !right) return false;
  const auto& p = in_.points;
  if (const double width = width_.of(std::array{a, b, s[0], s[1], s[2]}); width > 0) return runs_near(a, b, t, width);
  return std::ranges::all_of(std::array{a, b}, [&](std::uint32_t v) {
    return std::ranges::find(s, v) != s.end() || orient3d(p[s[0]], p[s[1]], p[s[2]], p[v]) == Sign::zero;
  });
}

/// Are both ends of what is seen of ab inside the triangle near to it? @pre something is
bool Search::runs_near(std::uint32_t a, std::uint32_t b, std::uint32_t t, double width) const {
  const PlanarTriangle& s = faces_.triangles[t];
  const int axis = axis_of(t);
  const Point3 p = shapes_.scaled(a), q = shapes_.scaled(b);
  SeenPoint from{p, a}, to{q, b};
  double at_from = 0, at_to = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = s[(i + 1) % 3], v = s[(i + 2) % 3];
    const Sign side_p = turn(u, v, a, axis), side_q = turn(u, v, b, axis);
    if (side_p != Sign::negative && side_q != Sign::negative) continue;
    const double area_p = area(shapes_.scaled(u), shapes_.scaled(v), p, axis);
    const double area_q = area(shapes_.scaled(u), shapes_.scaled(v), q, axis);
    const double part = std::clamp(area_p / (area_p - area_q), 0.0, 1.0);
    Point3 x;
    for (int k = 0; k < 3; ++k) x[k] = p[k] + part * (q[k] - p[k]);
    if (side_p == Sign::negative && !(part < at_from)) {
      at_from = part;
      from = {x, no_entity, static_cast<int>(i)};
    } else if (side_q == Sign::negative && !(part > at_to)) {
      at_to = part;
      to = {x, no_entity, static_cast<int>(i)};
    }
  }
  if (!(height(from, t) <= width && height(to, t) <= width)) return false;
  if (has_point(t, a) && has_point(t, b)) return true;
  const auto along = difference(q, p);
  return (at_to - at_from) * std::sqrt(dot(along, along)) > least_length * width;
}

/// Is v a point of the facet of this triangle, or one that was added, and is not before its edges are?
bool Search::has_point(std::uint32_t t, std::uint32_t v) const {
  if (width_.is_added(v) || std::ranges::find(faces_.triangles[t], v) != faces_.triangles[t].end()) return true;
  return std::ranges::binary_search(corners_, std::pair{faces_.facet_of[t], v});
}

/// Of a point that is seen inside the triangle, or on an edge of it: how far it is from there, along the facet's normal.
double Search::height(const SeenPoint& q, std::uint32_t t) const {
  const PlanarTriangle& s = faces_.triangles[t];
  if (std::ranges::find(s, q.corner) != s.end()) return 0;
  const Vector<3>& normal = normals_[faces_.facet_of[t]];
  if (q.edge < 0) return std::fabs(dot(normal, difference(q.at, shapes_.scaled(s[0]))));
  const int axis = axis_of(t), i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto k = static_cast<std::size_t>(q.edge);
  const Point3 u = shapes_.scaled(s[(k + 1) % 3]), v = shapes_.scaled(s[(k + 2) % 3]);
  const double along[2] = {v[i] - u[i], v[j] - u[j]};
  const double part = ((q.at[i] - u[i]) * along[0] + (q.at[j] - u[j]) * along[1]) / (along[0] * along[0] + along[1] * along[1]);
  return std::fabs((q.at[axis] - (u[axis] + part * (v[axis] - u[axis]))) * normal[static_cast<std::size_t>(axis)]);
}

bool Search::overlap(std::uint32_t t, std::uint32_t u) const {
  const PlanarTriangle &s = faces_.triangles[t], &r = faces_.triangles[u];
  const double width = width_.of(std::array{s[0], s[1], s[2], r[0], r[1], r[2]});
  if (width > 0 && overlap_nearly(t, u, width)) return true;
  return contact<3>(in_.points, pieces_[t], pieces_[u]).kind == Contact::Kind::overlap;
}

bool Search::overlap_nearly(std::uint32_t t, std::uint32_t u, double width) const {
  const auto polygon = common_polygon(t, u);
  const int axis = axis_of(t), i = (axis + 1) % 3, j = (axis + 2) % 3;
  double size = 0, diameter = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    if (!(height(polygon[k], t) <= width)) return false;
    if (k > 1) size += area(polygon[0].at, polygon[k - 1].at, polygon[k].at, axis);
    for (std::size_t l = 0; l < k; ++l) {
      const double u = polygon[k].at[i] - polygon[l].at[i], v = polygon[k].at[j] - polygon[l].at[j];
      diameter = std::max({diameter, std::sqrt(u * u + v * v), std::fabs(u), std::fabs(v)});  // the last: squares may underflow
    }
  }
  return std::fabs(size) > least_width * width * diameter;
}

/// What is seen of triangle u inside of t: clipped at the edges of that.
std::vector<SeenPoint> Search::common_polygon(std::uint32_t t, std::uint32_t u) const {
  const PlanarTriangle& s = faces_.triangles[t];
  const int axis = axis_of(t);
  std::vector<SeenPoint> polygon, clipped;
  for (const std::uint32_t v : faces_.triangles[u]) polygon.push_back({shapes_.scaled(v), v});
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t e0 = s[(i + 1) % 3], e1 = s[(i + 2) % 3];
    const auto side = [&](const SeenPoint& q) {
      return q.corner == e0 || q.corner == e1 ? 0 : area(shapes_.scaled(e0), shapes_.scaled(e1), q.at, axis);
    };
    clipped.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const SeenPoint &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double at_a = side(a), at_b = side(b);
      if (at_a >= 0) clipped.push_back(a);
      if (!(at_a > 0 && at_b < 0) && !(at_a < 0 && at_b > 0)) continue;
      SeenPoint x{{}, no_entity, static_cast<int>(i)};
      for (int d = 0; d < 3; ++d) x.at[d] = a.at[d] + at_a / (at_a - at_b) * (b.at[d] - a.at[d]);
      clipped.push_back(x);
    }
    polygon.swap(clipped);
  }
  return polygon;
}

}  // namespace

// Points are rounded to half an ulp a coordinate, and scaled coordinates are less than 2.
PlaneWidth::PlaneWidth(const BuildInput<3>& in, std::uint32_t first_added)
    : given_(in.tolerance * in.scale),
      added_(std::max(given_, 2 * rounding::of_point)),
      largest_((in.points.size() > first_added ? added_ : given_) / in.scale),
      first_added_(first_added) {}

PlaneMeetings find_plane_meetings(const BuildInput<3>& in, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                                  const PlaneWidth& width) {
  const std::vector<Piece> pieces = pieces_of(in, faces, segment_edges);
  return Search(in, faces, pieces, width).run();
}

}  // namespace pgdr::detail
