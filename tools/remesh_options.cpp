// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "remesh_options.hpp"

#include <map>
#include <string>

#include "validators.hpp"

namespace pgdr::tool {
namespace {

const std::map<std::string, SizeUnit> size_units{
    {"edge", SizeUnit::edge}, {"radius", SizeUnit::radius}, {"area", SizeUnit::area}, {"volume", SizeUnit::volume}};

CLI::Option* add_required(CLI::App& app, std::vector<std::string>& required) {
  return app
      .add_option("--required", required,
                  "vertices of the old mesh with these markers, or names, are vertices of the new one, wherever they are, or all "
                  "are; others "
                  "inside of planes, lines and cells go")
      ->type_name("MARKER,...|all")
      ->delimiter(',')
      ->allow_extra_args(false);
}

CLI::Option* add_size_field(CLI::App& app, BoundArguments& b) {
  return app
      .add_option(
          "--size-field", b.size_field,
          "as --size, from a field of the old mesh: a number for each point, interpolated linearly, or for each cell, each "
          "point having the smallest of its cells; with --size the smaller counts")
      ->type_name("NAME");
}

}  // namespace

void add_remesh_options(CLI::App& app, MeshArguments& a) {
  RemeshArguments& remesh = a.remesh.emplace();
  add_size_field(app, a.bounds);
  add_required(app, remesh.required);
  app.add_flag("--no-fields", remesh.no_fields, "leave the fields of the file behind");
}

void add_refine_options(CLI::App& app, MeshArguments& a) {
  RemeshArguments& remesh = a.remesh.emplace();
  remesh.keep_vertices = true;
  add_size_field(app, a.bounds);
  app.add_option(
         "--cell-bounds", remesh.cell_bounds,
         "a bound on the volume (2D: area) for what lies in each old cell: a .vol file as TetGen has it, an .area file as "
         "Triangle has it")
      ->type_name("FILE");
  app.add_flag("--no-fields", remesh.no_fields, "leave the fields of the file behind");
}

void add_remeshed(CLI::App& app, CheckArguments& a) {
  app.add_flag("--remeshed", a.remeshed,
               "the input is a mesh, which `remesh` has made this one of: its walls are to be there, and of its "
               "points the required ones (default: as the report of --reasons says)")
      ->needs("--input");
  add_required(app, a.required)->needs("--input");
  add_size_field(app, a.bounds)->needs("--input");
}

void add_size_unit(CLI::App& app, BoundArguments& b) {
  app.add_option_function<std::string>(
         "--size-unit", [&b](const std::string& t) { b.size_unit = size_units.at(t); },
         "what all sizes are of: radius (default in 3D), area (2D, the default there), volume (3D), or edge: the mean length of "
         "edges")
      ->type_name("UNIT")
      ->check(one_of(size_units, "units"));
}

}  // namespace pgdr::tool
