// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pieces of a Domain as questions of distance need them: 3D the triangles of facets, then segments of no facet; 2D the
// segments; then points of neither. Immutable once made, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "space/distances.hpp"
#include "pgdr/domain.hpp"
#include "space/box.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

template <int D>
class NearPieces {
 public:
  struct Piece {
    std::array<std::uint32_t, 3> corners{no_entity, no_entity, no_entity};
    std::uint8_t count = 0;        ///< of corners
    EntityId facet = no_entity;    ///< of a triangle
    EntityId segment = no_entity;  ///< of an edge
    bool has(std::uint32_t v) const { return corners[0] == v || corners[1] == v || corners[2] == v; }
    std::span<const std::uint32_t> points() const { return std::span(corners).first(count); }
    EntityRef entity() const {
      if (count == 3) return {EntityKind::facet, facet};
      return count == 2 ? EntityRef{EntityKind::segment, segment} : EntityRef{EntityKind::vertex, corners[0]};
    }
  };

  NearPieces(const Domain<D>& domain, const Bulk& bulk);

  const Domain<D>& domain() const { return *domain_; }
  std::span<const Point<D>> points() const { return points_; }  ///< of the Domain, in unit scale
  double unit() const { return unit_; }                         ///< the length of the input that is 1 here
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Of all pieces, larger by `width` on all sides.
  std::vector<Box<D>> boxes(double width, const Bulk& bulk) const;

  /// Is the edge a segment of the Domain?
  bool is_segment(std::uint32_t a, std::uint32_t b) const;
  /// Does the piece, with the whole facet that it is of, have this point?
  bool owner_has(const Piece& piece, std::uint32_t v) const;
  /// Do the entities of two pieces have no point in common?
  bool are_disjoint(const Piece& a, const Piece& b) const;
  ClosestPoints<D> closest(const Point<D>& x, const Piece& piece) const;

 private:
  const Domain<D>* domain_;
  double unit_ = 1;
  std::vector<Point<D>> points_;
  std::vector<Piece> pieces_;
};

extern template class NearPieces<2>;
extern template class NearPieces<3>;

}  // namespace pgdr::detail
