// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/reasons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "check/wedges.hpp"
#include "given/edge_net.hpp"
#include "numbers/angle_bounds.hpp"
#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/predicates.hpp"
#include "select/blocked_places.hpp"
#include "space/distances.hpp"
#include "space/equal_rows.hpp"

namespace pgdr::checking {
namespace {

constexpr const char* no_input = "an angle of the input cannot be measured without the input";

/// "segment from (0, 0) to (1, 0)", "facet 7"
template <int D>
std::string words_of(const GivenEntity& e) {
  if (e.kind != EntityKind::segment) return "facet " + std::to_string(e.facet);
  std::array<Point<D>, 2> ends;
  for (std::size_t k = 0; k < 2; ++k)
    for (int i = 0; i < D; ++i) ends[k][i] = e.ends[k][static_cast<std::size_t>(i)];
  return "the segment from " + words(ends[0]) + " to " + words(ends[1]);
}

template <int D>
std::span<const typename NamedEntity<D>::AtEdge> at_edge(const std::vector<typename NamedEntity<D>::AtEdge>& edges,
                                                         const detail::PlanarEdge& ends) {
  using AtEdge = typename NamedEntity<D>::AtEdge;
  return detail::equal_rows(std::span<const AtEdge>(edges), ends, &AtEdge::ends);
}

bool agrees(double stated, const std::vector<AngleRange>& angles) {
  return std::ranges::any_of(angles, [&](const AngleRange& r) { return r.low <= stated && stated <= r.high; });
}

}  // namespace

template <int D>
Reasons<D>::Reasons(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, NamedEntities<D>* named,
                    Findings& findings)
    : mesh_(mesh), options_(options), links_(links), named_(named) {
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
    if (reason.code == PoorReason::Code::input_dihedral) return in_wedge(reason, why) == Verdict::holds;
    if (reason.code == PoorReason::Code::kept_boundary)
      return beside_kept(reason, why) && (has_edge_on(reason) || is_behind_kept(reason));
    if (reason.code != PoorReason::Code::small_angle) return false;
    return is_true(reason, why) && (is_at_corner(reason) || is_in_gap(reason));
  });
}

template <int D>
auto Reasons<D>::pair_of(const PoorReason& reason) -> Pair {
  if (!named_) return {nullptr, nullptr};
  return {named_->find(reason.entities[0]), named_->find(reason.entities[1])};
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
  return judge_angle(reason, why);
}

/// Do the two entities meet at the small angle that it states?
template <int D>
bool Reasons<D>::is_true(const PoorReason& reason, std::string& why) {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return false;
  };
  if (!named_) return fail(no_input);
  const Pair pair = pair_of(reason);
  if (!pair.exists()) return fail("it names what is no segment and no facet of the input");
  const auto both = [&] { return words_of<D>(reason.entities[0]) + " and " + words_of<D>(reason.entities[1]); };
  const EntityMeeting& angle = meeting(pair);
  if (!angle.is_small) return fail(both() + " meet at no small angle");
  return agrees(reason.angle, angle.small) || fail(both() + " do not meet at " + words(reason.angle) + " degrees, but at " +
                                                   words((angle.small[0].low + angle.small[0].high) / 2));
}

template <int D>
bool Reasons<D>::misstates_angle(std::uint32_t cell, std::string& why) {
  const auto of = of_cell(cell);
  return named_ && std::any_of(of.begin(), of.end(), [&](std::uint32_t r) {
           const PoorReason& reason = (*options_.reasons)[r];
           return reason.code == PoorReason::Code::small_angle && !is_true(reason, why);
         });
}

template <int D>
auto Reasons<D>::judge_angle(const PoorReason& reason, std::string& why) -> Verdict {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return Verdict::fails;
  };
  if (!is_true(reason, why)) return Verdict::fails;
  const Pair pair = pair_of(reason);
  if (!near(reason.cell, *pair.a) && !meets_piece(reason.cell, *pair.a))
    return fail("its circumball, doubled, does not meet " + words_of<D>(reason.entities[0]) +
                (D == 2 ? ", nor it the diametral disk of a piece of that" : ""));
  const bool is_sharp = asks_for_dihedral() && meeting(pair).is_sharp;
  return is_sharp || !asks_for_dihedral() || is_in_gap(reason) ? Verdict::holds : Verdict::admitted;
}

/// Does it name two segments of one facet that meet at a vertex of the cell, at a planar angle that is too small?
template <int D>
bool Reasons<D>::is_at_corner(const PoorReason& reason) {
  if constexpr (D == 3) {
    const auto [a, b] = pair_of(reason);
    if (!a || !b || a->kind != EntityKind::segment || b->kind != EntityKind::segment || a->ends == b->ends) return false;
    for (const std::size_t i : {0, 1})
      for (const std::size_t k : {0, 1}) {
        const std::uint32_t v = a->ends[i];
        if (v != b->ends[k] || v >= mesh_.points.size() || !has_corner(mesh_.cells[reason.cell], v)) continue;
        if (!detail::is_too_sharp<3>(mesh_.points[v], named_->point(a->ends[1 - i]), named_->point(b->ends[1 - k]),
                                     options_.radius_edge_bound))
          continue;
        return is_facet_between(v, *a, *b);
      }
  }
  return false;
}

