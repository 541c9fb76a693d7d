// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/io.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "input/words.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "paths/file_input.hpp"
#include "paths/file_output.hpp"

namespace pgdr {
namespace detail {

std::string lower_extension(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  for (char& c : e) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return e;
}

}  // namespace detail
namespace {

using detail::lower_extension;
using detail::Purpose;
using Path = std::filesystem::path;

[[noreturn]] void unknown_format(const Path& file, const std::string& what) {
  const std::string message = "the extension '" + file.extension().string() + "' is not that of " + what;
  throw InputError(Diagnostic{Errc::unknown_format, message, file.string(), 0, {}, {}});
}

/// Runs `work`, and makes what the standard library throws for want of memory an error of ours.
template <class Work>
auto guarded(const Path& file, Work work) {
  const auto fail = [&file]() {
    return ResourceError(Diagnostic{Errc::out_of_memory, "out of memory", file.string(), 0, {}, {}});
  };
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw fail();
  } catch (const std::length_error&) {
    throw fail();
  }
}

/// The reader of a format that is input and mesh alike; null for others.
using FileMeshReader = detail::FileMesh (*)(std::string_view, const Path&, detail::Want);
FileMeshReader file_mesh_reader(const std::string& extension) {
  if (extension == ".mesh") return detail::read_medit;
  if (extension == ".msh") return detail::read_msh;
  if (extension == ".vtk") return detail::read_vtk;
  return nullptr;
}

bool is_geojson(const std::string& extension) { return extension == ".geojson" || extension == ".json"; }

bool is_tetgen_mesh(const std::string& extension) { return extension == ".node" || extension == ".ele"; }

/// Written for other programs, and not read.
bool is_for_others(const Path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".inp" || extension == ".mfem" || detail::is_foam_mesh(file);
}

bool is_vtk(const std::string& extension) { return extension == ".vtu" || extension == ".pvtu"; }

/// Says that cells of second order are read by their corners.
void note_mid_sides(std::size_t left_out, const Path& file, detail::FileTexts& texts) {
  if (left_out == 0) return;
  texts.warnings().push_back({.code = Errc::unknown_format,
                              .message = "cells of second order are read by their corners: " + std::to_string(left_out) +
                                         " nodes in the middles of edges are left out",
                              .file = file.string()});
}

/// The texts of the mesh that a .node or .ele file belongs to.
template <int D>
OutputMesh<D> read_tetgen_files(const Path& file, detail::FileTexts& texts) {
  const auto text = [&](std::string_view extension) { return texts.of(detail::tetgen_name(file, extension)); };
  const auto optional_text = [&](std::string_view extension) {
    std::error_code ignored;
    const bool there = std::filesystem::exists(detail::tetgen_name(file, extension), ignored);
    return there ? std::optional<std::string_view>(text(extension)) : std::nullopt;
  };
  const std::string_view node = text(".node"), ele = text(".ele");
  std::size_t left_out = 0;
  OutputMesh<D> mesh = detail::read_tetgen<D>({node, ele, optional_text(".face"), optional_text(".edge")}, file, &left_out);
  note_mid_sides(left_out, file, texts);
  return mesh;
}

template <int D>
Plc<D> read_by_extension(std::string_view bytes, const Path& name, detail::FileTexts& beside, const ReadOptions& options) {
  const std::string extension = lower_extension(name);
  if (const FileMeshReader read = file_mesh_reader(extension)) {
    detail::FileMesh mesh = read(bytes, name, {Purpose::input, D});
    note_mid_sides(detail::drop_mid_sides(mesh), name, beside);
    return detail::to_plc<D>(std::move(mesh));
  }
  if (extension == ".poly") return detail::read_poly<D>(bytes, name, beside, options);
  using Reader = Plc<D> (*)(std::string_view, const Path&);
  Reader reader = nullptr;
  if (extension == ".node") reader = detail::read_node<D>;
  if constexpr (D == 2) {
    if (is_geojson(extension)) reader = detail::read_geojson;
  }
  if constexpr (D == 3) {
    if (extension == ".smesh") return detail::read_smesh(bytes, name, beside);
    if (extension == ".obj") reader = detail::read_obj;
    if (extension == ".off") reader = detail::read_off;
    if (extension == ".ply") reader = detail::read_ply;
    if (extension == ".stl") reader = detail::read_stl;
  }
  if (reader == nullptr) unknown_format(name, "an input in " + std::to_string(D) + "D");
  return reader(bytes, name);
}

}  // namespace

