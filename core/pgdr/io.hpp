// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files in and out, by extension. Readers are strict: every count is checked against what the file can hold before
// anything is allocated, and errors carry the line. Writers go to a temporary name and rename (output_files.hpp), so that an
// interrupted run leaves no half file; text formats print doubles that read back to the same bits. Any thread; no global state
// (the C locale is never consulted).
//
// | extension              | read as Plc<2>     | read as Plc<3>      | read mesh   | write mesh |
// | .poly                  | Triangle's         | TetGen's            |             |            |
// | .smesh                 |                    | TetGen's            |             |            |
// | .node                  | points             | points              | with .ele   | with .ele  |
// | .ele                   |                    |                     | with .node  | with .node |
// | .off .obj .ply .stl    |                    | triangles, polygons |             |            |
// | .geojson .json         | GeoJSON            |                     |             |            |
// | .mesh                  | edges              | triangles, quads    | Medit       | Medit      |
// | .msh                   | lines              | triangles, quads    | 2.x and 4.1 | 4.1 binary |
// | .vtu .pvtu             |                    |                     | ours        | VTK XML    |
// | .vtk                   | lines              | triangles, quads    | 1.0 to 5.1  | 3.0 text   |
// | .inp                   |                    |                     |             | Abaqus     |
// | .mfem                  |                    |                     |             | MFEM       |
// | polyMesh (a folder)    |                    |                     |             | OpenFOAM   |
//
// docs/formats.md has what each format keeps. Choices that the formats leave open:
// - A .poly or .smesh that lists 0 points takes them from the .node file beside it. Point numbers start at 0 or 1 and
//   are consecutive. A region with one number behind its point has it as attribute alone, unless ReadOptions say
//   more. Holes are mandatory, regions may be missing.
// - .stl: equal points become one. Solids of a file with several, or with a name, have the markers 1, 2, ..., and are the bodies.
// - .off, .obj, .ply: normals, colours and textures are dropped; .obj counts points and faces from 1, and its groups, objects and
//   materials are markers with names. The edges of a .ply are not read.
// - .stl, and .ply whose coordinates are floats: Plc::are_floats is set. Nothing else is read out of the numbers.
// - .mesh: references are markers and region attributes; attributes that are not integers are numbered, and comments
//   "# region <n> = <value>" tell which is which. Labels that are all 0 read back as none. RequiredVertices lists the
//   input points. Sections that a mesh has no place for are skipped.
// - .msh, and .vtu of ours: tetrahedra, triangles and lines of second order are read by their corners; nodes that are no corners
//   are left out, of which InputFile::warnings() says how many.
// - .msh: the first physical group of an element is its label, and the group's name that of the label; groups of labels that are
//   no positive integers, and have no name, are called "pgdr marker <m>" and "pgdr region <a>". Node and element tags are their
//   places from 1 (cells come first).
// - .node, .ele: X.node, X.ele, X.face (3D, subfacets) and X.edge (subsegments), numbered from 1 unless WriteOptions say
//   0, written all or none. The latter two may be missing when read. X.edge may have all edges, and X.neigh the
//   neighbours of each cell.
// - .vtk: unstructured grids and polygonal data, as text or binary, with cell data "region" and "marker", and point data
//   "marker"; other point and cell data are for `read_fields`.
// - .mesh, .msh and .vtk as inputs: cells (tetrahedra, hexahedra, ...; in 2D triangles and quadrilaterals) are dropped, with the
//   points that they alone have, but faces of simplices that bound them, or lie between labels, become facets where the file
//   has none; labels become region seeds, the voids that the cells enclose holes. A file whose points all have z = 0 is 2D, if
//   it has no cells of volume.
// - .vtu: cells, then subfacets, then subsegments; cell data "region", "leaf" (of the cells) and "marker" (of the others),
//   point data "marker" and "attributes", field data "dimension", "input_points" and an array a name; raw appended data. Other
//   point and cell data are for `read_fields`.
// - .pvtu: X.pvtu names the files X_0.vtu, X_1.vtu, ... of the pieces (mesh_piece.hpp), which have "GlobalPointIds" and
//   "GlobalCellIds", too. They are read as one mesh, and written all or none.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {
class FileTexts;
}