/// Is there a fan of subfacets at the vertex from the one segment to the other, within their angle and across no subsegment? Then
/// a subfacet at the vertex is no wider than they are apart (core/reasons/sharp_corners.hpp has the proof).
template <int D>
bool Reasons<D>::is_facet_between(std::uint32_t v, const Entity& a, const Entity& b) {
  if constexpr (D == 3) {
    if (subfacets_.empty()) {
      for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s) {
        const auto& t = mesh_.subfacets[s].vertices;
        for (std::size_t i = 0; i < 3; ++i) subfacets_.push_back({sorted_edge(t[(i + 1) % 3], t[(i + 2) % 3]), t[i]});
      }
      std::sort(subfacets_.begin(), subfacets_.end());
      for (const auto& s : mesh_.subsegments) subsegments_.push_back(sorted_edge(s.vertices[0], s.vertices[1]));
      std::sort(subsegments_.begin(), subsegments_.end());
    }
    const auto ends_at = [&](const Entity& e) {
      std::vector<std::uint32_t> out;
      for (const auto& [ends, s] : e.edges)
        if (ends[0] == v || ends[1] == v) out.push_back(ends[0] == v ? ends[1] : ends[0]);
      return out;
    };
    const auto towards = [&](std::uint32_t w) { return detail::difference(mesh_.points[w], mesh_.points[v]); };
    const auto cosine = [&](std::uint32_t w, std::uint32_t x) {
      const auto u = towards(w), y = towards(x);
      return detail::dot(u, y) / std::sqrt(detail::dot(u, u) * detail::dot(y, y));
    };
    for (const std::uint32_t from : ends_at(a))
      for (const std::uint32_t to : ends_at(b)) {
        const double widest = cosine(from, to) * (1 - 0x1p-40);
        for (const auto& first : at_edge<D>(subfacets_, sorted_edge(v, from))) {
          std::uint32_t behind = from, at = first.apex;
          while (at != to && cosine(from, at) >= widest && !std::ranges::binary_search(subsegments_, sorted_edge(v, at))) {
            const auto next = at_edge<D>(subfacets_, sorted_edge(v, at));
            if (next.size() != 2) break;
            const std::uint32_t beyond = next[0].apex == behind ? next[1].apex : next[0].apex;
            if (!(cosine(from, beyond) < cosine(from, at))) break;  // each step leads on
            behind = at;
            at = beyond;
          }
          if (at == to) return true;
        }
      }
  }
  return false;
}

/// Is it between two segments or facets that share one of its vertices and no segment at it, and come too near to each other
/// about that (docs/small-angles.md has the proof)? It has to be as thin there as the proof says, with another vertex on one of
/// the two, and have a way round the vertex to the middle of the gap, so that this is meshed.
template <int D>
bool Reasons<D>::is_in_gap(const PoorReason& reason) {
  if constexpr (D == 3) {
    const Pair pair = pair_of(reason);
    if (reason.code != PoorReason::Code::small_angle || !pair.exists()) return false;
    const auto& cell = mesh_.cells[reason.cell];
    for (const std::uint32_t v : cell) {
      if (!pair.a->has(v) || !pair.b->has(v) || share_segment_at(*pair.a, *pair.b, v)) continue;
      if (!is_thin_at(corners_of(mesh_, reason.cell), corner_of(cell, v), angle_bounds())) continue;
      const auto touches = [&](std::uint32_t w) { return w != v && (pair.a->has(w) || pair.b->has(w)); };
      if (std::none_of(cell.begin(), cell.end(), touches)) continue;
      const auto middle = middle_of_gap(mesh_.points[v], sectors_at(*named_, *pair.a, v), sectors_at(*named_, *pair.b, v),
                                        angle_bounds());
      if (middle && reaches(reason.cell, v, pair, *middle)) return true;
    }
  }
  return false;
}

