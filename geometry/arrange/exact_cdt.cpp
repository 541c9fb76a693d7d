// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/exact_cdt.hpp"

#include <algorithm>

#include "numbers/determinants.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t after(int i, int steps) { return static_cast<std::size_t>((i + steps) % 3); }

/// A rational as a double: that is off by two ulps at most.
Bounded near(const Rational::Number& x) {
  const double d = x.convert_to<double>();
  return {d, 4 * unit_roundoff * std::fabs(d) + 0x1p-1000};
}

}  // namespace

struct ExactCdt::Forcible {
  using Vertex = std::uint32_t;
  using Cell = std::uint32_t;
  using Side = CellSide<Cell>;
  static constexpr bool from_b = false;

  ExactCdt& all;

  Vertex corner(Cell c, int i) const { return all.cells_[c].v[static_cast<std::size_t>(i)]; }
  Side across(Side s) const { return all.cells_[s.cell].across[static_cast<std::size_t>(s.edge)]; }
  bool is_constraint(Side s) const { return all.cells_[s.cell].fixed[static_cast<std::size_t>(s.edge)]; }
  bool is_ghost(Vertex v) const { return v == ghost; }
  Cell cell_at(Vertex v) const { return all.vertices_[v].cell; }
  Sign orient(Vertex a, Vertex b, Vertex c) const { return all.orient(a, b, c); }
  bool is_ahead(Vertex a, Vertex b, Vertex c) const { return all.is_ahead(a, b, c); }
  bool in_circle(Vertex a, Vertex b, Vertex c, Vertex d) const { return all.in_circle(a, b, c, d); }
  void set(Cell c, const std::array<Vertex, 3>& v) { all.set(c, v); }
  void link(Side a, Side b) { all.link(a, b); }
  void constrain(Side s) { all.cells_[s.cell].fixed[static_cast<std::size_t>(s.edge)] = true; }
};

ExactCdt::ExactCdt(const std::array<const ExactPoint*, 3>& corners, int axis)
    : axes_{static_cast<std::size_t>((axis + 1) % 3), static_cast<std::size_t>((axis + 2) % 3)}, cells_(4) {
  for (const ExactPoint* p : corners) add_vertex(*p);
  set(0, {0, 1, 2});
  for (std::uint32_t i = 0; i < 3; ++i) {
    set(1 + i, {ghost, (i + 2) % 3, (i + 1) % 3});
    cells_[0].fixed[i] = cells_[1 + i].fixed[0] = true;
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    link({0, static_cast<int>(i)}, {1 + i, 0});
    link({1 + i, 1}, {1 + (i + 2) % 3, 2});  // around corner i + 1: the ghosts of edges i and i + 2
    vertices_[i].cell = 0;
  }
}

std::uint32_t ExactCdt::add_vertex(const ExactPoint& p) {
  const ExactPoint& origin = vertices_.empty() ? p : *vertices_[0].at;
  Vertex v{&p, {}, 0};
  for (std::size_t i = 0; i < 2; ++i) v.near[i] = near(p.x[axes_[i]] - origin.x[axes_[i]]);
  vertices_.push_back(v);
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void ExactCdt::set(std::uint32_t c, const std::array<std::uint32_t, 3>& v) {
  cells_[c].v = v;
  cells_[c].fixed = {};
  for (const std::uint32_t w : v)
    if (w != ghost) vertices_[w].cell = c;
}

void ExactCdt::link(Side a, Side b) {
  cells_[a.cell].across[static_cast<std::size_t>(a.edge)] = b;
  cells_[b.cell].across[static_cast<std::size_t>(b.edge)] = a;
}

template <std::size_t N>
std::array<std::array<Rational, 2>, N> ExactCdt::rational_differences(const std::array<std::uint32_t, N>& to,
                                                                      std::uint32_t from) const {
  std::array<std::array<Rational, 2>, N> d;
  for (std::size_t k = 0; k < N; ++k)
    for (std::size_t i = 0; i < 2; ++i) d[k][i].q = vertices_[to[k]].at->x[axes_[i]] - vertices_[from].at->x[axes_[i]];
  return d;
}

template <std::size_t N>
std::array<std::array<Bounded, 2>, N> ExactCdt::near_differences(const std::array<std::uint32_t, N>& to,
                                                                 std::uint32_t from) const {
  std::array<std::array<Bounded, 2>, N> d;
  for (std::size_t k = 0; k < N; ++k)
    for (std::size_t i = 0; i < 2; ++i) d[k][i] = sub(vertices_[to[k]].near[i], vertices_[from].near[i]);
  return d;
}

Sign ExactCdt::orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  if (a == b || b == c || c == a) return Sign::zero;
  const std::array<std::uint32_t, 2> to{b, c};
  if (const auto s = sign(orient_det<Bounded>(near_differences(to, a)))) return *s;
  return sign(orient_det<Rational>(rational_differences(to, a)));
}

