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
// | .off, .obj, .stl |                    | triangles/polygons          |           |            |
// | .mesh            |                    |                             | Medit     | Medit      |
// | .vtu             |                    |                             | ours      | VTK XML    |
//
// Choices that the formats leave open:
// - A .poly or .smesh that lists 0 points takes them from the .node file beside it. Point numbers start at 0 or 1 and
//   are consecutive. A region with one number behind its point has it as attribute and, in 2D, as bound of the area too
//   (Triangle's manual); in 3D as attribute alone. Holes are mandatory, regions may be missing.
// - .stl: equal points become one. If an ASCII file has several solids, markers number them from 1.
// - .off, .obj: normals, colours, textures and groups are dropped; .obj counts points and faces from 1.
// - .mesh: references are markers and region attributes; attributes that are not integers are numbered, and comments
//   "# region <n> = <value>" tell which is which. Labels that are all 0 read back as none. RequiredVertices lists the
//   input points. Sections that OutputMesh has no place for are skipped, cells that are no simplices are refused.
// - .vtu: cells, then subfacets, then subsegments; cell data "region" (of the cells) and "marker" (of the others), point
//   data "marker", field data "dimension" and "input_points"; raw appended data.
#pragma once

#include <filesystem>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// @throws FileError if the file cannot be opened; InputError (unknown_format, syntax, truncated, count_too_large,
///   not_finite, index_out_of_range, ...) with file and line.
template <int D>
Plc<D> read_plc(const std::filesystem::path& file);

/// The dimension of a .poly/.node/.mesh/.vtu file from its header (2 or 3); 3 for .smesh, .off, .obj, .stl, which are
/// not opened. @throws as read_plc
int file_dimension(const std::filesystem::path& file);

/// Vertex indices are in range; whether the cells are a mesh is the checker's business. @throws as read_plc
template <int D>
OutputMesh<D> read_mesh(const std::filesystem::path& file);

/// Replaces a file of that name when all is written, not before.
/// @throws FileError cannot_write (nothing is left behind, an older file is as it was), InputError unknown_format
template <int D>
void write_mesh(const OutputMesh<D>& mesh, const std::filesystem::path& file);

}  // namespace pgdr
