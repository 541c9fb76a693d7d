// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
#include "reasons/poor_reasons.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_set>

#include "input/entities.hpp"
#include "input/sharp_angles.hpp"
#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/refine_options.hpp"
#include "reasons/meshed_segments.hpp"
#include "rule/insertion_rule.hpp"
#include "rule/sizes_of_cells.hpp"
#include "space/sort_by_points.hpp"

namespace pgdr {
namespace {

constexpr std::size_t most_cells_about = 4096;  // an element are looked at for a reason

/// May it be an angle within one plane, where triangles of that are facets of their own, since they are kept? That of two facets
/// at a segment is none, nor that of two segments.
template <int D>
bool may_be_of_one_plane(const Domain<D>& domain, const std::array<EntityRef, 2>& pair) {
  if (pair[0].kind != pair[1].kind) return true;
  if (pair[0].kind == EntityKind::segment) return false;
  const auto segments = domain.facet_segments(pair[0].id);
  return std::none_of(segments.begin(), segments.end(), [&](EntityId s) {
    const auto facets = domain.facets_of_segment(s);
    return std::find(facets.begin(), facets.end(), pair[1].id) != facets.end();
  });
}

}  // namespace

template <int D>
Ball<D> doubled_circumball(const Simplex<D>& cell) {
  const auto sphere = circumsphere<D>(cell);
  return {sphere.center, 4 * sphere.squared_radius * (1 - rounding::of_blame)};
}

template <int D>
bool is_beside(const Domain<D>& domain, EntityRef entity, const Ball<D>& doubled) {
  const Point<D>& x = doubled.center;
  const auto p = [&](std::uint32_t i) { return domain.points()[i]; };
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    if (in_diametral_ball<D>(p(ends[0]), p(ends[1]), x)) return true;
  } else if (entity.kind != EntityKind::facet) {
    return false;
  }
  if (squared_distance_to<D>(domain, entity, x) <= doubled.squared_radius) return true;
  if constexpr (D == 3)
    if (entity.kind == EntityKind::facet)
      for (const auto& t : domain.triangles(entity.id))
        if (in_equatorial_ball(equatorial_ball(p(t[0]), p(t[1]), p(t[2])), x)) return true;
  return false;
}

template <int D>
bool PoorReasons<D>::meets(EntityRef e, const Ball<D>& ball) const {
  return squared_distance_to<D>(*domain_, e, ball.center) <= ball.squared_radius;
}

/// As the checker will ask: do they meet, in the mesh, at less than 60 (two segments) or 90 degrees? The reason that this is, if
/// so.
template <int D>
std::optional<DomainReason> PoorReasons<D>::small_angle(const std::array<EntityRef, 2>& pair) const {
  if (!has_extent(pair[0]) || !has_extent(pair[1]) || pair[0] == pair[1]) return {};
  if (kept_->any() && may_be_of_one_plane(*domain_, pair)) return {};
  if (!entities_touch<D>(*domain_, pair[0], pair[1])) return {};
  const bool segments = pair[0].kind == EntityKind::segment && pair[1].kind == EntityKind::segment;
  const double limit = segments ? 60 : 90;
  double angle = entity_angle<D>(*domain_, pair[0], pair[1]);
  if (!segments && angle < limit) angle = counted_angle<D>(*domain_, pair[0], pair[1], meshed_);
  if (angle >= limit) return {};
  return DomainReason{PoorReason::Code::small_angle, pair, angle};
}

/// Do they meet at such an angle, one of them within the ball, which is named first then?
template <int D>
bool PoorReasons<D>::explains(const std::array<EntityRef, 2>& pair, const Ball<D>& doubled, DomainReason& reason) const {
  const auto found = small_angle(pair);
  if (!found) return false;
  for (const auto& order : {pair, std::array{pair[1], pair[0]}}) {
    if (!meets(order[0], doubled)) continue;
    reason = {found->code, order, found->angle};
    return true;
  }
  return false;
}

/// 2D: the small angle of a segment with a subsegment, on one of these cells, that may have been to be split in place of cell
/// c: its diametral disk meets the circumdisk (small-angles.md has the proof). What refused the cell comes first.
template <int D>
std::optional<DomainReason> PoorReasons<D>::explain_by_piece(CellId c, std::span<const CellId> cells,
                                                             std::span<const EntityRef> near) const {
  if constexpr (D == 2) {
    const auto sphere = circumsphere<D>(mesh_->simplex(c));
    const double radius = std::sqrt(sphere.squared_radius);
    std::optional<EntityPair> why;
    if (const auto at = why_.find(index(c)); at != why_.end()) why = at->second;
    std::optional<DomainReason> found;
    for (const CellId k : cells) {
      const auto* constraints = mesh_->constraints(k);
      for (int i = 0; constraints && i <= D; ++i) {
        if (!constraints->has_face(i)) continue;
        const auto ends = mesh_->points(face_without(mesh_->cell(k).vertices, i));
        const Ball<D> ball = diametral_ball<D>(ends[0], ends[1]);
        const double reach = (radius + std::sqrt(ball.squared_radius)) * (1 - rounding::of_blame);
        if (std::sqrt(squared_distance(sphere.center, ball.center)) > reach) continue;
        const EntityRef e = mesh_->entity_of_face(k, i);
        if (why && why->entities[0] == e)
          if (const auto reason = small_angle(why->entities)) return reason;
        for (std::size_t j = 0; j < near.size() && !found; ++j) found = small_angle({e, near[j]});
      }
    }
    return found;
  }
  return {};
}