/// Is d inside the circle through a, b, c? On it: no.
bool ExactCdt::in_circle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
  const std::array<std::uint32_t, 3> to{a, b, c};
  if (const auto s = sign(in_sphere_det<Bounded>(near_differences(to, d)))) return *s == Sign::positive;
  return sign(in_sphere_det<Rational>(rational_differences(to, d))) == Sign::positive;
}

/// Of c on the line ab: is it on the side of a where b is?
bool ExactCdt::is_ahead(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const std::array<std::uint32_t, 2> to{b, c};
  if (const auto s = sign(dot(near_differences(to, a)[0], near_differences(to, a)[1]))) return *s == Sign::positive;
  const auto d = rational_differences(to, a);
  return sign(dot(d[0], d[1])) == Sign::positive;
}

/// Walks towards the point, then looks everywhere.
ExactCdt::Location ExactCdt::locate(std::uint32_t v) const {
  const auto place_in = [&](std::uint32_t c, int* out) -> Location {
    const Cell& cell = cells_[c];
    Location where{c};
    int zeros = 0, other = -1;
    for (int i = 0; i < 3; ++i) {
      const Sign side = orient(cell.v[after(i, 1)], cell.v[after(i, 2)], v);
      if (side == Sign::negative) {
        *out = i;
        return where;
      }
      if (side == Sign::zero) {
        ++zeros;
        where.edge = i;
      } else {
        other = i;
      }
    }
    if (zeros == 2) where = {c, -1, other};
    return where;
  };
  std::uint32_t c = last_;
  for (std::size_t steps = 0; steps <= cells_.size() && !is_ghost(cells_[c]); ++steps) {
    int out = -1;
    const Location where = place_in(c, &out);
    if (out < 0) return where;
    c = cells_[c].across[static_cast<std::size_t>(out)].cell;
  }
  for (c = 0; c < cells_.size(); ++c) {
    if (is_ghost(cells_[c])) continue;
    int out = -1;
    const Location where = place_in(c, &out);
    if (out < 0) return where;
  }
  return {0, -1, 0};  // not reached: the point is in the triangle
}

std::uint32_t ExactCdt::insert(const ExactPoint& p) {
  const std::uint32_t v = add_vertex(p);
  const Location where = locate(v);
  if (where.corner < 0) return insert_at(v, where);
  vertices_.pop_back();
  return cells_[where.cell].v[static_cast<std::size_t>(where.corner)];
}

/// The edges about the one cell, or the two at an edge, and these cells.
std::vector<ExactCdt::Rim> ExactCdt::rim_of(const Location& where, std::vector<std::uint32_t>& slots) const {
  std::vector<Rim> rim;
  const auto add = [&](std::uint32_t c, std::size_t i) {
    const Cell& cell = cells_[c];
    rim.push_back({cell.v[(i + 1) % 3], cell.v[(i + 2) % 3], cell.across[i], cell.fixed[i]});
  };
  slots.push_back(where.cell);
  if (where.edge < 0) {
    for (std::size_t i = 0; i < 3; ++i) add(where.cell, i);
    return rim;
  }
  const Side behind = cells_[where.cell].across[static_cast<std::size_t>(where.edge)];
  slots.push_back(behind.cell);
  for (const int i : {1, 2}) add(where.cell, after(where.edge, i));
  for (const int i : {1, 2}) add(behind.cell, after(behind.edge, i));
  return rim;
}

/// One cell becomes three; the two at an edge become four, and its halves are constraints if it was one.
std::uint32_t ExactCdt::insert_at(std::uint32_t v, const Location& where) {
  std::vector<std::uint32_t> slots;
  const std::vector<Rim> rim = rim_of(where, slots);
  std::array<std::uint32_t, 2> halved{ghost, ghost};  // the ends of an edge that is a constraint
  if (where.edge >= 0 && cells_[where.cell].fixed[static_cast<std::size_t>(where.edge)])
    halved = {cells_[where.cell].v[after(where.edge, 1)], cells_[where.cell].v[after(where.edge, 2)]};
  while (slots.size() < rim.size()) {
    slots.push_back(static_cast<std::uint32_t>(cells_.size()));
    cells_.emplace_back();
  }
  std::vector<Side> stack;
  const auto is_half = [&](std::uint32_t w) { return w != ghost && (w == halved[0] || w == halved[1]); };
  for (std::size_t k = 0; k < rim.size(); ++k) {
    set(slots[k], {v, rim[k].a, rim[k].b});
    cells_[slots[k]].fixed = {rim[k].fixed, is_half(rim[k].b), is_half(rim[k].a)};
    link({slots[k], 0}, rim[k].outer);
    stack.push_back({slots[k], 0});
  }
  for (std::size_t k = 0; k < rim.size(); ++k) link({slots[k], 1}, {slots[(k + 1) % rim.size()], 2});
  for (const std::uint32_t c : slots)
    if (!is_ghost(cells_[c])) last_ = c;
  legalize(stack);
  return v;
}

