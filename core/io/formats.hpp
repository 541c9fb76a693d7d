// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One function a format and direction; io.cpp chooses by extension. All readers take the whole text of the file and
// its name (for messages, and for a file beside it); all throw what io.hpp says. Those of formats that are inputs and
// meshes alike say what there is (file_mesh.hpp makes of it what is wanted).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/file_mesh.hpp"
#include "output/mid_sides.hpp"
#include "paths/file_input.hpp"
#include "paths/file_output.hpp"
#include "paths/file_slices.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_piece.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// Reads as `read_plc` does, from memory. The extension of `name` says what it is; a file of that name need not exist
/// (a .poly or .smesh of 0 points looks for the .node file beside it: in `beside`).
template <int D>
Plc<D> read_plc_from(std::string_view bytes, const std::filesystem::path& name, FileTexts&& beside = {},
                     const ReadOptions& options = {});
/// As `read_mesh`, but for .node and .ele, which are several files (read_tetgen).
template <int D>
OutputMesh<D> read_mesh_from(std::string_view bytes, const std::filesystem::path& name, FileTexts&& beside = {});

template <int D>
Plc<D> read_poly(std::string_view text, const std::filesystem::path& file, FileTexts& beside, const ReadOptions& options);
template <int D>
Plc<D> read_node(std::string_view text, const std::filesystem::path& file);
Plc<2> read_geojson(std::string_view text, const std::filesystem::path& file);
Plc<3> read_smesh(std::string_view text, const std::filesystem::path& file, FileTexts& beside);
Plc<3> read_obj(std::string_view text, const std::filesystem::path& file);
Plc<3> read_off(std::string_view text, const std::filesystem::path& file);
Plc<3> read_ply(std::string_view text, const std::filesystem::path& file);
Plc<3> read_stl(std::string_view text, const std::filesystem::path& file);

enum class Purpose {
  input,  ///< lines are kept
  mesh,
  periods,   ///< as mesh, with what the file says of sides that correspond
  dimension  ///< what is read may end where the dimension is known
};
struct Want {
  Purpose purpose = Purpose::mesh;
  int dimension = 0;  ///< 2, 3, or any: what else is stated may be refused at once
};
FileMesh read_medit(std::string_view text, const std::filesystem::path& file, Want want);
FileMesh read_msh(std::string_view text, const std::filesystem::path& file, Want want);
FileMesh read_vtk(std::string_view text, const std::filesystem::path& file, Want want);
/// The point data and cell data that read_vtk() has no place for.
std::vector<MeshField> read_vtk_fields(std::string_view text, const std::filesystem::path& file);

/// @param left_out  how many nodes of cells of second order, which are no corners, the file has
template <int D>
OutputMesh<D> read_vtu(std::string_view text, const std::filesystem::path& file, std::size_t& left_out);
/// What the file says of sides that correspond; nothing where it says nothing.
template <int D>
StatedPeriods read_vtu_periods(std::string_view text, const std::filesystem::path& file);
/// The point data and cell data that read_vtu() has no place for.
std::vector<MeshField> read_vtu_fields(std::string_view text, const std::filesystem::path& file);
template <int D>
void write_medit(const OutputMesh<D>& mesh, FileOutput& out);
/// @param middles  of second order: the mesh has these nodes, too; null: of first order
template <int D>
void write_msh(const OutputMesh<D>& mesh, const std::vector<PeriodicPairs>& periodic, const MidSides<D>* middles,
               FileOutput& out);
template <int D>
void write_vtu(const OutputMesh<D>& mesh, const std::vector<PeriodicPairs>& periodic, const MidSides<D>* middles,
               FileOutput& out);
/// The file of a piece alone, with the numbers of its points and cells in the whole mesh.
template <int D>
void write_vtu_of_piece(const MeshPiece<D>& piece, FileOutput& out);
/// The rows of a piece, at their places in the file of the whole mesh, which is there when all pieces are written. Closes the
/// file.
/// @param frame  what belongs to no piece, too: one of them has to do it
/// @throws FileError cannot_write
template <int D>
void write_vtu_rows(const MeshPiece<D>& piece, bool frame, FileSlices& out);

