// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points of an input its tolerance has joined with something that they miss. A facet (2D: segment) with such a point is
// another one than was given.
#pragma once

#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {

/// By what a Domain has repaired. A value; any number of threads may ask it.
template <int D>
class JoinedPoints {
 public:
  explicit JoinedPoints(const Domain<D>& domain)
      : first_(domain.first_index()), number_(domain.point_of_input().begin(), domain.point_of_input().end()) {
    const std::size_t given = number_.size();
    with_any_.resize(domain.points().size());
    on_facet_.resize(D == 3 ? with_any_.size() : 0);
    for (std::uint32_t v = 0; v < with_any_.size(); ++v) {
      const std::uint32_t input = domain.input_of_point()[v];
      if (input < given) continue;
      with_any_[v] = true;
      if (input == no_entity) continue;
      if (number_.size() <= input) number_.resize(input + std::size_t{1}, no_entity);
      number_[input] = v;
    }
    for (const Diagnostic& repair : domain.repairs()) take(domain, repair);
  }

  /// Is the point one of several, on an edge that it misses, or no point of the input?
  bool with_point_or_edge(std::uint32_t v) const { return with_any_[v]; }
  /// 3D: was the point put on a facet? It misses that only if the facet is not planar.
  bool with_facet(std::uint32_t v) const { return on_facet_[v]; }

 private:
  void take(const Domain<D>& domain, const Diagnostic& repair) {
    const auto point = [&](std::size_t i) { return number_[static_cast<std::size_t>(repair.ids[i] - first_)]; };
    const std::size_t count = repair.ids.size();
    if (repair.code == Errc::near_points) {
      for (std::size_t i = 1; i < count; i += 2) with_any_[point(i)] = true;
    } else if (repair.code == Errc::point_on_segment) {
      const auto p = domain.points();
      for (std::size_t i = 2; i < count; i += 3) {
        const std::uint32_t v = point(i - 2);
        if (!collinear<D>(p[v], p[point(i - 1)], p[point(i)])) with_any_[v] = true;
      }
    } else if (repair.code == Errc::point_on_facet) {
      for (std::size_t i = 1; i < count; i += 2) on_facet_[point(i - 1)] = true;
    }
  }

  std::int64_t first_;
  std::vector<std::uint32_t> number_;  // the point of each that the input has, and of those behind them that were added
  std::vector<bool> with_any_, on_facet_;
};

}  // namespace pgdr::detail
