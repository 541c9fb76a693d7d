// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact signs of orientation and in-sphere determinants, and the symbolic perturbation of the lifted heights.
// Four stages: a floating-point filter with a derived bound; exact arithmetic without allocation (integers of a few words
// where the points lie on a common lattice, else expansions); exact rationals (CGAL); and, for the perturbed functions
// alone, the perturbation. All functions are pure and may be called from any thread; rounding must be to nearest, without
// flush-to-zero. Coordinates must be finite, and may be of any magnitude.
#pragma once

#include <cstdint>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Sign of det[p1-p0; ...; pD-p0]: positive for a counter-clockwise triangle, for a tetrahedron whose fourth point sees
/// the first three clockwise ((0,0,0),(1,0,0),(0,1,0),(0,0,1) is positive). Swapping two points negates it; zero iff
/// the points lie in one line (plane).
template <int D>
Sign orient(const Simplex<D>& s);

/// orient<2>({a, b, c})
inline Sign orient2d(const Point2& a, const Point2& b, const Point2& c) { return orient<2>({a, b, c}); }
/// orient<3>({a, b, c, d})
inline Sign orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d) { return orient<3>({a, b, c, d}); }

/// Where p lies about the sphere through the corners of s: positive inside, zero on it, negative outside.
/// @pre orient(s) is positive (where it is negative, so is the answer).
template <int D>
Sign in_sphere(const Simplex<D>& s, const Point<D>& p);

/// in_sphere<2>({a, b, c}, p) where the plain evaluation decides, without a count; zero where it does not.
inline Sign in_circle_quickly(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
  // Differences 1u. Heights: squares 3u, sum 4u. Minors 4u. Product 9u, sum of three 11u, and what predicates.cpp says of
  // its filters: the 0.01, underflow, overflow. |bx cy| + |by cx| <= |b| |c| <= (hb + hc) / 2, so that the permanent is at
  // most the sum of the products of two heights.
  const double ax = a[0] - p[0], ay = a[1] - p[1], bx = b[0] - p[0], by = b[1] - p[1], cx = c[0] - p[0], cy = c[1] - p[1];
  const double ha = ax * ax + ay * ay, hb = bx * bx + by * by, hc = cx * cx + cy * cy;
  const double det = ha * (bx * cy - by * cx) + hb * (cx * ay - cy * ax) + hc * (ax * by - ay * bx);
  const double bound = 11.01 * 0x1p-53 * (ha * hb + hb * hc + hc * ha) + 0x1p-650;
  if (!(ha + hb + hc < 0x1p250)) return Sign::zero;
  return det > bound ? Sign::positive : det < -bound ? Sign::negative : Sign::zero;
}

/// As in_sphere, with the lifted height of every point v raised by an infinitesimal eps(v); eps decreases in the
/// lexicographic order of coordinates (the lexicographically first point has the largest). Never zero. The points of s
/// and p must be pairwise distinct. The Delaunay triangulation under this test is unique, whatever the order of
/// insertion.
/// @pre orient(s) is positive.
template <int D>
Sign in_sphere_perturbed(const Simplex<D>& s, const Point<D>& p);

/// In-circle of four points of one plane of space: the coordinate `axis` (0, 1, 2) is dropped, heights are |x|^2 of all
/// three coordinates (so the circle is that of the plane in space), with the same perturbation. Positive: p inside the
/// circumcircle of a, b, c. Never zero for pairwise distinct points. For exactly coplanar points this is
/// in_sphere_perturbed in their plane, ties included. Otherwise it is still the test of one regular triangulation of the
/// projected points (the heights depend on nothing but the point), so flips by it end; it differs from the circle by
/// about (distance from the plane) * (dropped coordinate), so keep the origin near where points are far off the plane.
/// @pre orient_projected(a, b, c, axis) is positive; the four points are (nearly) coplanar.
Sign in_circle_perturbed(const Point3& a, const Point3& b, const Point3& c, const Point3& p, int axis);

/// orient2d of the points without coordinate `axis`; the two kept axes in cyclic order ((axis+1)%3, (axis+2)%3).
Sign orient_projected(const Point3& a, const Point3& b, const Point3& c, int axis);

/// True iff the angle at v between the directions to a and b is (strictly) below 60 degrees. Exact.
template <int D>
bool angle_below_60(const Point<D>& v, const Point<D>& a, const Point<D>& b);
/// The same for 90 degrees.
template <int D>
bool angle_below_90(const Point<D>& v, const Point<D>& a, const Point<D>& b);

/// True iff c lies on the line through a and b (a != b). Exact.
template <int D>
bool collinear(const Point<D>& a, const Point<D>& b, const Point<D>& c);

/// Circumradius over shortest edge within the bound: r^2 <= bound^2 * l^2, one test for refiner and checker. Exact where the
/// filter cannot decide, so the order of corners does not matter. Infinite bounds hold; bounds that are NaN or not positive
/// don't, nor any finite one on a flat simplex.
template <int D>
bool radius_edge_within(const Simplex<D>& s, double bound);
/// The circumradius within the size: r^2 <= size^2, decided as radius_edge_within is.
template <int D>
bool circumradius_within(const Simplex<D>& s, double size);
/// |volume| (area in 2D) <= bound, exactly; bound >= 0.
template <int D>
bool measure_within(const Simplex<D>& s, double bound);
/// All six dihedral angles at least the one whose cosine is `largest_cosine`, decided exactly as the others are. So it is not by
/// a flat tetrahedron, unless largest_cosine >= 1, which is no bound. NaN holds for nothing.
bool dihedral_within(const Simplex<3>& s, double largest_cosine);
/// The cosine of so many degrees, rounded to the nearest double: the shortest decimal that stands for `degrees` is taken as it
/// is. NaN of what is not finite. Takes microseconds.
double claimed_cosine(double degrees);

/// How often each stage decided, per thread, since the thread began: summed by whoever owns the threads. `expansion` is
/// the second stage, `perturbed` counts ties on top of what found them (and the orientations that break them count, too).
struct PredicateCounts {
  std::uint64_t filter = 0;                                   ///< decided by the floating-point filter
  std::uint64_t expansion = 0;                                ///< by integers or expansions
  std::uint64_t exact = 0;                                    ///< by rationals
  std::uint64_t perturbed = 0;                                ///< ties that the perturbation broke
  PredicateCounts& operator+=(const PredicateCounts& o);      ///< adds each
  PredicateCounts operator-(const PredicateCounts& o) const;  ///< what came since o was read
};
PredicateCounts predicate_counts();  ///< of the calling thread

}  // namespace pgdr
