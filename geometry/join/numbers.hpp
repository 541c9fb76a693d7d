// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of what is joined. bench/deciding_numbers.py makes meshes with half and with twice of each; bench/notebook/numbers.md
// has its tables.
#pragma once

#include <cstddef>

namespace pgdr::numbers {

/// Points of a group whose distances are all computed, 32,640 of them. The width of a larger group is taken from its extent
/// along each axis, which may be less by a factor of the square root of the dimension.
inline constexpr std::size_t most_compared = 256;

/// Of its extent, what a polygon may be off its plane, as files with few digits leave it; what is bent by more is several facets.
/// TetGen takes triangles for coplanar that meet at up to 0.1 degrees, about 1.7e-3 of their extent.
inline constexpr double most_bend = 1e-4;

}  // namespace pgdr::numbers
