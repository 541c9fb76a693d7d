// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of how the work is divided. They decide meshes, as they decide in which order points come, but not how good these
// are. bench/deciding_numbers.py makes meshes with half and with twice of each; bench/notebook/numbers.md has its tables.
#pragma once

#include <cstddef>

namespace pgdr::numbers {

/// Poor elements that wait in a leaf before it splits: so a visit takes some milliseconds. With half as many surfaces get up to
/// 9 % more cells, and the chain of visits that wait for each other is longer (bench/notebook/performance.md).
inline constexpr std::size_t crowded_leaf = 1000, crowded_leaf_2d = 2000;
/// The same of a window of the uniform schedule: with these a visit mostly meets no cell that reaches beyond its claim, which
/// grows by half the side of a leaf alone.
inline constexpr std::size_t crowded_window = 4000;

}  // namespace pgdr::numbers