/// Calls `f` with the entities that a vertex of this home lies on until it says true. Has it?
template <int D>
template <class F>
bool PoorReasons<D>::any_entity_of(Home of, F f) const {
  const auto any_at_segment = [&](EntityId s) {
    const bool is_meshed = meshed_segments_.empty() || meshed_segments_[s] != 0;
    if (is_meshed && f({EntityKind::segment, s})) return true;
    const auto facets = domain_->facets_of_segment(s);
    return std::any_of(facets.begin(), facets.end(), [&](EntityId x) { return f({EntityKind::facet, x}); });
  };
  const EntityRef home = of.entity();
  if (home.kind == EntityKind::facet) return f(home);
  if (home.kind == EntityKind::segment) return any_at_segment(home.id);
  if (home.kind != EntityKind::vertex) return false;
  const auto at = [&](std::uint32_t v) { return segments_at_.begin() + segments_begin_[v]; };
  return std::any_of(at(home.id), at(home.id + 1), any_at_segment);
}

/// The same with those constrained on the cell.
template <int D>
template <class F>
bool PoorReasons<D>::any_constrained(CellId c, F f) const {
  const auto* k = mesh_->constraints(c);
  for (int i = 0; k && i <= D; ++i)
    if (k->has_face(i) && f(mesh_->entity_of_face(c, i))) return true;
  return false;
}

/// What refused the element if that is a pair with a small angle, else the first such pair among the entities of ever
/// more cells round it; if `beside` is set, one of which has a vertex of the cell.
template <int D>
DomainReason PoorReasons<D>::explain(CellId c, bool beside) const {
  auto touches = [&](EntityRef e) {
    return std::any_of(mesh_->cell(c).vertices.begin(), mesh_->cell(c).vertices.end(),
                       [&](VertexId v) { return lies_on<D>(*domain_, mesh_->vertex(v).home, e); });
  };
  const Ball<D> doubled = doubled_circumball<D>(mesh_->simplex(c));
  DomainReason reason;
  if (const auto why = why_.find(index(c)); why != why_.end() && why->second)
    if (!beside && explains(why->second->entities, doubled, reason)) return reason;
  // Below the proved bound most cells have no small angle to name, and need none.
  const bool proved = bounds_->radius_edge_bound >= smallest_proved_bound<D>();
  const std::size_t most_cells = proved ? most_cells_about : 16;
  std::vector<CellId> cells{c};
  std::unordered_set<std::uint32_t> known{index(c)}, known_vertices;
  std::vector<EntityRef> near;
  std::vector<bool> in_ball;  // of any pair that explains it at least one is
  const auto completes_pair = [&](EntityRef e) {
    if (std::find(near.begin(), near.end(), e) != near.end()) return false;
    near.push_back(e);
    in_ball.push_back(has_extent(e) && meets(e, doubled));
    for (std::size_t j = 0; j + 1 < near.size(); ++j) {
      if (!in_ball[j] && !in_ball.back()) continue;
      if (beside && !touches(e) && !touches(near[j])) continue;
      if (explains({e, near[j]}, doubled, reason)) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const VertexId v : mesh_->cell(cells[i]).vertices)
      if (known_vertices.insert(index(v)).second && any_entity_of(mesh_->vertex(v).home, completes_pair)) return reason;
    if (any_constrained(cells[i], completes_pair)) return reason;
    for (const Link link : mesh_->cell(cells[i]).links)
      if (link && cells.size() < most_cells && known.insert(index(link.cell())).second) cells.push_back(link.cell());
  }
  if (proved && !beside)
    if (const auto found = explain_by_piece(c, cells, near)) return *found;
  reason.code = !proved                                                             ? PoorReason::Code::beyond_theory
                : checking::is_as_short_as_rounding<D>(mesh_->simplex(c), largest_) ? PoorReason::Code::rounding
                                                                                    : PoorReason::Code::not_found;
  if (!kept_->any() || beside) return reason;
  if (const auto why = why_.find(index(c)); why != why_.end() && why->second) near.insert(near.begin(), why->second->entities[0]);
  for (const EntityRef e : near)
    if (kept_->has(e) && is_beside<D>(*domain_, e, doubled)) return {PoorReason::Code::kept_boundary, {e, {}}, 0};
  return reason;
}

