// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles between input entities, decided exactly: of two segments below 60 degrees, otherwise below 90. A direction
// into a facet at one of its points is a positive combination of the edges of its triangles there, and the product of
// two positive combinations is positive for some choice iff it is for a pair of edges: so edges decide.
#include "check/reasons.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_set>

#include "check/wedges.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/predicates.hpp"
#include "space/distances.hpp"

namespace pgdr::checking {
namespace {

/// Ends of the edges that span the cones of the entity at a point of it: none if the point is not a corner of it.
template <int D>
std::vector<std::uint32_t> edges_at(const Domain<D>& domain, EntityRef entity, std::uint32_t point) {
  std::vector<std::uint32_t> ends;
  if (entity.kind == EntityKind::segment) {
    const auto& p = domain.segments()[entity.id].points;
    if (p[0] == point) ends.push_back(p[1]);
    if (p[1] == point) ends.push_back(p[0]);
  }
  if constexpr (D == 3)
    if (entity.kind == EntityKind::facet)
      for (const auto& t : domain.triangles(entity.id))
        for (int i = 0; i < 3; ++i)
          if (t[i] == point) ends.insert(ends.end(), {t[(i + 1) % 3], t[(i + 2) % 3]});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

template <int D>
std::vector<std::uint32_t> points_of(const Domain<D>& domain, EntityRef entity) {
  std::vector<std::uint32_t> points;
  if (entity.kind == EntityKind::segment) {
    const auto& p = domain.segments()[entity.id].points;
    points.assign(p.begin(), p.end());
  }
  if constexpr (D == 3)
    if (entity.kind == EntityKind::facet) {
      const auto p = domain.facet_points(entity.id);
      points.assign(p.begin(), p.end());
    }
  std::sort(points.begin(), points.end());
  return points;
}

template <int D>
std::vector<std::uint32_t> common_points(const Domain<D>& domain, EntityRef a, EntityRef b) {
  const auto of_a = points_of(domain, a), of_b = points_of(domain, b);
  std::vector<std::uint32_t> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  return common;
}

template <int D>
bool below_at(const Domain<D>& domain, EntityRef a, EntityRef b, std::uint32_t point) {
  const auto points = domain.points();
  const bool both_segments = a.kind == EntityKind::segment && b.kind == EntityKind::segment;
  for (const std::uint32_t p : edges_at(domain, a, point))
    for (const std::uint32_t q : edges_at(domain, b, point))
      if (both_segments ? angle_below_60<D>(points[point], points[p], points[q])
                        : angle_below_90<D>(points[point], points[p], points[q]))
        return true;
  return false;
}

/// The points opposite an edge in the triangles of a facet.
std::vector<std::uint32_t> apexes(const Domain<3>& domain, EntityId facet, std::array<std::uint32_t, 2> edge) {
  std::vector<std::uint32_t> out;
  for (const auto& t : domain.triangles(facet))
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      if ((a == edge[0] && b == edge[1]) || (a == edge[1] && b == edge[0])) out.push_back(t[i]);
    }
  return out;
}

/// Two facets with a common segment: their dihedral angle there. Ends of common segments are marked in `on_common`.
bool dihedral_below(const Domain<3>& domain, EntityId a, EntityId b, std::vector<std::uint32_t>& on_common) {
  const auto points = domain.points();
  const auto of_b = domain.facet_segments(b);
  for (const EntityId s : domain.facet_segments(a)) {
    if (std::find(of_b.begin(), of_b.end(), s) == of_b.end()) continue;
    const auto& edge = domain.segments()[s].points;
    on_common.insert(on_common.end(), edge.begin(), edge.end());
    for (const std::uint32_t c : apexes(domain, a, edge))
      for (const std::uint32_t d : apexes(domain, b, edge))
        if (dihedral_below_90(points[edge[0]], points[edge[1]], points[c], points[d])) return true;
  }
  return false;
}

bool contains_segment(const Domain<3>& domain, EntityRef facet, EntityRef segment) {
  if (facet.kind != EntityKind::facet || segment.kind != EntityKind::segment) return false;
  const auto list = domain.facet_segments(facet.id);
  return std::find(list.begin(), list.end(), segment.id) != list.end();
}

}  // namespace

template <int D>
Reasons<D>::Reasons(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links,
                    const Conformity<D>* conformity, Findings& findings)
    : mesh_(mesh), options_(options), links_(links), conformity_(conformity) {
  if (!options.reasons) return;
  for (const Point<D>& p : mesh.points)
    for (const double x : p.x) largest_ = std::max(largest_, std::abs(x));
  for (std::uint32_t i = 0; i < options.reasons->size(); ++i) {
    const std::uint32_t cell = (*options.reasons)[i].cell;
    if (cell < mesh.cells.size()) {
      by_cell_.push_back(i);
      continue;
    }
    findings.add(Kind::bad_reason, {cell}, [&] {
      return "Reason " + std::to_string(i) + " names cell " + std::to_string(cell) + ", which does not exist.";
    });
  }
  std::stable_sort(by_cell_.begin(), by_cell_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return (*options.reasons)[a].cell < (*options.reasons)[b].cell; });
}

