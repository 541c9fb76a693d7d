// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Missing subsegments that no point is needed for. Let two facets of one triangle each lie in one plane, on both sides of a
// segment, with all four corners on one circle. The Delaunay triangulation may have either diagonal of such a square, and ties
// are broken without regard to the segments. Where the mesh has the other one, with two cells on each side, these are flipped,
// which leaves it Delaunay: but not the unique one of the tie rule, into which points are inserted. So it is done last of all,
// and until then nothing is missing there. Where it cannot be done all flips are undone, and that segment is split as any other.
// Private to this room; one thread.
#pragma once

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "boundary/recovery.hpp"
#include "mesh/mesh.hpp"

namespace pgdr::detail {

/// See above.
class SquareFlips {
 public:
  /// All must outlive it.
  SquareFlips(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain)
      : mesh_(&mesh), delaunay_(&delaunay), domain_(&domain) {}

  /// Takes the segments among these, which are missing, that a flip can make.
  void take(std::span<const EntityId> missing);
  /// Is the segment to be made by a flip?
  bool has_segment(EntityId s) const { return squares_.contains(s); }
  /// Is the facet to be one by then?
  bool has_facet(EntityId f) const;
  /// There is a point on the facet: what is missing at it is to be split as any other.
  void drop_facet(EntityId f);
  bool any() const { return !squares_.empty(); }
  void clear() { squares_.clear(); }
  /// Makes all of them. Else it changes nothing, and drops those that cannot be made.
  bool flip();

 private:
  struct Square {
    std::array<VertexId, 2> wanted, present;  ///< diagonals
  };
  /// Two cells at the diagonal on one side: with wanted[0], and with wanted[1].
  using Side = std::array<CellId, 2>;

  bool find_sides(const Square& square, std::array<Side, 2>& sides);
  bool is_flippable(const Square& square, const std::array<Side, 2>& sides) const;
  void flip(const Square& square, const std::array<Side, 2>& sides);

  Mesh<3>* mesh_;
  Delaunay<3>* delaunay_;
  const Domain<3>* domain_;
  std::unordered_map<EntityId, Square> squares_;  ///< by segment
  std::vector<CellId> star_;                      // scratch
};

}  // namespace pgdr::detail
