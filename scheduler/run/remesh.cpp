// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/remesh.hpp"

#include "pgdr/transfer.hpp"

namespace pgdr {

template <int D>
RefineResult<D> remesh(const OutputMesh<D>& mesh, const RefineOptions<D>& options, const RemeshInputOptions& how) {
  RemeshInputOptions kept = how;
  kept.keep_boundary = how.keep_boundary || options.keep_boundary;
  const WholeFacets<D> input = remesh_input<D>(mesh, kept);
  RefineResult<D> result = refine(input.plc, options);
  name_given_facets(input.facet_of_input, result.reasons);
  transfer_attributes<D>(mesh, result.mesh);
  return result;
}

template PGDR_API RefineResult<2> remesh<2>(const OutputMesh<2>&, const RefineOptions<2>&, const RemeshInputOptions&);
template PGDR_API RefineResult<3> remesh<3>(const OutputMesh<3>&, const RefineOptions<3>&, const RemeshInputOptions&);

}  // namespace pgdr