namespace pgdr PGDR_API {

/// What the formats of inputs leave open. Those that do not leave it open take no notice of it.
struct ReadOptions {
  /// 2D .poly: a region with one number behind its point has it as largest area, too, as Triangle's manual says.
  bool region_areas = false;
};

/// @throws FileError if the file cannot be opened; InputError (unknown_format, syntax, truncated, count_too_large,
///   not_finite, index_out_of_range, ...) with file and line.
template <int D>
Plc<D> read_plc(const std::filesystem::path& file, const ReadOptions& options = {});

/// The dimension of a file (2 or 3) from its header, or from its points where the header does not tell; 3 for .smesh,
/// .off, .obj, .ply, .stl, which are not opened. @throws as read_plc
int file_dimension(const std::filesystem::path& file);

/// Whether a file has cells (those of volume in 3D, triangles in 2D), so that `read_mesh` gives more than its surface.
/// Always so for .vtu and .ele, never for formats of inputs alone; .node counts as points. @throws as read_plc
bool holds_cells(const std::filesystem::path& file);

/// A file of which several things are asked, and which is read once, so that it can be a FIFO, too. Its bytes, and those of files
/// that belong to it, are kept until read_plc() or read_mesh() has made something of them: then they are given back, and another
/// question reads again. One thread. Errors are those of the functions of the same names above and below.
class PGDR_API InputFile {
 public:
  explicit InputFile(std::filesystem::path name);  ///< reads nothing yet
  InputFile(InputFile&&) noexcept;                 ///< What was moved from may only be assigned to or destroyed.
  InputFile& operator=(InputFile&&) noexcept;      ///< likewise
  ~InputFile();

  const std::filesystem::path& name() const { return name_; }  ///< as given
  int dimension();                                             ///< as file_dimension
  bool holds_cells();                                          ///< as the function
  /// As the function. @throws as it does
  template <int D>
  Plc<D> read_plc(const ReadOptions& options = {});
  /// As the function. @throws as it does
  template <int D>
  OutputMesh<D> read_mesh();
  /// Of a .vtu or .vtk the arrays of point data and cell data that are not ours, points first, by name, without a "pgdr:" before
  /// it; of other formats none. Ask before `read_mesh`, after which the file is read again. @throws as read_mesh
  std::vector<MeshField> read_fields();
  /// What a .msh of version 4.1 or a .vtu of ours says of sides that correspond; of other files, and where it says nothing, none.
  /// Points have the numbers of `read_mesh`. Ask before that, after which the file is read again. @throws as read_mesh
  template <int D>
  StatedPeriods read_periods();
  /// What the last read_plc() or read_mesh() left out: nodes of cells of second order, which are read by their corners.
  const std::vector<Diagnostic>& warnings() const;

