// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the geometry of the input. bench/deciding_numbers.py makes meshes with half and with twice of each;
// bench/notebook/numbers.md has its tables.
#pragma once

namespace pgdr::numbers {

/// A point is put onto a facet that is planar within the tolerance alone by projecting it to one of its triangles, and then to
/// that which it is in by then, so many times at most. It ends by itself but near an edge at which the triangles rise to each
/// other, where it can go to and fro; either side is as near.
inline constexpr int projections_onto_bent = 8;

}  // namespace pgdr::numbers
