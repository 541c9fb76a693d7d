// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Tolerances for rounding, each with the reason for its size. Where a sign decides there are none: those are exact
// (predicates.hpp). These say which values in doubles count as equal, how far a rounded point may be off its place, and by how
// much a bound in doubles is widened so that it holds. u is the unit roundoff, 2^-53.
#pragma once

namespace pgdr::rounding {

/// The distance between doubles from 1 to 2. A number that is rounded once is off by half of it, times itself, at most.
inline constexpr double ulp = 0x1p-52;

// Relative, to be taken times a value or the sum of the absolute values of its terms.

/// The error of a sum of products of differences: two differences, two products and their sum in the plane, one product and two
/// sums more in space are seven roundings of u each; eight cover the rounding of the sum of absolute values, too.
inline constexpr double of_determinant = 8 * 0x1p-53;
/// The error of a sum of products in each of which a coordinate of a box, or of a point, is taken times one of a direction: up to
/// six such products and their sums are 12 roundings, the sum of absolute values, of up to 30 terms, as many again; 64 u.
inline constexpr double of_separation = 64 * 0x1p-53;
/// By so much a squared distance to a box, a depth, or a radius is made smaller or larger where it only tells what need not be
/// looked at: such a value has some 30 roundings at most, 2^-48. The rest is for what they are compared with.
inline constexpr double of_pruning = 0x1p-40;
/// The error of a computed circumcentre, relative to its distance from the first corner, above which it is computed anew in more
/// digits. Not derived: the error goes with the centre, and widens the doubt of what is decided by it.
inline constexpr double of_circumcenter = 0x1p-20;
/// The checker widens radii by this where it looks for the entity that a poor cell is blamed on: the radius of a ball in doubles
/// is off by a few u, plus the error of the centre, which is added apart.
inline constexpr double of_blame_checked = 0x1p-30;
/// The refiner narrows squared radii by this where it blames an entity: what it finds is within the checker's reach whatever both
/// round.
inline constexpr double of_blame = 0x1p-20;

// Absolute, to be taken times the largest coordinate of the points in question.

/// How far a point of a segment may be off its place. It is computed in double-double and rounded once, which is half an ulp a
/// coordinate, sqrt(3)/2 in space; its distance from an end, in doubles, is off by two ulps more at most.
inline constexpr double of_point = 4 * ulp;
/// How far points of one plane are off it once they were turned and shifted: each coordinate is a sum of three products and a
/// shift, six roundings of numbers of at most sqrt(3) times the largest, which is 5.2 ulps a coordinate and 9 along the normal.
/// The plane itself is that of such points, what is farther off is a bent facet (input/bent_facets.hpp).
inline constexpr double of_plane = 16 * ulp;
/// Above this a facet is more than rounding off its plane, that of its largest triangle, which may be much smaller than the
/// facet: not derived, sixteen times of_plane.
inline constexpr double of_large_plane = 16 * of_plane;
/// A triangle of less height above an edge is not to be split there: a point of the edge that is off by 2^-50 would turn it by
/// more than 2^-14, 0.0035 degrees.
inline constexpr double of_fragile_height = 0x1p-36;

}  // namespace pgdr::rounding
