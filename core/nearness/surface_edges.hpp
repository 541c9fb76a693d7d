// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The edges of a surface of triangles, with the triangles at each.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pgdr::checking {

class SurfaceEdges {
 public:
  using Corners = std::array<std::uint32_t, 3>;
  struct AtEdge {
    std::array<std::uint32_t, 2> ends;  ///< sorted
    std::uint32_t triangle, apex;
    friend auto operator<=>(const AtEdge&, const AtEdge&) = default;
  };

  /// @param take(t): is the triangle one of them?
  template <class Take>
  SurfaceEdges(std::span<const Corners> triangles, const Take& take) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3 && take(t); ++i) {
        const auto [a, b] = std::minmax(triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3]);
        uses_.push_back({{a, b}, t, triangles[t][i]});
      }
    std::sort(uses_.begin(), uses_.end());
  }

  /// Calls visit(uses) for each edge, with its triangles.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0, j; i < uses_.size(); i = j) {
      for (j = i + 1; j < uses_.size() && uses_[j].ends == uses_[i].ends;) ++j;
      visit(std::span(uses_).subspan(i, j - i));
    }
  }
  std::span<const AtEdge> at(std::uint32_t a, std::uint32_t b) const {
    const std::array<std::uint32_t, 2> ends{std::min(a, b), std::max(a, b)};
    const auto first = std::partition_point(uses_.begin(), uses_.end(), [&](const AtEdge& use) { return use.ends < ends; });
    const auto last = std::partition_point(first, uses_.end(), [&](const AtEdge& use) { return use.ends == ends; });
    return {first, last};
  }

 private:
  std::vector<AtEdge> uses_;
};

}  // namespace pgdr::checking
