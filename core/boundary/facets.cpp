// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "boundary/named_points.hpp"
#include "boundary/state.hpp"
#include "input/bent_facets.hpp"
#include "mesh/ridge.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {
namespace {

/// Sorted edges of the facet's defining triangles, directed so that the facet is on their left: both ways where it is on
/// both sides, as segments inside of the facet may enclose a part of it that the rim does not touch.
std::vector<std::array<std::uint32_t, 2>> directed_edges(const Domain<3>& domain, EntityId f) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : domain.triangles(f))
    for (int i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  return edges;
}

InputError not_a_plane_graph(const Domain<3>& domain, EntityId f, const Mesh<3>& mesh, std::span<const VertexId> at) {
  Diagnostic d = about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(f));
  d.message = facet_words(d) + ": its segments cross or touch in its projection once Steiner points are on them";
  d.points.clear();
  for (const VertexId v : at) d.points.push_back(mesh.point(v).x);
  return InputError(std::move(d));
}

/// Holds the ball, and what rounding may take for a part of it; all of space if the ball is not finite.
Box<3> box_around(const Ball<3>& ball) {
  const double radius = std::sqrt(ball.squared_radius);
  Box<3> box;
  for (int i = 0; i < 3; ++i) {
    const double reach = radius + rounding::of_pruning * (radius + std::fabs(ball.center[i]));
    const double low = ball.center[i] - reach, high = ball.center[i] + reach;
    box.low[i] = std::isfinite(low) ? low : std::numeric_limits<double>::lowest();
    box.high[i] = std::isfinite(high) ? high : std::numeric_limits<double>::max();
  }
  return box;
}

/// The mesh has a face or an edge, of these vertices, that would have to be inside of two facets.
InputError folded_over(const Domain<3>& domain, EntityId f, EntityId g, const Mesh<3>& mesh, std::span<const VertexId> common) {
  const Diagnostic other = about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(g));
  Diagnostic d = about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(f));
  d.message = facet_words(d) + " folds over onto " + facet_words(other) + ": within the tolerance they have " +
              (common.size() == 3 ? "a triangle" : "an edge") + " in common";
  d.ids.insert(d.ids.end(), other.ids.begin(), other.ids.end());
  d.points.clear();
  for (const VertexId v : common) d.points.push_back(mesh.point(v).x);
  return InputError(std::move(d));
}

/// How far on the way from p to q the line through a and b is, in the projection.
double part_of_way(const Point3& p, const Point3& q, const Point3& a, const Point3& b, int axis) {
  const auto off_line = [&](const Point3& x) { return std::fabs(cross(difference<3>(b, a), difference<3>(x, a))[axis]); };
  const double from = off_line(p);
  return from > 0 ? from / (from + off_line(q)) : 0;
}

}  // namespace

FacetPatches::FacetPatches(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SegmentChains& chains)
    : mesh_(&mesh),
      delaunay_(&delaunay),
      domain_(&domain),
      chains_(&chains),
      triangles_(domain.facets().size()),
      seen_(domain.facets().size()),
      inner_points_(domain.facets().size()),
      faces_(mesh) {
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    const auto given = domain.triangles(f);
    for (const auto& t : given)
      triangles_[f].push_back({delaunay.vertices()[t[0]], delaunay.vertices()[t[1]], delaunay.vertices()[t[2]]});
    // One triangle is its own Delaunay triangulation; of several the tie rules must be those of the mesh.
    if (given.size() > 1 || domain.facet_points(f).size() > 3) changed_.push_back(f);
    look_again_.push_back(f);
  }
  delaunay.tell_changes(faces_.changed());
}

auto FacetPatches::subsegments(EntityId facet) const -> std::vector<Subsegment> {
  std::vector<Subsegment> list;
  for (const EntityId s : domain_->facet_segments(facet)) {
    const auto& chain = chains_->chain(s);
    for (std::size_t i = 1; i < chain.size(); ++i) list.push_back({s, chain[i - 1].vertex, chain[i].vertex, chain[i - 1].t});
  }
  return list;
}

BoxTree<2> FacetPatches::tree_of_diametral_balls(const std::vector<Subsegment>& rim, int axis) const {
  std::vector<Box<2>> boxes;
  for (const Subsegment& s : rim) {
    const Box<3> ball = box_around(diametral_ball<3>(mesh_->point(s.a), mesh_->point(s.b)));
    boxes.push_back({projected(ball.low, axis), projected(ball.high, axis)});
  }
  return BoxTree<2>(boxes);
}

