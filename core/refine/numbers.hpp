// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the refinement that decide meshes and that no theory gives: what is looked at how far, and what is given up when.
// bench/deciding_numbers.py makes meshes with half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pgdr::numbers {

/// A point is distant if it is so many of the element's longest edges away: then the wall before it is looked for first. What
/// nearer points encroach upon is often a flat subfacet, whose split leaves fewer poor cells.
inline constexpr double distant_edges = 128;
/// A cavity of more cells ends at a face that is known to be refused. Beside small angles most elements that stay poor are
/// behind such a face, which is near to them; smaller cavities are collected to their ends, as there may be something else to
/// split. Where they end at once, elements of coarse nodes wait on in the uniform schedule, and ranks never cut their mesh.
inline constexpr std::size_t refused_face_cells = 128;
/// Degrees. Elements at a smaller angle get no last resort, which makes more of them poor than it repairs.
inline constexpr double sharp_degrees = 20;

/// Steps of a walk in a facet, and of one in a claim beside those in a cavity. A walk to a point across n triangles (cells)
/// takes some n steps, and where they are not Delaunay it can run in a circle: more than so many are no way to a point near by.
inline constexpr int facet_walk_steps = 1000;
inline constexpr std::size_t claim_walk_steps = 256;

/// Flips for each violation, so that those end that trade violations for others.
inline constexpr std::uint64_t flips_a_violation = 16;
/// What gift wrapping of large regions may do in vain in one visit, in cells times vertices: some seconds. Once entities have
/// been refused there need be no constrained Delaunay triangulation, and it is some hundredths of a second.
inline constexpr std::uint64_t wasted_wrap_work = 20'000'000, wasted_wrap_work_refused = 50'000;
/// A cell with so many corners inside of the volume is worth gift wrapping of a small region.
inline constexpr int inner_corners_to_wrap = 2;

/// The most qualities of cells that a treatment should ask for to treat one element.
inline constexpr std::uint64_t evaluations_a_poor_cell = 10'000;
/// The most that a change of the mesh may take, on the average: a visit ends its treatments once it has asked for more, and for
/// as many as one element may take. Where nearly all that is poor can be mended a change takes 100 to 800
/// (bench/notebook/needles.md).
inline constexpr std::uint64_t evaluations_a_change = 2000;

/// So many cells that are to come are as much work as one poor element that waits (bench/notebook/performance.md).
inline constexpr std::size_t cells_a_poor_element = 3;

}  // namespace pgdr::numbers
