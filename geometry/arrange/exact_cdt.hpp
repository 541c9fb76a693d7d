// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The constrained Delaunay triangulation of one triangle of space with exact points in its plane, seen along an axis. Edges that
// cross get their common point, an exact one. All signs are exact: doubles with bounds on their errors, then rationals. Circles
// are those of the projection. Unlike PlanarTriangulation it never meets points beside their edges: what is rounded is rounded
// after. One object belongs to one thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "arrange/exact_point.hpp"
#include "numbers/bounded.hpp"
#include "space/edge_forcing.hpp"

namespace pgdr::detail {

class ExactCdt {
 public:
  /// The triangle of these corners, which are vertices 0, 1, 2. @pre it is positive in the projection along `axis`
  ExactCdt(const std::array<const ExactPoint*, 3>& corners, int axis);

  /// The vertex at a point of the triangle, a new one if there is none. The point must outlive this.
  std::uint32_t insert(const ExactPoint& p);
  /// Makes the edge between two vertices a union of constraints, through the vertices that it passes and the points where it
  /// crosses constraints.
  void constrain(std::uint32_t a, std::uint32_t b);
  /// The triangles, as the triangle is oriented, once all edges are Delaunay that may be.
  std::vector<std::array<std::uint32_t, 3>> triangles();
  /// The vertices, by their numbers.
  std::size_t vertex_count() const { return vertices_.size(); }
  const ExactPoint& point(std::uint32_t v) const { return *vertices_[v].at; }

 private:
  static constexpr std::uint32_t ghost = 0xfffffffeu;  // the vertex at infinity
  using Side = CellSide<std::uint32_t>;

  struct Vertex {
    const ExactPoint* at;
    std::array<Bounded, 2> near;  // the kept coordinates, less those of the first corner
    std::uint32_t cell;           // some cell at it
  };
  // Edge i is opposite corner i.
  struct Cell {
    std::array<std::uint32_t, 3> v;
    std::array<Side, 3> across;
    std::array<bool, 3> fixed;
  };
  struct Location {
    std::uint32_t cell;
    int edge = -1, corner = -1;  // on which the point is
  };
  struct Rim {  // an edge about what is replaced, and what is behind it
    std::uint32_t a, b;
    Side outer;
    bool fixed;
  };
  struct Forcible;  // as EdgeForcing sees it

  std::uint32_t add_vertex(const ExactPoint& p);
  std::vector<Rim> rim_of(const Location& where, std::vector<std::uint32_t>& slots) const;
  std::uint32_t insert_at(std::uint32_t v, const Location& where);
  Location locate(std::uint32_t v) const;
  void set(std::uint32_t c, const std::array<std::uint32_t, 3>& v);
  void link(Side a, Side b);
  void legalize(std::vector<Side>& stack);
  bool flip_is_due(Side s) const;
  void flip(Side s);
  bool is_ghost(const Cell& c) const { return c.v[0] == ghost || c.v[1] == ghost || c.v[2] == ghost; }
  Sign orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  bool in_circle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const;
  bool is_ahead(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  template <std::size_t N>
  std::array<std::array<Rational, 2>, N> rational_differences(const std::array<std::uint32_t, N>& to, std::uint32_t from) const;
  template <std::size_t N>
  std::array<std::array<Bounded, 2>, N> near_differences(const std::array<std::uint32_t, N>& to, std::uint32_t from) const;

  std::array<std::size_t, 2> axes_;  // kept ones
  std::vector<Vertex> vertices_;
  std::vector<Cell> cells_;
  std::deque<ExactPoint> made_;  // where edges cross
  std::uint32_t last_ = 0;       // a cell to begin walks at
};

}  // namespace pgdr::detail
