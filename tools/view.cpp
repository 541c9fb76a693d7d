// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr view: a picture of a mesh, or a page that shows it.
#include <filesystem>
#include <utility>

#include "command.hpp"
#include "console.hpp"
#include "files.hpp"
#include "pgdr/io.hpp"
#include "pgdr/output_files.hpp"
#include "picture.hpp"
#include "view/page.hpp"

namespace pgdr::tool {
namespace {

template <int D>
int view_mesh(const ViewArguments& a, InputFile& file, bool png, Report& report) {
  const OutputMesh<D> mesh = file.read_mesh<D>();
  if (a.color == ViewColor::leaf && mesh.leaves.empty())
    throw UsageError({.code = Errc::bad_option, .message = "--color leaf is for meshes made with --leaves", .file = a.mesh});
  report.set("cells", mesh.cells.size());
  const Picture picture = draw(mesh, a);
  report.set("triangles_drawn", picture.triangles.size());
  report.set("width", picture.width);
  report.set("height", picture.height);
  write_file(a.output, [&](std::ostream& out) { png ? write_png(picture, out) : write_svg(picture, out); });
  report.mesh_files = {a.output};
  if (a.quiet) return exit_done;
  print_row("mesh", format("%s (%dD), ", a.mesh.c_str(), D) + count_cells<D>(mesh.cells.size()));
  print_row("picture", format("%s, %d x %d pixels, ", a.output.c_str(), picture.width, picture.height) +
                           count(picture.triangles.size(), "triangle", "triangles"));
  return exit_done;
}

template <int D>
int view_page(const ViewArguments& a, InputFile& file, Report& report) {
  if (D == 2 && (a.cut || a.from)) throw UsageError({.code = Errc::bad_option, .message = "--cut and --from are for 3D"});
  std::vector<MeshField> fields = file.read_fields();
  const OutputMesh<D> mesh = file.read_mesh<D>();
  if (mesh.cells.empty())
    throw InputError({.code = Errc::encloses_nothing, .message = "there are no cells to draw", .file = a.mesh});
  std::vector<std::string> names;
  for (const MeshField& field : fields) names.push_back(field.name);
  report.set("cells", mesh.cells.size());
  report.set("fields", names);
  const std::string title = std::filesystem::path(a.mesh).filename().string();
  write_file(a.output, [&](std::ostream& out) { write_page(mesh, std::move(fields), {title, a.coloring, a.cut, a.from}, out); });
  report.mesh_files = {a.output};
  if (a.quiet) return exit_done;
  print_row("mesh", format("%s (%dD), ", a.mesh.c_str(), D) + count_cells<D>(mesh.cells.size()));
  print_row("page", a.output + ", for any browser");
  return exit_done;
}

void require_format(const ViewArguments& a, bool page, bool png) {
  const auto refuse = [&a](Errc code, const std::string& message) {
    throw UsageError({.code = code, .message = message, .file = a.output});
  };
  if (!page && !has_extension(a.output, {".png", ".svg"}))
    refuse(Errc::unknown_format, "pictures are written as .svg, .png, or .html");
  if (page && !has_page())
    refuse(Errc::bad_option, "this pgdr was built without three.js (Debian's package libjs-three): pictures are .svg and .png");
  if (png && !has_png()) refuse(Errc::bad_option, "this pgdr was built without Cairo: pictures are .svg and .html");
  if (!page && a.color == ViewColor::of_pages)
    refuse(Errc::bad_option, "--color: the colourings of pictures are dihedral, leaf, quality, region, not \"" + a.coloring +
                                 "\"; a page has more");
}

}  // namespace

int view(const ViewArguments& a, Report& report) {
  report.set("input", a.mesh);
  report.set("output", a.output);
  const bool png = has_extension(a.output, {".png"}), page = has_extension(a.output, {".html"});
  require_format(a, page, png);
  require_writable(a.output);
  InputFile file(a.mesh);
  const int dimension = file.dimension();
  report.set("dimension", dimension);
  if (!file.holds_cells())
    throw InputError({.code = Errc::unknown_format, .message = "this is no mesh: there are no cells to draw", .file = a.mesh});
  if (page) return dimension == 2 ? view_page<2>(a, file, report) : view_page<3>(a, file, report);
  return dimension == 2 ? view_mesh<2>(a, file, png, report) : view_mesh<3>(a, file, png, report);
}

}  // namespace pgdr::tool
