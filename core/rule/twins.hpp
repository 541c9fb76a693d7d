// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Twins, in 3D: places to split a subsegment that other vertices are close beside, as along a needle, a triangle whose corner
// lies next to the opposite side (programs that subtract solids leave such).
//
// Along the sides of a needle the subsegments of the one side would be split for the vertices of the other, and these for the new
// ones. Were each split in the middle, the distances between their points would become those at which they are split next, and so
// on, down to how far apart the sides are. So a subsegment is split at one of these places:
//   * As far from an end of its segment as a vertex beside it that lies on another segment there: its twin. No vertex of the one
//     side is then in a diametral ball of the other.
//   * Next to an input vertex beside it, so that no diametral ball has that inside.
//   * In the recovery, where the subsegment does not reach the common end: next to any vertex of a segment that runs along it.
//     (Where four segments run from two near points to two others, places as far from one end and from the other differ, and
//     copies of copies would come back at a distance. The nearest points of lines do not.) The recovery has a limit of its own.
//     For the refinement the distance from the end bounds that of the twins, and must not become less.
//
// Subsegments at the common end o must be equally long in any case. The nearest point to q at an angle a is cos a times as far
// from o as q is. So of three side by side the middle one, op, may be the longest, and both others' ends see it at more than 90
// degrees. The circles through o, p and them leave op no empty one: it is missing and is split, and the next round may have the
// same three at half the size.
//
// The distance between twins is not counted: the insertion radius of a point, which is compared with its demand, and which later
// points inherit, is the distance from all other vertices (insertion_rule.hpp has the proof that this ends).
//
// Pure functions of the domain and of points; any thread.
#pragma once

#include <optional>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"

namespace pgdr {

/// Where to split a subsegment.
struct SplitPlace {
  double t;                        ///< parameter on the segment, strictly inside of the piece
  Point3 x;                        ///< the point there
  std::uint32_t apex = no_entity;  ///< the input vertex, an end of the segment, from which twins are as far; none without twins
  double radius = 0;               ///< that distance
};

/// Which place next to a vertex on another segment.
enum class Beside {
  as_far,   ///< from the common end
  nearest,  ///< to it; as far if the piece reaches the common end
};

/// Finds, on the piece of a segment from t0 to t1, the place beside a vertex that is nearest to the middle of the piece.
class TwinPlaces {
 public:
  /// 0 <= t0 < t1 <= 1
  TwinPlaces(const Domain<3>& domain, EntityId segment, double t0, double t1, Beside where);

  void look_at(const VertexRecord<3>& q);                          ///< any vertex; the order in which they come does not matter
  const std::optional<SplitPlace>& best() const { return best_; }  ///< nothing without any

 private:
  void add(double t, const Point3& q, double least_room, std::uint32_t apex);

  const Domain<3>* domain_;
  EntityId segment_;
  double t0_, t1_, whole_;
  Beside where_;
  std::optional<SplitPlace> best_;
};

/// Does the vertex lie on another segment at the place's apex, as far from it, but for rounding and 1/64 of their distance?
bool is_twin(const Domain<3>& domain, EntityId segment, const SplitPlace& place, const VertexRecord<3>& v);

}  // namespace pgdr
