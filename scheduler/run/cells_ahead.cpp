// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/cells_ahead.hpp"

#include "pgdr/estimate.hpp"

namespace pgdr::detail {

template <int D>
void guard_memory(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop) {
  const bool has_fewer = options.max_vertices < RefineOptions<D>().max_vertices || options.min_edge > 0 || options.keep_boundary;
  if (!options.refine || !options.memory_guard || has_fewer || options.time_limit) return;
  require_memory<D>(domain, EstimateOptions<D>{.voids_by_nesting = options.regions == RegionMode::automatic,
                                               .radius_edge_bound = options.radius_edge_bound,
                                               .measure = {},
                                               .stop = stop});
}

template void guard_memory<2>(const Domain<2>&, const RefineOptions<2>&, const std::stop_token&);
template void guard_memory<3>(const Domain<3>&, const RefineOptions<3>&, const std::stop_token&);

}  // namespace pgdr::detail
