// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large the regions of a mesh are, and how large the input has them. Plain values.
#pragma once

#include <optional>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// What the cells of one label fill. Volumes (2D: areas) are exact sums over the coordinates as they are, rounded once.
struct RegionVolume {
  double label = 0;          ///< of the cells, as in OutputMesh::regions; 0 where these have none
  double volume_meshed = 0;  ///< of the cells
  /// Of what the facets (2D: segments) enclose, by the coordinates of the input. Nothing where they close only by what is joined
  /// of them, or where there is no input.
  std::optional<double> volume_given;
};

/// One entry a label that cells have, ascending; without `volume_given`, which RefineResult::regions has. Less than a microsecond
/// a cell.
template <int D>
std::vector<RegionVolume> measure_regions(const OutputMesh<D>& mesh);

}  // namespace pgdr