 private:
  std::filesystem::path name_;
  std::unique_ptr<detail::FileTexts> texts_;
};

inline constexpr std::uint32_t most_pieces = 100000;  ///< of a .pvtu

/// What the formats leave open. Those that do not leave it open take no notice of it.
struct WriteOptions {
  std::uint32_t first_index = 1;  ///< .node, .ele: number of the first point, cell, ...: 0 or 1
  bool edges = false;        ///< X.edge has all edges: first the subsegments, which a comment counts, then the others, marker 0
  bool neighbors = false;    ///< write X.neigh, too: of each cell, in the order of its corners, the cell opposite; -1: none
  std::uint32_t pieces = 0;  ///< .pvtu: in so many files, up to most_pieces; 0: one, of a mesh on ranks one a rank
  std::vector<PeriodicPairs> periodic = {};  ///< .msh: a section of them; .vtu: "periodic_of", and the sides (periodic.hpp)
  /// 2: .msh, .vtu and .inp of second order, with a node in the middle of each edge, which is straight: tet10, tri6, line3, in
  /// the order of nodes of the format. Nodes are numbered behind all points, have no marker, and means of attributes and fields.
  /// Not with `periodic`.
  int order = 1;
};

/// The name of standard input, where it is read, and of standard output, where it is written, in the format with this extension.
/// No file of this name in the current folder is: "./" before it names that.
inline std::string stream_name(const std::string& extension) { return "-" + extension; }

/// Whether `read_mesh` and `write_mesh` know the extension. The file is not opened.
bool is_mesh_format(const std::filesystem::path& file);
/// Whether `write_mesh` knows it: these, and what is for other programs and is not read: .inp, .mfem, a folder polyMesh.
bool is_output_format(const std::filesystem::path& file);
/// The files that `write_mesh` to this name replaces: itself, and with .node and .ele their family, with .pvtu its pieces; of a
/// folder polyMesh the files in it.
std::vector<std::string> files_of_mesh(const std::filesystem::path& file, const WriteOptions& options = {});

/// The names that the format of this file cannot hold, and what `write_mesh` writes instead: a warning unfit_name each, of
/// regions first. A function of the names and of the format alone: characters that may not be become '_', what is too long is
/// cut, and of names that are alike then, all but the first get "_2", "_3", ... behind them. No file is opened.
std::vector<Diagnostic> unfit_names(const Names& names, const std::filesystem::path& file);

/// Vertex indices are in range; whether the cells are a mesh is the checker's business. @throws as read_plc
template <int D>
OutputMesh<D> read_mesh(const std::filesystem::path& file);

/// Replaces a file of that name when all is written, not before (.node and .ele: the files of both and of .face and
/// .edge; a process that is killed in the middle leaves no .ele).
/// @throws FileError cannot_write (nothing is left behind, an older file is as it was), InputError unknown_format,
///   UsageError bad_option (an order that the format does not have, or with `periodic`; a mesh in 2D to a folder polyMesh; a
///   first index other than 0 and 1; too many pieces; neighbours of a mesh that has none, see neighbors_of_cells)
template <int D>
void write_mesh(const OutputMesh<D>& mesh, const std::filesystem::path& file, const WriteOptions& options = {});

/// One number a vertex from a Medit solution file (.sol, ASCII: MeshVersionFormatted, Dimension, SolAtVertices with one
/// scalar), as mmg and others write it beside a .mesh file. Further sections are not read.
/// @param file  the .sol
/// @param dimension  2 or 3: what the file must say
/// @throws FileError cannot_open; InputError syntax, truncated, count_too_large, not_finite, with file and line
std::vector<double> read_vertex_values(const std::filesystem::path& file, int dimension);

/// A size along a line, or at a point, which has twice the same end (sizes_along() in size_fields.hpp).
template <int D>
struct SizedLine {
  std::array<Point<D>, 2> ends;  ///< of the line
  double size = 0;               ///< along it
};
/// Sizes in a text: a line of it has a point and a size, D + 1 numbers, or two ends and a size, 2 D + 1 numbers. '#' begins
/// comments.
/// @throws FileError cannot_open; InputError syntax, truncated, not_finite, bad_size, with file and line
template <int D>
std::vector<SizedLine<D>> read_sized_lines(const std::filesystem::path& file);

/// 2D: a raster of sizes as a background mesh (sizes_on_mesh() in size_fields.hpp).
struct SizeRaster {
  OutputMesh<2> mesh;          ///< its points are the middles of the raster's cells, row by row from the top
  std::vector<double> values;  ///< of each point; 1 of those without one, which no cell has
};
/// An ASCII grid of ESRI (.asc). Cells are triangles between neighbouring values that are there; values that are NODATA_value or
/// NaN are not.
/// @throws FileError cannot_open; InputError syntax, truncated, count_too_large, bad_size, with file and line
SizeRaster read_size_raster(const std::filesystem::path& file);

}  // namespace pgdr
