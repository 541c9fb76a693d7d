// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// At which angles two named entities meet. Signs are exact where what meets are points that were given. A point of the mesh that
// was put onto a facet may be off it by the facet's reach r, which turns the direction to it from a distance d by at most
// asin(r/d): such angles are known up to that, and up to the rounding of what is computed in doubles.
#pragma once

#include "given/named_entities.hpp"
#include "input/sharp_angles.hpp"

namespace pgdr::checking {

/// Degrees, at least and at most.
struct AngleRange {
  double low, high;
};

struct EntityMeeting {
  bool is_small = false;  ///< below 60 degrees (two segments) or 90 somewhere, or may be
  bool is_sharp = false;  ///< 3D: somewhere at one at which the bounds cannot be met: of two facets at a segment, of two segments
  std::vector<AngleRange> small;  ///< those angles, ascending; ranges do not meet

  void join(const EntityMeeting& other);
};

template <int D>
EntityMeeting meeting_of(const NamedEntities<D>& entities, const NamedEntity<D>& a, const NamedEntity<D>& b,
                         const AngleBounds& bounds);

/// Is one a part of the other, or the same? These make no angle.
template <int D>
bool are_one(const NamedEntity<D>& a, const NamedEntity<D>& b);

/// Do they, of which none is a part of the other, share a segment at this point? It is a point of both.
bool share_segment_at(const NamedEntity<3>& a, const NamedEntity<3>& b, std::uint32_t point);

/// What the entity is about the point.
std::vector<Sector> sectors_at(const NamedEntities<3>& entities, const NamedEntity<3>& e, std::uint32_t point);

/// The dihedral angle of the half-planes from ab through c and through d, up to rounding.
AngleRange dihedral_range(const std::array<Point3, 4>& abcd);

}  // namespace pgdr::checking
