// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/mesh_join.hpp"

#include <utility>

#include "weld/joining.hpp"

namespace pgdr {

template <int D>
JoinedMesh<D> join_meshes(std::span<const OutputMesh<D>* const> meshes, const JoinOptions& options) {
  const auto refuse = [](const char* what) { throw UsageError({.code = Errc::bad_option, .message = what}); };
  if (meshes.empty()) refuse("there is no mesh to join");
  if (!options.names.empty() && options.names.size() != meshes.size()) refuse("there is not one name for each mesh");
  detail::Joining<D> joining{meshes, &options, detail::StopCheck(options.stop), {}, {}, {}};
  detail::join_cells(joining);
  detail::join_faces(joining);
  detail::find_near_points(joining);
  detail::compare_boundaries(joining);
  joining.refusals.throw_any(joining.out.warnings);
  detail::join_constraints(joining);
  detail::join_data(joining);
  return std::move(joining.out);
}

template PGDR_API JoinedMesh<2> join_meshes<2>(std::span<const OutputMesh<2>* const>, const JoinOptions&);
template PGDR_API JoinedMesh<3> join_meshes<3>(std::span<const OutputMesh<3>* const>, const JoinOptions&);

}  // namespace pgdr
