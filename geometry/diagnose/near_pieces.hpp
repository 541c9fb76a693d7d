// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pieces of a Domain; and as questions of distance need them, in unit scale. Immutable once made, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/domain.hpp"
#include "space/box.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {

/// 3D the triangles of facets, then segments of no facet; 2D the segments; then points of neither.
template <int D>
std::vector<Piece> pieces_of(const Domain<D>& domain, const Bulk& bulk);

/// The segment between two points, in either order; no_entity if there is none.
template <int D>
EntityId segment_between(const Domain<D>& domain, std::uint32_t a, std::uint32_t b);

template <int D>
class NearPieces {
 public:
  NearPieces(const Domain<D>& domain, const Bulk& bulk);

  const Domain<D>& domain() const { return *domain_; }
  std::span<const Point<D>> points() const { return points_; }  ///< of the Domain, in unit scale
  double unit() const { return unit_; }                         ///< the length of the input that is 1 here
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Of all pieces, larger by `width` on all sides.
  std::vector<Box<D>> boxes(double width, const Bulk& bulk) const;

  /// Is the edge a segment of the Domain?
  bool is_segment(std::uint32_t a, std::uint32_t b) const { return segment_between(*domain_, a, b) != no_entity; }
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
