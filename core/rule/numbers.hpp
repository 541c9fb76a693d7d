// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of points on segments that meet at small angles. The theory needs some such numbers, and lets them be what they are.
// bench/deciding_numbers.py makes meshes with half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

namespace pgdr::numbers {

/// A vertex is beside a subsegment if it is within this part of its length, as it is where segments meet at less than half a
/// degree. At larger angles, from about one degree, few points make most elements between the segments good, if they may go
/// where that takes the fewest (bench/notebook/small_angles.md).
inline constexpr double beside_subsegment = 0x1p-7;
/// The part of a piece that is left on either side of a place with a twin: no edge gets shorter than half of what a split in
/// the middle makes.
inline constexpr double least_part_at_twin = 0.25;
/// Twins are as far from their common end but for rounding and this part of their distance.
inline constexpr double twin_slack = 0x1p-6;
/// 2D: two points are as far from a common end if the squares of their distances differ by no more than this part. On shells
/// they differ by rounding, or by a factor of four and more.
inline constexpr double equally_far = 0.002;

}  // namespace pgdr::numbers
