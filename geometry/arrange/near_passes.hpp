// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where edges pass each other within the tolerance, and neither has a point there: what a Domain refuses by name. A point between
// them is within the tolerance of both, so that both go through it in the next Domain. Pure function, any thread.
#pragma once

#include <span>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// A point for each such pair of edges, distinct, in lexicographic order.
std::vector<Point3> points_at_near_passes(std::span<const Diagnostic> refused);

}  // namespace pgdr::detail
