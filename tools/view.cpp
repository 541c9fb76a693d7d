// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr view: a picture of a mesh.
#include "command.hpp"
#include "console.hpp"
#include "files.hpp"
#include "pgdr/io.hpp"
#include "pgdr/output_files.hpp"
#include "picture.hpp"

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

}  // namespace

int view(const ViewArguments& a, Report& report) {
  report.set("input", a.mesh);
  report.set("output", a.output);
  const bool png = has_extension(a.output, {".png"});
  if (!has_extension(a.output, {".png", ".svg"}))
    throw UsageError({.code = Errc::unknown_format, .message = "pictures are written as .svg or .png", .file = a.output});
  if (png && !has_png())
    throw UsageError(
        {.code = Errc::bad_option, .message = "this pgdr was built without Cairo: pictures are .svg alone", .file = a.output});
  require_writable(a.output);
  InputFile file(a.mesh);
  const int dimension = file.dimension();
  report.set("dimension", dimension);
  if (!file.holds_cells())
    throw InputError({.code = Errc::unknown_format, .message = "this is no mesh: there are no cells to draw", .file = a.mesh});
  return dimension == 2 ? view_mesh<2>(a, file, png, report) : view_mesh<3>(a, file, png, report);
}

}  // namespace pgdr::tool
