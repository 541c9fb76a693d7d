// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "space/bulk.hpp"

namespace pgdr::detail {

/// The items at point v, in their order, become at[begin[v]] ... at[begin[v + 1] - 1]; points_of(k): where item k lies.
template <class PointsOf>
void sort_by_points(std::size_t points, std::size_t items, const PointsOf& points_of, std::vector<std::uint32_t>& begin,
                    std::vector<std::uint32_t>& at) {
  begin.assign(points + 1, 0);
  for (std::uint32_t k = 0; k < items; ++k)
    for (const std::uint32_t v : points_of(k)) ++begin[v + 1];
  for (std::size_t v = 1; v <= points; ++v) begin[v] += begin[v - 1];
  at.resize(begin[points]);
  std::vector<std::uint32_t> next(begin);
  for (std::uint32_t k = 0; k < items; ++k)
    for (const std::uint32_t v : points_of(k)) at[next[v]++] = k;
}

/// The same by bulk loops: of no use if they were stopped.
template <class PointsOf>
void sort_by_points(std::size_t points, std::size_t items, const PointsOf& points_of, const Bulk& bulk,
                    std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& at) {
  const auto count = [](std::uint32_t& n) { return std::atomic_ref(n).fetch_add(1, std::memory_order_relaxed); };
  begin.assign(points + 1, 0);
  bulk.each(items, [&](std::size_t k) {
    for (const std::uint32_t v : points_of(static_cast<std::uint32_t>(k))) count(begin[v + 1]);
  });
  for (std::size_t v = 1; v <= points; ++v) begin[v] += begin[v - 1];
  at.resize(begin[points]);
  std::vector<std::uint32_t> next(begin);
  bulk.each(items, [&](std::size_t k) {
    for (const std::uint32_t v : points_of(static_cast<std::uint32_t>(k))) at[count(next[v])] = static_cast<std::uint32_t>(k);
  });
  bulk.each(points, [&](std::size_t v) { std::sort(at.begin() + begin[v], at.begin() + begin[v + 1]); });  // whoever came first
}

}  // namespace pgdr::detail
