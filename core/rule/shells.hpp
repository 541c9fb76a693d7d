// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where to split a segment that makes an angle below 60 degrees with another: on a shell, a sphere (circle) about their
// common end whose radius is a power of two. Subsegments of one shell at that end are equally long, so that the point that
// splits the one does not encroach upon the other (after Ruppert 1995, Shewchuk 1997). Immutable; any thread may read it.
#pragma once

#include <array>
#include <vector>

#include "numbers/rounding.hpp"
#include "pgdr/domain.hpp"
#include "space/bulk.hpp"

namespace pgdr {

/// The shells at the ends of all segments. Immutable.
template <int D>
class Shells {
 public:
  /// `any`: false if no end is to have shells.
  explicit Shells(const Domain<D>& domain, bool any = true, const detail::Bulk& bulk = detail::Bulk(false));

  /// Parameter, on the segment, of the point that splits its piece from t0 to t1, 0 <= t0 < t1 <= 1: the middle, but next
  /// to an end with a shell the one on a shell between a third and two thirds of the piece.
  double split_parameter(EntityId segment, double t0, double t1) const;
  /// The end about which a piece from t0 to t1 is split on a shell; -1 if it is split in the middle.
  int end_of(EntityId segment, double t0, double t1) const {
    return t0 == 0 && at_end_[segment][0] ? 0 : t1 == 1 && at_end_[segment][1] ? 1 : -1;
  }
  /// Is this distance from an end of the segment the radius of a shell, but for the rounding of a point on it?
  bool is_radius(EntityId segment, double distance) const;
  /// How far a rounded point on it may be off its place.
  double rounding(EntityId segment) const { return rounding::of_point * domain_->segment_magnitude(segment); }

 private:
  const Domain<D>* domain_;
  std::vector<std::array<bool, 2>> at_end_;  ///< another segment makes less than 60 degrees here
};

extern template class Shells<2>;
extern template class Shells<3>;

}  // namespace pgdr