namespace detail {

template <int D>
Plc<D> read_plc_from(std::string_view bytes, const Path& name, FileTexts&& beside, const ReadOptions& options) {
  return read_by_extension<D>(bytes, name, beside, options);
}

template <int D>
OutputMesh<D> read_mesh_from(std::string_view bytes, const Path& name, FileTexts&& beside) {
  const std::string extension = lower_extension(name);
  if (const FileMeshReader read = file_mesh_reader(extension)) {
    FileMesh mesh = read(bytes, name, {Purpose::mesh, D});
    note_mid_sides(drop_mid_sides(mesh), name, beside);
    return to_output_mesh<D>(std::move(mesh));
  }
  if (extension == ".vtu") {
    std::size_t left_out = 0;
    OutputMesh<D> mesh = read_vtu<D>(bytes, name, left_out);
    note_mid_sides(left_out, name, beside);
    return mesh;
  }
  if (extension == ".pvtu") return read_pvtu<D>(bytes, name, beside);
  unknown_format(name, "a mesh (.vtu .pvtu .vtk .msh .mesh .node .ele)");
}

template Plc<2> read_plc_from<2>(std::string_view, const Path&, FileTexts&&, const ReadOptions&);
template Plc<3> read_plc_from<3>(std::string_view, const Path&, FileTexts&&, const ReadOptions&);
template OutputMesh<2> read_mesh_from<2>(std::string_view, const Path&, FileTexts&&);
template OutputMesh<3> read_mesh_from<3>(std::string_view, const Path&, FileTexts&&);

}  // namespace detail

namespace {

template <int D>
bool is_input_format(const std::string& extension) {
  constexpr std::string_view formats[] = {".poly", ".node", ".mesh", ".msh", ".vtk", ".smesh", ".obj", ".off", ".ply", ".stl"};
  constexpr std::ptrdiff_t in_2d = 5;
  if (is_geojson(extension)) return D == 2;
  const auto end = D == 2 ? std::begin(formats) + in_2d : std::end(formats);
  return std::find(std::begin(formats), end, extension) != end;
}

}  // namespace

InputFile::InputFile(Path name) : name_(std::move(name)), texts_(std::make_unique<detail::FileTexts>()) {}
InputFile::InputFile(InputFile&&) noexcept = default;
InputFile& InputFile::operator=(InputFile&&) noexcept = default;
InputFile::~InputFile() = default;

/// A file of unknown format is not opened.
template <int D>
Plc<D> InputFile::read_plc(const ReadOptions& options) {
  texts_->warnings().clear();
  return guarded(name_, [&] {
    const bool known = is_input_format<D>(lower_extension(name_));
    Plc<D> plc = detail::read_plc_from<D>(known ? texts_->of(name_) : std::string_view(), name_, std::move(*texts_), options);
    texts_->clear();
    return plc;
  });
}

template <int D>
OutputMesh<D> InputFile::read_mesh() {
  texts_->warnings().clear();
  return guarded(name_, [&] {
    const bool several = is_tetgen_mesh(lower_extension(name_)), known = is_mesh_format(name_);
    OutputMesh<D> mesh = several ? read_tetgen_files<D>(name_, *texts_)
                                 : detail::read_mesh_from<D>(known ? texts_->of(name_) : std::string_view(), name_,
                                                             std::move(*texts_));
    texts_->clear();
    return mesh;
  });
}

std::vector<MeshField> InputFile::read_fields() {
  const std::string extension = lower_extension(name_);
  if (extension != ".vtu" && extension != ".vtk") return {};
  const auto read = extension == ".vtu" ? detail::read_vtu_fields : detail::read_vtk_fields;
  return guarded(name_, [&] { return read(texts_->of(name_), name_); });
}

