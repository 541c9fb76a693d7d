// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_step.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "console.hpp"
#include "pgdr/domain.hpp"
#include "surface_output.hpp"
#include "surface_tolerance.hpp"

namespace pgdr::tool {
namespace {

/// The circumradius of a triangle of 30 degrees is its shortest edge. Triangles of 14.5 degrees are too sharp for the bound of 15
/// on dihedral angles; beyond a larger one there is some headroom, too.
constexpr double usual_wanted_corner = 30, headroom = 10;

JsonObject refusals(const SurfaceReport::Refused& r) {
  return {{"angle", r.angle},       {"fold", r.fold},   {"cells", r.cells}, {"size", r.size},
          {"distance", r.distance}, {"meets", r.meets}, {"gap", r.gap},     {"swept", r.swept}};
}

/// The least of the sizes that are asked for at a point; none if none is.
std::function<double(const Point3&)> size_of(const Bounds<3>& bounds) {
  std::vector<SizingField<3>> fields;
  if (bounds.size.bounded()) fields.push_back(bounds.size);
  for (const RegionSize<3>& r : bounds.region_sizes)
    if (r.size.bounded()) fields.push_back(r.size);
  if (fields.empty()) return {};
  return [fields](const Point3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& field : fields) least = std::min(least, field.at(p));
    return least;
  };
}

}  // namespace

void require_3d(const SurfaceArguments& arguments, int dimension) {
  if (arguments.tolerance && dimension == 2)
    throw UsageError({.code = Errc::bad_option, .message = "--surface-tolerance is for 3D"});
  if (!arguments.output.empty()) require_surface_writable(arguments.output);
}

SurfaceStep replace_surface(const Plc<3>& plc, const SurfaceArguments& arguments, std::optional<double> tolerance,
                            const Bounds<3>& bounds, std::vector<int> fixed_markers, const std::stop_token& stop) {
  SurfaceOptions options;
  options.tolerance = surface_tolerance(*arguments.tolerance, plc, tolerance);
  require_fine_surface_tolerance(options.tolerance, plc);
  if (arguments.feature_angle) options.feature_angle = *arguments.feature_angle;
  options.wanted_corner = std::max(usual_wanted_corner, bounds.min_dihedral.value_or(0) + headroom);
  options.fixed_markers = std::move(fixed_markers);
  options.stop = stop;
  options.size = size_of(bounds);
  SurfaceStep step{*arguments.tolerance, pgdr::replace_surface(plc, options), surface_counts(plc), {}};
  step.after = surface_counts(Domain<3>(step.replaced.plc, stop));
  if (!arguments.output.empty()) write_surface(arguments.output, step.replaced.plc);
  return step;
}

void set_surface(Report& report, const SurfaceStep& step) {
  const SurfaceReport& r = step.replaced.report;
  report.set("surface_tolerance", JsonObject{{"given", step.given},
                                             {"length", r.tolerance},
                                             {"used", r.used},
                                             {"feature_angle", r.feature_angle},
                                             {"triangles", r.triangles},
                                             {"counted_corners_below_14.5", r.sharp_triangles},
                                             {"smallest_counted_corner", r.smallest_corner},
                                             {"heights_below_14.5", r.sharp_heights},
                                             {"creases", r.creases},
                                             {"corners", r.corners},
                                             {"flat_groups", r.flat_groups},
                                             {"contracted", r.contracted},
                                             {"flipped", r.flipped},
                                             {"moved", r.moved},
                                             {"split", r.split},
                                             {"refused", refusals(r.refused)},
                                             {"distance", JsonObject{{"to_given", r.to_given}, {"from_given", r.from_given}}},
                                             {"farthest_point", r.farthest_point.x},
                                             {"given_up", r.given_up},
                                             {"stopped", r.stopped},
                                             {"seconds", r.seconds}});
  report.set("surface", JsonObject{{"given", to_json(step.before)}, {"meshed", to_json(step.after)}});
}

void print_surface(const SurfaceStep& step) {
  const SurfaceReport& r = step.replaced.report;
  print_row("surface", count(r.triangles[1], "triangle", "triangles") + " in place of " + std::to_string(r.triangles[0]) +
                           format(", within %.4g; corners below 14.5 degrees: %llu, were %llu (%.3f s)", r.tolerance,
                                  static_cast<unsigned long long>(r.sharp_triangles[1]),
                                  static_cast<unsigned long long>(r.sharp_triangles[0]), r.seconds));
  if (r.sharp_triangles[0] > 0)
    print_row("", format("heights of those that were: half of them up to %.4g, the largest %.4g", r.sharp_heights[0],
                         r.sharp_heights[1]));
}

}  // namespace pgdr::tool
