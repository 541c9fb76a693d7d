// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "view_options.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "validators.hpp"

namespace pgdr::tool {
namespace {

const std::map<std::string, ViewColor> view_colors{
    {"quality", ViewColor::quality}, {"dihedral", ViewColor::dihedral}, {"region", ViewColor::region}, {"leaf", ViewColor::leaf}};

bool is_direction(const std::string& text) {
  const std::vector<double> v = numbers(text);
  const double square = v.size() == 3 ? v[0] * v[0] + v[1] * v[1] + v[2] * v[2] : 0;
  return std::isnormal(square);
}

bool is_plane(const std::string& text) {
  return text.size() > 2 && text[0] >= 'x' && text[0] <= 'z' && text[1] == '=' && numbers(text.substr(2)).size() == 1;
}

}  // namespace

void add_view(CLI::App& app, ViewArguments& a) {
  app.add_option("MESH", a.mesh, "the mesh: .vtu .pvtu .vtk .msh .mesh .node .ele")->required()->type_name("");
  app.add_option("-o,--output", a.output, "the picture: .svg .png, or .html, a page that shows the mesh in any browser")
      ->required()
      ->type_name("PICTURE");
  app.add_option_function<std::string>(
         "--color",
         [&a](const std::string& t) {
           const auto known = view_colors.find(t);
           a.color = known == view_colors.end() ? ViewColor::of_pages : known->second;
           a.coloring = t;
         },
         "quality (default): by the smallest (dihedral) angle, red is poor; in 3D of the "
         "cells that a cut opens; dihedral: of all cells, in classes of degrees, red is below 5; region: by label; leaf: by leaf "
         "of the tree, of a mesh made "
         "with --leaves; a page has radius_edge, volume, marker, name and the fields of the file, too")
      ->type_name("NAME");
  app.add_option_function<std::string>(
         "--cut",
         [&a](const std::string& t) {
           a.cut = CutPlane{t[0] - 'x', numbers(t.substr(2))[0]};
         },
         "3D: leave out the cells on the eye's side of a plane, e.g. x=0.5")
      ->type_name("PLANE")
      ->check(shaped(is_plane, "x=, y= or z= and a number"));
  app.add_option_function<std::string>(
         "--from",
         [&a](const std::string& t) {
           const std::vector<double> v = numbers(t);
           a.from = Point3{{v[0], v[1], v[2]}};
         },
         "3D: the direction towards the eye (default 1,-1.5,0.8)")
      ->type_name("X,Y,Z")
      ->check(shaped(is_direction, "three numbers with commas, not all 0"));
  app.add_option("--size", a.width, "width of the picture (default 1000)")->type_name("PIXELS")->check(whole_number(16, 8000));
}

}  // namespace pgdr::tool
