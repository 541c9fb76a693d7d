// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files in and out, by extension. Readers are strict: every count is checked against what the file can hold before
// anything is allocated, and errors carry the line. Writers go to a temporary name and rename, so that an interrupted
// run leaves no half file; text formats print doubles that read back to the same bits. Any thread; no global state
// (the C locale is never consulted).
//
// | extension        | read as Plc<2>     | read as Plc<3>              | read mesh | write mesh |
// | .poly            | Triangle's         | TetGen's                    |           |            |
// | .smesh           |                    | TetGen's                    |           |            |
// | .node            | points             | points                      |           |            |
// | .off, .stl       |                    | triangles/polygons          |           |            |
// | .mesh            |                    |                             | Medit     | Medit      |
// | .vtu             |                    |                             | ours      | VTK XML    |
#pragma once

#include <filesystem>

#include "pgdr/error.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"

namespace pgdr {

/// @throws FileError if the file cannot be opened; InputError (unknown_format, syntax, truncated, count_too_large,
///   not_finite, index_out_of_range, ...) with file and line.
template <int D>
Plc<D> read_plc(const std::filesystem::path& file);

/// The dimension of a .poly/.node/.mesh/.vtu file from its header (2 or 3); 3 for .smesh, .off, .stl.
int file_dimension(const std::filesystem::path& file);

template <int D>
OutputMesh<D> read_mesh(const std::filesystem::path& file);

/// @throws FileError cannot_write (nothing is left behind), InputError unknown_format for other extensions.
template <int D>
void write_mesh(const OutputMesh<D>& mesh, const std::filesystem::path& file);

}  // namespace pgdr