/// Anew, from the points and subsegments that the facet has now.
void FacetPatches::triangulate(EntityId facet) {
  std::vector<VertexId> vertices;
  std::unordered_map<std::uint32_t, std::uint32_t> local;
  std::vector<Point3> points;
  auto add = [&](VertexId v) {
    const auto [at, fresh] = local.try_emplace(index(v), static_cast<std::uint32_t>(points.size()));
    if (fresh) {
      points.push_back(levelled(*domain_, facet, mesh_->point(v)));
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
  replace_triangles(facet, [&](auto& triangles) {
    for (const PlanarTriangle& t : plane.triangles()) triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  });
}

/// Those that stay are where they were seen.
template <class Fill>
void FacetPatches::replace_triangles(EntityId facet, const Fill& fill) {
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  auto& triangles = triangles_[facet];
  auto& seen = seen_[facet];
  std::vector<std::pair<Triangle, CellId>> before;
  for (std::size_t i = 0; i < seen.size(); ++i) before.emplace_back(sorted(triangles[i]), seen[i]);
  std::sort(before.begin(), before.end());
  triangles.clear();
  fill(triangles);
  seen.clear();
  for (const Triangle& t : triangles) {
    const auto at = std::lower_bound(before.begin(), before.end(), std::pair(sorted(t), CellId{0}));
    seen.push_back(at != before.end() && at->first == sorted(t) ? at->second : never_asked);
  }
}

/// Finds where all triangles are: the facets, ascending, that may have others missing than those before.
std::vector<EntityId> FacetPatches::find_present() {
  std::vector<EntityId> due = faces_.take_due();
  due.insert(due.end(), look_again_.begin(), look_again_.end());
  make_set(due);
  for (const EntityId f : due) {
    seen_[f].resize(triangles_[f].size(), never_asked);
    for (std::size_t i = 0; i < triangles_[f].size(); ++i) faces_.ask(f, triangles_[f][i], seen_[f][i]);
  }
  faces_.find();
  return due;
}

bool FacetPatches::recover_once(const std::function<bool()>& stop) {
  for (const EntityId s : chains_->take_changed())
    for (const EntityId f : domain_->facets_of_segment(s)) changed_.push_back(f);
  make_set(changed_);
  for (const EntityId f : changed_) {
    if (stop()) return true;
    triangulate(f);
  }
  look_again_.insert(look_again_.end(), changed_.begin(), changed_.end());
  changed_.clear();
  std::vector<std::pair<EntityId, std::vector<Candidate>>> missing;
  const std::vector<EntityId> due = find_present();
  look_again_.clear();
  std::size_t triangles = 0;
  for (const EntityId f : due) {
    std::vector<Candidate> of_facet;
    for (std::size_t i = 0; i < triangles_[f].size(); ++i)
      if (const Triangle& t = triangles_[f][i]; seen_[f][i] == not_seen)
        of_facet.push_back({equatorial_ball(mesh_->point(t[0]), mesh_->point(t[1]), mesh_->point(t[2])), t, 0});
    if (of_facet.empty()) continue;
    look_again_.push_back(f);
    triangles += of_facet.size();
    missing.emplace_back(f, std::move(of_facet));
  }
  trend_.note(triangles);
  for (auto& [f, candidates] : missing)
    if (!stop()) split_triangles(f, std::move(candidates), stop);
  return !missing.empty();
}

Point3 FacetPatches::centroid_of(const Triangle& t) const {
  Point3 c;
  for (int i = 0; i < 3; ++i) c[i] = mesh_->point(t[0])[i] / 3 + mesh_->point(t[1])[i] / 3 + mesh_->point(t[2])[i] / 3;
  return c;
}

/// The subsegment that hides x from triangle t: of those of the facet that x lies beyond, the one nearest to t. (To split one of
/// the others does nothing about t, and would go on for ever.) If there is none, the first whose diametral ball contains x.
/// `tree` is over the rim's balls in the facet's projection.
auto FacetPatches::in_the_way(const std::vector<Subsegment>& rim, const BoxTree<2>& tree, EntityId facet, const Triangle& t,
                              const Point3& x) const -> std::optional<Subsegment> {
  const int axis = domain_->facets()[facet].axis;
  const Point3 from = centroid_of(t);
  std::pair<double, std::size_t> crossed{std::numeric_limits<double>::infinity(), rim.size()};
  std::size_t encroached = rim.size();
  auto sight = Box<2>::around(projected(from, axis));
  sight.add(projected(x, axis));
  tree.meeting(sight, [&](std::size_t i) {
    const Point3 &a = mesh_->point(rim[i].a), &b = mesh_->point(rim[i].b);
    if (orient_projected(a, b, from, axis) != orient_projected(a, b, x, axis) &&
        orient_projected(from, x, a, axis) != orient_projected(from, x, b, axis))
      crossed = std::min(crossed, std::pair(part_of_way(from, x, a, b, axis), i));
    if (in_diametral_ball<3>(a, b, x)) encroached = std::min(encroached, i);
  });
  const std::size_t first = crossed.second < rim.size() ? crossed.second : encroached;
  if (first == rim.size()) return std::nullopt;
  return rim[first];
}

/// A vertex that was made inside the facet.
void FacetPatches::add_inner_point(EntityId facet, VertexId v) {
  auto& inner = inner_points_[facet];
  const Home home = mesh_->vertex(v).home;
  const bool own = home.kind() == EntityKind::facet && home.id() == facet;
  // New vertices have larger ids than all before.
  if (!own || (!inner.empty() && v <= inner.back())) throw not_a_plane_graph(*domain_, facet, *mesh_, std::array{v});
  inner.push_back(v);
  changed_.push_back(facet);
  ++points_;
}

/// At x, the triangle's circumcentre; where this is a vertex of the facet already, as in facets that are planar only within
/// rounding, whose triangles need not have empty circles, at the centroid.
VertexId FacetPatches::insert_inside(EntityId facet, const Candidate& c, const Point3& x) {
  const Home home(EntityKind::facet, facet);
  const VertexId v = delaunay_->insert(x, home, c.triangle[0], c.least);
  const auto& inner = inner_points_[facet];
  if (v == no_vertex || !std::binary_search(inner.begin(), inner.end(), v)) return v;
  return delaunay_->insert(point_on_facet(*domain_, facet, centroid_of(c.triangle)), home, c.triangle[0], c.least);
}

/// Largest triangles first; a triangle that a point of this round has reached already waits for the next. Trees of boxes say
/// what is near a point: strips have many triangles, and the same facet many rounds.
bool FacetPatches::split_triangles(EntityId facet, std::vector<Candidate> candidates, const std::function<bool()>& stop) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.ball.squared_radius != b.ball.squared_radius) return a.ball.squared_radius > b.ball.squared_radius;
    return lex_less(a.ball.center, b.ball.center);
  });
  const std::vector<Subsegment> rim = subsegments(facet);
  const BoxTree<2> rim_tree = tree_of_diametral_balls(rim, domain_->facets()[facet].axis);
  std::vector<Box<3>> boxes;
  for (const Candidate& c : candidates) boxes.push_back(box_around(c.ball));
  const BoxTree<3> tree(boxes);
  std::vector<bool> reached(candidates.size(), false);
  auto place = [&](const Point3& p) {
    tree.at(p, [&](std::size_t i) { reached[i] = reached[i] || in_equatorial_ball(candidates[i].ball, p); });
  };
  // What other facets have split in this round: to split it once more for a triangle that is gone would go on for ever
  // about a point where segments meet at small angles, each facet halving what its neighbour has just halved.
  for (const EntityId s : domain_->facet_segments(facet))
    for (const auto& link : chains_->chain(s))
      if (chains_->is_new(link)) place(mesh_->point(link.vertex));
  bool any = false;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    if (reached[i]) continue;
    if (stop()) break;
    const Point3 x = point_on_facet(*domain_, facet, c.ball.center);
    if (const auto s = in_the_way(rim, rim_tree, facet, c.triangle, x)) {
      if (c.least > 0 && !may_split(*s)) continue;
      const VertexId v = chains_->split(*s, c.least);
      if (v == no_vertex) continue;  // another triangle has asked for it, or it is too near
      place(mesh_->point(v));
      any = true;
    } else if (const VertexId v = insert_inside(facet, c, x); v != no_vertex) {
      add_inner_point(facet, v);
      place(mesh_->point(v));
      any = true;
    }
  }
  return any;
}

