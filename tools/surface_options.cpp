// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_options.hpp"

#include "surface_tolerance.hpp"
#include "validators.hpp"

namespace pgdr::tool {
namespace {

bool is_surface_tolerance(const std::string& text) { return split_surface_tolerance(text).has_value(); }

}  // namespace

void add_surface(CLI::App& app, SurfaceArguments& arguments, const std::string& purpose) {
  auto* tolerance = app.add_option("--surface-tolerance", arguments.tolerance,
                                   "3D: " + purpose + "; a length, or E% of the diagonal of all points")
                        ->type_name("E|E%")
                        ->check(shaped(is_surface_tolerance, "a length, or a percentage as 0.1%"));
  app.add_option(
         "--feature-angle", arguments.feature_angle,
         "3D: edges at which normals differ by more than this are creases, which are kept (default 40 degrees; 180: none)")
      ->type_name("A")
      ->check(number("between 0 and 180", [](double v) { return v >= 0 && v <= 180; }))
      ->needs(tolerance);
}

}  // namespace pgdr::tool
