// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/sharp_places.hpp"

#include <algorithm>
#include <utility>

namespace pgdr {
namespace {

/// Do two of the facet's segments make a corner that is too sharp?
bool has_sharp_corner(const Domain<3>& domain, EntityId facet, const AngleBounds& bounds) {
  std::vector<std::pair<std::uint32_t, EntityId>> at;  // segments by their ends
  for (const EntityId s : domain.facet_segments(facet))
    for (const std::uint32_t p : domain.segments()[s].points) at.push_back({p, s});
  std::sort(at.begin(), at.end());
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = i + 1; j < at.size() && at[j].first == at[i].first; ++j)
      if (is_sharp_corner(domain, at[i].first, at[i].second, at[j].second, bounds)) return true;
  return false;
}

bool has_sharp_wedge(const Domain<3>& domain, EntityId segment, const AngleBounds& bounds) {
  const auto facets = domain.facets_of_segment(segment);
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (meet_too_sharply(domain, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[j]}, bounds)) return true;
  return false;
}

}  // namespace

SharpPlaces::SharpPlaces(const Domain<3>& domain, const AngleBounds& bounds)
    : domain_(&domain), points_(domain.points().size()), segments_(domain.segments().size()), facets_(domain.facets().size()) {
  for (EntityId f = 0; f < facets_.size(); ++f) {
    facets_[f] = has_sharp_corner(domain, f, bounds);
    if (!facets_[f]) continue;
    for (const EntityId s : domain.facet_segments(f))
      for (const std::uint32_t p : domain.segments()[s].points) points_[p] = true;
  }
  for (EntityId s = 0; s < segments_.size(); ++s) {
    segments_[s] = has_sharp_wedge(domain, s, bounds);
    if (!segments_[s]) continue;
    for (const std::uint32_t p : domain.segments()[s].points) points_[p] = true;
  }
}

bool SharpPlaces::touches(Home home) const {
  switch (home.kind()) {
    case EntityKind::vertex: return points_[home.id()];
    case EntityKind::facet: return facets_[home.id()];
    case EntityKind::volume: return false;
    case EntityKind::segment: break;
  }
  const auto facets = domain_->facets_of_segment(home.id());
  return segments_[home.id()] || std::any_of(facets.begin(), facets.end(), [this](EntityId f) { return facets_[f]; });
}

}  // namespace pgdr
