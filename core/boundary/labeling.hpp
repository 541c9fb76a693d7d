// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Carving: the exterior and the holes are taken out of the mesh, and regions get their numbers.
#pragma once

#include <vector>

#include "cavity/delaunay.hpp"
#include "diagnose/islands.hpp"
#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/region_mode.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// The regions of the mesh.
struct RegionTable {
  std::vector<double> attribute{0.0};  ///< by region number; 0 is what no seed labels
  std::vector<double> measure;         ///< bound of each region, infinity for none; empty if no region has one
  bool labelled = false;               ///< cells have labels: the input has region seeds, or volumes are numbered
};

/// Floods the cells through unconstrained faces: what reaches the ghosts is outside, what a hole seed reaches is a hole,
/// and so is what `mode` makes void. `islands`: as `delaunay` has them; seeds are looked for in these. Frees these cells and all
/// ghosts; the faces left open have no link. `pieces` run the passes over all cells; the result does not depend on them.
/// @throws InputError encloses_nothing (with the open boundaries of the input), seed_on_boundary, conflicting_seeds;
///   ResourceError ids_exhausted. `warnings` gets seeds that lie outside, and region seeds in holes.
template <int D>
RegionTable carve(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Delaunay<D>& delaunay, const Domain<D>& domain,
                  RegionMode mode, std::vector<Diagnostic>& warnings, const detail::Pieces& pieces = detail::OneByOne(),
                  const detail::Islands& islands = {});

}  // namespace pgdr
