// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of a change that could be made: is the surface still within the tolerance of the given one, does it meet itself nowhere,
// and is everything on the side that it was on? The proofs are in docs/surface.md. Nothing is remembered of which given triangle
// a face stands for: the surface as it is is all that counts. Any number of threads may ask at once while nothing changes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "replace/change.hpp"
#include "replace/complex.hpp"
#include "replace/given_surface.hpp"
#include "space/changing_boxes.hpp"

namespace pgdr::detail {

/// A surface that changes, with what it is compared with.
struct ChangingSurface {
  SurfaceComplex complex;
  LoosePieces loose;
  std::vector<Point3> seeds;  ///< of holes and regions
  GivenSurface given;
  ChangingBoxes boxes;  ///< of the faces
  ChangingSurface(SurfaceComplex s, LoosePieces pieces, std::vector<Point3> points);
};

/// Curves stay within e of the given ones, both ways, curve by curve.
bool keeps_curves(const ChangingSurface& s, const SurfaceChange& change, double e);
/// Every new face is within e of the given triangles of its class, and every given triangle within e of faces of its class
/// afterwards, if it is so now.
bool keeps_distance(const ChangingSurface& s, const SurfaceChange& change, double e);

/// New faces meet others, and each other, in common corners and edges alone (exact), and none is flat or next to it.
bool meets_nothing(const ChangingSurface& s, const SurfaceChange& change);
/// No gap is narrower than that which was not.
bool keeps_gaps(const ChangingSurface& s, const SurfaceChange& change, double least);
/// Nothing that stays is passed over.
bool sweeps_nothing(const ChangingSurface& s, const SurfaceChange& change);
/// The new vertex is not so far from the faces that go.
bool is_place_near(const ChangingSurface& s, const SurfaceChange& change, double most);
/// A split: its point is not in a wedge between two sides of the surface.
bool avoids_wedges(const ChangingSurface& s, const SurfaceChange& change);

}  // namespace pgdr::detail