/// Round the vertex, across neither of the two, is there a way from the cell to one that the direction to the middle leads into?
template <int D>
bool Reasons<D>::reaches(std::uint32_t cell, std::uint32_t v, const Pair& pair, const Point3& middle) const {
  if constexpr (D == 3) {
    const auto is_on_one = [&](std::uint32_t face) {
      const auto corners = face_vertices(mesh_, face);
      return std::ranges::any_of(std::array{pair.a, pair.b}, [&](const Entity* e) {
        return e->kind == EntityKind::facet && std::ranges::all_of(corners, [&](std::uint32_t w) { return e->has(w); });
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
  if (!named_) return fail(no_input);
  const Entity* s = pair_of(reason).a;
  if (!s || s->kind != EntityKind::segment) return fail("it names no segment of the input");
  bool at_segment = false, is_below = false;
  if constexpr (D == 3)
    for (int e = 0; e < edge_count(3); ++e) {
      const auto ends = ends_of_edge(mesh_.cells[reason.cell], e);
      if (at_edge<D>(s->edges, sorted_edge(ends[0], ends[1])).empty()) continue;
      at_segment = true;
      const auto wedge = wedge_below(mesh_, links_, reason.cell, e, options_.largest_cosine);
      if (wedge && agrees(reason.angle, {dihedral_range(*wedge)})) return Verdict::holds;
      is_below = is_below || wedge;
    }
  if (is_below)
    return fail("its walls at " + words_of<D>(reason.entities[0]) + " do not meet at " + words(reason.angle) + " degrees");
  return at_segment ? Verdict::admitted : fail("it has no edge on " + words_of<D>(reason.entities[0]));
}

/// Is it a facet of a side whose subfacets are kept as they are?
template <int D>
bool Reasons<D>::is_side(const GivenEntity& name) const {
  if (name.kind != EntityKind::facet || !options_.input || name.facet >= options_.input->facets.size()) return false;
  return std::ranges::find(options_.kept_sides, options_.input->facets[name.facet].marker) != options_.kept_sides.end();
}

template <int D>
bool Reasons<D>::is_subfacet(std::array<std::uint32_t, 3> corners) {
  if (sorted_subfacets_.empty()) {
    for (const auto& f : mesh_.subfacets) std::ranges::sort(sorted_subfacets_.emplace_back(f.vertices));
    std::ranges::sort(sorted_subfacets_);
  }
  std::ranges::sort(corners);
  return std::ranges::binary_search(sorted_subfacets_, corners);
}

/// Calls on_triangle with the corners of each triangle of what was kept, on_segment with the ends of a segment. Of a side it is
/// the subfacets that count, and their edges.
template <int D>
template <class OnTriangle, class OnSegment>
void Reasons<D>::each_kept_piece(const GivenEntity& name, const Entity& e, OnTriangle on_triangle, OnSegment on_segment) {
  const auto p = [&](std::uint32_t i) { return named_->point(i); };
  if (e.kind == EntityKind::segment) return on_segment(std::array{p(e.ends[0]), p(e.ends[1])});
  if constexpr (D == 3) {
    const bool of_side = is_side(name);
    for (const auto& t : e.triangles) {
      if (of_side && !is_subfacet(t)) continue;
      on_triangle(std::array{p(t[0]), p(t[1]), p(t[2])});
      for (std::size_t i = 0; of_side && i < 3; ++i) on_segment(std::array{p(t[i]), p(t[(i + 1) % 3])});
    }
  }
}

/// A segment in one piece, or a facet without points of its own, that meets the cell's circumball, doubled, or has its centre in
/// the smallest ball about the segment, or about a triangle of the facet.
template <int D>
bool Reasons<D>::beside_kept(const PoorReason& reason, std::string& why) {
  const auto fail = [&](std::string text) {
    why = std::move(text);
    return false;
  };
  if (!named_) return fail("whether the boundary was kept cannot be seen without the input");
  const Entity* e = pair_of(reason).a;
  if (!e) return fail("it names no segment and no facet of the input");
  const bool is_segment = e->kind == EntityKind::segment, of_side = is_side(reason.entities[0]);
  if (is_segment ? e->edges.size() != 1 || e->edges[0].ends != sorted_edge(e->ends[0], e->ends[1])
                 : !of_side && !std::ranges::all_of(e->points, [&](std::uint32_t p) { return named_->is_given(p); }))
    return fail(words_of<D>(reason.entities[0]) + " has points of its own");
  const auto ball = circumsphere<D>(corners_of(mesh_, reason.cell));
  const auto is_in = [&](const Ball<D>& own) {
    return std::sqrt(squared_distance(own.center, ball.center)) <=
           std::sqrt(own.squared_radius) * (1 + rounding::of_blame_checked) + ball.center_error;
  };
  bool encroached = false;
  each_kept_piece(
      reason.entities[0], *e, [&](const auto& t) { encroached = encroached || is_in(equatorial_ball(t[0], t[1], t[2])); },
      [&](const auto& ends) { encroached = encroached || is_in(diametral_ball<D>(ends[0], ends[1])); });
  return encroached || near(reason.cell, *e) || fail("its circumcentre is not beside " + words_of<D>(reason.entities[0]));
}

/// Is the cell over the bound of shape, and both places for a point that takes it away are hidden by what was kept, which meets
/// its circumball, doubled, or in the smallest balls about that? Then refinement would have to split it. @pre beside_kept()
template <int D>
bool Reasons<D>::is_behind_kept(const PoorReason& reason) {
  if constexpr (D == 3) {
    const Simplex<3> s = corners_of(mesh_, reason.cell);
    const double bound = options_.radius_edge_bound;
    const Entity* e = pair_of(reason).a;
    if (!(bound < std::numeric_limits<double>::infinity()) || radius_edge_within<3>(s, bound)) return false;
    const detail::PlacesForCell places(s, bound);
    unsigned blocked = 0;
    each_kept_piece(
        reason.entities[0], *e, [&](const auto& t) { blocked |= places.blocked_by_triangle(t); },
        [&](const auto& ends) { blocked |= places.blocked_by_segment(ends); });
    return blocked == places.all && near(reason.cell, *e);
  }
  return false;
}

/// Has the cell an edge on what was kept?
template <int D>
bool Reasons<D>::has_edge_on(const PoorReason& reason) {
  const Entity* e = pair_of(reason).a;
  const auto& cell = mesh_.cells[reason.cell];
  return e && std::count_if(cell.begin(), cell.end(), [&](std::uint32_t v) { return e->has(v); }) >= 2;
}

template <int D>
const EntityMeeting& Reasons<D>::meeting(const Pair& pair) {
  const auto made = meetings_.try_emplace({pair.a, pair.b});
  EntityMeeting& meeting = made.first->second;
  if (!made.second) return meeting;
  meeting = meeting_of<D>(*named_, *pair.a, *pair.b, angle_bounds());
  const auto try_parts = [&](const Entity& a, const Entity& b) {
    const bool facets = a.kind == EntityKind::facet && b.kind == EntityKind::facet;
    if (!facets || !named_->are_in_one_plane(a, b)) meeting.join(meeting_of<D>(*named_, a, b, angle_bounds()));
  };
  using Parts = std::vector<const Entity*>;
  const auto try_all = [&](const Parts& of_a, const Parts& of_b) {
    for (const Entity* a : of_a) try_parts(*a, *pair.b);
    for (const Entity* b : of_b) try_parts(*pair.a, *b);
    for (const Entity* a : of_a)
      for (const Entity* b : of_b) try_parts(*a, *b);
  };
  try_all(pair.a->faces, pair.b->faces);
  // Where both are in one plane each, and no subsegment divides them, there is no doubt about what is one.
  if (pair.a->is_one_plane && pair.b->is_one_plane && are_one(*pair.a, *pair.b)) return meeting;
  const auto parts_of = [](const Entity& e) {
    Parts parts;
    for (const Entity& part : e.alone) parts.push_back(&part);
    return parts;
  };
  try_all(parts_of(*pair.a), parts_of(*pair.b));
  return meeting;
}

template <int D>
bool Reasons<D>::near(std::uint32_t cell, const Entity& entity) const {
  const auto ball = circumsphere<D>(corners_of(mesh_, cell));
  const double reach = 2 * std::sqrt(ball.squared_radius) * (1 + rounding::of_blame_checked) + ball.center_error;
  return named_->is_within(ball.center, reach, entity);
}

/// 2D: does the circumdisk meet the diametral disk of a subsegment of the segment? (docs/small-angles.md has the proof that it
/// does if that was to be split in place of the cell, however far it is.)
template <int D>
bool Reasons<D>::meets_piece(std::uint32_t cell, const Entity& entity) const {
  if (D != 2) return false;
  const auto ball = circumsphere<D>(corners_of(mesh_, cell));
  return std::ranges::any_of(entity.edges, [&](const auto& edge) {
    const Ball<D> piece = diametral_ball<D>(mesh_.points[edge.ends[0]], mesh_.points[edge.ends[1]]);
    const double reach = (std::sqrt(ball.squared_radius) + std::sqrt(piece.squared_radius)) * (1 + rounding::of_blame_checked);
    return std::sqrt(squared_distance(ball.center, piece.center)) <= reach + ball.center_error;
  });
}

template <int D>
std::vector<std::uint8_t> Reasons<D>::vertices_at_refused() {
  if (!options_.reasons || !named_) return {};
  std::vector<std::uint8_t> at(mesh_.points.size(), 0);
  std::unordered_set<const Entity*> marked;
  for (const PoorReason& r : *options_.reasons) {
    std::string why;
    if (r.code != PoorReason::Code::small_angle || !is_true(r, why)) continue;
    const Pair pair = pair_of(r);
    for (const Entity* e : {pair.a, pair.b})
      if (marked.insert(e).second)
        for (const std::uint32_t v : e->points)
          if (v < at.size()) at[v] = 1;
  }
  return at;
}

template class Reasons<2>;
template class Reasons<3>;

}  // namespace pgdr::checking
