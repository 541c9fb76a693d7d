// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "boundary/facet_splits.hpp"
#include "boundary/named_points.hpp"
#include "input/bent_facets.hpp"
#include "mesh/ridge.hpp"
#include "space/make_set.hpp"
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

std::array<VertexId, 3> sorted(std::array<VertexId, 3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

InputError not_a_plane_graph(const Domain<3>& domain, EntityId f, const Mesh<3>& mesh, std::span<const VertexId> at) {
  Diagnostic d = about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(f));
  d.message = facet_words(d) + ": its segments cross or touch in its projection once Steiner points are on them";
  d.points.clear();
  for (const VertexId v : at) d.points.push_back(mesh.point(v).x);
  return InputError(std::move(d));
}

FacetPatches::FacetPatches(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SegmentChains& chains,
                           SquareFlips& squares, const Bulk& bulk)
    : mesh_(&mesh),
      delaunay_(&delaunay),
      domain_(&domain),
      chains_(&chains),
      squares_(&squares),
      bulk_(&bulk),
      triangles_(domain.facets().size()),
      seen_(domain.facets().size()),
      inner_points_(domain.facets().size()),
      faces_(mesh),
      look_again_(domain.facets().size()) {
  bulk.each(triangles_.size(), [&](std::size_t f) {
    const auto given = domain.triangles(static_cast<EntityId>(f));
    triangles_[f].reserve(given.size());
    for (const auto& t : given)
      triangles_[f].push_back({delaunay.vertices()[t[0]], delaunay.vertices()[t[1]], delaunay.vertices()[t[2]]});
    seen_[f].assign(given.size(), never_asked);
    look_again_[f] = static_cast<EntityId>(f);
  });
  // One triangle is its own Delaunay triangulation; of several the tie rules must be those of the mesh.
  changed_ = bulk.gather<EntityId>(triangles_.size(), [&](std::size_t i, std::vector<EntityId>& out) {
    const auto f = static_cast<EntityId>(i);
    if (triangles_[f].size() > 1 || domain.facet_points(f).size() > 3) out.push_back(f);
  });
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

/// Anew, from the points and subsegments that the facet has now.
auto FacetPatches::triangulate(EntityId facet) -> Crossing {
  std::vector<VertexId> vertices;
  std::unordered_map<std::uint32_t, std::uint32_t> local;
  std::vector<Point3> points;
  const LevelledFacet levelled(*domain_, facet);
  auto add = [&](VertexId v) {
    const auto [at, fresh] = local.try_emplace(index(v), static_cast<std::uint32_t>(points.size()));
    if (fresh) {
      points.push_back(levelled(mesh_->point(v)));
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
  if (!result) return {{vertices[result.edge[0]], vertices[result.edge[1]]}};
  plane.keep_left_of(rim);
  replace_triangles(facet, [&](auto& triangles) {
    for (const PlanarTriangle& t : plane.triangles()) triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  });
  return std::nullopt;
}

/// False if `stop` says so. @throws InputError boundary_not_recovered: of the first facet whose edges are no plane graph
bool FacetPatches::triangulate_changed(const std::function<bool()>& stop) {
  constexpr std::size_t between_looks = 1 << 13;  // facets, some 50 milliseconds, while nobody asks whether to stop
  for (std::size_t first = 0; first < changed_.size(); first += between_looks) {
    if (stop()) return false;
    using Failed = std::pair<EntityId, std::array<VertexId, 2>>;
    const std::size_t count = std::min(between_looks, changed_.size() - first);
    const std::vector<Failed> failed = bulk_->gather<Failed>(count, [&](std::size_t i, std::vector<Failed>& out) {
      const EntityId f = changed_[first + i];
      if (const Crossing at = triangulate(f)) out.emplace_back(f, *at);
    });
    if (!failed.empty()) throw not_a_plane_graph(*domain_, failed[0].first, *mesh_, failed[0].second);
  }
  return true;
}

/// Those that stay are where they were seen.
template <class Fill>
void FacetPatches::replace_triangles(EntityId facet, const Fill& fill) {
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
  make_set(due, *bulk_);
  const auto ask_for = [this](EntityId f, const auto& ask) {
    for (std::size_t i = 0; i < triangles_[f].size(); ++i) ask(triangles_[f][i], seen_[f][i]);
  };
  faces_.look(due, ask_for, *bulk_);
  return due;
}

bool FacetPatches::recover_once(const std::function<bool()>& stop) {
  for (const EntityId s : chains_->take_changed())
    for (const EntityId f : domain_->facets_of_segment(s)) changed_.push_back(f);
  make_set(changed_, *bulk_);
  if (!triangulate_changed(stop)) return true;
  look_again_.insert(look_again_.end(), changed_.begin(), changed_.end());
  changed_.clear();
  const std::vector<EntityId> present = find_present();
  std::vector<SplitPlan> missing = plan_splits(present, [this](EntityId f) {
    std::vector<Candidate> of_facet;
    if (squares_->has_facet(f)) return of_facet;
    for (std::size_t i = 0; i < triangles_[f].size(); ++i)
      if (const Triangle& t = triangles_[f][i]; seen_[f][i] == not_seen)
        of_facet.push_back({equatorial_ball(mesh_->point(t[0]), mesh_->point(t[1]), mesh_->point(t[2])), t, 0});
    return of_facet;
  });
  look_again_.clear();
  for (const EntityId f : present)
    if (squares_->has_facet(f)) look_again_.push_back(f);
  std::size_t triangles = 0;
  for (const SplitPlan& plan : missing) {
    look_again_.push_back(plan.facet());
    triangles += plan.candidates().size();
  }
  trend_.note(triangles);
  for (SplitPlan& plan : missing)
    if (!stop()) split_triangles(plan, stop);
  return !missing.empty();
}

WantedFaces FacetPatches::wanted() const {
  using Item = WantedFaces::Item;
  WantedFaces faces;
  faces.set(bulk_->gather<Item>(triangles_.size(),
                                [this](std::size_t f, std::vector<Item>& out) {
                                  for (const Triangle& t : triangles_[f])
                                    out.push_back(WantedFaces::item(t, static_cast<EntityId>(f)));
                                }),
            mesh_->vertex_bound(), *bulk_);
  return faces;
}

void FacetPatches::require_distinct(const WantedFaces& wanted) const {
  if (!wanted.has_equal(*bulk_)) return;
  std::map<Triangle, EntityId> before;  // to name the first of those that fold over onto others
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (const Triangle& t : triangles_[f]) {
      const auto [at, is_new] = before.try_emplace(sorted(t), f);
      if (!is_new) throw folded_over(*domain_, at->second, f, *mesh_, t);
    }
}

/// An edge inside of a facet has two subfacets, of that facet. What makes and changes cavities relies on it. Facets that bend by
/// more than their distance from others can break it. @pre subfacets and subsegments are marked
/// @throws InputError boundary_not_recovered: an edge is inside of one facet, and of another one, too
void FacetPatches::require_edges_inside_one() const {
  struct Shared {
    EntityId f, g;
    std::array<VertexId, 2> ends;
  };
  const auto look_at = [this](EntityId f, std::vector<Shared>& out) {
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
          if (const EntityId g = mesh_->entity_of_face(walk.cell, walk.exit).id; g != f) out.push_back({f, g, {a, b}});
          return RoundEdge::go_on;
        });
      }
  };
  const std::vector<Shared> shared = bulk_->gather<Shared>(triangles_.size(), [&](std::size_t f, std::vector<Shared>& out) {
    if (triangles_[f].size() > 1) look_at(static_cast<EntityId>(f), out);
  });
  if (!shared.empty()) throw folded_over(*domain_, shared[0].f, shared[0].g, *mesh_, shared[0].ends);
}

}  // namespace pgdr::detail
