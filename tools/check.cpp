// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr check: the verdict of the independent checker on a mesh file.
#include "pgdr/check.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bodies.hpp"
#include "bounds.hpp"
#include "command.hpp"
#include "console.hpp"
#include "files.hpp"
#include "input.hpp"
#include "old_mesh.hpp"
#include "periodic.hpp"
#include "pgdr/check_bodies.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine.hpp"
#include "surface_tolerance.hpp"

namespace pgdr::tool {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// As it was given: 2D, where segments cross, too. 3D, where facets cross, or openings are to be closed: as `mesh` has done
/// that, within the tolerance of its report if none is given.
template <int D>
std::optional<Plc<D>> read_input_of_mesh(const std::vector<std::string>& inputs, InputArguments reading,
                                         std::optional<double> tolerance) {
  for (const std::string& input : inputs) require_input_format(input);
  Inputs files(inputs);
  if (files.dimension() != D)
    throw UsageError(
        {.code = Errc::bad_option, .message = format("the mesh is %dD, its input is not", D), .file = inputs.front()});
  if (D == 2) reading.resolve_crossings = false;
  Plc<D> plc = files.read_given<D>(reading);
  const bool is_changed = reading.resolve_crossings || reading.close_openings;
  if (is_changed && !reading.tolerance && tolerance && *tolerance != tolerance_of(plc)) plc.tolerance = tolerance;
  std::vector<Diagnostic> repairs;
  return treated<D>(std::move(plc), reading, repairs);
}

/// The options of another surface. @throws UsageError in 2D, and what surface_tolerance() throws
template <int D>
void set_surface(const CheckArguments& a, const ReportedBounds& reported, CheckOptions<D>& options) {
  if (!a.surface.tolerance) return;
  if constexpr (D == 3) {
    options.surface_tolerance = surface_tolerance(*a.surface.tolerance, *options.input, options.tolerance);
    options.feature_angle = a.surface.feature_angle.value_or(reported.feature_angle.value_or(options.feature_angle));
  } else {
    throw UsageError({.code = Errc::bad_option, .message = "--surface-tolerance is for 3D"});
  }
}

template <int D>
void fill(Report& report, const OutputMesh<D>& mesh, const Bounds<D>& bounds, const std::optional<QualitySummary>& q,
          const CheckReport& r, bool delaunay, std::size_t unused) {
  report.set("vertices", mesh.points.size());
  report.set("cells", mesh.cells.size());
  report.set("unused_points", JsonObject{{"count", unused}});
  if (q) {
    JsonObject quality = to_json(*q);
    if (delaunay)
      quality.set("not_delaunay", JsonObject{{"rounding", r.not_delaunay_rounding},
                                             {"refused", r.not_delaunay_refused},
                                             {"unexplained", r.not_delaunay_unexplained}});
    else
      quality.set("not_delaunay", nullptr);
    report.set("quality", quality);
  }
  report.set("bounds", JsonObject{{"radius_edge", bounds.radius_edge},
                                  {"size_met", r.over_size == 0},
                                  {"over_radius_edge", r.over_radius_edge},
                                  {"over_size", r.over_size},
                                  {"below_dihedral", r.below_dihedral},
                                  {"explained", r.explained},
                                  {"unexplained", r.unexplained}});
  report.set("delaunay", delaunay);
  report.set("verdict", r.exit_code());
  report.set("finding_count", r.finding_count);
  report.set("findings", to_json(r.findings));
}

/// The cells that are not Delaunay, for --list-not-delaunay: all in the report, the first in words.
template <int D>
void list_not_delaunay(const OutputMesh<D>& mesh, bool quiet, Report& report) {
  constexpr std::size_t most_rows = 20;
  const std::vector<NotDelaunayCell> found = cells_not_delaunay(mesh);
  std::vector<std::array<std::uint32_t, 2>> cells;
  for (const NotDelaunayCell& c : found) cells.push_back({c.cell, c.vertex});
  report.set("not_delaunay_cells", JsonObject{{"count", cells.size()}, {"cells", cells}});
  if (quiet) return;
  print_row("delaunay", cells.empty()
                            ? "all cells are, but for what is beyond " + std::string(D == 3 ? "subfacets" : "subsegments")
                            : count(cells.size(), "cell is not", "cells are not"));
  for (std::size_t i = 0; i < std::min(cells.size(), most_rows); ++i)
    print_row("", format("cell %u has vertex %u inside its circumsphere", cells[i][0], cells[i][1]));
  if (cells.size() > most_rows) print_row("", count(cells.size() - most_rows, "more", "more"));
}

template <int D>
void print_summary(const CheckArguments& a, const OutputMesh<D>& mesh, const Bounds<D>& bounds,
                   const std::optional<QualitySummary>& q, const CheckReport& r, std::size_t unused,
                   std::optional<double> surface_tolerance, const PeriodicCheck& in_step) {
  print_row("mesh", format("%s (%dD, ", a.mesh.c_str(), D) + count(mesh.points.size(), "vertex", "vertices") + ", " +
                        count_cells<D>(mesh.cells.size()) + ')');
  if (unused > 0) print_row("unused", count(unused, "vertex is in no cell", "vertices are in no cell"));
  print_row("input", a.inputs.empty() ? "not given: conformity was not checked" : Inputs(a.inputs).words());
  if (q)
    print_row("quality", format("radius-edge up to %.4f, %s %.2f to %.2f degrees", q->max_radius_edge,
                                D == 3 ? "dihedral angles" : "angles", q->min_angle_deg, q->max_angle_deg));
  if (bounds.radius_edge == unbounded) print_row("bounds", "no radius-edge bound was given");
  if (r.over_radius_edge + r.over_size + r.below_dihedral > 0)
    print_row("bounds", count(r.over_radius_edge, "cell", "cells") + " over the radius-edge bound, " +
                            count(r.over_size, "cell", "cells") + " over a size bound, " +
                            (D == 3 ? count(r.below_dihedral, "cell", "cells") + " below the dihedral bound, " : "") +
                            count(r.explained, "cell", "cells") + " with a reason that holds" +
                            (r.unexplained > 0 ? ", " + count(r.unexplained, "cell", "cells") + " unexplained" : ""));
  if (r.not_delaunay_rounding + r.not_delaunay_refused + r.not_delaunay_unexplained > 0)
    print_row("delaunay", count(r.not_delaunay_rounding, "local violation", "local violations") + " by rounding, " +
                              std::to_string(r.not_delaunay_refused) + " beside refused entities, " +
                              std::to_string(r.not_delaunay_unexplained) + " unexplained");
  if (surface_tolerance)
    print_row("surface", format("another one, to be within %.6g of the given one, both ways", *surface_tolerance) +
                             (r.undecided_volumes > 0
                                  ? "; " + count(r.undecided_volumes, "volume is", "volumes are") + " too thin to be told apart"
                                  : ""));
  for (const CheckFinding& f : r.findings) print_row("found", std::string(name(f.kind)) + ": " + f.message);
  if (r.finding_count > r.findings.size()) print_row("found", count(r.finding_count - r.findings.size(), "more", "more"));
  print_periodic(in_step.pairs);
  if (in_step.failure) print_row("periodic", "FAILED: " + in_step.failure->message);
  const int code = in_step.failure ? exit_check_failed : r.exit_code();
  print_row("verdict", code == exit_done        ? r.not_delaunay_refused == 0 ? "everything holds" : "every bound holds"
                       : code == exit_poor_left ? r.unexplained + r.not_delaunay_unexplained > 0
                                                      ? "sound; over a bound also where nothing explains it"
                                                      : "sound; over a bound only where the reasons explain it"
                                                : "FAILED");
}

/// The tolerance of an input of the points of a mesh.
template <int D>
double rounding_of(const OutputMesh<D>& mesh) {
  Plc<D> plc;
  plc.points = mesh.points;
  return rounding_tolerance(plc);
}

/// The boundary of the mesh that this one was made of, which of its points are required, and bounds that its fields are.
template <int D>
Plc<D> read_old_mesh(const CheckArguments& a, const InputArguments& reading, const ReportedBounds& reported, Bounds<D>& bounds,
                     std::optional<std::vector<std::uint8_t>>& required) {
  if (a.inputs.size() != 1) throw UsageError({.code = Errc::bad_option, .message = "--remeshed takes one mesh as --input"});
  InputFile file(a.inputs.front());
  const OldMesh<D> old(file, !a.bounds.size_field.empty());
  bounds.size = smallest<D>({bounds.size, old.sizes(a.bounds)});
  const std::vector<std::uint8_t> vertices = old.required(a.required.empty() ? reported.required : a.required);
  MeshBoundary<D> boundary = boundary_with_vertices<D>(old.mesh(), vertices);
  required = required_points(boundary, vertices);
  if constexpr (D == 3)
    if (a.surface.tolerance) drop_plain_segments(boundary.plc);
  return Inputs::as_asked<D>(std::move(boundary.plc), reading);
}

template <int D>
int check_as(const CheckArguments& a, InputFile& file, Report& report) {
  ReportedBounds reported;
  if (!a.reasons.empty()) reported = read_bounds(a.reasons);
  Bounds<D> bounds = resolve<D>(a.bounds, reported.radius_edge.value_or(unbounded));
  const StatedPeriods stated = periods_of<D>(file);
  const OutputMesh<D> mesh = file.read_mesh<D>();
  report.set("warnings", to_json(file.warnings()));
  if (!a.quiet) print_warnings(file.warnings());
  InputArguments reading = a.reading;
  reading.convex_hull = reading.convex_hull || reported.convex_hull;
  reading.region_areas = reading.region_areas || reported.region_areas;
  reading.resolve_crossings = reading.resolve_crossings || reported.resolve_crossings;
  reading.close_openings = reading.close_openings || reported.close_openings;
  if (!reading.markers) reading.markers = reported.markers;
  if (reading.seeds.empty()) reading.seeds = reported.seeds;
  if (reading.holes.empty()) reading.holes = reported.holes;
  if (!a.regions) reading.bodies = reported.bodies;
  std::optional<Plc<D>> plc;
  std::optional<std::vector<std::uint8_t>> required;
  if (!a.inputs.empty() && (a.remeshed || reported.remeshed))
    plc = read_old_mesh(a, reading, reported, bounds, required);
  else if (!a.required.empty() || !a.bounds.size_field.empty())
    throw UsageError({.code = Errc::bad_option, .message = "--required and --size-field are for meshes as --input: --remeshed"});
  else if (!a.inputs.empty())
    plc = read_input_of_mesh<D>(a.inputs, reading, reported.tolerance);
  std::optional<Plc<D>> with_bodies;  // what the mesh was made of
  if (plc && reading.bodies) label_bodies(with_bodies.emplace(*plc), reading);
  resolve_names(with_bodies ? with_bodies->names : plc ? plc->names : mesh.names, bounds);
  if (!reading.tolerance) reading.tolerance = reported.tolerance;

  CheckOptions<D> options;
  if (plc) options.input = with_bodies ? &*with_bodies : &*plc;
  options.required_points = std::move(required);
  options.tolerance = reading.tolerance;
  options.radius_edge_bound = bounds.radius_edge;
  options.size = bounds.size;
  options.region_sizes = bounds.region_sizes;
  options.max_measure = bounds.max_volume;
  options.seed_sizes = reported.refined;
  options.largest_cosine = reported.largest_cosine.value_or(1);
  if (bounds.min_dihedral) options.largest_cosine = claimed_cosine(*bounds.min_dihedral);
  options.delaunay = a.delaunay || reported.delaunay;
  options.conforming_delaunay = a.conforming_delaunay || reported.conforming_delaunay;
  options.not_delaunay_left = reported.not_delaunay_left;
  options.regions = a.regions.value_or(reported.regions);
  options.keep_boundary = a.kept.any() || reported.keep_boundary;
  options.kept_markers = a.kept.any() ? a.kept.markers() : reported.kept_markers;
  if (!a.reasons.empty()) options.reasons = &reported.reasons;
  set_surface(a, reported, options);
  const std::vector<std::string>& periodic = a.periodic.empty() ? reported.periodic : a.periodic;
  const double tolerance = options.tolerance.value_or(plc ? tolerance_of(*plc) : rounding_of(mesh));
  const PeriodicCheck in_step = check_periodic(mesh, periodic_sides<D>(periodic, plc ? plc->names : mesh.names), stated,
                                               2 * tolerance);
  for (const PeriodicPairs& p : in_step.pairs) options.kept_sides.insert(options.kept_sides.end(), {p.from, p.to});
  CheckReport verdict = pgdr::check(mesh, options);
  std::optional<BodyCheck> bodies;
  if constexpr (D == 3)
    if (with_bodies)
      bodies = check_bodies(mesh, *plc, *reading.bodies,
                            options.surface_tolerance ? options.surface_tolerance : options.tolerance, verdict);
  std::optional<QualitySummary> quality;  // of a mesh whose numbers can be used at all
  if (verdict.count(CheckFinding::Kind::bad_index) + verdict.count(CheckFinding::Kind::not_finite) == 0)
    quality = summarize_quality(mesh);
  if (a.list_not_delaunay && quality) list_not_delaunay(mesh, a.quiet, report);
  if (in_step.failure) report.add_error(*in_step.failure);
  if (in_step.failure || !in_step.pairs.empty())
    in_step.failure ? report.set("periodic", nullptr) : set_periodic(report, in_step.pairs);
  const std::size_t unused = unused_points(mesh).size();
  fill(report, mesh, bounds, quality, verdict, options.delaunay, unused);
  if (options.surface_tolerance)
    report.set("surface_tolerance", JsonObject{{"given", *a.surface.tolerance},
                                               {"length", *options.surface_tolerance},
                                               {"feature_angle", options.feature_angle},
                                               {"undecided_volumes", verdict.undecided_volumes}});
  if (bodies) report.set("bodies", JsonObject{{"checked", bodies->done}, {"left_out", bodies->left_out}});
  if (!a.quiet) print_summary(a, mesh, bounds, quality, verdict, unused, options.surface_tolerance, in_step);
  if (!a.quiet && bodies)
    print_row("bodies", bodies->done ? "as rays through the given facets count them" : "not checked: " + bodies->left_out);
  return in_step.failure ? exit_check_failed : verdict.exit_code();
}

}  // namespace

int check(const CheckArguments& arguments, Report& report) {
  report.set("mesh", arguments.mesh);
  if (!arguments.inputs.empty()) report.set("input", Inputs(arguments.inputs).json());
  InputFile file(arguments.mesh);
  const int dimension = file.dimension();
  report.set("dimension", dimension);
  return dimension == 2 ? check_as<2>(arguments, file, report) : check_as<3>(arguments, file, report);
}

}  // namespace pgdr::tool
