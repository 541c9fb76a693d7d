// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumspheres, diametral and equatorial balls, computed from the vertices in lexicographic order of coordinates, so
// that each is a function of the vertex set. Pure functions, any thread.
#pragma once

#include <span>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Circumsphere of a full-dimensional simplex. `center_error` bounds |computed centre - exact centre| (Euclidean);
/// infinity if the doubles could not even bound it. `squared_radius` is |center - lexicographically first corner|^2
/// of the computed centre. Where the plain evaluation is ill-conditioned (bound > 2^-20 of the radius) the centre is evaluated
/// in expansions or rationals and rounded; it is non-finite only if it overflows.
template <int D>
struct Circumsphere {
  Point<D> center;            ///< rounded; in units of the input
  double squared_radius = 0;  ///< of the ball about `center`; their squares
  double center_error = 0;    ///< bound on the distance of `center` from the exact centre
};

/// @pre the corners are affinely independent (exactly).
template <int D>
Circumsphere<D> circumsphere(const Simplex<D>& s);

/// Squared length of the shortest edge (rounded differences, canonical order of the two ends).
template <int D>
double shortest_edge_squared(const Simplex<D>& s);

/// Centroid, the same for every order of the vertices.
template <int D>
Point<D> centroid(const Simplex<D>& s);

/// Smallest ball through the two ends of an edge, or the three corners of a triangle in space (diametral, equatorial).
template <int D>
struct Ball {
  Point<D> center;            ///< in units of the input
  double squared_radius = 0;  ///< in their squares
};
/// The ball on which a-b is a diameter, rounded; the same whichever end is a.
template <int D>
Ball<D> diametral_ball(const Point<D>& a, const Point<D>& b);
/// The ball about the circumcentre of abc with its circumradius, rounded; the same in any order. @pre not on one line
Ball<3> equatorial_ball(const Point3& a, const Point3& b, const Point3& c);

/// x strictly inside the ball on which a-b is a diameter: (a-x).(b-x) < 0, exact.
template <int D>
bool in_diametral_ball(const Point<D>& a, const Point<D>& b, const Point<D>& x);
/// x strictly inside the equatorial ball of abc; decided from the rounded ball (deterministic, not exact).
bool in_equatorial_ball(const Ball<3>& ball, const Point3& x);

}  // namespace pgdr
