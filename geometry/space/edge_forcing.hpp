// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Forcing an edge into a triangulation of the plane (Anglada 1997). The cells that it crosses leave a polygon on each side of
// it, possibly with dangling edges, so that a vertex may occur twice in its chain. Each is filled from the new edge outwards:
// the third corner of an edge is the chain vertex whose circle through the edge holds no other one. Every chain vertex is joined
// to the new edge by a crossed edge inside the polygon; hence no chain edge can cut such a triangle, and the rest of the chain is
// again in that situation with respect to the two new edges. Nothing is written before the fill is known. Costs up to the square
// of the number of edges crossed.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Edge `edge` of a cell, opposite its corner of that number, seen from the cell.
template <class Cell>
struct CellSide {
  Cell cell{};
  int edge = 0;
  friend auto operator<=>(const CellSide&, const CellSide&) = default;
};

/// A triangulation as forcing sees it: cells of three corners, counter-clockwise, closed by ghosts about a vertex at infinity.
template <class T>
concept ForcibleTriangles = requires(T& t, const T& c, typename T::Cell cell, typename T::Vertex v,
                                     CellSide<typename T::Cell> side) {
  {
    T::from_b
    } -> std::convertible_to<bool>;  // crossed cells are used again from b on, not from a: refinement depends on the order
  { c.corner(cell, 0) } -> std::same_as<typename T::Vertex>;
  { c.across(side) } -> std::same_as<CellSide<typename T::Cell>>;  // the same edge, seen from the cell behind it
  { c.is_constraint(side) } -> std::same_as<bool>;
  { c.is_ghost(v) } -> std::same_as<bool>;
  { c.cell_at(v) } -> std::same_as<typename T::Cell>;  // some cell with this corner
  { c.orient(v, v, v) } -> std::same_as<Sign>;
  { c.is_ahead(v, v, v) } -> std::same_as<bool>;      // of c on the line ab: on the side of a where b is
  { c.in_circle(v, v, v, v) } -> std::same_as<bool>;  // the fourth inside the circle through the others
  t.set(cell, std::array<typename T::Vertex, 3>{});   // new corners, no constraints
  t.link(side, side);
  t.constrain(side);
};

/// A workspace; used by one thread.
template <ForcibleTriangles Triangles>
class EdgeForcing {
 public:
  using Vertex = typename Triangles::Vertex;
  using Cell = typename Triangles::Cell;
  using Side = CellSide<Cell>;

  enum class Status {
    is_edge,             ///< ab is an edge already; `side`: to its left
    planned,             ///< write() will make it one
    crosses_constraint,  ///< the constraint between `met` is in its way
    meets_vertex,        ///< met[0] lies inside it
    no_way,              ///< no cell at a is entered, or the hull is left
    no_fill,             ///< a polygon beside it has no triangles
  };
  struct Plan {
    Status status = Status::no_way;
    Side side{};
    std::array<Vertex, 2> met{};
  };