template <int D>
StatedPeriods InputFile::read_periods() {
  const std::string extension = lower_extension(name_);
  if (extension == ".vtu") return guarded(name_, [&] { return detail::read_vtu_periods<D>(texts_->of(name_), name_); });
  if (extension != ".msh") return {};
  return guarded(name_, [&]() -> StatedPeriods {
    const std::string_view text = texts_->of(name_);
    if (text.find("$Periodic") == std::string_view::npos) return {};
    detail::FileMesh mesh = detail::read_msh(text, name_, {detail::Purpose::periods, D});
    drop_mid_sides(mesh);
    return detail::to_periods<D>(mesh);
  });
}

const std::vector<Diagnostic>& InputFile::warnings() const { return texts_->warnings(); }

int InputFile::dimension() {
  const std::string extension = lower_extension(name_);
  for (const std::string_view spatial : {".smesh", ".obj", ".off", ".ply", ".stl"}) {
    if (extension == spatial) return 3;
  }
  if (is_geojson(extension)) return 2;
  return guarded(name_, [&] {
    if (const FileMeshReader read = file_mesh_reader(extension))
      return dimension_of(read(texts_->of(name_), name_, {Purpose::dimension, 0}));
    if (extension == ".ele") {
      const Path node = detail::tetgen_name(name_, ".node");
      return detail::node_dimension(texts_->of(node), node, *texts_);
    }
    if (extension == ".poly" || extension == ".node") return detail::node_dimension(texts_->of(name_), name_, *texts_);
    if (extension == ".vtu") return detail::vtu_dimension(texts_->of(name_), name_);
    if (extension == ".pvtu") return detail::pvtu_dimension(texts_->of(name_), name_, *texts_);
    unknown_format(
        name_,
        "a file that is read (.poly .smesh .node .off .obj .ply .stl .mesh .msh .vtk .geojson; meshes also .vtu .pvtu .ele)");
  });
}

bool InputFile::holds_cells() {
  const std::string extension = lower_extension(name_);
  if (const FileMeshReader read = file_mesh_reader(extension))
    return guarded(name_, [&] { return has_cells(read(texts_->of(name_), name_, {Purpose::mesh, 0})); });
  return is_vtk(extension) || extension == ".ele";
}

template <int D>
Plc<D> read_plc(const Path& file, const ReadOptions& options) {
  return InputFile(file).read_plc<D>(options);
}

template <int D>
OutputMesh<D> read_mesh(const Path& file) {
  return InputFile(file).read_mesh<D>();
}

int file_dimension(const Path& file) { return InputFile(file).dimension(); }

bool holds_cells(const Path& file) { return InputFile(file).holds_cells(); }

bool is_mesh_format(const Path& file) {
  const std::string extension = lower_extension(file);
  return file_mesh_reader(extension) != nullptr || is_tetgen_mesh(extension) || is_vtk(extension);
}

bool is_output_format(const Path& file) { return is_mesh_format(file) || is_for_others(file); }

std::vector<Diagnostic> unfit_names(const Names& names, const Path& file) {
  const Names valid = detail::valid_names(names, detail::name_rule(file));
  std::vector<Diagnostic> warnings;
  const auto compare = [&](const auto& given, const auto& written, const char* what) {
    for (const auto& [label, name] : given) {
      const std::string& now = written.at(label);
      if (now == name) continue;
      std::string words = "the name \"";
      words.append(name).append("\" of ").append(what).append(" ").append(detail::to_text(static_cast<double>(label)));
      words.append(" cannot be written to this file as it is; it is \"").append(now).append("\" there");
      warnings.push_back({Errc::unfit_name, std::move(words), file.string(), 0, {}, {}});
    }
  };
  compare(names.regions, valid.regions, "region");
  compare(names.markers, valid.markers, "marker");
  return warnings;
}

namespace detail {

void require_order(const Path& file, const WriteOptions& options) {
  const std::string extension = lower_extension(file);
  const bool can = extension == ".msh" || extension == ".vtu" || extension == ".inp";
  if (options.order == 1 || (options.order == 2 && can && options.periodic.empty())) return;
  throw UsageError(Diagnostic{Errc::bad_option,
                              options.order == 2 && can ? "sides that correspond have no nodes in the middles of edges: order 1"
                              : options.order == 2      ? "meshes of second order are written to .msh, .vtu and .inp"
                                                        : "the order of a mesh is 1 or 2",
                              file.string(),
                              0,
                              {},
                              {}});
}

}  // namespace detail

