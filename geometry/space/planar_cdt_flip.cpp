// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Links, flips and the validity check of the planar triangulation. An edge is flipped when the circle of one side holds
// the apex of the other, which lowers the lifted surface strictly, so that any sequence of flips ends; and only if both
// new triangles are positive, which for points of one plane follows, and for points a few ulps off has to be asked.
#include <algorithm>

#include "pgdr/predicates.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

int PlanarTriangulation::index_in(std::uint32_t t, std::uint32_t v) const {
  const auto& w = cells_[t].v;
  return w[0] == v ? 0 : w[1] == v ? 1 : w[2] == v ? 2 : -1;
}

// The index of edge i of t in the cell behind it. By vertices: two cells may share two edges at the ghost vertex.
int PlanarTriangulation::mirror(std::uint32_t t, int i) const {
  const Cell& c = cells_[t];
  const std::uint32_t a = c.v[static_cast<std::size_t>((i + 1) % 3)];
  return (index_in(c.n[static_cast<std::size_t>(i)], a) + 1) % 3;
}

Sign PlanarTriangulation::orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return orient_projected(points_[a], points_[b], points_[c], axis_);
}

bool PlanarTriangulation::in_circle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool flat) const {
  if (!flat) return in_circle_perturbed(points_[a], points_[b], points_[c], points_[d], axis_) == Sign::positive;
  Point3 p[4] = {points_[a], points_[b], points_[c], points_[d]};
  for (Point3& q : p) q[axis_] = 0;
  return in_circle_perturbed(p[0], p[1], p[2], p[3], axis_) == Sign::positive;
}

void PlanarTriangulation::link(Side a, Side b) {
  cells_[a.t].n[static_cast<std::size_t>(a.i)] = b.t;
  cells_[b.t].n[static_cast<std::size_t>(b.i)] = a.t;
}

void PlanarTriangulation::set_cell(std::uint32_t t, const std::array<std::uint32_t, 3>& v, std::uint8_t fixed, bool inside) {
  cells_[t].v = v;
  cells_[t].fixed = fixed;
  cells_[t].inside = inside;
  for (const std::uint32_t w : v)
    if (w != ghost) cell_of_[w] = t;
}

void PlanarTriangulation::touch(std::uint32_t t) {
  if (change_ == nullptr) return;
  if (touch_stamp_.size() < cells_.size()) touch_stamp_.resize(cells_.size(), 0);
  if (touch_stamp_[t] == stamp_) return;
  touch_stamp_[t] = stamp_;
  touched_.emplace_back(t, cells_[t]);
}

void PlanarTriangulation::begin_change(PlanarChange* change) {
  change_ = change;
  touched_.clear();
  if (change == nullptr) return;
  change->destroyed.clear();
  change->created.clear();
  ++stamp_;
}

void PlanarTriangulation::end_change() {
  if (change_ == nullptr) return;
  for (const auto& [t, old] : touched_) {
    const Cell& now = cells_[t];
    const auto names = [this](const Cell& c) { return PlanarTriangle{ids_[c.v[0]], ids_[c.v[1]], ids_[c.v[2]]}; };
    if (old.inside) change_->destroyed.push_back(names(old));
    if (now.inside) change_->created.push_back(names(now));
  }
  change_ = nullptr;
}

bool PlanarTriangulation::flip_is_due(std::uint32_t t, int i, bool flat) const {
  const Cell& c = cells_[t];
  const auto at = [](const Cell& cell, int k) { return cell.v[static_cast<std::size_t>(k % 3)]; };
  if (is_fixed(c, i) || is_out(c) || is_out(cells_[c.n[static_cast<std::size_t>(i)]])) return false;
  const std::uint32_t p = at(c, i), a = at(c, i + 1), b = at(c, i + 2);
  const std::uint32_t q = at(cells_[c.n[static_cast<std::size_t>(i)]], mirror(t, i));
  if (p == ghost || q == ghost) return false;
  if (a == ghost) return orient(p, q, b) == Sign::positive;  // two hull edges that make a pocket
  if (b == ghost) return orient(p, a, q) == Sign::positive;
  return in_circle(p, a, b, q, flat) && orient(p, a, q) == Sign::positive && orient(p, q, b) == Sign::positive;
}

