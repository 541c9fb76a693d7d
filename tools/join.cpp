// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr join: one mesh of several whose boundaries match.
#include <cstdio>

#include "command.hpp"
#include "console.hpp"
#include "files.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_join.hpp"
#include "pgdr/output_files.hpp"

namespace pgdr::tool {
namespace {

template <int D>
std::vector<OutputMesh<D>> read_all(std::vector<InputFile>& files) {
  std::vector<OutputMesh<D>> meshes;
  for (InputFile& file : files) {
    if (!file.holds_cells())
      throw InputError(
          {.code = Errc::unknown_format, .message = "this is no mesh: there are no cells to join", .file = file.name().string()});
    meshes.push_back(file.read_mesh<D>());
  }
  return meshes;
}

/// Of a refusal, the first few to stderr, and all to the report.
int refuse(const InputError& error, Report& report) {
  constexpr std::size_t most = 5;
  const std::vector<Diagnostic>& all = error.diagnostics();
  for (std::size_t i = 0; i < all.size(); ++i) {
    report.add_error(all[i]);
    if (i < most) std::fprintf(stderr, "pgdr: error: %s\n", Error(all[i]).what());
  }
  if (all.size() > most) std::fprintf(stderr, "pgdr: and %zu more errors\n", all.size() - most);
  return exit_input;
}

std::vector<Json> json_of(const std::vector<SharedConstraints>& shared, const std::vector<std::string>& files) {
  std::vector<Json> list;
  for (const SharedConstraints& s : shared)
    list.push_back(JsonObject{
        {"files", std::array{Json(files[s.meshes[0]]), Json(files[s.meshes[1]])}}, {"markers", s.markers}, {"count", s.count}});
  return list;
}

template <int D>
void fill(Report& report, const JoinArguments& a, const JoinedMesh<D>& joined) {
  report.set("vertices", joined.mesh.points.size());
  report.set("cells", joined.mesh.cells.size());
  report.set("shared_points", joined.shared_points);
  report.set("interfaces", json_of(joined.interfaces, a.meshes));
  if (D == 3) report.set("shared_segments", json_of(joined.shared_segments, a.meshes));
  std::vector<Json> labels;
  for (const JoinedLabel& l : joined.labels)
    labels.push_back(JsonObject{{"file", a.meshes[l.mesh]}, {"given", l.given}, {"label", l.label}});
  report.set("labels", labels);
  report.set("added_walls", joined.added_walls);
  report.set("dropped", joined.dropped);
}

template <int D>
void print_summary(const JoinArguments& a, const JoinedMesh<D>& joined) {
  print_row("mesh", format("%s (%dD, ", a.output.c_str(), D) + count(joined.mesh.points.size(), "vertex", "vertices") + ", " +
                        count_cells<D>(joined.mesh.cells.size()) + ')');
  const auto name = [&a](std::uint32_t mesh) { return a.meshes[mesh]; };
  if (joined.interfaces.empty()) print_row("joined", "nothing: no two meshes share a face");
  for (const SharedConstraints& s : joined.interfaces) {
    const std::string what = D == 3 ? count(s.count, "face", "faces") : count(s.count, "edge", "edges");
    std::string markers = "marker " + std::to_string(s.markers[0]);
    if (s.markers[1] != s.markers[0]) markers += ", there " + std::to_string(s.markers[1]);
    print_row("joined", what + " of " + name(s.meshes[0]) + " and " + name(s.meshes[1]) + ", " + markers);
  }
  for (const JoinedLabel& l : joined.labels)
    if (l.label != l.given) print_row("label", digits(l.label) + " was " + digits(l.given) + " in " + name(l.mesh));
  if (joined.added_walls > 0)
    print_row("added", count(joined.added_walls, D == 3 ? "subfacet" : "subsegment", D == 3 ? "subfacets" : "subsegments") +
                           " that no file lists, with marker 0");
  for (const std::string& what : joined.dropped) print_row("dropped", what);
}

template <int D>
int join_as(const JoinArguments& a, std::vector<InputFile>& files, Report& report) {
  const std::vector<OutputMesh<D>> meshes = read_all<D>(files);
  std::vector<const OutputMesh<D>*> all;
  for (const OutputMesh<D>& mesh : meshes) all.push_back(&mesh);
  JoinedMesh<D> joined;
  try {
    joined = join_meshes<D>(all, {.relabel = a.relabel, .names = a.meshes});
  } catch (const InputError& e) {
    return refuse(e, report);
  }
  for (Diagnostic& unfit : unfit_names(joined.mesh.names, a.output)) joined.warnings.push_back(std::move(unfit));
  report.set("warnings", to_json(joined.warnings));
  print_warnings(joined.warnings);
  fill(report, a, joined);
  report.mesh_files = files_of_mesh(a.output);
  write_mesh(joined.mesh, a.output);
  if (!a.quiet) print_summary(a, joined);
  return exit_done;
}

}  // namespace

int join(const JoinArguments& a, Report& report) {
  report.set("meshes", a.meshes);
  report.set("output", a.output);
  require_mesh_writable(a.output);
  std::vector<InputFile> files;
  for (const std::string& name : a.meshes) files.emplace_back(name);
  const int dimension = files.front().dimension();
  for (InputFile& file : files)
    if (const int other = file.dimension(); other != dimension)
      throw UsageError({.code = Errc::bad_option,
                        .message = format("this mesh is %dD, %s is %dD", other, a.meshes.front().c_str(), dimension),
                        .file = file.name().string()});
  report.set("dimension", dimension);
  return dimension == 2 ? join_as<2>(a, files, report) : join_as<3>(a, files, report);
}

}  // namespace pgdr::tool
