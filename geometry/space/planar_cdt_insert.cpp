// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Insertion of a vertex into the planar triangulation: the cells around it (one, or two at an edge) are replaced by the
// star of their rim, then flips. A point given for an edge may be off it by its rounding; the cavity then grows over
// unconstrained edges until the point sees the whole rim, or gives up with nothing changed.
#include <algorithm>

#include "space/planar_cdt.hpp"

namespace pgdr::detail {
namespace {
// A rounded point is beyond one or two very flat cells at most; more means that something else is wrong.
constexpr std::size_t max_cavity = 64;
}  // namespace

// The rim of the one cell, or of the two cells at an edge; in the second case it starts at the end of that edge, goes
// round the first cell, then the second.
std::vector<PlanarTriangulation::RimEdge> PlanarTriangulation::rim_of(Location where) const {
  std::vector<RimEdge> rim;
  const auto push = [&](std::uint32_t t, int i) {
    const Cell& c = cells_[t];
    const auto k = [](int x) { return static_cast<std::size_t>(x % 3); };
    rim.push_back({c.v[k(i + 1)], c.v[k(i + 2)], {c.n[k(i)], mirror(t, i)}, is_fixed(c, i), c.inside, is_ghost(c)});
  };
  const int first = where.edge < 0 ? 0 : where.edge + 1;
  for (int i = first; i < first + (where.edge < 0 ? 3 : 2); ++i) push(where.t, i % 3);
  if (where.edge >= 0) {
    const std::uint32_t u = cells_[where.t].n[static_cast<std::size_t>(where.edge)];
    const int j = mirror(where.t, where.edge);
    push(u, (j + 1) % 3);
    push(u, (j + 2) % 3);
  }
  return rim;
}

bool PlanarTriangulation::make_star_shaped(std::uint32_t p, std::vector<RimEdge>& rim, std::vector<std::uint32_t>& cells) const {
  for (std::size_t e = 0; e < rim.size();) {
    const RimEdge edge = rim[e];
    if (!edge.inside || orient(p, edge.a, edge.b) == Sign::positive) {
      ++e;
      continue;
    }
    const Cell& c = cells_[edge.outer.t];
    const auto k = [&](int x) { return static_cast<std::size_t>((edge.outer.i + x) % 3); };
    const std::uint32_t apex = c.v[k(0)];
    const bool known = std::any_of(rim.begin(), rim.end(), [&](const RimEdge& r) { return r.a == apex; });
    if (edge.fixed || known || cells.size() >= max_cavity) return false;
    cells.push_back(edge.outer.t);
    // Behind a -> b the outer cell has b -> a; its other edges are a -> apex and apex -> b.
    const auto side = [&](int x) { return Side{c.n[k(x)], mirror(edge.outer.t, static_cast<int>(k(x)))}; };
    rim[e] = {edge.a, apex, side(1), is_fixed(c, k(1)), edge.inside, false};
    rim.insert(rim.begin() + static_cast<std::ptrdiff_t>(e) + 1, {apex, edge.b, side(2), is_fixed(c, k(2)), edge.inside, false});
  }
  return true;
}

// Replaces the cells by the triangles from p to the rim; the edges from p to the two vertices `fixed_spokes` become
// constraints. The rim has two edges more than there are cells.
void PlanarTriangulation::fill_star(std::uint32_t p, const std::vector<RimEdge>& rim, const std::vector<std::uint32_t>& cells,
                                    PlanarEdge fixed_spokes, bool flat) {
  std::vector<std::uint32_t> slots = cells;
  for (const std::uint32_t t : cells) touch(t);
  while (slots.size() < rim.size()) {
    slots.push_back(static_cast<std::uint32_t>(cells_.size()));
    cells_.emplace_back();
    touch(slots.back());
  }
  const auto spoke = [&](std::uint32_t v) { return v == fixed_spokes[0] || v == fixed_spokes[1]; };
  std::vector<Side> stack;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const RimEdge& e = rim[k];
    const int fixed = (e.fixed ? 1 : 0) | (spoke(e.b) ? 2 : 0) | (spoke(e.a) ? 4 : 0);
    // A real cell in place of a ghost: the hull has grown, the domain only if nothing bounds it there.
    const bool real = e.a != ghost && e.b != ghost;
    const bool inside = e.inside || (e.grown && !e.fixed && cells_[e.outer.t].inside);
    set_cell(slots[k], {p, e.a, e.b}, static_cast<std::uint8_t>(fixed), real && inside);
    link({slots[k], 0}, e.outer);
    stack.push_back({slots[k], 0});
  }
  for (std::size_t k = 0; k < rim.size(); ++k) link({slots[k], 1}, {slots[(k + 1) % rim.size()], 2});
  hint_ = slots[0];
  legalize(stack, flat, true);
}

void PlanarTriangulation::forget_last_vertex() {
  const auto v = static_cast<std::uint32_t>(points_.size() - 1);
  local_of_.erase(std::lower_bound(local_of_.begin(), local_of_.end(), std::pair{ids_[v], v}));
  points_.pop_back();
  ids_.pop_back();
  cell_of_.pop_back();
}

PlanarResult PlanarTriangulation::insert(std::uint32_t id, const Point3& p, PlanarChange* change) {
  if (cells_.empty()) return {PlanarStatus::outside};
  const Location where = locate(p);
  const Cell& c = cells_[where.t];
  const auto at = [&](int i) { return c.v[static_cast<std::size_t>(i % 3)]; };
  if (where.vertex >= 0) return {PlanarStatus::coincident, {id, ids_[at(where.vertex)]}, {}};
  std::vector<std::uint32_t> cells{where.t};
  bool inside = c.inside;
  if (where.edge >= 0) {
    cells.push_back(c.n[static_cast<std::size_t>(where.edge)]);
    inside = inside || cells_[cells[1]].inside;
    if (inside && is_fixed(c, where.edge)) return problem(PlanarStatus::on_constraint, at(where.edge + 1), at(where.edge + 2));
  }
  if (!inside) return {PlanarStatus::outside};
  begin_change(change);
  fill_star(add_vertex(id, p), rim_of(where), cells, {none, none}, false);
  end_change();
  return {};
}

PlanarResult PlanarTriangulation::split_edge(std::uint32_t a, std::uint32_t b, std::uint32_t id, const Point3& p,
                                             PlanarChange* change) {
  const std::uint32_t u = local(a), w = local(b);
  const Side s = u == none || w == none || u == w ? Side{} : find_edge(u, w);
  if (s.t == none) return {PlanarStatus::no_such_edge, {a, b}, {}};
  const bool fixed = is_fixed(cells_[s.t], s.i);
  std::vector<RimEdge> rim = rim_of({s.t, s.i, -1});
  std::vector<std::uint32_t> cells{s.t, cells_[s.t].n[static_cast<std::size_t>(s.i)]};
  const std::uint32_t v = add_vertex(id, p);
  if (!make_star_shaped(v, rim, cells)) {
    forget_last_vertex();
    return {PlanarStatus::inverted, {a, b}, {}};
  }
  const bool bounds = !cells_[cells[0]].inside || !cells_[cells[1]].inside;
  outside_is_crooked_ = outside_is_crooked_ || (bounds && orient(u, w, v) != Sign::zero);
  begin_change(change);
  fill_star(v, rim, cells, fixed ? PlanarEdge{u, w} : PlanarEdge{none, none}, false);
  end_change();
  return {};
}

}  // namespace pgdr::detail
