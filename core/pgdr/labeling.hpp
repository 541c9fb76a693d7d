// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is inside: the exterior and the holes are carved away, regions get their numbers. Serial.
#pragma once

#include <vector>

#include "pgdr/delaunay.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/mesh.hpp"

namespace pgdr {

struct RegionTable {
  std::vector<double> attribute{0.0};  ///< by region number; 0 is what no seed labels
  std::vector<double> measure;         ///< bound of each region, infinity for none; empty if no region has one
  bool labelled = false;               ///< the input has region seeds
};

/// Floods the cells through unconstrained faces: what reaches the ghosts is outside, what a hole seed reaches is a hole.
/// Frees these cells and all ghosts; the faces left open have no link.
/// @throws InputError encloses_nothing, seed_on_boundary, conflicting_seeds; `warnings` gets seeds that lie outside.
template <int D>
RegionTable carve(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Delaunay<D>& delaunay, const Domain<D>& domain,
                  std::vector<Diagnostic>& warnings);

}  // namespace pgdr