template <int D>
PoorReasons<D>::PoorReasons(const Mesh<D>& mesh, const Domain<D>& domain, const CellBounds<D>& bounds,
                            const KeptEntities<D>& kept, CountedTriangles meshed, const detail::Bulk& bulk)
    : mesh_(&mesh),
      domain_(&domain),
      bounds_(&bounds),
      kept_(&kept),
      meshed_(meshed),
      meshed_segments_(meshed_segments<D>(mesh, domain, meshed)) {
  const auto ends = [&](EntityId s) { return domain.segments()[s].points; };
  detail::sort_by_points(domain.points().size(), domain.segments().size(), ends, bulk, segments_begin_, segments_at_);
  for (const Point<D>& p : domain.points())
    for (const double x : p.x) largest_ = std::max(largest_, std::abs(x));
}

template <int D>
void PoorReasons<D>::add(std::span<const Refusal<D>> refused) {
  for (const Refusal<D>& r : refused)
    if (r.entry.kind() == EntryKind::cell && r.entry.alive(*mesh_))
      if (const auto [at, is_new] = why_.try_emplace(index(r.entry.cell), r.pair); !is_new && r.pair) at->second = r.pair;
}

template <int D>
void PoorReasons<D>::look_at(CellId c, bool violated, std::vector<PoorCell>& found) const {
  const CellVerdict verdict = bounds_->test(*mesh_, c);
  if (!verdict && !violated) return;
  DomainReason reason;
  // Without a small angle nearby a violation is one of rounding, which needs no reason.
  const bool beside = violated && (reason = explain(c, true)).code == PoorReason::Code::small_angle;
  if (verdict && !beside) reason = explain(c, false);
  if (verdict || beside) found.push_back({c, static_cast<bool>(verdict), verdict.over_size > 0, reason, beside});
}

template <int D>
std::vector<PoorCell> PoorReasons<D>::of_violated(std::span<const CellId> cells, const std::function<bool()>& ended) const {
  std::vector<PoorCell> found;
  for (const CellId c : cells) {
    if (ended()) break;
    const DomainReason reason = explain(c, true);
    if (reason.code == PoorReason::Code::small_angle) found.push_back({c, false, false, reason, true});
  }
  return found;
}

template <int D>
PoorCount count_poor_cells(const Mesh<D>& mesh, const CellBounds<D>& bounds, std::uint32_t first, std::uint32_t last) {
  PoorCount poor;
  SizesOfCells<D> cells(mesh, bounds);
  for (std::uint32_t i = first; i < last;) {
    i = cells.look(i, last);
    for (std::size_t k = 0; k < cells.alive().size(); ++k) {
      const CellVerdict verdict = cells.test(k);
      poor.cells += verdict ? 1 : 0;
      poor.over_size = poor.over_size || verdict.over_size > 0;
    }
  }
  return poor;
}

template <int D>
std::vector<PoorCell> PoorReasons<D>::of_cells(std::uint32_t first, std::uint32_t last, const std::vector<bool>& violated,
                                               const std::function<bool()>& must_end) const {
  std::vector<PoorCell> found;
  for (std::uint32_t i = first; i < last; ++i) {
    if (i % 64 == 0 && must_end()) break;  // of each thousands of cells may be looked at
    if (mesh_->alive(CellId{i})) look_at(CellId{i}, violated[i], found);
  }
  return found;
}

// After a run to the end a poor cell is alive only because it was refused.
template <int D>
std::vector<PoorCell> PoorReasons<D>::of_refused(const std::function<bool()>& must_end, const detail::Bulk& bulk) const {
  constexpr std::size_t cells_a_part = 16;  // of each thousands of others may be looked at
  std::vector<CellId> cells;
  for (const auto& why : why_) cells.push_back(CellId{why.first});
  std::vector<std::vector<PoorCell>> found((cells.size() + cells_a_part - 1) / cells_a_part);
  bulk.parts(found.size(), [&](std::size_t part) {
    if (must_end()) return;
    for (std::size_t i = part * cells_a_part; i < std::min(cells.size(), (part + 1) * cells_a_part); ++i)
      look_at(cells[i], false, found[part]);
  });
  std::vector<PoorCell> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

template Ball<2> doubled_circumball<2>(const Simplex<2>&);
template Ball<3> doubled_circumball<3>(const Simplex<3>&);
template bool is_beside<2>(const Domain<2>&, EntityRef, const Ball<2>&);
template bool is_beside<3>(const Domain<3>&, EntityRef, const Ball<3>&);
template PoorCount count_poor_cells(const Mesh<2>&, const CellBounds<2>&, std::uint32_t, std::uint32_t);
template PoorCount count_poor_cells(const Mesh<3>&, const CellBounds<3>&, std::uint32_t, std::uint32_t);
template class PoorReasons<2>;
template class PoorReasons<3>;

}  // namespace pgdr
