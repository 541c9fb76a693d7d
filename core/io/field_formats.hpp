// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Formats with room for fields.
#pragma once

#include <string_view>
#include <vector>

#include "output/mid_sides.hpp"
#include "paths/file_output.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"

namespace pgdr::detail {

/// Names of arrays of a mesh itself; a field that is called so, or begins with field_data_escape, has that before its name.
inline constexpr std::string_view own_point_data[] = {"marker", "attributes", "GlobalPointIds", "periodic_of"},
                                  own_cell_data[] = {"region", "leaf", "marker", "GlobalCellIds"};

template <int D>
void write_vtu_with_fields(const OutputMesh<D>& mesh, const MeshFields& fields, const std::vector<PeriodicPairs>& periodic,
                           const MidSides<D>* middles, FileOutput& out);

}  // namespace pgdr::detail
