// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/domain.hpp"

#include <algorithm>
#include <cmath>

#include "build/domain_builder.hpp"

namespace pgdr {
template <int D>
Domain<D>::Domain(const Plc<D>& plc, std::stop_token stop) {
  try {
    DomainBuilder<D>(plc, *this, stop).run();
  } catch (const InputError& first) {  // which names one culprit: find them all
    std::vector<Diagnostic> all;
    without_invalid(plc, all, std::move(stop));
    if (all.empty()) throw;
    throw InputError(first.diagnostic(), std::move(all));
  }
}

template <int D>
Domain<D> Domain<D>::without_invalid(const Plc<D>& plc, std::vector<Diagnostic>& refused, std::stop_token stop) {
  Domain<D> domain;
  DomainBuilder<D>(plc, domain, std::move(stop), &refused).run();
  return domain;
}

template <int D>
std::span<const TriangleOrigin> Domain<D>::triangle_origins(EntityId f) const {
  return std::span(triangle_origins_).subspan(facets_[f].first_triangle, facets_[f].triangle_count);
}

template <int D>
std::span<const SegmentOrigin> Domain<D>::segment_origins(EntityId s) const {
  const std::uint32_t begin = segment_origins_begin_[s];
  return std::span(segment_origins_).subspan(begin, segment_origins_begin_[s + 1] - begin);
}

template <int D>
std::span<const std::array<std::uint32_t, 3>> Domain<D>::triangles(EntityId f) const {
  return std::span(triangles_).subspan(facets_[f].first_triangle, facets_[f].triangle_count);
}

template <int D>
std::span<const std::uint32_t> Domain<D>::triangles_at(EntityId f, std::uint32_t point) const {
  const auto begin = triangles_at_.begin() + triangles_at_begin_[point],
             end = triangles_at_.begin() + triangles_at_begin_[point + 1];
  const std::uint32_t first = facets_[f].first_triangle, last = first + facets_[f].triangle_count;
  return {std::lower_bound(begin, end, first), std::lower_bound(begin, end, last)};
}

template <int D>
std::span<const EntityId> Domain<D>::facet_segments(EntityId f) const {
  return std::span(facet_segments_).subspan(facets_[f].first_segment, facets_[f].segment_count);
}

template <int D>
std::span<const std::uint32_t> Domain<D>::facet_points(EntityId f) const {
  return std::span(facet_points_).subspan(facets_[f].first_point, facets_[f].point_count);
}

template <int D>
bool Domain<D>::facets_touch(EntityId f, EntityId g) const {
  if (f == g) return true;
  auto few = facet_points(f), many = facet_points(g);
  if (few.size() > many.size()) std::swap(few, many);
  if (few.size() > few_points)
    return std::binary_search(touching_.begin(), touching_.end(), std::array{std::min(f, g), std::max(f, g)});
  return std::ranges::any_of(few, [&](std::uint32_t v) { return std::binary_search(many.begin(), many.end(), v); });
}

template <int D>
std::span<const EntityId> Domain<D>::facets_of_segment(EntityId s) const {
  const std::uint32_t begin = facets_of_segment_begin_[s];
  return std::span(facets_of_segment_).subspan(begin, facets_of_segment_begin_[s + 1] - begin);
}

template <int D>
double Domain<D>::segment_magnitude(EntityId s) const {
  double m = 0;
  for (const std::uint32_t v : segments_[s].points)
    for (const double x : points_[v].x) m = std::max(m, std::fabs(x));
  return m;
}

template class Domain<2>;
template class Domain<3>;

}  // namespace pgdr
