// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of this room. None decides what is right, only how far is looked.
#pragma once

#include <cstddef>

namespace pgdr::numbers {

/// Steps by which a point goes inwards, each half of the one before: all bits of a double, and some.
inline constexpr int most_halvings = 60;
/// Rounds over all points that are left, each of which begins only where the one before has changed something.
inline constexpr int most_rounds = 8;

/// Cells of a hull that grows: others are seldom filled (optimize/numbers.hpp). And between two looks for a filling, since each
/// takes as long as thousands of cells do: as many more as make this part of them.
inline constexpr std::size_t most_grown_cells = 60, growth_between_looks = 4;

}  // namespace pgdr::numbers
