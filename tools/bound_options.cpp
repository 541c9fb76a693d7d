// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bound_options.hpp"

#include "pgdr/refine.hpp"
#include "remesh_options.hpp"
#include "validators.hpp"

namespace pgdr::tool {
namespace {

bool is_region_size(const std::string& text) { return split_region_size(text).has_value(); }

}  // namespace

CLI::Option* add_bounds(CLI::App& app, BoundArguments& b, const std::string& without, const std::string& without_dihedral) {
  auto* radius_edge = app.add_option("--radius-edge", b.radius_edge,
                                     "bound on circumradius over shortest edge (default " + without + ")")
                          ->type_name("R")
                          ->check(number("> 0", positive));
  app.add_option(
         "--size", b.size,
         "bound on the circumradius (3D) or the area (2D), at the centroid: a number, or an expression in x, y, z, with pi, "
         "if(c, a, b), pow, hypot, sqrt, exp, min, max, abs, sin and others (docs/usage.md)")
      ->type_name("S");
  app.add_option("--region-size", b.region_sizes,
                 "as --size, for the cells of the region with this label or name alone; repeatable, and all bounds are met")
      ->type_name("LABEL=S")
      ->allow_extra_args(false)
      ->check(shaped(is_region_size, "LABEL=S: a region's label or name, and a size"));
  add_size_unit(app, b);
  app.add_option(
         "--size-mesh", b.size_mesh,
         "as --size, from a background mesh (.mesh, .vtu): a size for each vertex in the .sol "
         "file beside it, interpolated linearly; 2D: or from a raster, an ASCII grid (.asc); with --size the smaller counts")
      ->type_name("MESH");
  app.add_option(
         "--size-at", b.size_at,
         "as --size, at points and along lines: a text with X Y [Z] S, or both ends and S, in each line; sizes grow with the "
         "distance by --size-growth")
      ->type_name("FILE");
  app.add_option(
         "--size-growth", b.size_growth,
         "most that sizes of --size-mesh and --size-field may grow a unit of length along an edge (areas: their square roots); "
         "what those of --size-at do grow (default there: 0.2)")
      ->type_name("G")
      ->check(number(">= 0", not_negative));
  app.add_option("--max-volume", b.max_volume, "bound on the volume of every tetrahedron (3D)")
      ->type_name("V")
      ->check(number("> 0", positive));
  app.add_option("--min-angle", b.min_angle,
                 "2D: smallest angle in degrees, for --radius-edge 1/(2 sin A); proved up to 20.7, `mesh` takes "
                 "up to 34")
      ->type_name("A")
      ->check(number("between 0 and 60", [](double v) { return v > 0 && v < 60; }))
      ->excludes(radius_edge);
  return app
      .add_option("--min-dihedral", b.min_dihedral,
                  "3D: smallest dihedral angle in degrees, up to 35 (default " + without_dihedral + ")")
      ->type_name("A")
      ->check(number("between 0 and 35", [](double v) { return v >= 0 && v <= most_min_dihedral; }));
}

}  // namespace pgdr::tool
