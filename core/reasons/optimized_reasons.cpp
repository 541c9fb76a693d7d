// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/optimized_reasons.hpp"

#include <algorithm>

#include "input/entities.hpp"
#include "mesh/ridge.hpp"
#include "numbers/angle_bounds.hpp"
#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/refine_options.hpp"
#include "reasons/meshed_segments.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {
namespace {

constexpr std::size_t most_cells_near = 1024;  // are looked at for a sharp angle near a cell
constexpr std::size_t most_pairs_at = 64;      // of segments at one point are remembered

/// A wall at an edge: its vertex that is not on the edge, and its facet.
struct WallAtEdge {
  VertexId apex = no_vertex;
  EntityId facet = no_entity;
};

/// The first walls round the edge, on the sides of its two other corners, in the order of corners_without(). None where there is
/// none.
std::array<WallAtEdge, 2> walls_at(const Mesh<3>& mesh, CellId c, int edge) {
  std::array<WallAtEdge, 2> walls;
  std::size_t way = 1;  // for_cells_round goes to the side of the second corner first
  for_cells_round(mesh, c, edge, [&](const RidgeWalk<3>& walk) {
    if (!mesh.constrained(walk.cell, walk.exit)) return RoundEdge::go_on;
    walls[way] = {mesh.cell(walk.cell).vertices[walk.entry], mesh.entity_of_face(walk.cell, walk.exit).id};
    if (way == 0) return RoundEdge::stop;
    way = 0;
    return RoundEdge::turn_back;
  });
  return walls;
}

}  // namespace

OptimizedReasons::OptimizedReasons(const Mesh<3>& mesh, const Domain<3>& domain, const CellBounds<3>& bounds,
                                   const KeptEntities<3>& kept, CountedTriangles meshed, double largest_cosine)
    : mesh_(&mesh),
      domain_(&domain),
      bounds_(&bounds),
      kept_(&kept),
      meshed_(meshed),
      angles_{bounds.radius_edge_bound, largest_cosine},
      gaps_(mesh, domain, angles_, meshed),
      segments_at_(domain.points().size()) {
  for (const Point3& p : domain.points())
    for (const double x : p.x) largest_ = std::max(largest_, std::abs(x));
  const std::vector<std::uint8_t> has_segment = meshed_segments<3>(mesh, domain, meshed);
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (has_segment.empty() || has_segment[s] != 0)
      for (const std::uint32_t p : domain.segments()[s].points) segments_at_[p].push_back(s);
}

DomainReason OptimizedReasons::small_angle(EntityKind kind, const Pair& pair) const {
  const std::array<EntityRef, 2> entities{EntityRef{kind, pair[0]}, EntityRef{kind, pair[1]}};
  return {PoorReason::Code::small_angle, entities, counted_angle<3>(*domain_, entities[0], entities[1], meshed_)};
}

/// A segment at which the walls on both sides of the cell make an angle below the target. The walls are the mesh's, as the cell
/// has to live with these, and the checker asks the same.
std::optional<DomainReason> OptimizedReasons::wedge_of(CellId c) const {
  const auto* constraints = mesh_->constraints(c);
  const auto& v = mesh_->cell(c).vertices;
  for (int e = 0; constraints && e < edge_count(3); ++e) {
    if (!constraints->has_edge(e)) continue;
    const auto walls = walls_at(*mesh_, c, e);
    if (walls[0].apex == no_vertex || walls[1].apex == no_vertex || walls[0].facet == walls[1].facet) continue;
    const auto [i, j] = edge_ends[e];
    const auto [k, l] = corners_without(i, j);
    const Point3 &a = mesh_->point(v[i]), &b = mesh_->point(v[j]);
    const Point3 &first = mesh_->point(walls[0].apex), &last = mesh_->point(walls[1].apex);
    if (orient3d(a, b, first, last) != orient3d(a, b, mesh_->point(v[k]), mesh_->point(v[l]))) continue;
    if (!detail::dihedral_below(a, b, first, last, angles_.largest_cosine)) continue;
    const EntityRef segment{EntityKind::segment, constraints->edge_entity[e]};
    return DomainReason{PoorReason::Code::input_dihedral, {segment, {}}, dihedral_degrees(a, b, first, last)};
  }
  return {};
}

