// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The facets of the convex hull of points in space. Exact; a pure function, any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Each as its corners, counterclockwise seen from outside, the least first; by these. No two lie in one plane, and no corner of
/// one lies between two others. Empty if all points lie in one plane. Expected time n log n.
/// @param candidates  indices of points, of distinct places
std::vector<std::vector<std::uint32_t>> facets_of_hull(std::span<const Point3> points, std::vector<std::uint32_t> candidates);

}  // namespace pgdr::detail
