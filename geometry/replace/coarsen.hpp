// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>

#include "replace/changer.hpp"

namespace pgdr::detail {

/// Contracts edges, shortest first, as long as the surfaces stay that near and no corner gets worse than the worst of its patch,
/// or than `floor`. Ends, since each takes a vertex away. @returns false if the token ended it
bool coarsen(Changer& changer, double distance, HalfTangent floor, const std::stop_token& stop);

/// What `improve` makes better.
enum class Improved : std::uint8_t {
  corners,            ///< those that are smaller than wanted
  corners_and_edges,  ///< then, where all are as wanted, also edges that will get points, without splits
};
/// Makes corners larger up to `wanted`, worst first: by contractions, flips, moves, and by at most so many splits. Ends: all but
/// splits put corners of higher levels in the place of those of a patch, which makes the multiset of levels smaller in the order
/// of Dershowitz and Manna, or they leave it and make fewer cells expect; splits are counted. @returns as above
bool improve(Changer& changer, double distance, HalfTangent wanted, std::uint64_t most_splits, Improved what,
             const std::stop_token& stop);

}  // namespace pgdr::detail
