// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "detail/planar_cdt.hpp"
#include "detail/recovery_state.hpp"
#include "detail/vectors.hpp"

namespace pgdr::detail {
namespace {

// Triangles times segments of a facet that is improved: each triangle looks at all of them.
constexpr std::size_t most_improved = 1'000'000;

/// Sorted edges of the facet's defining triangles, directed so that the facet is on their left: both ways where it is on
/// both sides, as segments inside of the facet may enclose a part of it that the rim does not touch.
std::vector<std::array<std::uint32_t, 2>> directed_edges(const Domain<3>& domain, EntityId f) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : domain.triangles(f))
    for (int i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::array<std::uint32_t, 2> sorted_ends(std::array<std::uint32_t, 2> ends) {
  if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
  return ends;
}

/// Of length one, square to ab, towards c.
Vector<3> direction_into(const Point3& a, const Point3& b, const Point3& c) {
  const auto along = difference(b, a), up = difference(c, a);
  const double part = dot(up, along) / dot(along, along);
  Vector<3> d;
  for (std::size_t i = 0; i < 3; ++i) d[i] = up[i] - part * along[i];
  const double length = std::sqrt(dot(d, d));
  for (double& x : d) x /= length;
  return d;
}

InputError not_a_plane_graph(const Domain<3>& domain, EntityId f, const Mesh<3>& mesh, std::span<const VertexId> at) {
  Diagnostic d;
  d.code = Errc::boundary_not_recovered;
  d.message = "facet " + std::to_string(f) + ": its segments cross or touch in its projection once Steiner points are on them";
  for (const std::uint32_t p : domain.facet_points(f)) d.ids.push_back(domain.input_of_point()[p]);
  for (const VertexId v : at) d.points.push_back(mesh.point(v).x);
  return InputError(std::move(d));
}

}  // namespace

FacetPatches::FacetPatches(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SegmentChains& chains)
    : mesh_(&mesh),
      delaunay_(&delaunay),
      domain_(&domain),
      chains_(&chains),
      triangles_(domain.facets().size()),
      inner_points_(domain.facets().size()),
      changed_(domain.facets().size(), false) {
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    const auto given = domain.triangles(f);
    for (const auto& t : given)
      triangles_[f].push_back({delaunay.vertices()[t[0]], delaunay.vertices()[t[1]], delaunay.vertices()[t[2]]});
    // One triangle is its own Delaunay triangulation; of several the tie rules must be those of the mesh.
    changed_[f] = given.size() > 1 || domain.facet_points(f).size() > 3;
  }
}

auto FacetPatches::subsegments(EntityId facet) const -> std::vector<Subsegment> {
  std::vector<Subsegment> list;
  for (const EntityId s : domain_->facet_segments(facet)) {
    const auto& chain = chains_->chain(s);
    for (std::size_t i = 1; i < chain.size(); ++i) list.push_back({s, chain[i - 1].vertex, chain[i].vertex});
  }
  return list;
}

/// Anew, from the points and subsegments that the facet has now.
void FacetPatches::triangulate(EntityId facet) {
  std::vector<VertexId> vertices;
  std::unordered_map<std::uint32_t, std::uint32_t> local;
  std::vector<Point3> points;
  auto add = [&](VertexId v) {
    const auto [at, fresh] = local.try_emplace(index(v), static_cast<std::uint32_t>(points.size()));
    if (fresh) {
      points.push_back(mesh_->point(v));
      vertices.push_back(v);
    }
    return at->second;
  };
  for (const std::uint32_t p : domain_->facet_points(facet)) add(delaunay_->vertices()[p]);
  for (const VertexId v : inner_points_[facet]) add(v);
  std::vector<PlanarEdge> constraints, rim;
  const auto directed = directed_edges(*domain_, facet);
  for (const EntityId s : domain_->facet_segments(facet)) {
    const auto& ends = domain_->segments()[s].points;
    const bool forward = std::binary_search(directed.begin(), directed.end(), std::array{ends[0], ends[1]});
    const bool backward = std::binary_search(directed.begin(), directed.end(), std::array{ends[1], ends[0]});
    const auto& chain = chains_->chain(s);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const PlanarEdge e{add(chain[i - 1].vertex), add(chain[i].vertex)};
      constraints.push_back(e);
      if (forward) rim.push_back(e);
      if (backward) rim.push_back({e[1], e[0]});
    }
  }
  std::vector<std::uint32_t> all(points.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  PlanarTriangulation plane;
  const PlanarResult result = plane.build(points, all, constraints, domain_->facets()[facet].axis);
  if (!result) {
    const std::array<VertexId, 2> at{vertices[result.edge[0]], vertices[result.edge[1]]};
    throw not_a_plane_graph(*domain_, facet, *mesh_, at);
  }
  plane.keep_left_of(rim);
  triangles_[facet].clear();
  for (const PlanarTriangle& t : plane.triangles())
    triangles_[facet].push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
}

