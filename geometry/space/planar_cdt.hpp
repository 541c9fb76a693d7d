// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Constrained Delaunay triangulation, without Steiner points, of points of one (nearly) plane of space, seen along a
// coordinate axis; of the plane itself with axis = 2 and z = 0. The hull is closed by ghost triangles, so that every
// edge has two sides. Constraint edges are forced by retriangulating the two polygons that they cut out (edge_forcing.hpp),
// everything else is Lawson's flips. Signs are exact. For points of one plane the result is unique: it is the
// constrained Delaunay triangulation of that plane in space under the perturbation of predicates.hpp. For points that
// are a few ulps off it is still a triangulation, all triangles positive in the projection. Problems are values, not
// exceptions. Cost: n log n in practice, and for each forced edge up to the square of the number of edges it crosses.
// One object belongs to one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

using PlanarEdge = std::array<std::uint32_t, 2>;
using PlanarTriangle = std::array<std::uint32_t, 3>;

enum class PlanarStatus : std::uint8_t {
  ok,
  collinear,      ///< fewer than three points, or all on one line of the projection
  coincident,     ///< the points `edge` have the same projection
  edges_cross,    ///< the constraint edges `edge` and `other` cross in their interiors
  point_on_edge,  ///< point other[0] lies exactly inside the constraint edge `edge`
  no_such_edge,   ///< `edge` is not an edge of the triangulation
  outside,        ///< the point is not in the domain
  on_constraint,  ///< the point is exactly on the constraint edge `edge`: see split_edge
  inverted,       ///< no way was found to keep all triangles positive
};

/// What became of a request. Unless ok (and but for `build`), nothing was changed.
struct PlanarResult {
  PlanarStatus status = PlanarStatus::ok;
  PlanarEdge edge{}, other{};
  explicit operator bool() const { return status == PlanarStatus::ok; }
};

/// Net effect of one insertion on the triangles of the domain, by vertex ids, counter-clockwise.
struct PlanarChange {
  std::vector<PlanarTriangle> destroyed, created;
};

/// Vertices go by the ids that the caller gives them; any 32-bit number but 0xffffffff.
class PlanarTriangulation {
 public:
  /// Triangulates points[v] for the v in `vertices` (distinct), with ids v, and all of `constraints` (pairs of those
  /// v; such with equal ends are passed over).
  /// All triangles of the convex hull are in the domain at first. Replaces what was there.
  /// @return ok, collinear, coincident, edges_cross, point_on_edge or inverted; unless ok the object is empty.
  PlanarResult build(std::span<const Point3> points, std::span<const std::uint32_t> vertices,
                     std::span<const PlanarEdge> constraints, int axis);

  // Choosing the domain: before the first split_edge, after which cells outside of it may be turned over.
  /// Takes out of the domain what is reached from outside of the hull without crossing a constraint.
  void carve_outside();
  /// Takes out of the domain what is reached from p (projected) without crossing a constraint.
  /// @return ok, outside (p is in no triangle of the domain), on_constraint (also for a vertex; `edge` says which).
  PlanarResult carve_hole(const Point3& p);
  /// Makes the domain the union of what is reached from the left sides of these directed constraint edges without
  /// crossing a constraint; pairs that are no constraint edge are passed over.
  void keep_left_of(std::span<const PlanarEdge> edges);

  /// Makes a-b a constraint edge, if it lies in the domain.
  /// @return ok, edges_cross, point_on_edge, outside, no_such_edge (a or b is no vertex), inverted.
  PlanarResult constrain(std::uint32_t a, std::uint32_t b);
  /// Adds a vertex inside the domain.  @return ok, outside, on_constraint, coincident (`edge` = id and the other).
  PlanarResult insert(std::uint32_t id, const Point3& p, PlanarChange* change = nullptr);
  /// Replaces edge a-b by a-id-b; the pieces are constraints if a-b was. p may be off the edge by its rounding: where a
  /// triangle of the domain would be turned over thereby, unconstrained neighbours are taken into the retriangulation.
  /// @return ok, no_such_edge, inverted.
  PlanarResult split_edge(std::uint32_t a, std::uint32_t b, std::uint32_t id, const Point3& p, PlanarChange* change = nullptr);

  /// The triangles of the domain, counter-clockwise in the projection, in an order that depends on the calls alone.
  std::vector<PlanarTriangle> triangles() const;
  /// For each of triangles(): bit i is set if its edge i (from corner i + 1 to i + 2) is a constraint.
  std::vector<std::uint8_t> constraint_masks() const;
  bool has_vertex(std::uint32_t id) const { return local(id) != none; }
  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  bool is_constraint(std::uint32_t a, std::uint32_t b) const;
  int axis() const { return axis_; }
  std::size_t vertex_count() const { return points_.size(); }

