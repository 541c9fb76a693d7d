// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/cells_ahead.hpp"

#include "pgdr/error.hpp"
#include "pgdr/estimate.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

template <int D>
EstimateOptions<D> estimate_options(const RefineOptions<D>& options, const std::stop_token& stop) {
  return {.narrowest = {},
          .voids_by_nesting = options.regions == RegionMode::automatic,
          .radius_edge_bound = options.radius_edge_bound,
          .measure = {},
          .stop = stop};
}

}  // namespace

template <int D>
void guard_memory(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop) {
  const bool has_fewer = options.max_vertices < RefineOptions<D>().max_vertices || options.min_edge > 0 || options.keep_boundary;
  if (!options.refine || !options.memory_guard || has_fewer || options.time_limit) return;
  require_memory<D>(domain, estimate_options(options, stop));
}

template <int D>
double estimate_in_run(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop,
                       const Pieces& pieces) {
  const PiecesHere here(pieces);
  try {
    return estimate_cells<D>(domain, estimate_options(options, stop)).cells;
  } catch (const CancelledError&) {
    return 0;
  }
}

template void guard_memory<2>(const Domain<2>&, const RefineOptions<2>&, const std::stop_token&);
template void guard_memory<3>(const Domain<3>&, const RefineOptions<3>&, const std::stop_token&);
template double estimate_in_run<2>(const Domain<2>&, const RefineOptions<2>&, const std::stop_token&, const Pieces&);
template double estimate_in_run<3>(const Domain<3>&, const RefineOptions<3>&, const std::stop_token&, const Pieces&);

}  // namespace pgdr::detail