WantedSimplices<3> FacetPatches::wanted() const {
  WantedSimplices<3> faces;
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (const Triangle& t : triangles_[f]) faces.add(t, f);
  faces.index_by_first(mesh_->vertex_bound());
  return faces;
}

void FacetPatches::find_present(WantedSimplices<3>& wanted) const {
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    const auto& v = mesh_->cell(CellId{i}).vertices;
    for (int f = 0; f < 4; ++f)
      if (auto* face = wanted.find({v[(f + 1) & 3], v[(f + 2) & 3], v[(f + 3) & 3]})) face->present = true;
  }
}

bool FacetPatches::recover_once(const std::function<bool()>& stop) {
  for (const EntityId s : chains_->take_changed())
    for (const EntityId f : domain_->facets_of_segment(s)) changed_[f] = true;
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    if (changed_[f]) triangulate(f);
    changed_[f] = false;
  }
  WantedSimplices<3> faces = wanted();
  find_present(faces);
  std::vector<std::vector<Candidate>> missing(triangles_.size());
  bool any = false;
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (const Triangle& t : triangles_[f])
      if (!faces.find(t)->present) {
        missing[f].push_back({equatorial_ball(mesh_->point(t[0]), mesh_->point(t[1]), mesh_->point(t[2])), t, 0});
        any = true;
      }
  for (EntityId f = 0; f < triangles_.size(); ++f)
    if (!missing[f].empty() && !stop()) split_triangles(f, std::move(missing[f]));
  return any;
}

/// A subsegment of the facet whose diametral ball contains x, or that x lies beyond as seen from triangle t.
auto FacetPatches::in_the_way(const std::vector<Subsegment>& rim, EntityId facet, const Triangle& t,
                              const Point3& x) const -> std::optional<Subsegment> {
  const int axis = domain_->facets()[facet].axis;
  Point3 from{};
  for (int i = 0; i < 3; ++i)
    from[i] = mesh_->point(t[0])[i] / 3 + mesh_->point(t[1])[i] / 3 + mesh_->point(t[2])[i] / 3;
  std::optional<Subsegment> encroached;
  for (const Subsegment& s : rim) {
    const Point3 &a = mesh_->point(s.a), &b = mesh_->point(s.b);
    if (orient_projected(a, b, from, axis) != orient_projected(a, b, x, axis) &&
        orient_projected(from, x, a, axis) != orient_projected(from, x, b, axis))
      return s;
    if (!encroached && in_diametral_ball<3>(a, b, x)) encroached = s;
  }
  return encroached;
}

/// Largest triangles first; a triangle that a point of this round has reached already waits for the next.
bool FacetPatches::split_triangles(EntityId facet, std::vector<Candidate> candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.ball.squared_radius != b.ball.squared_radius) return a.ball.squared_radius > b.ball.squared_radius;
    return lex_less(a.ball.center, b.ball.center);
  });
  const std::vector<Subsegment> rim = subsegments(facet);
  std::vector<Point3> placed;
  for (const Candidate& c : candidates) {
    bool reached = false;
    for (const Point3& p : placed) reached = reached || in_equatorial_ball(c.ball, p);
    if (reached) continue;
    const Point3 x = point_on_facet(*domain_, facet, c.ball.center);
    if (const auto s = in_the_way(rim, facet, c.triangle, x)) {
      if (c.least > 0 && !may_split(*s)) continue;
      if (!chains_->split(s->segment, s->a, s->b, c.least)) continue;  // another triangle has asked for it, or it is too near
      placed.push_back(diametral_ball<3>(mesh_->point(s->a), mesh_->point(s->b)).center);
      continue;
    }
    const VertexId v = delaunay_->insert(x, Home(EntityKind::facet, facet), c.triangle[0], c.least);
    if (v == no_vertex) continue;
    const Home home = mesh_->vertex(v).home;
    const bool own = home.kind() == EntityKind::facet && home.id() == facet;
    if (!own || std::find(inner_points_[facet].begin(), inner_points_[facet].end(), v) != inner_points_[facet].end())
      throw not_a_plane_graph(*domain_, facet, *mesh_, std::array{v});
    inner_points_[facet].push_back(v);
    placed.push_back(x);
    changed_[facet] = true;
    ++points_;
  }
  return !placed.empty();
}

