// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/kept_boundary.hpp"

#include <utility>
#include <vector>

#include "kept/withdrawal.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/kept_edges.hpp"

namespace pgdr::detail {

RefineResult<3> with_kept_input(const Plc<3>& plc, const RefineOptions<3>& options,
                                const std::function<RefineResult<3>(const Plc<3>&)>& run) {
  try {
    return run(with_kept_edges(plc, options.kept_markers));
  } catch (const InputError&) {
    require_no_errors(Domain<3>(plc, options.stop), options.stop);
    throw;
  }
}

void keep_boundary(Mesh<3>& mesh, Mesh<3>::Pools& pools, const Domain<3>& domain, const RefineOptions<3>& options,
                   const std::stop_token& stop, RefineResult<3>& result) {
  const WithdrawalCounts counts = withdraw_points(mesh, pools, domain, KeptEntities<3>(options, domain), stop);
  RefineStatistics& s = result.statistics;
  s.segment_points -= counts.on_segments - counts.left_on_segments;
  s.facet_points -= counts.on_facets - counts.left_on_facets;
  s.boundary_points = counts.left_on_segments + counts.left_on_facets;
  s.inner_points = counts.inside;
  result.delaunay = s.boundary_points == counts.on_segments + counts.on_facets;
  result.violations_seen = !result.delaunay;
}

std::uint64_t count_boundary_points(const Mesh<3>& mesh, const KeptEntities<3>& kept) {
  std::vector<std::uint8_t> known(mesh.vertex_bound(), 0);
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i}))
      for (const VertexId v : mesh.cell(CellId{i}).vertices)
        if (!std::exchange(known[index(v)], 1) && kept.has(mesh.vertex(v).home.entity())) ++count;
  return count;
}

}  // namespace pgdr::detail
