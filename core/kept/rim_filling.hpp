// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes a vertex v off the free rim of a sheet, on whose both sides all of its cells are one sector. No point inside sees both
// sides of the sheet; so the plane of the sheet is continued beyond the rim, and each of its sides gets a point.
//
// Why that always does it, in exact numbers. The link of v, the faces opposite v of its cells, is a sphere that v sees from
// inside. The plane cuts it in a closed curve about v: the path of the fan on the sheet from one end a of the rim to the other,
// b; and beyond the rim, across edges of the link and through vertices. Where it crosses the edge q-r, halfway from v, there
// comes a point x in the face v-q-r. The cells of v on that are divided: what is beyond the points stays, and v has a link whose
// vertices in the plane are those of the path and the points x, in a ring that v sees. All other faces of that link are on one
// side. The point w = v + h n, n the normal, sees each face of the upper side for h small enough, as v does, and so does v - h n
// those of the lower side. Between these two there is a double pyramid on the ring, a polygon that the line a-b divides into the
// fan's and that beyond. Triangulated without v, each triangle with w above and with w below are cells, positive for each h > 0.
//
// In doubles signs are verified, and h is halved until all are positive.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kept/vertex_parts.hpp"
#include "mesh/mesh.hpp"

namespace pgdr {

/// See above. One thread.
class RimFilling {
 public:
  RimFilling(const Mesh<3>& mesh, const Domain<3>& domain) : mesh_(&mesh), domain_(&domain) {}  ///< both must outlive it

  /// Fills the hull of a sector at v that is on both sides of the only fan. `fan`: the fan's triangles without v; `rim`: the ends
  /// of its subsegments. False: it does not.
  bool fill(const Hull& hull, VertexId v, std::span<const VertexParts::Triangle> fan, const std::array<VertexId, 2>& rim);

  using Corner = std::uint32_t;  ///< of old_vertices(), and behind them of new_points()
  const std::vector<VertexId>& old_vertices() const { return old_; }
  std::span<const Point3> new_points() const { return std::span(points_).subspan(old_.size()); }
  const std::vector<std::array<Corner, 4>>& cells() const { return cells_; }  ///< positive

 private:
  using Face = std::array<Corner, 3>;
  using Edge = std::array<Corner, 2>;
  enum class Side : std::int8_t { below = -1, in_plane = 0, above = 1 };

  void take_vertices(const Hull& hull, std::span<const VertexParts::Triangle> fan);
  bool divide(const Face& face);
  void divide_at_vertex(const Face& face);
  void divide_across(const Face& face);
  Corner crossing(Corner q, Corner r);
  void add_near(Side side, const Face& face) { (side == Side::above ? above_ : below_).push_back(face); }
  void follow_edges_in_plane();
  bool close_ring(const std::array<VertexId, 2>& rim);
  bool place_pyramids();
  Corner corner(VertexId v) const;

  const Mesh<3>* mesh_;
  const Domain<3>* domain_;
  Point3 center_;                 // of v
  std::array<double, 3> normal_;  // of length 1
  int axis_ = 0;                  // of the facet
  std::vector<VertexId> old_;     // ascending
  std::vector<Point3> points_;
  std::vector<Side> sides_;  // of each point
  std::vector<std::pair<Edge, Corner>> crossings_;
  std::vector<Face> above_, below_, base_;  // of the pyramids
  std::vector<Edge> curve_;                 // beyond the rim
  std::vector<std::array<Corner, 4>> outer_, cells_;
};

}  // namespace pgdr
