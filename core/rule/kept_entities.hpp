// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which entities are kept as they are: no point goes onto them (RefineOptions::keep_boundary).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr {

/// See above. A value; any thread may read it.
template <int D>
class KeptEntities {
 public:
  KeptEntities(const RefineOptions<D>& options, const Domain<D>& domain)
      : any_(options.keep_boundary), all_(options.kept_markers.empty()) {
    if (!any_ || all_) return;
    const auto is_named = [&](int marker) {
      return std::find(options.kept_markers.begin(), options.kept_markers.end(), marker) != options.kept_markers.end();
    };
    for (const DomainFacet& f : domain.facets()) facets_.push_back(is_named(f.marker));
    for (EntityId s = 0; s < domain.segments().size(); ++s) {
      const auto facets = domain.facets_of_segment(s);
      segments_.push_back(D == 2 ? is_named(domain.segments()[s].marker)
                                 : std::any_of(facets.begin(), facets.end(), [&](EntityId f) { return facets_[f] != 0; }));
    }
  }

  bool any() const { return any_; }  ///< may any be?
  /// Is the segment or facet kept? In 3D segments are with any kept facet that has them.
  bool has(EntityRef e) const {
    if (!any_ || (e.kind != EntityKind::segment && e.kind != EntityKind::facet)) return false;
    return all_ || (e.kind == EntityKind::segment ? segments_ : facets_)[e.id] != 0;
  }

 private:
  bool any_, all_;
  std::vector<std::uint8_t> facets_, segments_;
};

}  // namespace pgdr