/// Two segments of one facet that make too small an angle at a vertex of the cell.
std::optional<DomainReason> OptimizedReasons::corner_of_cell(CellId c) {
  for (const VertexId v : mesh_->cell(c).vertices) {
    const Home home = mesh_->vertex(v).home;
    if (home.kind() != EntityKind::vertex) continue;
    const auto [at, fresh] = sharp_corners_.try_emplace(home.id());
    if (fresh)
      for (const Pair& pair : segments_sharp_at(home.id()))
        if (!at->second && is_sharp_corner(*domain_, home.id(), pair[0], pair[1], angles_, meshed_)) at->second = pair;
    if (at->second) return small_angle(EntityKind::segment, *at->second);
  }
  return {};
}

/// Two entities that share a vertex of the cell alone, and come too near to each other about it, with the cell between.
std::optional<DomainReason> OptimizedReasons::gap_at_corner(CellId c) {
  const auto pair = gaps_.of_cell(c);
  if (!pair) return {};
  return DomainReason{PoorReason::Code::small_angle, *pair, counted_angle<3>(*domain_, (*pair)[0], (*pair)[1], meshed_)};
}

const std::vector<OptimizedReasons::Pair>& OptimizedReasons::segments_sharp_at(EntityId point) {
  const auto [at, fresh] = sharp_segments_.try_emplace(point);
  if (!fresh) return at->second;
  const auto& segments = segments_at_[point];
  const auto far_end = [&](EntityId s) -> const Point3& {
    const auto& ends = domain_->segments()[s].points;
    return domain_->points()[ends[0] == point ? ends[1] : ends[0]];
  };
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (std::size_t j = 0; j < i && at->second.size() < most_pairs_at; ++j)
      if (detail::is_too_sharp<3>(domain_->points()[point], far_end(segments[i]), far_end(segments[j]), angles_.radius_edge))
        at->second.push_back({segments[i], segments[j]});
  return at->second;
}

const std::vector<OptimizedReasons::Pair>& OptimizedReasons::facets_sharp_at(EntityId segment) {
  const auto [at, fresh] = sharp_facets_.try_emplace(segment);
  if (!fresh) return at->second;
  const auto facets = domain_->facets_of_segment(segment);
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (meet_too_sharply(*domain_, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[j]}, angles_, meshed_))
        at->second.push_back({facets[i], facets[j]});
  return at->second;
}

/// Two entities that meet at too small an angle, one of which meets the cell's circumball, doubled: among those on which vertices
/// of ever more cells round it lie.
std::optional<DomainReason> OptimizedReasons::angle_near(CellId c) {
  const auto sphere = circumsphere<3>(mesh_->simplex(c));
  const double reach = 4 * sphere.squared_radius * (1 - rounding::of_blame);  // a hair less, for the checker's rounding
  std::optional<DomainReason> found;
  const auto take = [&](EntityKind kind, const std::vector<Pair>& pairs) {
    for (const Pair& pair : pairs)
      for (const Pair& order : {pair, Pair{pair[1], pair[0]}})
        if (!found && squared_distance_to<3>(*domain_, {kind, order[0]}, sphere.center) <= reach)
          found = small_angle(kind, order);
  };
  std::vector<CellId>& cells = cells_near_;
  cells.assign(1, c);
  known_cells_.reset(most_cells_near);
  known_vertices_.reset(4 * most_cells_near);
  known_cells_.insert(index(c));
  for (std::size_t i = 0; i < cells.size() && !found; ++i) {
    for (const VertexId v : mesh_->cell(cells[i]).vertices) {
      if (found || !known_vertices_.insert(index(v))) continue;
      const Home home = mesh_->vertex(v).home;
      if (home.kind() == EntityKind::segment) take(EntityKind::facet, facets_sharp_at(home.id()));
      if (home.kind() != EntityKind::vertex) continue;
      take(EntityKind::segment, segments_sharp_at(home.id()));
      for (const EntityId s : segments_at_[home.id()]) take(EntityKind::facet, facets_sharp_at(s));
    }
    for (const Link link : mesh_->cell(cells[i]).links)
      if (link && cells.size() < most_cells_near && known_cells_.insert(index(link.cell()))) cells.push_back(link.cell());
  }
  return found;
}