template <int D>
std::span<const std::uint32_t> Reasons<D>::of_cell(std::uint32_t cell) const {
  if (!options_.reasons) return {};
  const auto& reasons = *options_.reasons;
  const auto first = std::partition_point(by_cell_.begin(), by_cell_.end(),
                                          [&](std::uint32_t r) { return reasons[r].cell < cell; });
  return {first, std::partition_point(first, by_cell_.end(), [&](std::uint32_t r) { return reasons[r].cell == cell; })};
}

template <int D>
auto Reasons<D>::judge(std::uint32_t cell, std::string& why) -> Verdict {
  Verdict of_all = Verdict::absent;
  for (const std::uint32_t r : of_cell(cell)) {
    const Verdict verdict = judge((*options_.reasons)[r], why);
    if (verdict == Verdict::holds) return verdict;
    if (of_all != Verdict::admitted) of_all = verdict;
  }
  return of_all;
}

template <int D>
bool Reasons<D>::excuses_dihedral(std::uint32_t cell) {
  std::string why;
  const auto of = of_cell(cell);
  return std::any_of(of.begin(), of.end(), [&](std::uint32_t r) {
    const PoorReason& reason = (*options_.reasons)[r];
    return is_at_corner(reason) || is_in_gap(reason) ||
           (reason.code == PoorReason::Code::input_dihedral && in_wedge(reason, why) == Verdict::holds);
  });
}

template <int D>
auto Reasons<D>::judge(const PoorReason& reason, std::string& why) -> Verdict {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return Verdict::fails;
  };
  switch (reason.code) {
    case PoorReason::Code::not_found:
    case PoorReason::Code::budget: return Verdict::admitted;
    case PoorReason::Code::rounding:
      return is_as_short_as_rounding<D>(corners_of(mesh_, reason.cell), largest_)
                 ? Verdict::holds
                 : fail("it has no edge as short as the rounding of coordinates");
    case PoorReason::Code::beyond_theory:
      return options_.radius_edge_bound < smallest_proved_bound<D>() ? Verdict::holds
                                                                     : fail("the radius-edge bound is not below the proved one");
    case PoorReason::Code::kept_boundary: return beside_kept(reason, why) ? Verdict::holds : Verdict::fails;
    case PoorReason::Code::input_dihedral:
      if (!asks_for_dihedral()) return Verdict::admitted;
      return in_wedge(reason, why);
    case PoorReason::Code::small_angle: break;
  }
  if (!options_.domain) return fail("an angle of the input cannot be measured without the input");
  const auto& [a, b] = reason.entities;
  if (!exists(a) || !exists(b)) return fail("it names an entity that does not exist");
  const Meeting angle = meeting(a, b);
  if (!angle.small && !angle.sharp) return fail(words(a) + " and " + words(b) + " meet at no small angle");
  if (!near(reason.cell, a) && !meets_piece(reason.cell, a))
    return fail("its circumball, doubled, does not meet " + words(a) +
                (D == 2 ? ", nor it the diametral disk of a piece of that" : ""));
  return angle.sharp || !asks_for_dihedral() || is_in_gap(reason) ? Verdict::holds : Verdict::admitted;
}

