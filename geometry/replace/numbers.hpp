// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the search for another surface, E the tolerance. They decide which surface it is, never whether it is within E.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pgdr::numbers {

/// Of E, what the step uses, 63/64: so that whoever certifies the result at E ends quickly (a piece of which all is within 63/64
/// E is decided at a radius of E/64 at the latest), and rounding has room.
inline constexpr double used_part = 0.984375;

/// An E has to be that many times the tolerance within which things meet, so that both are not about the same thing.
inline constexpr double least_of_tolerance = 16;

/// Of E: a triangle that is not higher over an edge is a needle there, and its normal says nothing of the shape. Without it one
/// noisy scan has 2,972 edges of creases in place of some hundred.
inline constexpr double real_height = 0.25;
/// Needles side by side, across which the first triangle that is none is looked for.
inline constexpr int needles_crossed = 8;
/// Of E: creases that hang together in a smaller box are noise; E is the scale below which shape is not meant (203 creases of
/// one scan become 117, 1,210 of another 114).
inline constexpr double least_creases = 30;
/// Of E: a vertex of a curve is a corner if both of its edges are longer.
inline constexpr double corner_edges = 0.5;

/// Of the diagonal of all points: faces whose corners are as near to a plane are one flat group. A file of six digits is noise of
/// that size. At most half of E, as a polygon can be triangulated in several ways.
inline constexpr double flat_part = 1e-6;
/// Of what a polygon may be bent to be one facet: corners of a group may be as far off the plane of its largest face. The
/// mesher's own triangles have other diagonals: of four corners its largest may be half as large.
inline constexpr double group_bend = 0.5;
/// Of that: as near to the plane of the group as given nobody has to look. Four corners that are so far off it on alternating
/// sides are four times as far off that of three of them.
inline constexpr double surely_flat = 0.25;
/// Of E: a flat group whose area over the diagonal of its box is larger may not be broken. Narrow ones are mostly chance, two
/// triangles of a curved face. None may be broken: 86 and 229 cells stay over a bound on two models; all may: 602 on one where
/// nothing had been poor; with this rule 0, 14 and 0.
inline constexpr double wide_group = 20;
/// Of what the corners of a polygon are off its plane: one whose outline comes as near to itself is handed on as triangles, since
/// points that are put onto its edges leave them by as much.
inline constexpr double outline_gap = 30;

/// Parts that are looked at for one question of coverage, and so many more a triangle: by the faces that come alone, and by more.
inline constexpr std::size_t first_parts = 60, first_parts_each = 4;
inline constexpr std::size_t more_parts = 300, more_parts_each = 10;

/// Degrees: corners between two kept edges may shrink to this. Without a rule creases are bent until they meet at 8 degrees.
inline constexpr double kept_corner = 29;
/// Degrees: corners beyond the rim of a patch may shrink to this; what is larger makes no poor cell by itself.
inline constexpr double rim_corner = 15;
/// Of the least corner of a patch: a split halves no corner along the path of longest edges, and may make one so small.
inline constexpr double split_corner = 0.45;
/// A cosine between normals: ridges that are less sharp may come.
inline constexpr double flat_enough = 0.75;
/// Radians: a face with a corner below the first is refused, or below the second and half of what was there.
inline constexpr double flat_corner = 1e-5, thin_corner = 2e-3;
/// Of E: gaps that are wider may become as narrow. Narrow gaps cost cells more than any needle.
inline constexpr double narrow_gap = 0.25;
/// Of E: a point that is farther from the patch makes a cone that stands off the surface.
inline constexpr double farthest_place = 4;
/// A new point has no other side of the surface as near as this part of the heights of the faces at its edge: a face whose plane
/// makes a cosine above the second with these, above or below the point (a cosine above the third). No edge of a curve is split
/// at which faces meet more sharply than the second. In a wedge of 1.4 degrees a new point lies 1/40 of its distance from the tip
/// off the other side, and meshing that costs more than what it cured.
inline constexpr double wedge_height = 0.5, wedge_cosine = 0.2, wedge_beyond = 0.7;

/// Cells that a mesh is expected to have for a corner of a facet: the first number, and the second for each unit of the corner's
/// cotangent, which is the length of a needle there over its width, up to the third. With 8 in the place of 32 the estimate is
/// less good, with 100 as with 32.
inline constexpr double cells_of_corner = 1, cells_of_width = 2, needle_cotangent = 32;
/// Of two equilateral triangles: what comes with a point on an edge. An edge of facets is a segment of the mesh, which gets one
/// if a vertex is in its diametral ball. Of 56 surfaces of ten models, of 400 to 12,000 triangles, meshes had a share of the
/// cells expected that was within 20 % (one standard deviation) of the mean of all; without the edges within 34 %. It is also
/// what a contraction wins once the corners about it are as good as before, and what it may cost until then. With 0 a ball of
/// needles at its poles keeps 1,174 triangles in the place of 88; without the rule the cells of one model rise by a fifth.
inline constexpr double cells_of_two_faces = 6 * (cells_of_corner + cells_of_width * 0.57735);
/// Of a cell, what expected cells are counted in.
inline constexpr double parts_of_cell = 1024;
/// Degrees: a counted corner that is smaller leaves cells over the usual bound of 15 degrees on dihedral angles.
inline constexpr double poor_corner = 14.5;
/// Such a cell weighs as much as so many others: chosen, not derived. Expected cells are worth less than a cell: meshes have a
/// third of them. Meshes have 0.11 of these poor ones, too (within 20 %, of eight models with needles and without narrow gaps).
inline constexpr std::int64_t poor_weight = 7;
/// Changes of one transaction: a cure takes 6 at the median, 13 at nine of ten. Longer ones walk on from needle to needle, over
/// all of a surface.
inline constexpr std::size_t most_in_transaction = 40;

/// Corners are compared by levels of so much: changes that make less of a difference are none.
inline constexpr double level_ratio = 1.01;
/// Faces along a path of longest edges that are asked for a split.
inline constexpr int most_path = 12;
/// Of E: shorter edges are not split, since what is that small is not meant.
inline constexpr double shortest_split = 2;

/// Changes that are judged in one round of improving, for each face that there is: what takes more is a surface most of which are
/// needles between curves, where each change makes its neighbours be tried again, in vain. Models of 1,000 to 75,000 triangles
/// take 10 to 60 in all rounds.
inline constexpr std::uint64_t effort = 40;

/// Of E, for the first changes: room must be left for splits, flips and moves, or nothing moves any more.
inline constexpr double first_part = 0.6;
/// Splits, for each face of the surface that has been coarsened: in the first round, in the second.
inline constexpr std::uint64_t first_splits = 6, second_splits = 3;

}  // namespace pgdr::numbers
