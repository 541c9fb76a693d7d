// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of gift wrapping: how much is tried where a mesh is not locally Delaunay. bench/deciding_numbers.py makes meshes with
// half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pgdr::numbers {

/// Cells of a region that is filled anew: few where that is done for very many faces, and otherwise so many that what a filling
/// takes, which goes with their square, is still some hundredths of a second.
inline constexpr std::size_t quick_wrap_cells = 20, wide_wrap_cells = 512;
/// A region grows by one part in so many of itself before all of it is filled again: so all fillings together take at most
/// about twice the time of the last.
inline constexpr std::size_t least_wrap_growth = 2;
/// Gift wrapping goes on while what it did in vain is not more than an allowance and so many times what had an effect: it takes
/// at most one more than so many times the time that it is good for.
inline constexpr std::uint64_t wrap_effect_weight = 2;

}  // namespace pgdr::numbers
