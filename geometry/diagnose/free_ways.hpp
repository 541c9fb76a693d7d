// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which places see each other, past the facets (2D: segments) of an input, and which see the outside. For estimates: to be inside
// is to see no way out along an axis. Immutable, any thread.
#pragma once

#include "diagnose/size_field_of_gaps.hpp"

namespace pgdr::detail {

template <int D>
class FreeWays {
 public:
  explicit FreeWays(const SizeFieldOfGaps<D>& field) : field_(field), all_(Box<D>::of(field.pieces().points())) {}

  /// Is nothing between the two, in unit scale (NearPieces)?
  bool is_free(const Point<D>& a, const Point<D>& b) const;
  bool is_inside(const Point<D>& x) const;
  /// How much of the box is inside, by the middles of its quarters (3D: eighths).
  double part_inside(const Box<D>& box) const;

 private:
  bool crosses(const Point<D>& a, const Point<D>& b, const typename NearPieces<D>::Piece& piece) const;

  const SizeFieldOfGaps<D>& field_;
  const Box<D> all_;
};

extern template class FreeWays<2>;
extern template class FreeWays<3>;

}  // namespace pgdr::detail