/// Does it name two segments of one facet that meet at a vertex of the cell, at a planar angle that is too small?
template <int D>
bool Reasons<D>::is_at_corner(const PoorReason& reason) const {
  if constexpr (D == 3) {
    const auto& [a, b] = reason.entities;
    if (reason.code != PoorReason::Code::small_angle || !options_.domain || !conformity_) return false;
    if (a.kind != EntityKind::segment || b.kind != EntityKind::segment || !exists(a) || !exists(b)) return false;
    for (const std::uint32_t p : common_points(*options_.domain, a, b))
      if (const std::uint32_t v = conformity_->vertex_of_point[p]; v != none && has_corner(mesh_.cells[reason.cell], v))
        return is_sharp_corner(*options_.domain, p, a.id, b.id, angle_bounds());
  }
  return false;
}

/// Of the mesh: does the vertex lie on the segment or facet?
template <int D>
bool Reasons<D>::lies_on(std::uint32_t v, EntityRef entity) const {
  const EntityRef home = conformity_->home[v];
  if (home == entity) return true;
  if (home.kind == EntityKind::vertex) {
    const auto points = points_of(*options_.domain, entity);
    return std::binary_search(points.begin(), points.end(), home.id);
  }
  if constexpr (D == 3) return contains_segment(*options_.domain, entity, home);
  return false;
}

/// Is it between two segments or facets that share one of its vertices and no segment at it, and come too near to each other
/// about that (docs/small-angles.md has the proof)? It has to be as thin there as the proof says, with another vertex on one of
/// the two, and have a way round the vertex to the middle of the gap, so that this is meshed.
template <int D>
bool Reasons<D>::is_in_gap(const PoorReason& reason) const {
  if constexpr (D == 3) {
    const EntityRef a = reason.entities[0], b = reason.entities[1];
    if (reason.code != PoorReason::Code::small_angle || !options_.domain || !conformity_ || !exists(a) || !exists(b))
      return false;
    const auto& cell = mesh_.cells[reason.cell];
    for (const std::uint32_t p : common_points(*options_.domain, a, b)) {
      const std::uint32_t v = conformity_->vertex_of_point[p];
      if (v == none || !has_corner(cell, v) || !is_thin_at(corners_of(mesh_, reason.cell), corner_of(cell, v), angle_bounds()))
        continue;
      const auto touches = [&](std::uint32_t w) { return w != v && (lies_on(w, a) || lies_on(w, b)); };
      if (std::none_of(cell.begin(), cell.end(), touches)) continue;
      const auto middle = middle_of_gap(*options_.domain, p, a, b, angle_bounds());
      if (middle && reaches(reason.cell, v, reason.entities, *middle)) return true;
    }
  }
  return false;
}

/// Round the vertex, across neither of the two, is there a way from the cell to one that the direction to the middle leads into?
template <int D>
bool Reasons<D>::reaches(std::uint32_t cell, std::uint32_t v, const std::array<EntityRef, 2>& pair, const Point3& middle) const {
  if constexpr (D == 3) {
    const auto is_on_one = [&](std::uint32_t face) {
      const auto corners = face_vertices(mesh_, face);
      return std::any_of(pair.begin(), pair.end(), [&](EntityRef e) {
        return e.kind == EntityKind::facet &&
               std::all_of(corners.begin(), corners.end(), [&](std::uint32_t w) { return lies_on(w, e); });
      });
    };
    std::vector<std::uint32_t> cells{cell};
    std::unordered_set<std::uint32_t> known{cell};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int corner = corner_of(mesh_.cells[cells[i]], v);
      if (!links_.positive(cells[i]) || corner == 4) continue;
      if (has_direction(corners_of(mesh_, cells[i]), corner, middle)) return true;
      for (int k = 0; k < 4; ++k) {
        const std::uint32_t face = 4 * cells[i] + static_cast<std::uint32_t>(k), back = links_.neighbour[face];
        if (k == corner || back == none || (links_.is_wall(face) && is_on_one(face))) continue;
        if (known.insert(back / 4).second) cells.push_back(back / 4);
      }
    }
  }
  return false;
}