/// Marks the faces on both sides of each triangle. @pre none is missing
/// @throws InputError boundary_not_recovered: a triangle is one of two facets
void FacetPatches::mark(Mesh<3>::Pools& pools) {
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (std::size_t i = 0; i < triangles_[f].size(); ++i) {
      const Triangle& t = triangles_[f][i];
      const CellId c = seen_[f][i];
      assert(has_corners(*mesh_, c, t));
      const auto& v = mesh_->cell(c).vertices;
      const auto is_other = [&](VertexId w) { return std::find(t.begin(), t.end(), w) == t.end(); };
      const int face = static_cast<int>(std::find_if(v.begin(), v.end(), is_other) - v.begin());
      if (mesh_->constrained(c, face)) throw folded_over(*domain_, mesh_->entity_of_face(c, face).id, f, *mesh_, t);
      const Link beyond = mesh_->cell(c).links[face];
      mesh_->constrain_face(pools, c, face, f);
      mesh_->constrain_face(pools, beyond.cell(), beyond.face(), f);
    }
}

/// An edge inside of a facet has two subfacets, of that facet. What makes and changes cavities relies on it. Facets that bend by
/// more than their distance from others can break it. @pre subfacets and subsegments are marked
/// @throws InputError boundary_not_recovered: an edge is inside of one facet, and of another one, too
void FacetPatches::require_edges_inside_one() const {
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    if (triangles_[f].size() < 2) continue;
    for (std::size_t i = 0; i < triangles_[f].size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const VertexId a = triangles_[f][i][k], b = triangles_[f][i][(k + 1) % 3];
        if (b < a) continue;  // the triangle on the other side looks at it
        const CellId c = seen_[f][i];
        const auto& v = mesh_->cell(c).vertices;
        const int edge = edge_of_ends[corner_of(v, a)][corner_of(v, b)];
        if (mesh_->is_subsegment(c, edge)) continue;
        for_cells_round(*mesh_, c, edge, [&](const RidgeWalk<3>& walk) {
          if (!mesh_->constrained(walk.cell, walk.exit)) return RoundEdge::go_on;
          const EntityId g = mesh_->entity_of_face(walk.cell, walk.exit).id;
          if (g != f) throw folded_over(*domain_, f, g, *mesh_, std::array{a, b});
          return RoundEdge::go_on;
        });
      }
  }
}

}  // namespace pgdr::detail