/// A kept segment that the cell has an edge on, or a kept facet on which two of its corners lie: what a dihedral angle below the
/// bound has to be at. A segment with points of its own is none: it was to be kept, but for a point that could not be taken off.
std::optional<DomainReason> OptimizedReasons::kept_at(CellId c) const {
  const auto& v = mesh_->cell(c).vertices;
  const auto is_given = [&](VertexId x) { return mesh_->vertex(x).home.kind() == EntityKind::vertex; };
  const auto reason = [](EntityRef e) { return DomainReason{PoorReason::Code::kept_boundary, {e, {}}, 0}; };
  const auto* constraints = mesh_->constraints(c);
  for (int e = 0; constraints && e < edge_count(3); ++e) {
    if (!constraints->has_edge(e)) continue;
    const EntityRef segment{EntityKind::segment, constraints->edge_entity[e]};
    const auto ends = ends_of_edge(v, e);
    if (kept_->has(segment) && is_given(ends[0]) && is_given(ends[1])) return reason(segment);
  }
  std::vector<EntityId> of_others, of_corner;
  for (const VertexId x : v) {
    if (!is_given(x)) continue;
    of_corner.clear();
    for (const EntityId s : segments_at_[mesh_->vertex(x).home.id()])
      for (const EntityId f : domain_->facets_of_segment(s))
        if (kept_->has({EntityKind::facet, f})) of_corner.push_back(f);
    for (const EntityId f : of_corner)
      if (std::find(of_others.begin(), of_others.end(), f) != of_others.end()) return reason({EntityKind::facet, f});
    of_others.insert(of_others.end(), of_corner.begin(), of_corner.end());
  }
  return {};
}

/// What was kept, and blocks the places for a point that would take the cell away, which is over the bound of shape.
std::optional<DomainReason> OptimizedReasons::kept_before(CellId c) {
  if (!kept_blocks_) kept_blocks_.emplace(*domain_, *kept_);
  const auto e = kept_blocks_->of_cell(mesh_->simplex(c), bounds_->radius_edge_bound);
  if (!e) return {};
  return DomainReason{PoorReason::Code::kept_boundary, {*e, {}}, 0};
}

/// A kept entity that stands in the way of a better cell: among those at ever more cells round it, the first beside its
/// circumball.
std::optional<DomainReason> OptimizedReasons::kept_near(CellId c) {
  const Ball<3> doubled = doubled_circumball<3>(mesh_->simplex(c));
  std::vector<EntityRef> known;
  const auto is_beside_cell = [&](EntityRef e) {
    if (!kept_->has(e) || std::find(known.begin(), known.end(), e) != known.end()) return false;
    known.push_back(e);
    return is_beside<3>(*domain_, e, doubled);
  };
  const auto first_of = [&](const ConstraintRecord<3>& k) -> std::optional<EntityRef> {
    for (int f = 0; f < 4; ++f)
      if (const EntityRef e{EntityKind::facet, k.face_entity[f]}; k.has_face(f) && is_beside_cell(e)) return e;
    for (int e = 0; e < edge_count(3); ++e)
      if (const EntityRef s{EntityKind::segment, k.edge_entity[e]}; k.has_edge(e) && is_beside_cell(s)) return s;
    return {};
  };
  std::vector<CellId>& cells = cells_near_;
  cells.assign(1, c);
  known_cells_.reset(most_cells_near);
  known_cells_.insert(index(c));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (const auto* k = mesh_->constraints(cells[i]))
      if (const auto found = first_of(*k)) return DomainReason{PoorReason::Code::kept_boundary, {*found, {}}, 0};
    for (const Link link : mesh_->cell(cells[i]).links)
      if (link && cells.size() < most_cells_near && known_cells_.insert(index(link.cell()))) cells.push_back(link.cell());
  }
  return {};
}

std::vector<PoorCell> OptimizedReasons::of_cells(std::span<const CellId> cells, PoorReason::Code otherwise,
                                                 const std::function<bool()>& ended) {
  std::vector<PoorCell> found;
  for (const CellId c : cells) {
    if (ended()) break;
    const Simplex<3> s = mesh_->simplex(c);
    const CellVerdict verdict = bounds_->test(*mesh_, c);
    const bool below = !dihedral_within(s, angles_.largest_cosine);
    if (!verdict && !below) continue;
    std::optional<DomainReason> reason = wedge_of(c);
    if (!reason) reason = corner_of_cell(c);
    if (!reason) reason = gap_at_corner(c);
    if (!reason && !below) {
      reason = angle_near(c);
      if (!reason && checking::is_as_short_as_rounding<3>(s, largest_)) reason = DomainReason{PoorReason::Code::rounding, {}, 0};
      if (!reason && bounds_->radius_edge_bound < smallest_proved_bound<3>())
        reason = DomainReason{PoorReason::Code::beyond_theory, {}, 0};
    }
    if (!reason && kept_->any()) reason = below ? kept_at(c) : kept_near(c);
    if (!reason && kept_->any() && below && verdict.over_radius_edge) reason = kept_before(c);
    found.push_back({c, true, verdict.over_size > 0, reason.value_or(DomainReason{otherwise, {}, 0}), false});
  }
  return found;
}

}  // namespace pgdr