bool ExactCdt::flip_is_due(Side s) const {
  const Cell& c = cells_[s.cell];
  if (c.fixed[static_cast<std::size_t>(s.edge)]) return false;  // those of the triangle are, too
  const Side behind = c.across[static_cast<std::size_t>(s.edge)];
  const std::uint32_t q = cells_[behind.cell].v[static_cast<std::size_t>(behind.edge)];
  if (q == ghost || is_ghost(c)) return false;
  return in_circle(c.v[0], c.v[1], c.v[2], q);
}

/// (p, a, b) and (q, b, a) become (p, a, q) and (p, q, b).
void ExactCdt::flip(Side s) {
  const Side behind = cells_[s.cell].across[static_cast<std::size_t>(s.edge)];
  const Cell c = cells_[s.cell], d = cells_[behind.cell];
  const std::uint32_t p = c.v[after(s.edge, 0)], a = c.v[after(s.edge, 1)], b = c.v[after(s.edge, 2)],
                      q = d.v[after(behind.edge, 0)];
  const Side bp = c.across[after(s.edge, 1)], pa = c.across[after(s.edge, 2)];
  const Side aq = d.across[after(behind.edge, 1)], qb = d.across[after(behind.edge, 2)];
  set(s.cell, {p, a, q});
  set(behind.cell, {p, q, b});
  cells_[s.cell].fixed = {d.fixed[after(behind.edge, 1)], false, c.fixed[after(s.edge, 2)]};
  cells_[behind.cell].fixed = {d.fixed[after(behind.edge, 2)], c.fixed[after(s.edge, 1)], false};
  link({s.cell, 1}, {behind.cell, 2});
  link({s.cell, 0}, aq);
  link({s.cell, 2}, pa);
  link({behind.cell, 0}, qb);
  link({behind.cell, 1}, bp);
}

void ExactCdt::legalize(std::vector<Side>& stack) {
  while (!stack.empty()) {
    const Side s = stack.back();
    stack.pop_back();
    if (!flip_is_due(s)) continue;
    const std::uint32_t behind = cells_[s.cell].across[static_cast<std::size_t>(s.edge)].cell;
    flip(s);
    for (const Side next : {Side{s.cell, 0}, Side{s.cell, 2}, Side{behind, 0}, Side{behind, 1}}) stack.push_back(next);
  }
}

void ExactCdt::constrain(std::uint32_t a, std::uint32_t b) {
  using Forcing = EdgeForcing<Forcible>;
  Forcible triangles{*this};
  Forcing forcing;
  std::vector<std::array<std::uint32_t, 2>> todo{{a, b}};
  while (!todo.empty()) {
    const auto [from, to] = todo.back();
    todo.pop_back();
    if (from == to) continue;
    const Forcing::Plan plan = forcing.plan(triangles, from, to);
    if (plan.status == Forcing::Status::is_edge) {
      triangles.constrain(plan.side);
      triangles.constrain(triangles.across(plan.side));
    } else if (plan.status == Forcing::Status::planned) {
      forcing.write(triangles);
    } else if (plan.status == Forcing::Status::meets_vertex || plan.status == Forcing::Status::crosses_constraint) {
      std::uint32_t middle = plan.met[0];
      if (plan.status == Forcing::Status::crosses_constraint) {
        made_.push_back(meeting_of_lines(point(from), point(to), point(plan.met[0]), point(plan.met[1])));
        middle = insert_at(add_vertex(made_.back()), {plan.side.cell, plan.side.edge, -1});
      }
      todo.push_back({middle, to});
      todo.push_back({from, middle});
    }
  }
}

std::vector<std::array<std::uint32_t, 3>> ExactCdt::triangles() {
  std::vector<Side> stack;
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    for (int i = 0; i < 3; ++i) stack.push_back({c, i});
  legalize(stack);
  std::vector<std::array<std::uint32_t, 3>> out;
  for (const Cell& c : cells_)
    if (!is_ghost(c)) out.push_back(c.v);
  return out;
}

}  // namespace pgdr::detail