/// Has the cell an edge on the segment at which the walls on both sides make an angle below the bound, with the cell between? If
/// they make a larger one the cell is at the segment, but not excused.
template <int D>
auto Reasons<D>::in_wedge(const PoorReason& reason, std::string& why) -> Verdict {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return Verdict::fails;
  };
  const EntityRef s = reason.entities[0];
  if (!options_.domain || !conformity_) return fail("an angle of the input cannot be measured without the input");
  if (s.kind != EntityKind::segment || !exists(s)) return fail("it names no segment of the input");
  bool at_segment = false;
  if constexpr (D == 3) {
    list_subsegments();
    for (int e = 0; e < edge_count(3); ++e) {
      auto ends = ends_of_edge(mesh_.cells[reason.cell], e);
      std::sort(ends.begin(), ends.end());
      if (!std::binary_search(subsegments_.begin(), subsegments_.end(), std::pair{ends, EntityId{s.id}})) continue;
      if (is_wedge_below(mesh_, links_, reason.cell, e, options_.largest_cosine)) return Verdict::holds;
      at_segment = true;
    }
  }
  return at_segment ? Verdict::admitted : fail("it has no edge on " + words(s));
}

template <int D>
void Reasons<D>::list_subsegments() {
  if (!subsegments_.empty()) return;
  for (std::size_t i = 0; i < mesh_.subsegments.size(); ++i) {
    auto ends = mesh_.subsegments[i].vertices;
    std::sort(ends.begin(), ends.end());
    subsegments_.push_back({ends, conformity_->segment_of[i].entity});
  }
  std::sort(subsegments_.begin(), subsegments_.end());
}

/// A segment in one piece that meets the cell's circumball, doubled, or has its centre in the diametral ball.
template <int D>
bool Reasons<D>::beside_kept(const PoorReason& reason, std::string& why) const {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return false;
  };
  const EntityRef s = reason.entities[0];
  if (!options_.domain || !conformity_) return fail("whether a segment was kept cannot be seen without the input");
  if (D != 2 || s.kind != EntityKind::segment || !exists(s)) return fail("it names no segment of a planar input");
  if (conformity_->pieces[s.id] != 1) return fail(words(s) + " has points of its own");
  const auto& ends = options_.domain->segments()[s.id].points;
  const Point<D> middle = detail::on_edge(options_.domain->points()[ends[0]], options_.domain->points()[ends[1]], 0.5);
  const auto ball = circumsphere<D>(corners_of(mesh_, reason.cell));
  const double reach = std::sqrt(squared_distance(middle, options_.domain->points()[ends[0]]));
  const bool encroached = std::sqrt(squared_distance(middle, ball.center)) <=
                          reach * (1 + rounding::of_blame_checked) + ball.center_error;
  return encroached || near(reason.cell, s) || fail("its circumcentre is not beside " + words(s));
}

template <int D>
bool Reasons<D>::exists(EntityRef entity) const {
  switch (entity.kind) {
    case EntityKind::vertex: return entity.id < options_.domain->points().size();
    case EntityKind::segment: return entity.id < options_.domain->segments().size();
    case EntityKind::facet: return entity.id < options_.domain->facets().size();
    default: return false;
  }
}

template <int D>
auto Reasons<D>::meeting(EntityRef a, EntityRef b) -> Meeting {
  const auto code = [](EntityRef e) { return std::uint64_t{static_cast<std::uint8_t>(e.kind)} << 32 | e.id; };
  const auto [at, fresh] = angles_.try_emplace({code(a), code(b)}, Meeting{});
  if (!fresh) return at->second;
  at->second.small = measure_angle(a, b);
  if constexpr (D == 3) at->second.sharp = asks_for_dihedral() && meet_too_sharply(*options_.domain, a, b, angle_bounds());
  return at->second;
}

template <int D>
bool Reasons<D>::measure_angle(EntityRef a, EntityRef b) const {
  const Domain<D>& domain = *options_.domain;
  if (a == b) return false;
  if (a.kind == EntityKind::vertex) return small_at_point(a.id, b);
  if (b.kind == EntityKind::vertex) return small_at_point(b.id, a);
  std::vector<std::uint32_t> on_common;  // two facets with a common segment make no other angle at its ends
  if constexpr (D == 3) {
    if (contains_segment(domain, a, b) || contains_segment(domain, b, a)) return false;
    if (a.kind == EntityKind::facet && b.kind == EntityKind::facet && dihedral_below(domain, a.id, b.id, on_common)) return true;
  }
  for (const std::uint32_t p : common_points(domain, a, b))
    if (std::find(on_common.begin(), on_common.end(), p) == on_common.end() && below_at(domain, a, b, p)) return true;
  return false;
}

