// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of a run: what the optimiser may take, and which facets rounding may fold. bench/deciding_numbers.py makes meshes with
// half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstdint>

namespace pgdr::numbers {

/// The budget of the optimiser: so many evaluations for each cell of the mesh, which take about as long as its refinement; and
/// at least so many, about a second (bench/notebook/needles.md).
inline constexpr std::uint64_t evaluations_a_cell = 40, least_evaluations = 6'000'000;
/// It is so many tenths more for each degree that the target is above the default (docs/quality.md has what comes of it).
inline constexpr std::uint64_t more_tenths_a_degree = 3;
/// What is tried for a cell that nothing excuses may take so many times as many evaluations as one look at it.
inline constexpr std::uint64_t looks_at_an_unexplained_cell = 10;

// A mesh is looked through for facets that fold over where a facet is bent by more than rounding, or rounding could move one
// across another. So a fold is refused before anything is refined; one that is missed here fails `check`. Points on facets are
// rounded once, to half an ulp, 2^-53 of the largest coordinate, in each coordinate.

/// Of the largest coordinate: a facet that is bent by more has its bend from the input; 2^13 roundings of a point.
inline constexpr double bent_beyond_rounding = 0x1p-40;
/// Of the length of a segment: its pieces together are no shorter than it but for so much, which rounding takes.
inline constexpr double lost_of_segment = 0x1p-30;
/// Of the largest coordinate: longer segments no rounding folds over; 2^6 times the bend of a facet that is not looked at
/// above.
inline constexpr double foldable_length = 0x1p-34;
/// Degrees: at larger angles no rounding folds facets over that are not thin themselves.
inline constexpr double foldable_degrees = 1e-6;

}  // namespace pgdr::numbers
