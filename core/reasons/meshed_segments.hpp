// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "input/sharp_angles.hpp"
#include "mesh/mesh.hpp"
#include "numbers/corners.hpp"
#include "pgdr/domain.hpp"

namespace pgdr {

/// Of each segment of the Domain: has the mesh a part of it? One that bounds what is not meshed alone makes no angle that a cell
/// would have to live with. Empty: it has all, as it has all facets (`meshed` is empty); and in 2D. Linear in cells.
template <int D>
std::vector<std::uint8_t> meshed_segments(const Mesh<D>& mesh, const Domain<D>& domain, CountedTriangles meshed) {
  std::vector<std::uint8_t> marked;
  if (D == 2 || meshed.empty()) return marked;
  marked.resize(domain.segments().size(), 0);
  for (std::uint32_t c = 0; c < mesh.cell_bound(); ++c) {
    const auto* constraints = mesh.alive(CellId{c}) ? mesh.constraints(CellId{c}) : nullptr;
    if constexpr (D == 3)
      for (int e = 0; constraints && e < edge_count(3); ++e)
        if (constraints->has_edge(e)) marked[constraints->edge_entity[e]] = 1;
  }
  return marked;
}

}  // namespace pgdr
