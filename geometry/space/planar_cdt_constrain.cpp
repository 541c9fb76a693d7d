// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Forcing a constraint edge. The cells that it crosses leave a polygon on each side of it (possibly with dangling
// edges, so that a vertex may occur twice in its chain). Each is filled from the constraint outwards: the third corner
// of an edge is the chain vertex whose circle through the edge holds no other one. Every chain vertex is joined to the
// constraint by a crossed edge inside the polygon; hence no chain edge can cut such a triangle, and the rest of the
// chain is again in that situation with respect to the two new edges. Nothing is written before the fill is known.
#include <algorithm>
#include <map>

#include "space/planar_cdt.hpp"

namespace pgdr::detail {

PlanarResult PlanarTriangulation::problem(PlanarStatus status, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                          std::uint32_t d) const {
  PlanarResult r{status, {ids_[a], ids_[b]}, {}};
  if (c != none) r.other = {ids_[c], ids_[d == none ? c : d]};
  return r;
}

PlanarResult PlanarTriangulation::constrain(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t u = local(a), w = local(b);
  if (u == none || w == none || u == w) return {PlanarStatus::no_such_edge, {a, b}, {}};
  const PlanarResult result = constrain_local(u, w, true);
  if (!result) return result;
  std::vector<Side> stack;
  for (std::uint32_t t = 0; t < cells_.size(); ++t)
    for (int i = 0; i < 3; ++i) stack.push_back({t, i});
  legalize(stack, false, false);
  return result;
}

PlanarResult PlanarTriangulation::constrain_local(std::uint32_t a, std::uint32_t b, bool inside_only) {
  Side s = find_edge(a, b);
  if (s.t != none) {
    const Side m{cells_[s.t].n[static_cast<std::size_t>(s.i)], mirror(s.t, s.i)};
    if (inside_only && !cells_[s.t].inside && !cells_[m.t].inside) return problem(PlanarStatus::outside, a, b);
    cells_[s.t].fixed |= static_cast<std::uint8_t>(1 << s.i);
    cells_[m.t].fixed |= static_cast<std::uint8_t>(1 << m.i);
    return {};
  }
  PlanarResult result = first_crossing(a, b, s);
  Crossing crossing;
  if (result) result = march(a, b, s, crossing);
  if (!result) return result;
  if (inside_only && !cells_[s.t].inside) return problem(PlanarStatus::outside, a, b);
  std::vector<Apex> left, right;
  if (!plan_polygon(crossing.left, left) || !plan_polygon(crossing.right, right))
    return problem(PlanarStatus::inverted, a, b);
  fill_crossing(crossing, left, right);
  return {};
}

// The cell at a whose inner angle holds the direction to b; `at` is its edge opposite a.
PlanarResult PlanarTriangulation::first_crossing(std::uint32_t a, std::uint32_t b, Side& at) const {
  const int k = points_[a][(axis_ + 1) % 3] != points_[b][(axis_ + 1) % 3] ? (axis_ + 1) % 3 : (axis_ + 2) % 3;
  const bool up = points_[a][k] < points_[b][k];
  std::uint32_t t = cell_of_[a];
  const std::uint32_t first = t;
  do {
    const auto i = static_cast<std::size_t>(index_in(t, a));
    const std::uint32_t r = cells_[t].v[(i + 1) % 3], l = cells_[t].v[(i + 2) % 3];
    const Sign side_r = r == ghost ? Sign::zero : orient(a, b, r);
    if (r != ghost && side_r == Sign::zero && (up ? points_[a][k] < points_[r][k] : points_[r][k] < points_[a][k]))
      return problem(PlanarStatus::point_on_edge, a, b, r);
    if (r != ghost && l != ghost && side_r == Sign::negative && orient(a, b, l) == Sign::positive) {
      at = {t, static_cast<int>(i)};
      return {};
    }
    t = cells_[t].n[(i + 1) % 3];
  } while (t != first);
  return problem(PlanarStatus::inverted, a, b);
}

PlanarResult PlanarTriangulation::march(std::uint32_t a, std::uint32_t b, Side at, Crossing& crossing) const {
  const auto k = [](int x) { return static_cast<std::size_t>(x % 3); };
  std::uint32_t r = cells_[at.t].v[k(at.i + 1)], l = cells_[at.t].v[k(at.i + 2)];
  crossing.cells = {at.t};
  crossing.left = {a, l};
  crossing.right = {a, r};
  crossing.left_edges = {{at.t, (at.i + 1) % 3}};
  crossing.right_edges = {{at.t, (at.i + 2) % 3}};
  while (true) {
    if (is_fixed(cells_[at.t], at.i)) return problem(PlanarStatus::edges_cross, a, b, r, l);
    const Side next{cells_[at.t].n[k(at.i)], mirror(at.t, at.i)};
    const std::uint32_t w = cells_[next.t].v[k(next.i)];  // the cell is (w, l, r)
    crossing.cells.push_back(next.t);
    const Side l_w{next.t, (next.i + 2) % 3}, w_r{next.t, (next.i + 1) % 3};
    if (w == ghost) return problem(PlanarStatus::inverted, a, b);
    const Sign side = w == b ? Sign::zero : orient(a, b, w);
    if (w != b && side == Sign::zero) return problem(PlanarStatus::point_on_edge, a, b, w);
    if (w == b || side == Sign::positive) {
      crossing.left.push_back(w);
      crossing.left_edges.push_back(l_w);
    }
    if (w == b || side == Sign::negative) {
      crossing.right.push_back(w);
      crossing.right_edges.push_back(w_r);
    }
    if (w == b) break;
    at = side == Sign::positive ? w_r : l_w;
    (side == Sign::positive ? l : r) = w;
  }
  // The right polygon seen from its own side: from b to a.
  std::reverse(crossing.right.begin(), crossing.right.end());
  std::reverse(crossing.right_edges.begin(), crossing.right_edges.end());
  return {};
}

// Triangles of the polygon to the left of chain[0] -> chain.back().
bool PlanarTriangulation::plan_polygon(const std::vector<std::uint32_t>& chain, std::vector<Apex>& apexes) const {
  std::vector<Apex> todo{{0, static_cast<std::uint32_t>(chain.size() - 1), none, none}};
  while (!todo.empty()) {
    Apex base = todo.back();
    todo.pop_back();
    const std::uint32_t p = chain[base.i], q = chain[base.j];
    for (std::uint32_t k = base.i + 1; k < base.j; ++k) {
      const std::uint32_t v = chain[k];
      if (v == p || v == q || orient(p, q, v) != Sign::positive) continue;
      if (base.k == none || (v != chain[base.k] && in_circle(p, q, chain[base.k], v, true))) base.k = k;
    }
    if (base.k == none) return false;
    const auto number = static_cast<std::uint32_t>(apexes.size());
    apexes.push_back(base);
    if (base.k + 1 < base.j) todo.push_back({base.k, base.j, none, 2 * number});
    if (base.i + 1 < base.k) todo.push_back({base.i, base.k, none, 2 * number + 1});
  }
  return true;
}

void PlanarTriangulation::fill_crossing(const Crossing& crossing, const std::vector<Apex>& left,
                                        const std::vector<Apex>& right) {
  const bool inside = cells_[crossing.cells.front()].inside;
  struct Behind {  // what is behind a chain edge: another cell, or (dangling edge) another chain edge
    Side outer;
    bool fixed;
  };
  std::map<std::pair<std::uint32_t, int>, Side> own;  // crossed side of a chain edge -> its new cell
  std::map<std::pair<std::uint32_t, int>, Behind> behind;
  for (const auto* edges : {&crossing.left_edges, &crossing.right_edges})
    for (const Side& e : *edges)
      behind[{e.t, e.i}] = {{cells_[e.t].n[static_cast<std::size_t>(e.i)], mirror(e.t, e.i)},
                            is_fixed(cells_[e.t], e.i)};
  std::size_t next = 0;
  Side base[2];
  for (const int side : {0, 1}) {
    const auto& apexes = side == 0 ? left : right;
    const auto& chain = side == 0 ? crossing.left : crossing.right;
    const auto& edges = side == 0 ? crossing.left_edges : crossing.right_edges;
    const std::size_t begin = next;
    for (const Apex& apex : apexes) {
      const std::uint32_t t = crossing.cells[next++];
      touch(t);
      set_cell(t, {chain[apex.i], chain[apex.j], chain[apex.k]}, 0, inside);
      if (apex.up == none) base[side] = {t, 2};
      if (apex.up != none) link({t, 2}, {crossing.cells[begin + apex.up / 2], static_cast<int>(apex.up % 2)});
      if (apex.k + 1 == apex.j) own[{edges[apex.k].t, edges[apex.k].i}] = {t, 0};
      if (apex.i + 1 == apex.k) own[{edges[apex.i].t, edges[apex.i].i}] = {t, 1};
    }
  }
  link(base[0], base[1]);
  for (const Side& s : base) cells_[s.t].fixed |= 4;
  for (const auto& [key, cell] : own) {
    const Behind& b = behind[key];
    const auto twin = own.find({b.outer.t, b.outer.i});
    link(cell, twin == own.end() ? b.outer : twin->second);
    if (b.fixed) cells_[cell.t].fixed |= static_cast<std::uint8_t>(1 << cell.i);
  }
}

}  // namespace pgdr::detail
