// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What meshes with fields are written to, beside what io.hpp writes (InputFile::read_fields reads them), and bounds of cells. As
// there: strict readers, whole files or none, any thread.
#pragma once

#include <filesystem>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// Has the format of this file room for fields? .vtu. It is not opened.
bool has_room_for_fields(const std::filesystem::path& file);

/// Bounds of cells as TetGen's .vol and Triangle's .area files have them: how many, then for each its number, from 0 or 1, and a
/// volume or area; what is not positive is none.
/// @throws FileError cannot_open; InputError syntax, truncated, count_too_large, not_finite, with file and line
std::vector<double> read_cell_bounds(const std::filesystem::path& file);

/// As write_mesh of io.hpp, with fields. An array that is called as one of the mesh's own gets "pgdr:" before its name, which
/// InputFile::read_fields takes away again.
/// @throws as write_mesh, and UsageError bad_option: a field without a name, with a name twice, not with as many values as points
/// or
///   cells times its width, or for a format without room
template <int D>
void write_mesh(const OutputMesh<D>& mesh, const MeshFields& fields, const std::filesystem::path& file,
                const WriteOptions& options = {});

}  // namespace pgdr
