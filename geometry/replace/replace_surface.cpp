// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "input/diagonal.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/surface.hpp"
#include "replace/changer.hpp"
#include "replace/coarsen.hpp"
#include "replace/numbers.hpp"
#include "replace/result.hpp"

namespace pgdr {
namespace {

void require_options(const Plc<3>& input, const SurfaceOptions& o) {
  const auto refuse = [](const std::string& message) { throw UsageError({Errc::bad_option, message, {}, 0, {}, {}}); };
  const auto is_angle = [](double a) { return a >= 0 && a <= 180; };
  if (!(o.tolerance > 0) || !std::isfinite(o.tolerance)) refuse("the surface tolerance has to be positive and finite");
  const double least = numbers::least_of_tolerance * tolerance_of(input);
  if (!(o.tolerance >= least))
    refuse("the surface tolerance is " + std::to_string(o.tolerance) + ", and has to be " + std::to_string(least) +
           " or more, 16 times the tolerance within which things meet");
  if (!is_angle(o.feature_angle) || !is_angle(o.wanted_corner)) refuse("angles have to be between 0 and 180 degrees");
}

/// The distance that changes are held to, so that with what the input's own joining and rounding have moved it stays below the
/// tolerance.
double used_tolerance(const Domain<3>& domain, double tolerance) {
  double largest = 0;
  for (const Point3& p : domain.points())
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  return numbers::used_part * tolerance - 2 * domain.tolerance() - 8 * largest * 0x1p-52;
}

/// A seed that is within the tolerance of the surface could change sides.
void require_deep_seeds(const Plc<3>& input, const detail::GivenSurface& given, std::size_t classes, double tolerance) {
  const auto require = [&](const Point3& seed, const char* what) {
    double square = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < classes; ++k) square = std::min(square, given.nearest(seed, k).square);
    if (square > tolerance * tolerance) return;
    throw InputError({Errc::seed_on_boundary,
                      std::string("the seed of a ") + what + " is " + std::to_string(std::sqrt(square)) +
                          " from the surface, within the surface tolerance " + std::to_string(tolerance) +
                          ": which volume it means would not be certain",
                      {},
                      0,
                      {},
                      {seed.x}});
  };
  for (const Point3& p : input.holes) require(p, "hole");
  for (const auto& r : input.regions) require(r.point, "region");
}

/// The phases: where there is room first, with corners of half of what is wanted, which the room is for; then as far as the
/// tolerance goes. Coarsening behind the splits takes back what was not needed of these. Edges come last, when there are no more
/// than are needed.
/// @returns false if the token ended them
bool change_surface(detail::Changer& changer, double e, double wanted_degrees, const std::stop_token& stop) {
  const auto corner = [](double degrees) { return detail::half_tangent(degrees); };
  const double first = numbers::first_part * e;
  if (!improve(changer, first, corner(wanted_degrees / 2), 0, detail::Improved::corners, stop)) return false;
  if (!coarsen(changer, first, corner(wanted_degrees / 2), stop)) return false;
  std::uint64_t faces = 0;
  for (const auto& f : changer.complex().faces) faces += f.alive;
  return improve(changer, e, corner(wanted_degrees), numbers::first_splits * faces, detail::Improved::corners, stop) &&
         coarsen(changer, e, corner(wanted_degrees), stop) &&
         improve(changer, e, corner(wanted_degrees), numbers::second_splits * faces, detail::Improved::corners_and_edges, stop);
}

ReplacedSurface replaced(const Plc<3>& input, const SurfaceOptions& options) {
  const Domain<3> domain(input, options.stop);
  require_no_errors(domain, options.stop);
  ReplacedSurface out;
  SurfaceReport& report = out.report;
  report.tolerance = options.tolerance;
  report.used = used_tolerance(domain, options.tolerance);
  report.feature_angle = options.feature_angle;
  detail::LoosePieces loose;
  auto complex = detail::make_complex(input, domain, report.used, options, loose, report.creases);
  const double diagonal = detail::diagonal_of(detail::Box<3>::of(domain.points()));
  detail::find_groups(complex, std::min(numbers::flat_part * diagonal, report.used / 2), domain.tolerance(), report.used);
  std::vector<Point3> seeds(input.holes);
  for (const auto& r : input.regions) seeds.push_back(r.point);
  detail::ChangingSurface surface(std::move(complex), std::move(loose), std::move(seeds));
  require_deep_seeds(input, surface.given, surface.complex.classes.size(), options.tolerance);
  const detail::ResultMaker maker(input, domain, surface);
  maker.measure(report, 0);
  detail::Changer changer(surface, report.used, options.size, report);
  report.stopped = !change_surface(changer, report.used, options.wanted_corner, options.stop);
  maker.measure(report, 1);
  maker.make(out);
  return out;
}

}  // namespace

ReplacedSurface replace_surface(const Plc<3>& input, const SurfaceOptions& options) {
  require_options(input, options);
  const auto began = std::chrono::steady_clock::now();
  ReplacedSurface out = replaced(input, options);
  out.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return out;
}

}  // namespace pgdr
