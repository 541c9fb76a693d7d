// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact tests with tolerances: distances in ulps, order along a line, whether rounding explains an in-sphere sign. The checker
// asks them, and the diagnosis, which wall comes first. Each is decided by a filter in extended precision, then by rationals.
// Pure functions, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "numbers/rounding.hpp"
#include "pgdr/types.hpp"

namespace pgdr::checking {

/// k ulps of an entity: k * 2^-52 * the largest |coordinate| of its points.
struct Tolerance {
  int ulps = 0;
  double magnitude = 0;
  double width() const { return ulps * (magnitude * rounding::ulp); }
};

/// Distance of x from the line through p and q at most the tolerance. @pre p != q.
template <int D>
bool near_line(const Point<D>& p, const Point<D>& q, const Point<D>& x, const Tolerance& tolerance);

/// Distance of x from the plane of the triangle at most the tolerance. @pre not collinear.
bool near_plane(const std::array<Point3, 3>& triangle, const Point3& x, const Tolerance& tolerance);

/// Distances in doubles, for messages.
template <int D>
double distance_from_line(const Point<D>& p, const Point<D>& q, const Point<D>& x);
double distance_from_plane(const std::array<Point3, 3>& triangle, const Point3& x);

/// (y - x) . (q - p) > 0
template <int D>
bool advances(const Point<D>& p, const Point<D>& q, const Point<D>& x, const Point<D>& y);

/// The dihedral angle between the half-planes from the line ab through c and d is less than 90 degrees.
bool dihedral_below_90(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// True iff |det| of in_sphere(s, p) is at most the change that moving each point i (the corners, then p) by at most
/// `delta[i]` in each coordinate can make: then the points may stand for a configuration that is Delaunay.
template <int D>
bool rounding_cancels(const Simplex<D>& s, const Point<D>& p, const std::array<double, D + 2>& delta);

/// Is an edge (2D: or a height) at most 8 ulps of `largest` long, the largest coordinate of all? Where input points are so near
/// to others, or to segments, few places are left for points between, and poor cells stay.
template <int D>
bool is_as_short_as_rounding(const Simplex<D>& s, double largest);

/// The order in which the open segment from q to p crosses the given simplices of dimension D - 1; empty if two of them
/// are crossed at the same point. @pre q lies strictly on one side of each, p on the other.
template <int D>
std::vector<std::uint32_t> order_along(const Point<D>& q, const Point<D>& p,
                                       const std::vector<std::array<Point<D>, D>>& simplices);

}  // namespace pgdr::checking
