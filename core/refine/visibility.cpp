// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/visibility.hpp"

#include <algorithm>

#include "refine/numbers.hpp"

namespace pgdr {
namespace {

/// The constrained face that cuts x off from cell c, on a visibility walk through cells that `may_enter` allows; none if x
/// is reached or the walk leaves these before.
template <int D, class MayEnter>
std::optional<Entry<D>> wall_before(Workspace<D>& w, CellId c, const Point<D>& x, MayEnter may_enter) {
  const Mesh<D>& mesh = w.mesh;
  const std::size_t most_steps = numbers::claim_walk_steps + w.cavity.cells().size();
  int from = -1;
  for (std::size_t steps = 0; steps < most_steps && may_enter(c); ++steps) {
    const auto& k = mesh.cell(c);
    w.trace.push_back(c);
    int exit = -1, wall = -1;
    for (int i = 0; i <= D && exit < 0; ++i) {
      if (i == from) continue;
      Simplex<D> s = mesh.simplex(c);
      s[i] = x;
      if (orient<D>(s) == Sign::positive) continue;
      (mesh.constrained(c, i) ? wall : exit) = i;
    }
    if (exit < 0) return wall < 0 ? std::nullopt : std::optional(w.entry(c, EntryKind::face, wall));
    from = k.links[exit].face();
    c = k.links[exit].cell();
  }
  return std::nullopt;
}

template <int D>
double longest_edge_squared(const Simplex<D>& s) {
  double longest = 0;
  for (int i = 0; i <= D; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, squared_distance(s[i], s[j]));
  return longest;
}

}  // namespace

template <int D>
std::optional<Entry<D>> wall_in_claim(Workspace<D>& w, CellId c, const Point<D>& x) {
  return wall_before<D>(w, c, x, [&w](CellId k) { return w.cavity.owns(k); });
}

template <int D>
std::optional<Entry<D>> wall_that_hides(Workspace<D>& w, CellId c, const Point<D>& x) {
  if (!w.cavity.touches_constraints() || w.cavity.surely_star_shaped()) return std::nullopt;
  return wall_before<D>(w, c, x, [&w](CellId k) { return w.mesh.marked(k); });
}

template <int D>
std::optional<Entry<D>> wall_before_distant_point(Workspace<D>& w, CellId c, const Point<D>& x) {
  if constexpr (D == 2) return std::nullopt;
  const double squared = squared_distance(w.mesh.point(w.mesh.cell(c).vertices[0]), x);
  if (!(squared > numbers::distant_edges * numbers::distant_edges * longest_edge_squared<D>(w.mesh.simplex(c))))
    return std::nullopt;
  w.cavity.release();
  return wall_in_claim(w, c, x);
}

template std::optional<Entry<2>> wall_in_claim(Workspace<2>&, CellId, const Point<2>&);
template std::optional<Entry<3>> wall_in_claim(Workspace<3>&, CellId, const Point<3>&);
template std::optional<Entry<2>> wall_that_hides(Workspace<2>&, CellId, const Point<2>&);
template std::optional<Entry<3>> wall_that_hides(Workspace<3>&, CellId, const Point<3>&);
template std::optional<Entry<2>> wall_before_distant_point(Workspace<2>&, CellId, const Point<2>&);
template std::optional<Entry<3>> wall_before_distant_point(Workspace<3>&, CellId, const Point<3>&);

}  // namespace pgdr
