// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the optimiser: how far it looks. None decides what is accepted (judge.hpp), but for the last two.
// bench/deciding_numbers.py makes meshes with half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pgdr::numbers {

/// Rounds of cheap changes about what a detour or a split has made; and in the last phase, for cells that nothing excuses. Each
/// round begins only where the one before has changed something.
inline constexpr int rounds_of_compound = 3, rounds_in_rest = 10;
/// Cells round an edge that is split; a split makes twice as many, which all have to be measured.
inline constexpr std::size_t longest_split_ring = 60;
/// Cells of a polyhedron that is filled anew: others are seldom searched to the end. And cells that one search lays, those
/// taken back included, after which it takes the best so far.
inline constexpr std::size_t most_filling_cells = 24, most_filling_nodes = 3000;
/// Cells of a star whose vertex moves or goes: those of more are hubs of needles, where a move costs much and gains little.
inline constexpr std::size_t most_star_cells = 100;

// A move of a vertex.

/// Steps, and how often one is halved before the search ends.
inline constexpr int most_placement_rounds = 8, most_step_halvings = 7;
/// Of the whole, relatively: less is no gain.
inline constexpr double least_placement_gain = 1e-4;
/// Of a step, by the linear terms: a tenth of a level of quality. Less is not worth the evaluations.
inline constexpr double least_step_gain = 1e-3;
/// The cells that are at most so many times as good as the worst are looked at before one of them stops a step. It saves one or
/// two trials: from 1 to 2 the places are the same, and from 1.02 to 1.1 it takes the fewest evaluations.
inline constexpr double share_of_cells = 1.05;
/// Of a cell, its terms are looked at that are at most so many times its least.
inline constexpr double share_of_terms = 2;
/// A step is as good as the best one if it gains so much less, relatively; and it is taken after so many terms.
inline constexpr double balanced_step = 0.05;
inline constexpr int most_step_terms = 40;

// What is better.

/// Of the rise of the cosine, how large angles count (cell_quality.hpp): so that a target of 15 degrees bounds them by 162.
inline constexpr double of_large_angles = 0.7;
/// A cell counts one more for each so many levels, which are of a hundredth, that it is below the bounds: 1.01 to that power is
/// five.
inline constexpr int levels_a_weight = 162;

}  // namespace pgdr::numbers
