// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The segments of a Domain: every edge that is not soft. An edge of a polygon that no triangle has (outside of its facet, or in a
// hole of it) is a segment, too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/edge_uses.hpp"
#include "join/explicit_segments.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

/// The members of a Domain that speak of segments.
struct MaximalSegments {
  std::vector<DomainSegment> segments;
  std::vector<std::uint32_t> origins_begin;  ///< of each segment, and one more: into `origins`
  std::vector<SegmentOrigin> origins;
  std::vector<EntityId> of_facets;          ///< the segments of each facet, facet by facet
  std::vector<std::uint32_t> facets_begin;  ///< of each segment, and one more: into `facets`
  std::vector<EntityId> facets;             ///< that have the segment
};

/// `soft`: by position in `uses`, at the first use of each edge. `group_of`: the Domain's facet of each triangulated one. Sets
/// which segments the facets have.
template <int D>
MaximalSegments make_maximal_segments(const BuildInput<D>& in, const EdgeUses& uses, const std::vector<bool>& soft,
                                      const ExplicitSegments<D>& segments, std::span<const EntityId> group_of,
                                      std::span<DomainFacet> facets, BuildReport<D>& report);

}  // namespace pgdr::detail