std::vector<std::string> files_of_mesh(const Path& file, const WriteOptions& options) {
  if (detail::is_foam_mesh(file)) return detail::foam_files(file);
  const std::string own = lower_extension(file);
  std::vector<std::string> files;
  if (!is_tetgen_mesh(own)) files.push_back(file.string());
  for (std::uint32_t k = 0; own == ".pvtu" && k < std::max(options.pieces, 1u); ++k)
    files.push_back(detail::name_of_piece(file, k));
  if (!is_tetgen_mesh(own)) return files;
  for (const std::string_view extension : {".node", ".ele", ".face", ".edge"})
    files.push_back(detail::tetgen_name(file, extension));
  if (options.neighbors) files.push_back(detail::tetgen_name(file, ".neigh"));
  return files;
}

template <int D>
void write_mesh(const OutputMesh<D>& mesh, const Path& file, const WriteOptions& options) {
  if (options.first_index > 1)
    throw UsageError(Diagnostic{Errc::bad_option, "points are numbered from 0 or 1", file.string(), 0, {}, {}});
  const std::string extension = lower_extension(file);
  detail::require_order(file, options);
  if (extension == ".pvtu" && options.pieces > most_pieces)
    throw UsageError(Diagnostic{Errc::bad_option, "a mesh is written in up to 100,000 pieces", file.string(), 0, {}, {}});
  if (extension == ".pvtu") return guarded(file, [&] { detail::write_pvtu<D>(mesh, file, std::max(options.pieces, 1u)); });
  if (is_tetgen_mesh(extension)) return guarded(file, [&] { detail::write_tetgen<D>(mesh, file, options); });
  if (detail::is_foam_mesh(file)) return guarded(file, [&] { detail::write_foam<D>(mesh, file); });
  if (extension == ".msh" || extension == ".vtu" || extension == ".inp")
    return guarded(file, [&] {
      detail::FileOutput out(file);
      const detail::OfOrder<D> of_order(mesh, options);
      const detail::MidSides<D>* const middles = of_order.middles();
      if (extension == ".msh") detail::write_msh<D>(of_order.mesh(), options.periodic, middles, out);
      if (extension == ".vtu") detail::write_vtu<D>(of_order.mesh(), options.periodic, middles, out);
      if (extension == ".inp") detail::write_abaqus<D>(of_order.mesh(), middles, out);
      out.commit();
    });
  using Writer = void (*)(const OutputMesh<D>&, detail::FileOutput&);
  Writer writer = nullptr;
  if (extension == ".mesh") writer = detail::write_medit<D>;
  if (extension == ".mfem") writer = detail::write_mfem<D>;
  if (extension == ".vtk") writer = detail::write_vtk<D>;
  if (writer == nullptr) unknown_format(file, "a mesh that can be written");
  guarded(file, [&] {
    detail::FileOutput out(file);
    writer(mesh, out);
    out.commit();
  });
}

template PGDR_API Plc<2> InputFile::read_plc<2>(const ReadOptions&);
template PGDR_API Plc<3> InputFile::read_plc<3>(const ReadOptions&);
template PGDR_API OutputMesh<2> InputFile::read_mesh<2>();
template PGDR_API OutputMesh<3> InputFile::read_mesh<3>();
template PGDR_API StatedPeriods InputFile::read_periods<2>();
template PGDR_API StatedPeriods InputFile::read_periods<3>();
template PGDR_API Plc<2> read_plc<2>(const Path&, const ReadOptions&);
template PGDR_API Plc<3> read_plc<3>(const Path&, const ReadOptions&);
template PGDR_API OutputMesh<2> read_mesh<2>(const Path&);
template PGDR_API OutputMesh<3> read_mesh<3>(const Path&);
template PGDR_API void write_mesh<2>(const OutputMesh<2>&, const Path&, const WriteOptions&);
template PGDR_API void write_mesh<3>(const OutputMesh<3>&, const Path&, const WriteOptions&);

}  // namespace pgdr