/// No segment of a calm facet makes less than 60 degrees with another segment, nor do two facets there; and it is plane but
/// for rounding.
void FacetPatches::find_calm() {
  const auto segments = domain_->segments();
  std::vector<std::pair<std::array<std::uint32_t, 2>, EntityId>> by_ends;
  for (EntityId s = 0; s < segments.size(); ++s) by_ends.push_back({sorted_ends(segments[s].points), s});
  std::sort(by_ends.begin(), by_ends.end());
  std::vector<std::vector<Vector<3>>> into(segments.size());  // directions from each segment into its facets
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (const auto& t : domain_->triangles(f))
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const auto ends = sorted_ends({a, b});
        const auto at = std::lower_bound(by_ends.begin(), by_ends.end(), std::pair(ends, EntityId{0}));
        if (at == by_ends.end() || at->first != ends) continue;
        const auto points = domain_->points();
        into[at->second].push_back(direction_into(points[a], points[b], points[t[(i + 2) % 3]]));
      }
  std::vector<bool> wide(segments.size());
  for (EntityId s = 0; s < segments.size(); ++s) {
    wide[s] = !chains_->at_small_angle(s);
    for (std::size_t i = 0; i < into[s].size(); ++i)
      for (std::size_t j = 0; j < i; ++j) wide[s] = wide[s] && dot(into[s][i], into[s][j]) <= 0.5;
  }
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    const auto own = domain_->facet_segments(f);
    calm_.push_back(std::all_of(own.begin(), own.end(), [&](EntityId s) {
      return wide[s] && domain_->facets()[f].planarity_defect <= 0x1p-44 * domain_->segment_magnitude(s);
    }));
  }
}

bool FacetPatches::may_split(const Subsegment& s) const {
  const std::array<VertexId, 2> edge{std::min(s.a, s.b), std::max(s.a, s.b)};
  return !std::binary_search(fragile_.begin(), fragile_.end(), edge);
}

/// A rounded point of an edge is off it by some 2^-50 of the coordinates.
void FacetPatches::find_fragile() {
  fragile_.clear();
  for (const auto& triangles : triangles_)
    for (const Triangle& t : triangles)
      for (int i = 0; i < 3; ++i) {
        const VertexId v = t[i], w = t[(i + 1) % 3];
        const Point3 &a = mesh_->point(v), &b = mesh_->point(w), &c = mesh_->point(t[(i + 2) % 3]);
        double magnitude = 0;
        for (int k = 0; k < 3; ++k) magnitude = std::max({magnitude, std::fabs(a[k]), std::fabs(b[k]), std::fabs(c[k])});
        const auto ab = difference(b, a), normal = cross(ab, difference(c, a));
        const double least = 0x1p-36 * magnitude;
        if (dot(normal, normal) < least * least * dot(ab, ab)) fragile_.push_back({std::min(v, w), std::max(v, w)});
      }
  std::sort(fragile_.begin(), fragile_.end());
}

bool FacetPatches::improve_once(double bound, double min_edge, const std::function<bool()>& stop) {
  if (calm_.empty()) find_calm();
  find_fragile();
  bool any = false;
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    if (!calm_[f] || triangles_[f].size() * domain_->facet_segments(f).size() > most_improved) continue;
    std::vector<Candidate> poor;
    for (const Triangle& t : triangles_[f]) {
      const Point3 &a = mesh_->point(t[0]), &b = mesh_->point(t[1]), &c = mesh_->point(t[2]);
      const double shortest = std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
      const Ball<3> ball = equatorial_ball(a, b, c);
      if (ball.squared_radius > bound * bound * shortest) poor.push_back({ball, t, std::max(std::sqrt(shortest), min_edge)});
    }
    if (!poor.empty() && !stop()) any = split_triangles(f, std::move(poor)) || any;
  }
  return any;
}

void FacetPatches::mark(Mesh<3>::Pools& pools) {
  WantedSimplices<3> faces = wanted();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    const auto v = mesh_->cell(c).vertices;
    for (int f = 0; f < 4; ++f) {
      const auto* face = faces.find({v[(f + 1) & 3], v[(f + 2) & 3], v[(f + 3) & 3]});
      if (!face) continue;
      auto& k = mesh_->ensure_constraints(pools, c);
      k.faces |= static_cast<std::uint8_t>(1 << f);
      k.face_entity[f] = face->entity;
    }
  }
}

}  // namespace pgdr::detail
