// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Is each point of a triangle, or of a segment, within a distance of the union of others? Yes is a proof; no has a place at which
// it was seen, or at which it could not be told.
//
// Two facts make proofs: the distance from anything changes by no more than one moves; and the distance from one convex set is a
// convex function, so that it is largest at a corner. What neither of them decides is cut: first by what each of the others
// covers of the plane of a triangle (cover.hpp), since a piece across the common edge of two others has to get as small as the
// distance before it is on one side; what is left then in halves across the longest edge.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "pgdr/types.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

using Triangle3 = std::array<Point3, 3>;
using Segment3 = std::array<Point3, 2>;

/// Where something is not within the distance.
struct FarPlace {
  Point3 where;
  double distance;  ///< of the nearest of the others, at most; infinite: there is none
  bool is_certain;  ///< it is farther away; else it could not be told of this place
};

/// Immutable once made; any thread may ask.
class NearSet {
 public:
  /// Triangles; flat ones count as what is left of them.
  explicit NearSet(std::vector<Triangle3> triangles);
  explicit NearSet(const std::vector<Segment3>& segments);

  bool empty() const { return triangles_.empty(); }
  /// The distance of x from the nearest of them, at most: rounding of a few ulps of what they measure may be in it. Infinite if
  /// none is within `most`.
  double distance(const Point3& x, double most) const;
  /// None: all of it is within `limit` of them. @param limit above 0
  std::optional<FarPlace> farther(const Triangle3& piece, double limit) const;
  std::optional<FarPlace> farther(const Segment3& piece, double limit) const;

 private:
  template <std::size_t N>
  class Decision;
  std::vector<Triangle3> triangles_;
  std::unique_ptr<detail::BoxTree<3>> tree_;
};

/// The squared distance of x from a point of the triangle, which is the nearest one up to rounding: no less than the square of
/// its distance from the triangle, but for that.
double squared_distance_above(const Point3& x, const Triangle3& triangle);
/// Is x within `limit` of the triangle? Decided by about 100 bits where doubles leave it open; yes is true up to what the
/// rounding of the foot beside the nearest point adds, squared: a fraction of an ulp.
bool is_within(const Point3& x, const Triangle3& triangle, double limit);

}  // namespace pgdr::checking