  /// All links, orientations, constraint marks; and, unless `delaunay` is false, that no flip is due. For tests.
  bool is_valid(bool delaunay = true) const;

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::uint32_t ghost = 0xfffffffeu;  // the vertex at infinity

  // Edge i is opposite vertex i: from v[i+1] to v[i+2].
  struct Cell {
    std::array<std::uint32_t, 3> v{none, none, none};
    std::array<std::uint32_t, 3> n{none, none, none};
    std::uint8_t fixed = 0;  // bit i: edge i is a constraint
    bool inside = false;
  };
  struct Side {  // edge i of cell t, seen from t
    std::uint32_t t = none;
    int i = 0;
  };
  struct RimEdge {  // an edge of the rim of a cavity, counter-clockwise, and what is behind it
    std::uint32_t a, b;
    Side outer;
    bool fixed, inside;
    bool grown;  // the cell of the cavity is a ghost
  };
  struct Location {
    std::uint32_t t = none;
    int edge = -1, vertex = -1;  // index in t if the point is on an edge, resp. at a vertex
  };
  struct Forcible;  // as EdgeForcing sees it

  // planar_cdt.cpp
  std::uint32_t local(std::uint32_t id) const;
  std::uint32_t add_vertex(std::uint32_t id, const Point3& p);
  PlanarResult build_delaunay(std::span<const Point3> points, std::span<const std::uint32_t> vertices);
  PlanarResult start(std::vector<std::uint32_t>& order);
  PlanarResult insert_in_hull(std::uint32_t v);
  Location locate(const Point3& p) const;
  Location walk_to(const Point3& p) const;
  Location locate_in(std::uint32_t t, const std::array<Sign, 3>& side) const;
  Location locate_by_scan(const Point3& p) const;
  void flood(std::vector<std::uint32_t>& queue, bool inside);
  // planar_cdt_flip.cpp
  // By mask, not by shifting the mark down: GCC 12 -O2 was seen to miscompile ((x >> i) & 1) != ((y >> j) & 1).
  template <class Index>
  static bool is_fixed(const Cell& c, Index i) {
    return (c.fixed & (1u << static_cast<unsigned>(i))) != 0;
  }
  bool is_out(const Cell& c) const { return !c.inside && outside_is_crooked_; }
  bool is_ghost(const Cell& c) const { return c.v[0] == ghost || c.v[1] == ghost || c.v[2] == ghost; }
  int index_in(std::uint32_t t, std::uint32_t v) const;
  int mirror(std::uint32_t t, int i) const;
  Sign orient(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  bool in_circle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool flat) const;
  void link(Side a, Side b);
  void set_cell(std::uint32_t t, const std::array<std::uint32_t, 3>& v, std::uint8_t fixed, bool inside);
  void touch(std::uint32_t t);
  bool flip_is_due(std::uint32_t t, int i, bool flat) const;
  void flip(std::uint32_t t, int i);
  void legalize(std::vector<Side>& stack, bool flat, bool around_vertex);
  Side find_edge(std::uint32_t a, std::uint32_t b) const;
  void begin_change(PlanarChange* change);
  void end_change();
  // planar_cdt_constrain.cpp
  PlanarResult constrain_local(std::uint32_t a, std::uint32_t b, bool inside_only);
  PlanarResult problem(PlanarStatus status, std::uint32_t a, std::uint32_t b, std::uint32_t c = none,
                       std::uint32_t d = none) const;
  // planar_cdt_insert.cpp
  std::vector<RimEdge> rim_of(Location where) const;
  bool make_star_shaped(std::uint32_t p, std::vector<RimEdge>& rim, std::vector<std::uint32_t>& cells) const;
  void fill_star(std::uint32_t p, const std::vector<RimEdge>& rim, const std::vector<std::uint32_t>& cells,
                 PlanarEdge fixed_spokes, bool flat);
  void forget_last_vertex();

  int axis_ = 2;
  std::vector<Point3> points_;                                     // by local number
  std::vector<std::uint32_t> ids_;                                 // by local number
  std::vector<std::uint32_t> cell_of_;                             // some cell at each vertex
  std::vector<std::pair<std::uint32_t, std::uint32_t>> local_of_;  // (id, local number), sorted
  std::vector<Cell> cells_;
  std::uint32_t hint_ = 0;
  // A point was added off an edge that bounds the domain: cells outside of it may be turned over, and are left as they
  // are. Location then trusts the cells of the domain alone.
  bool outside_is_crooked_ = false;
  // While an insertion is recorded: the cells touched, as they were.
  PlanarChange* change_ = nullptr;
  std::vector<std::pair<std::uint32_t, Cell>> touched_;
  std::vector<std::uint32_t> touch_stamp_;
  std::uint32_t stamp_ = 0;
};

}  // namespace pgdr::detail
