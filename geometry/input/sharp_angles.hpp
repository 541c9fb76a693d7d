// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles of the input at which no mesh meets the bounds that are asked for, decided exactly. Reads a Domain; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "pgdr/domain.hpp"

namespace pgdr {

/// Of each triangle of all facets of a Domain: do its corners count? Empty: all do. Of a facet that is partly in the mesh, those
/// of the rest make no angle there (core/refine/meshed_parts.hpp).
using CountedTriangles = std::span<const std::uint8_t>;

/// The bounds of shape of a mesh, by which angles of its input are too small.
struct AngleBounds {
  double radius_edge;  ///< on circumradius over shortest edge: planar angles below arcsin(1 / (2 bound)) are too small
  double largest_cosine =
      1;  ///< of dihedral angles (claimed_cosine): of the input those with a larger one are too small; 1: none
};

/// Do they meet at an angle that is too small: two facets at a common segment, between their half-planes there, or two segments
/// at a common end?
bool meet_too_sharply(const Domain<3>& domain, EntityRef a, EntityRef b, const AngleBounds& bounds,
                      CountedTriangles counted = {});

/// Do the segments, of one facet, meet at this point at a planar angle that is too small, with a part of the facet between them?
/// Then some cell there is over the bound, whatever the mesh (core/reasons/sharp_corners.hpp has the proof).
bool is_sharp_corner(const Domain<3>& domain, std::uint32_t point, EntityId s, EntityId t, const AngleBounds& bounds,
                     CountedTriangles counted = {});

/// Do two segments or facets, which share this point and no segment at it, come nearer to each other about it than cells can be
/// thin there within the bounds: at an angle below arcsin(sin A / (2 B)), A the angle of largest_cosine? Then some cell at the
/// point is over a bound, whatever the mesh, if there are cells between them (docs/small-angles.md has the proof). A point in the
/// middle between the nearest of their directions, rounded, if they do.
std::optional<Point3> middle_of_gap(const Domain<3>& domain, std::uint32_t point, EntityRef a, EntityRef b,
                                    const AngleBounds& bounds, CountedTriangles counted = {});

/// What an entity is about a point of it: the directions to what is between these two points, which are one for a segment.
using Sector = std::array<Point3, 2>;
/// The same of what two entities are about the point v. @pre they share no segment at it
std::optional<Point3> middle_of_gap(const Point3& v, std::span<const Sector> a, std::span<const Sector> b,
                                    const AngleBounds& bounds);

/// entity_angle, but of corners that count.
template <int D>
double counted_angle(const Domain<D>& domain, EntityRef a, EntityRef b, CountedTriangles counted);

/// The angle of the half-planes from the line ab through c and through d, in degrees.
double dihedral_degrees(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Has the tetrahedron, at corner i, an edge that makes an angle below that with the face beside it? Then it is over a bound.
bool is_thin_at(const Simplex<3>& s, int i, const AngleBounds& bounds);

/// Does the direction from corner i to the point lead into the tetrahedron, or into its boundary? @pre positively oriented
bool has_direction(const Simplex<3>& s, int i, const Point3& point);

}  // namespace pgdr