// (p, a, b) and (q, b, a) become (p, a, q) and (p, q, b).
void PlanarTriangulation::flip(std::uint32_t t, int i) {
  const std::uint32_t u = cells_[t].n[static_cast<std::size_t>(i)];
  const int j = mirror(t, i);
  touch(t);
  touch(u);
  const Cell c = cells_[t], d = cells_[u];
  const auto k = [](int x) { return static_cast<std::size_t>(x % 3); };
  const std::uint32_t p = c.v[k(i)], a = c.v[k(i + 1)], b = c.v[k(i + 2)], q = d.v[k(j)];
  // Edges: b-p is i+1 of c, p-a is i+2 of c, a-q is j+1 of d, q-b is j+2 of d.
  const Side bp{c.n[k(i + 1)], mirror(t, (i + 1) % 3)}, pa{c.n[k(i + 2)], mirror(t, (i + 2) % 3)};
  const Side aq{d.n[k(j + 1)], mirror(u, (j + 1) % 3)}, qb{d.n[k(j + 2)], mirror(u, (j + 2) % 3)};
  const auto bit = [](const Cell& cell, std::size_t from, int to) { return is_fixed(cell, from) ? 1 << to : 0; };
  // A pocket of the hull: the triangle without the ghost is new, and in the domain if nothing bounds it there.
  const bool hull = a == ghost || b == ghost;
  const auto open = [&](const Cell& cell, std::size_t e) { return !is_fixed(cell, e) && cells_[cell.n[e]].inside; };
  const bool t_inside = hull ? a != ghost && (open(d, k(j + 1)) || open(c, k(i + 2))) : c.inside;
  const bool u_inside = hull ? b != ghost && (open(d, k(j + 2)) || open(c, k(i + 1))) : c.inside;
  set_cell(t, {p, a, q}, static_cast<std::uint8_t>(bit(d, k(j + 1), 0) | bit(c, k(i + 2), 2)), t_inside);
  set_cell(u, {p, q, b}, static_cast<std::uint8_t>(bit(d, k(j + 2), 0) | bit(c, k(i + 1), 1)), u_inside);
  link({t, 1}, {u, 2});
  link({t, 0}, aq);
  link({t, 2}, pa);
  link({u, 0}, qb);
  link({u, 1}, bp);
}

// Flips until no flip is due. around_vertex: the edges given are opposite a new vertex, and only such can become due.
void PlanarTriangulation::legalize(std::vector<Side>& stack, bool flat, bool around_vertex) {
  while (!stack.empty()) {
    const Side s = stack.back();
    stack.pop_back();
    if (!flip_is_due(s.t, s.i, flat)) continue;
    const std::uint32_t u = cells_[s.t].n[static_cast<std::size_t>(s.i)];
    flip(s.t, s.i);  // the apex of s is vertex 0 of both
    stack.push_back({s.t, 0});
    stack.push_back({u, 0});
    if (around_vertex) continue;
    stack.push_back({s.t, 2});
    stack.push_back({u, 1});
  }
}

// The cell to the left of a -> b, and the index of the edge in it.
PlanarTriangulation::Side PlanarTriangulation::find_edge(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t first = cell_of_[a];
  std::uint32_t t = first;
  do {
    const auto i = static_cast<std::size_t>(index_in(t, a));
    if (cells_[t].v[(i + 1) % 3] == b) return {t, static_cast<int>((i + 2) % 3)};
    t = cells_[t].n[(i + 1) % 3];
  } while (t != first);
  return {};
}

bool PlanarTriangulation::has_edge(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t u = local(a), w = local(b);
  return u != none && w != none && u != w && find_edge(u, w).t != none;
}

bool PlanarTriangulation::is_constraint(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t u = local(a), w = local(b);
  if (u == none || w == none || u == w) return false;
  const Side s = find_edge(u, w);
  return s.t != none && is_fixed(cells_[s.t], s.i);
}

bool PlanarTriangulation::is_valid(bool delaunay) const {
  for (std::uint32_t v = 0; v < points_.size(); ++v)
    if (cell_of_[v] >= cells_.size() || index_in(cell_of_[v], v) < 0) return false;
  for (std::uint32_t t = 0; t < cells_.size(); ++t) {
    const Cell& c = cells_[t];
    if (is_ghost(c) ? c.inside : !is_out(c) && orient(c.v[0], c.v[1], c.v[2]) != Sign::positive) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (c.n[i] >= cells_.size()) return false;
      const int j = mirror(t, static_cast<int>(i));
      const Cell& d = cells_[c.n[i]];
      if (d.n[static_cast<std::size_t>(j)] != t || d.v[static_cast<std::size_t>((j + 2) % 3)] != c.v[(i + 1) % 3]) return false;
      const bool fixed = is_fixed(c, i);
      if (fixed != is_fixed(d, j)) return false;
      if (!fixed && c.inside != d.inside && !is_ghost(c) && !is_ghost(d)) return false;
      if (delaunay && flip_is_due(t, static_cast<int>(i), false)) return false;
    }
  }
  return true;
}

}  // namespace pgdr::detail
