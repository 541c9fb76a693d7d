// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run does beside all others where the boundary is kept (3D): every edge is a segment, and the points of the recovery are
// taken off again.
#pragma once

#include <functional>
#include <stop_token>

#include "mesh/mesh.hpp"
#include "pgdr/refine.hpp"
#include "rule/kept_entities.hpp"

namespace pgdr::detail {

/// Runs on the input whose kept edges are segments. These have no number in the input: so what is wrong with it is said of it as
/// it was given.
RefineResult<3> with_kept_input(const Plc<3>& plc, const RefineOptions<3>& options,
                                const std::function<RefineResult<3>(const Plc<3>&)>& run);

/// Takes the points of the recovery off what is kept, and counts. Is the mesh constrained Delaunay still?
void keep_boundary(Mesh<3>& mesh, Mesh<3>::Pools& pools, const Domain<3>& domain, const RefineOptions<3>& options,
                   const std::stop_token& stop, RefineResult<3>& result);

/// Of the finished mesh: the points on what was kept that are none of the input, as the optimiser may have taken some off, too.
std::uint64_t count_boundary_points(const Mesh<3>& mesh, const KeptEntities<3>& kept);

}  // namespace pgdr::detail