/// A file that write_vtu_of_piece() has made.
template <int D>
MeshPiece<D> read_vtu_piece(std::string_view text, const std::filesystem::path& file);
/// With the files of its pieces beside it.
template <int D>
OutputMesh<D> read_pvtu(std::string_view text, const std::filesystem::path& file, FileTexts& beside);
/// X.pvtu and X_0.vtu, X_1.vtu, ... of so many pieces: all or none.
template <int D>
void write_pvtu(const OutputMesh<D>& mesh, const std::filesystem::path& file, std::uint64_t count);
/// The text of a .pvtu of so many pieces, of which this is any.
template <int D>
std::string pvtu_text(const MeshPiece<D>& piece, std::uint64_t count, const std::filesystem::path& file);
/// The file of piece k of a .pvtu.
std::string name_of_piece(const std::filesystem::path& file, std::uint64_t k);
/// Names of arrays of a piece.
inline constexpr std::string_view point_ids = "GlobalPointIds", cell_ids = "GlobalCellIds";
/// Text as an attribute of XML has it.
std::string xml_escaped(std::string_view text);
std::string xml_unescaped(std::string_view text);
/// Arrays of field data that are ours; of a name that is one of them, or begins so, the array has "pgdr:" before it.
inline constexpr std::string_view periodic_sides_array = "periodic_sides", periodic_motions_array = "periodic_motions";
inline constexpr std::string_view own_field_data[] = {"dimension", "input_points", "piece", periodic_sides_array,
                                                      periodic_motions_array},
                                  field_data_escape = "pgdr:";

/// Comments of text formats that keep names: "# name region <label> = <name>", "# name marker <marker> = <name>".
std::string name_comments(const Names& names);
/// Those in the first lines of a text. Lines that are no such comments are passed over. @throws syntax
Names read_name_comments(std::string_view head, const std::string& file);

/// A folder named polyMesh, or a file in it?
bool is_foam_mesh(const std::filesystem::path& file);
/// The files of such a folder, in the order in which they appear: the last means that all are there.
std::vector<std::string> foam_files(const std::filesystem::path& folder);
/// @throws UsageError bad_option
template <int D>
void write_foam(const OutputMesh<D>& mesh, const std::filesystem::path& folder);
template <int D>
void write_abaqus(const OutputMesh<D>& mesh, const MidSides<D>* middles, FileOutput& out);
template <int D>
void write_mfem(const OutputMesh<D>& mesh, FileOutput& out);
template <int D>
void write_vtk(const OutputMesh<D>& mesh, FileOutput& out);

/// A mesh as TetGen and Triangle have it: one text a file, named `file` with another extension. None: there is no such file.
struct TetgenTexts {
  std::string_view node, ele;
  std::optional<std::string_view> face;  ///< subfacets
  std::optional<std::string_view> edge;  ///< subsegments
};
/// Comments at the head of .node and .edge, with a number.
inline constexpr std::string_view input_points_comment = "# pgdr input_points ", subsegments_comment = "# pgdr subsegments ";
/// The name of the file of that family with an extension: `file` itself if it is the one.
std::string tetgen_name(const std::filesystem::path& file, std::string_view extension);
/// @param left_out  null, or where to put how many nodes of cells of second order, which are no corners, the files have
template <int D>
OutputMesh<D> read_tetgen(const TetgenTexts& texts, const std::filesystem::path& file, std::size_t* left_out = nullptr);
/// Writes .node, .face (3D), .edge, .neigh (on request) and .ele, all or none.
template <int D>
void write_tetgen(const OutputMesh<D>& mesh, const std::filesystem::path& file, const WriteOptions& options);

/// The dimension that the header states; anything but 2 and 3 is a syntax error.
int node_dimension(std::string_view text, const std::filesystem::path& file, FileTexts& beside);  ///< .node, .poly
int vtu_dimension(std::string_view text, const std::filesystem::path& file);
int pvtu_dimension(std::string_view text, const std::filesystem::path& file, FileTexts& beside);  ///< that of the first piece

/// @throws UsageError bad_option: an order that the format does not have
void require_order(const std::filesystem::path& file, const WriteOptions& options);

/// A mesh as a file of the order of the options has it. It refers to the mesh that it was made of.
template <int D>
class OfOrder {
 public:
  OfOrder(const OutputMesh<D>& mesh, const WriteOptions& options) : mesh_(&mesh) {
    if (options.order != 2) return;
    middles_.emplace(mesh);
    wide_ = middles_->with_nodes(mesh);
    mesh_ = &wide_;
  }
  OfOrder(const OfOrder&) = delete;
  OfOrder& operator=(const OfOrder&) = delete;

  const OutputMesh<D>& mesh() const { return *mesh_; }
  const MidSides<D>* middles() const { return middles_ ? &*middles_ : nullptr; }

 private:
  const OutputMesh<D>* mesh_;
  OutputMesh<D> wide_;
  std::optional<MidSides<D>> middles_;
};

/// In lower case, with its dot.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace pgdr::detail