/// An input point stands for what meets there: some other entity makes a small angle with b at it.
template <int D>
bool Reasons<D>::small_at_point(std::uint32_t point, EntityRef b) const {
  const Domain<D>& domain = *options_.domain;
  if (edges_at(domain, b, point).empty()) return false;
  const auto meets = [&](EntityRef c) { return !(c == b) && !edges_at(domain, c, point).empty() && measure_angle(c, b); };
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (meets({EntityKind::segment, s})) return true;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (meets({EntityKind::facet, f})) return true;
  return false;
}

template <int D>
bool Reasons<D>::near(std::uint32_t cell, EntityRef entity) const {
  const auto ball = circumsphere<D>(corners_of(mesh_, cell));
  const double reach = 2 * std::sqrt(ball.squared_radius) * (1 + rounding::of_blame_checked) + ball.center_error;
  return within(ball.center, reach, entity);
}

/// 2D: does the circumdisk meet the diametral disk of a subsegment of the segment? (docs/small-angles.md has the proof that it
/// does if that was to be split in place of the cell, however far it is.)
template <int D>
bool Reasons<D>::meets_piece(std::uint32_t cell, EntityRef entity) {
  if (D != 2 || entity.kind != EntityKind::segment || !conformity_) return false;
  if (pieces_.empty())
    for (std::uint32_t i = 0; i < mesh_.subsegments.size(); ++i)
      if (const auto s = conformity_->segment_of[i].entity; s != none) pieces_[s].push_back(i);
  const auto ball = circumsphere<D>(corners_of(mesh_, cell));
  const auto& of_segment = pieces_[entity.id];
  return std::any_of(of_segment.begin(), of_segment.end(), [&](std::uint32_t i) {
    const auto& ends = mesh_.subsegments[i].vertices;
    const Ball<D> piece = diametral_ball<D>(mesh_.points[ends[0]], mesh_.points[ends[1]]);
    const double reach = (std::sqrt(ball.squared_radius) + std::sqrt(piece.squared_radius)) * (1 + rounding::of_blame_checked);
    return std::sqrt(squared_distance(ball.center, piece.center)) <= reach + ball.center_error;
  });
}

template <int D>
bool Reasons<D>::within(const Point<D>& x, double distance, EntityRef entity) const {
  const Domain<D>& domain = *options_.domain;
  const auto points = domain.points();
  if (entity.kind == EntityKind::vertex) return std::sqrt(squared_distance(x, points[entity.id])) <= distance;
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    return std::sqrt(detail::closest_to_edge(x, points[ends[0]], points[ends[1]]).square) <= distance;
  }
  if constexpr (D == 3)
    for (const auto& t : domain.triangles(entity.id))
      if (std::sqrt(detail::closest_to_triangle(x, points[t[0]], points[t[1]], points[t[2]]).square) <= distance) return true;
  return false;
}

template <int D>
std::vector<std::uint8_t> Reasons<D>::vertices_at_refused(const InputVolumes<D>& input) {
  if (!options_.reasons || !conformity_) return {};
  std::vector<std::uint8_t> at(mesh_.points.size(), 0), segment(options_.domain->segments().size(), 0),
      facet(options_.domain->facets().size(), 0);
  for (const PoorReason& r : *options_.reasons) {
    const auto& [a, b] = r.entities;
    if (r.code != PoorReason::Code::small_angle || !exists(a) || !exists(b) || !meeting(a, b).small) continue;
    for (const EntityRef e : r.entities) {
      if (e.kind == EntityKind::segment) segment[e.id] = 1;
      if (e.kind == EntityKind::facet) facet[e.id] = 1;
      if (e.kind == EntityKind::vertex)
        if (const std::uint32_t v = conformity_->vertex_of_point[e.id]; v != none) at[v] = 1;
    }
  }
  const auto mark = [&](const auto& vertices) {
    for (const std::uint32_t v : vertices) at[v] = 1;
  };
  for (std::size_t i = 0; i < mesh_.subsegments.size(); ++i)
    if (const auto s = conformity_->segment_of[i].entity; s != none && segment[s]) mark(mesh_.subsegments[i].vertices);
  if constexpr (D == 3)
    for (std::size_t i = 0; i < mesh_.subfacets.size(); ++i)
      if (const auto p = conformity_->patch_of[i].entity; p != none && facet[input.patches()[p].entity])
        mark(mesh_.subfacets[i].vertices);
  return at;
}

template class Reasons<2>;
template class Reasons<3>;

}  // namespace pgdr::checking
