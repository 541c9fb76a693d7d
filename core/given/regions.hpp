// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Regions: which volume of the input the cells of each component fill, labels, holes, measures.
#pragma once

#include <cstdint>
#include <vector>

#include "enclosed/input_volumes.hpp"
#include "given/links.hpp"

namespace pgdr::checking {

/// Cells connected across faces that are no walls.
struct Components {
  std::vector<std::uint32_t> of_cell;
  std::vector<std::uint32_t> volume;  ///< of each component: of InputVolumes; none if unknown
};

/// Floods the cells; labels that change across a face that is no wall are findings.
template <int D>
Components flood_cells(const OutputMesh<D>& mesh, const Links<D>& links, Findings& findings);

/// Components against volumes of the input; seeds; measures.
/// @param volumes  its first walls are those of the mesh, in their order
template <int D>
void check_regions(const OutputMesh<D>& mesh, const Links<D>& links, const InputVolumes<D>& volumes, Components& components,
                   Findings& findings);

}  // namespace pgdr::checking
