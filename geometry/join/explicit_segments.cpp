// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/explicit_segments.hpp"

namespace pgdr::detail {

template <int D>
ExplicitSegments<D>::ExplicitSegments(const BuildInput<D>& in, BuildReport<D>& report) : in_(in) {
  const Plc<D>& plc = in.plc;
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    const auto [i, j] = plc.segments[s].points;
    const std::uint32_t a = in.point_of_input[i], b = in.point_of_input[j];
    ends_.push_back({a, b});
    if (a == b) drop("segment ", static_cast<std::uint32_t>(s), {i, j}, report);
  }
  if constexpr (D == 3) {
    take_line_facets(report);
    index_by_first();
  }
}

/// Reports a segment of which nothing is left: `kind` and `item` name it, `ends` are points of the input.
template <int D>
void ExplicitSegments<D>::drop(const char* kind, std::uint32_t item, std::array<std::uint32_t, 2> ends, BuildReport<D>& report) {
  const std::int64_t number = report.number(item);
  report.repairs.dropped_edges.add([&] { return kind + std::to_string(number); },
                                   {number, report.number(ends[0]), report.number(ends[1])});
}

template <int D>
void ExplicitSegments<D>::take_line_facets(BuildReport<D>& report) {
  for (std::uint32_t f = 0; f < in_.plc.facets.size(); ++f) {
    const auto& facet = in_.plc.facets[f];
    if (facet.polygons.size() != 1 || facet.polygons[0].size() != 2 || !facet.holes.empty()) continue;
    const std::uint32_t i = facet.polygons[0][0], j = facet.polygons[0][1];
    const std::uint32_t a = in_.point_of_input[i], b = in_.point_of_input[j];
    if (a == b) drop("facet ", f, {i, j}, report);
    ends_.push_back({a, b});
    line_facets_.push_back(f);
  }
}

template <int D>
void ExplicitSegments<D>::index_by_first() {
  from_begin_.assign(in_.points.size() + 1, 0);
  for (const auto& [a, b] : ends_) ++from_begin_[a + 1];
  for (std::size_t v = 1; v < from_begin_.size(); ++v) from_begin_[v] += from_begin_[v - 1];
  std::vector<std::uint32_t> next(from_begin_);
  from_.resize(ends_.size());
  for (std::uint32_t s = 0; s < ends_.size(); ++s) from_[next[ends_[s][0]]++] = s;
}

template class ExplicitSegments<2>;
template class ExplicitSegments<3>;

}  // namespace pgdr::detail
