// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// Places of points in the order of their coordinates; those with equal coordinates share one.
template <int D>
std::vector<std::uint32_t> point_ranks(std::span<const Point<D>> points, const Bulk& bulk) {
  std::vector<std::uint32_t> order(points.size()), rank(points.size());
  std::iota(order.begin(), order.end(), 0u);
  bulk.sort(order, [&](std::uint32_t a, std::uint32_t b) { return lex_less(points[a], points[b]); });
  for (std::size_t i = 1; i < order.size(); ++i)
    rank[order[i]] = rank[order[i - 1]] + (lex_less(points[order[i - 1]], points[order[i]]) ? 1 : 0);
  return rank;
}

}  // namespace pgdr::detail
