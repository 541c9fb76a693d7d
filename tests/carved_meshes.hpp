// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A mesh before its refinement: triangulated, its boundary recovered, what lies outside carved away.
#pragma once

#include <chrono>
#include <vector>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "model_plcs.hpp"

namespace pgdr::test {

/// Makes the mesh, which is empty, that of the domain.
inline void carve_mesh(const Domain<3>& domain, Mesh<3>& mesh, Mesh<3>::Pools& pools) {
  Delaunay<3> delaunay(mesh, pools);
  delaunay.build(domain.points());
  RecoveryCounts counts;
  recover_boundary<3>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
  std::vector<Diagnostic> warnings;
  carve<3>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
}

struct Carved {
  Mesh<3> mesh;
  Mesh<3>::Pools pools = mesh.make_pools();

  explicit Carved(const Plc<3>& plc) { carve_mesh(Domain<3>(plc), mesh, pools); }
};

}  // namespace pgdr::test