  /// Looks for what makes ab an edge; changes nothing.
  Plan plan(const Triangles& triangles, Vertex a, Vertex b) {
    Plan found = first_crossing(triangles, a, b);
    if (found.status == Status::planned) found = march(triangles, a, b, found.side);
    if (found.status != Status::planned) return found;
    if (!fill(triangles, left_) || !fill(triangles, right_)) found.status = Status::no_fill;
    return found;
  }
  /// The cells that the planned edge crosses, from a on. As many new ones take their places.
  const std::vector<Cell>& crossed() const { return crossed_; }
  /// Makes the planned edge a constraint.
  void write(Triangles& triangles) {
    std::size_t next = 0;
    const Side above = write(triangles, left_, next), below = write(triangles, right_, next);
    triangles.link(above, below);
    triangles.constrain(above);
    triangles.constrain(below);
    join(triangles);
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  /// An edge of a polygon, seen from inside.
  struct ChainEdge {
    Side old;     ///< of a crossed cell
    Side beyond;  ///< of a cell outside, or (dangling edge) of another crossed one
    bool is_constraint;
    Side now{};  ///< of a new cell
  };
  /// A triangle of a polygon: its corners by their places in the chain, and the triangle and edge below it, 2 * triangle + (0,
  /// 1).
  struct Triangle {
    std::uint32_t i, j, k = none, below = none;
  };
  /// A polygon: vertices from one end of the edge to the other, counter-clockwise about what is to be filled.
  struct Polygon {
    std::vector<Vertex> vertices;
    std::vector<ChainEdge> edges;  ///< edge i between vertices i and i + 1
    std::vector<Triangle> triangles;
  };

  /// The cell at a whose inner angle holds the direction to b: its edge opposite a.
  static Plan first_crossing(const Triangles& triangles, Vertex a, Vertex b) {
    const Cell first = triangles.cell_at(a);
    Cell c = first;
    do {
      int i = 0;
      while (triangles.corner(c, i) != a) ++i;
      const Vertex r = triangles.corner(c, (i + 1) % 3), l = triangles.corner(c, (i + 2) % 3);
      if (r == b) return {Status::is_edge, {c, (i + 2) % 3}, {}};
      if (!triangles.is_ghost(r)) {
        const Sign side = triangles.orient(a, b, r);
        if (side == Sign::zero && triangles.is_ahead(a, b, r)) return {Status::meets_vertex, {}, {r, r}};
        if (side == Sign::negative && !triangles.is_ghost(l) && triangles.orient(a, b, l) == Sign::positive)
          return {Status::planned, {c, i}, {}};
      }
      c = triangles.across({c, (i + 1) % 3}).cell;
    } while (c != first);
    return {};
  }

  /// Along the edge: what it crosses, and the polygons on both sides of it.
  Plan march(const Triangles& triangles, Vertex a, Vertex b, Side at) {
    const auto edge = [&](Cell c, int i) {
      const Side side{c, i % 3};
      return ChainEdge{side, triangles.across(side), triangles.is_constraint(side)};
    };
    Vertex r = triangles.corner(at.cell, (at.edge + 1) % 3), l = triangles.corner(at.cell, (at.edge + 2) % 3);
    crossed_.assign({at.cell});
    left_.vertices.assign({a, l});
    right_.vertices.assign({a, r});
    left_.edges.assign({edge(at.cell, at.edge + 1)});
    right_.edges.assign({edge(at.cell, at.edge + 2)});
    while (true) {
      if (triangles.is_constraint(at)) return {Status::crosses_constraint, at, {r, l}};
      const auto [c, i] = triangles.across(at);  // its corners are w, l, r
      const Vertex w = triangles.corner(c, i);
      if (triangles.is_ghost(w)) return {};
      const Sign side = w == b ? Sign::zero : triangles.orient(a, b, w);
      if (w != b && side == Sign::zero) return {Status::meets_vertex, {}, {w, w}};
      crossed_.push_back(c);
      if (side != Sign::negative) {
        left_.vertices.push_back(w);
        left_.edges.push_back(edge(c, i + 2));
      }
      if (side != Sign::positive) {
        right_.vertices.push_back(w);
        right_.edges.push_back(edge(c, i + 1));
      }
      if (w == b) break;
      at = {c, (i + (side == Sign::positive ? 1 : 2)) % 3};
      (side == Sign::positive ? l : r) = w;
    }
    // The right polygon is to the left of the edge from b to a.
    std::reverse(right_.vertices.begin(), right_.vertices.end());
    std::reverse(right_.edges.begin(), right_.edges.end());
    return {Status::planned, {}, {}};
  }

  /// Triangles to the left of the edge from the first vertex to the last; false if there are none.
  bool fill(const Triangles& triangles, Polygon& polygon) {
    const auto& v = polygon.vertices;
    polygon.triangles.clear();
    todo_.assign({{0, static_cast<std::uint32_t>(v.size() - 1)}});
    while (!todo_.empty()) {
      Triangle t = todo_.back();
      todo_.pop_back();
      for (std::uint32_t k = t.i + 1; k < t.j; ++k) {
        if (v[k] == v[t.i] || v[k] == v[t.j] || triangles.orient(v[t.i], v[t.j], v[k]) != Sign::positive) continue;
        if (t.k == none || (v[k] != v[t.k] && triangles.in_circle(v[t.i], v[t.j], v[t.k], v[k]))) t.k = k;
      }
      if (t.k == none) return false;
      const auto number = static_cast<std::uint32_t>(polygon.triangles.size());
      polygon.triangles.push_back(t);
      const Triangle at_j{t.k, t.j, none, 2 * number}, at_i{t.i, t.k, none, 2 * number + 1};
      for (const Triangle& next : {Triangles::from_b ? at_i : at_j, Triangles::from_b ? at_j : at_i})
        if (next.i + 1 < next.j) todo_.push_back(next);
    }
    return true;
  }

  /// The crossed cell whose place the n-th triangle takes.
  Cell place(std::size_t n) const { return crossed_[Triangles::from_b ? crossed_.size() - 1 - n : n]; }

  /// New cells in the places of crossed ones, from the one numbered `next` on; the side that is the edge.
  Side write(Triangles& triangles, Polygon& polygon, std::size_t& next) {
    const std::size_t begin = next;
    for (const Triangle& t : polygon.triangles) {
      const Cell c = place(next++);
      triangles.set(c, {polygon.vertices[t.i], polygon.vertices[t.j], polygon.vertices[t.k]});
      if (t.below != none) triangles.link({c, 2}, {place(begin + t.below / 2), static_cast<int>(t.below % 2)});
      if (t.k + 1 == t.j) polygon.edges[t.k].now = {c, 0};
      if (t.i + 1 == t.k) polygon.edges[t.i].now = {c, 1};
    }
    return {place(begin), 2};
  }

  /// Links the edges of both polygons to what is behind them.
  void join(Triangles& triangles) {
    now_.clear();
    for (const Polygon* polygon : {&left_, &right_})
      for (const ChainEdge& e : polygon->edges) now_.emplace_back(e.old, e.now);
    std::sort(now_.begin(), now_.end());
    for (const Polygon* polygon : {&left_, &right_})
      for (const ChainEdge& e : polygon->edges) {
        const auto twin = std::partition_point(now_.begin(), now_.end(), [&](const auto& x) { return x.first < e.beyond; });
        const bool is_dangling = twin != now_.end() && twin->first == e.beyond;
        triangles.link(e.now, is_dangling ? twin->second : e.beyond);
        if (e.is_constraint) triangles.constrain(e.now);
      }
  }

  std::vector<Cell> crossed_;
  Polygon left_, right_;
  std::vector<Triangle> todo_;
  std::vector<std::pair<Side, Side>> now_;  // of each old side the new one; sorted
};

}  // namespace pgdr::detail
