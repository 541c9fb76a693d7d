// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// First step of a Domain, its points: exact duplicates are one, and, only where the caller asks for it, points within a
// distance. Each point then goes to the nearest of those before it that are kept, if it is near enough: none moves by more than
// that distance, and what comes of a file depends on its order, but on nothing else.
#include <algorithm>
#include <cmath>

#include "input/domain_builder.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

constexpr double most_merge_within = 0.01;

template <int D>
Point<D> with_positive_zeros(Point<D> p) {
  for (double& x : p.x) x += 0.0;
  return p;
}

}  // namespace

template <int D>
std::size_t DomainBuilder<D>::attributes_per_point() const {
  const std::size_t n = plc_.points.size(), attributes = n == 0 ? 0 : plc_.point_attributes.size() / n;
  if (attributes * n != plc_.point_attributes.size())
    throw UsageError({Errc::bad_option,
                      std::to_string(plc_.point_attributes.size()) + " attributes for " + std::to_string(n) + " points",
                      plc_.source.file, 0, {}, {}});
  return attributes;
}

template <int D>
void DomainBuilder<D>::keep_point(std::uint32_t i, const Point<D>& p, std::size_t attributes) {
  out_.points_.push_back(p);
  out_.input_of_point_.push_back(i);
  out_.point_markers_.push_back(i < plc_.point_markers.size() ? plc_.point_markers[i] : 0);
  const auto first = plc_.point_attributes.begin() + static_cast<std::ptrdiff_t>(i * attributes);
  out_.point_attributes_.insert(out_.point_attributes_.end(), first, first + static_cast<std::ptrdiff_t>(attributes));
}

template <int D>
void DomainBuilder<D>::merge_points() {
  if (!(plc_.merge_within >= 0 && plc_.merge_within <= most_merge_within))
    throw UsageError({Errc::bad_option, "points are merged within a distance from 0 to 0.01 times the largest coordinate",
                      plc_.source.file, 0, {}, {}});
  const std::size_t n = plc_.points.size(), attributes = attributes_per_point();
  const bool near = plc_.merge_within > 0;
  const auto [scale, largest] = detail::scale_of<D>(plc_.points);
  detail::PointPlaces places(n);
  detail::PointGrid<D> grid(near ? n : 0, scale, std::max(plc_.merge_within * largest, 0x1p-200));
  out_.points_.reserve(n);
  out_.point_of_input_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Point<D> p = with_positive_zeros(plc_.points[i]);
    if (std::any_of(p.x.begin(), p.x.end(), [](double x) { return x == 0; }))
      if (std::any_of(plc_.points[i].x.begin(), plc_.points[i].x.end(), [](double x) { return x == 0 && std::signbit(x); }))
        negative_zeros_.add([&] { return std::to_string(number(i)); }, {number(i)});
    const std::size_t hash = detail::hash_of(p);
    std::uint32_t at = places.find(hash, [&](std::uint32_t v) { return out_.points_[v] == p; });
    const bool repeated = at != no_entity;
    if (!repeated && near) at = grid.nearest(p, out_.points_);
    if (at == no_entity) {
      at = static_cast<std::uint32_t>(out_.points_.size());
      keep_point(i, p, attributes);
      places.insert(hash, at);
      if (near) grid.insert(p, at);
    } else {
      const std::int64_t first = point_number(at);
      const auto words = [&] { return std::to_string(number(i)) + " = " + std::to_string(first); };
      (repeated ? merged_ : merged_near_).add(words, {number(i), first});
    }
    out_.point_of_input_[i] = at;
  }
  for (const Point<D>& p : plc_.holes) out_.holes_.push_back(with_positive_zeros(p));
  for (RegionSeed<D> r : plc_.regions) {
    r.point = with_positive_zeros(r.point);
    out_.regions_.push_back(r);
  }
}

#define PGDR_INSTANTIATE(D)                                                                   \
  template std::size_t DomainBuilder<D>::attributes_per_point() const;                        \
  template void DomainBuilder<D>::keep_point(std::uint32_t, const Point<D>&, std::size_t);    \
  template void DomainBuilder<D>::merge_points();
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
