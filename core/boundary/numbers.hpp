// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the recovery that decide meshes, or which inputs are refused, and that no theory gives. bench/deciding_numbers.py
// makes meshes with half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstdint>

namespace pgdr::numbers {

// Early splits (recovery.hpp says what for).

/// A facet has none if a segment of it makes less than 20 degrees with another one: so the square of the cosine is above this.
/// With less, or none, rotor, anchor and spool are not recovered (bench/notebook/tangles.md).
inline constexpr double early_split_squared_cosine = 0.8830222215594890;
/// They are of triangles whose ratio is above so many times the bound, or the least that is proved if that is more. What is
/// nearly within it is left to the refinement, which splits in the order that makes few points.
inline constexpr double early_split_slack = 2;

// Recovery by Steiner points need not end where facets meet at small angles or nearly touch. (Between two faces 1e-9 apart 1.85
// times as many triangles are missing round by round. In a terrain with facets at a tenth of a degree it is twice as many
// segments, until there are 300 points for one of the input, and soon a third from there on.) So there are budgets of points,
// past which an input is refused. Larger ones take longer to say no; smaller ones refuse what could be meshed: a terrain of 725
// points takes some thousand more than the 272,500 that it would have without its hump.

/// Points of missing pieces: for any input, and for each point of it.
inline constexpr std::uint64_t missing_points = 200'000, missing_points_a_point = 100;
/// For the hump of terrains: for each point of the input, and at most so many of these.
inline constexpr std::uint64_t hump_points_a_point = 300, most_hump_points = 1'500'000;
/// In addition, while less is missing than was before: such a recovery is going to end. And in so many rounds at most of these,
/// lest that be by ever smaller steps.
inline constexpr std::uint64_t falling_points = 5'000'000, falling_rounds = 2000;
/// Points of pieces that went missing since triangles are split early: for any input, for each point of it, and for each point
/// of an early split.
inline constexpr std::uint64_t early_missing_points = 20'000, early_missing_points_a_point = 10, early_missing_points_a_split = 4;

}  // namespace pgdr::numbers
