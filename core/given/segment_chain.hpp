// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::checking {

/// An edge of a mesh near a segment: its ends, and where they lie.
template <int D>
struct NearEdge {
  std::array<std::uint32_t, 2> ends;
  std::array<Point<D>, 2> at;
};

/// The edges of the chain from one end of the segment to the other, never back, that has the least area between it and the
/// segment, by their places in `edges`. Near one end of a segment that meets another one at a small angle edges of both are
/// within any reach; only its own lead to its other end, or lead there straight. Empty if no chain does: what lies between is not
/// all there.
template <int D>
std::vector<std::uint32_t> segment_chain(std::span<const NearEdge<D>> edges, const std::array<std::uint32_t, 2>& ends,
                                         const std::array<Point<D>, 2>& at);

}  // namespace pgdr::checking
