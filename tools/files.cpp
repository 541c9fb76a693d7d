// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <strings.h>

#include <algorithm>
#include <filesystem>

#include "pgdr/error.hpp"
#include "pgdr/output_files.hpp"

namespace pgdr::tool {

namespace fs = std::filesystem;

namespace {

void name_stream(std::string& file, const std::string& formats, bool is_output = false) {
  if (file != "-") return;
  const std::size_t comma = formats.find(',');
  const std::string format = is_output && comma != std::string::npos ? formats.substr(comma + 1) : formats.substr(0, comma);
  if (format.empty())
    throw UsageError({.code = Errc::bad_option,
                      .message = "-, standard input or output, needs --format: an extension such as off, or of both off,vtu"});
  file = stream_name("." + format);
}

}  // namespace

void name_streams(MeshArguments& a) {
  if (a.output == "-") a.quiet = true;
  for (std::string& file : a.inputs) name_stream(file, a.reading.format);
  name_stream(a.output, a.reading.format, true);
}

void name_streams(CheckArguments& a) {
  name_stream(a.mesh, a.reading.format);
  for (std::string& file : a.inputs) name_stream(file, a.reading.format);
}

void name_streams(InfoArguments& a) {
  for (std::string& file : a.files) name_stream(file, a.reading.format);
}

bool has_extension(const std::string& file, std::initializer_list<const char*> extensions) {
  const std::string own = fs::path(file).extension().string();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&own](const char* extension) { return strcasecmp(own.c_str(), extension) == 0; });
}

void require_mesh_writable(const std::string& output) {
  if (!is_output_format(output))
    throw UsageError(
        {.code = Errc::unknown_format,
         .message = "meshes are written as .vtu, .pvtu, .msh, .mesh, .node with .ele, .inp, .mfem, .vtk, or a folder polyMesh",
         .file = output});
  const fs::path first = files_of_mesh(output).front();
  if (!fs::path(output).has_extension() && !fs::exists(first.parent_path())) {  // a folder, made with those that it lies in
    fs::path there = first.parent_path();
    while (there.has_relative_path() && !fs::exists(there)) there = there.parent_path();
    return require_writable(there / first.filename());
  }
  for (const std::string& file : files_of_mesh(output)) require_writable(file);
}

void require_format(const MeshArguments& a) {
  const auto refuse = [&a](const char* what) { throw UsageError({.code = Errc::bad_option, .message = what, .file = a.output}); };
  if ((a.neighbors || a.edges || a.first_index) && !has_extension(a.output, {".node", ".ele"}))
    refuse("--neighbors, --edges and --first-index are for .node and .ele");
  if (a.leaves && !has_extension(a.output, {".vtu", ".pvtu"})) refuse("--leaves is for .vtu and .pvtu");
  if (a.order == 2 && (!has_extension(a.output, {".msh", ".vtu", ".inp"}) || !a.periodic.empty()))
    refuse("--order 2 is for .msh, .vtu and .inp, without --periodic");
  if (a.pieces && !has_extension(a.output, {".pvtu"})) refuse("--pieces is for .pvtu");
  if (a.voronoi.empty()) return;
  if (!has_extension(a.voronoi, {".voronoi"}))
    throw UsageError({.code = Errc::bad_option, .message = "Voronoi cells are written as .voronoi", .file = a.voronoi});
  require_writable(a.voronoi);
}

WriteOptions write_options(const MeshArguments& a, std::uint32_t first_index_of_input) {
  WriteOptions options;
  if (a.first_index)
    options.first_index = static_cast<std::uint32_t>(*a.first_index);
  else if (!a.remesh && a.inputs.size() == 1 && has_extension(a.inputs.front(), {".poly", ".smesh", ".node"}))
    options.first_index = first_index_of_input;
  options.pieces = static_cast<std::uint32_t>(a.pieces.value_or(0));
  options.edges = a.edges;
  options.order = a.order;
  options.neighbors = a.neighbors;
  return options;
}

void require_input_format(const std::string& file) {
  if (has_extension(file, {".vtu", ".pvtu", ".ele"}))
    throw InputError(
        {.code = Errc::unknown_format,
         .message = "this is a mesh in a format that is no input: give what it was made of, or write the mesh as .mesh "
                    "or .msh, which are inputs, too",
         .file = file});
}

}  // namespace pgdr::tool
