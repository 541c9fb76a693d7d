// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Constraint edges of the planar triangulation.
#include "space/edge_forcing.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

/// Circles are those of the projection. What a forced edge crosses is inside the domain or outside as the first cell is.
struct PlanarTriangulation::Forcible {
  using Vertex = std::uint32_t;
  using Cell = std::uint32_t;
  using Side = CellSide<Cell>;
  static constexpr bool from_b = false;

  PlanarTriangulation& all;
  bool inside = false;

  Vertex corner(Cell t, int i) const { return all.cells_[t].v[static_cast<std::size_t>(i)]; }
  Side across(Side s) const { return {all.cells_[s.cell].n[static_cast<std::size_t>(s.edge)], all.mirror(s.cell, s.edge)}; }
  bool is_constraint(Side s) const { return is_fixed(all.cells_[s.cell], s.edge); }
  bool is_ghost(Vertex v) const { return v == ghost; }
  Cell cell_at(Vertex v) const { return all.cell_of_[v]; }
  Sign orient(Vertex a, Vertex b, Vertex c) const { return all.orient(a, b, c); }
  bool is_ahead(Vertex a, Vertex b, Vertex c) const {
    const Point3 &p = all.points_[a], &q = all.points_[b], &x = all.points_[c];
    const int u = (all.axis_ + 1) % 3, w = (all.axis_ + 2) % 3, k = p[u] != q[u] ? u : w;
    return p[k] < q[k] ? p[k] < x[k] : x[k] < p[k];
  }
  bool in_circle(Vertex a, Vertex b, Vertex c, Vertex d) const { return all.in_circle(a, b, c, d, true); }
  void set(Cell t, const std::array<Vertex, 3>& v) {
    all.touch(t);
    all.set_cell(t, v, 0, inside);
  }
  void link(Side a, Side b) { all.link({a.cell, a.edge}, {b.cell, b.edge}); }
  void constrain(Side s) { all.cells_[s.cell].fixed |= static_cast<std::uint8_t>(1 << s.edge); }
};

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
  using Forcing = EdgeForcing<Forcible>;
  Forcible triangles{*this};
  if (const Side s = find_edge(a, b); s.t != none) {
    const Forcible::Side side{s.t, s.i}, other = triangles.across(side);
    if (inside_only && !cells_[side.cell].inside && !cells_[other.cell].inside) return problem(PlanarStatus::outside, a, b);
    triangles.constrain(side);
    triangles.constrain(other);
    return {};
  }
  Forcing forcing;
  const Forcing::Plan plan = forcing.plan(triangles, a, b);
  switch (plan.status) {
    case Forcing::Status::crosses_constraint: return problem(PlanarStatus::edges_cross, a, b, plan.met[0], plan.met[1]);
    case Forcing::Status::meets_vertex: return problem(PlanarStatus::point_on_edge, a, b, plan.met[0]);
    case Forcing::Status::planned: break;
    default: return problem(PlanarStatus::inverted, a, b);
  }
  triangles.inside = cells_[forcing.crossed().front()].inside;
  if (inside_only && !triangles.inside) return problem(PlanarStatus::outside, a, b);
  forcing.write(triangles);
  return {};
}

}  // namespace pgdr::detail
