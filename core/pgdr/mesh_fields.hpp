// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Values that live on a mesh, at its points or on its cells. Plain values.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// Numbers for each point or for each cell of a mesh that an OutputMesh has no place for.
struct MeshField {
  std::string name;            ///< as a file has it
  bool of_points = false;      ///< else of the cells
  std::size_t components = 1;  ///< 1 of a scalar, 3 of a vector, 9 of a tensor, ...
  std::vector<double> values;  ///< so many for each point or cell, in the order of these
  bool is_integer = false;     ///< whole numbers, as labels are; up to 2^53
};

/// Those of one mesh.
using MeshFields = std::vector<MeshField>;

}  // namespace pgdr
