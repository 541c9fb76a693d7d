// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_report.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "console.hpp"
#include "kept.hpp"
#include "selector.hpp"
#include "trace.hpp"

namespace pgdr::tool {
namespace {

/// Threads that have run any visit. What comes before the visits runs on one.
template <int D>
std::size_t threads_that_ran(const RefineResult<D>& r) {
  return std::max<std::size_t>(r.scheduler.busy_seconds.size(), 1);
}

/// Are the violations of the finished mesh counted? Not after a run that was ended early, as such a mesh may have many, and each
/// takes rationals; and not where the optimiser ran, which makes them. (All faces take a tenth of the time of meshing.)
template <int D>
bool counts_violations(const RefineResult<D>& r) {
  return r.delaunay && r.stop != StopCause::cancelled && r.stop != StopCause::time_limit;
}

Json json_of(const std::optional<NotDelaunay>& n) {
  return n ? Json(JsonObject{{"rounding", n->rounding}, {"refused", n->other}}) : Json(nullptr);
}

std::string words(const SchedulerStatistics& s, std::size_t threads) {
  return count(threads, "thread", "threads") + ", " + count(s.visits, "visit", "visits") + " of " +
         count(s.leaves, "leaf", "leaves") + " in " + count(s.generations, "generation", "generations") +
         format(", at most %u at once", s.max_concurrent);
}

}  // namespace

template <int D>
Measured measure(const RefineResult<D>& r) {
  Measured m{r.mesh.points.size(), r.mesh.cells.size(), summarize_quality(r.mesh), std::nullopt};
  if (counts_violations(r)) m.not_delaunay = count_not_delaunay(r.mesh, r.violations_seen);
  return m;
}

/// The same on all ranks.
template <int D>
Measured measure(Transport& transport, const DistributedResult<D>& r) {
  Measured m{r.piece.total.points, r.piece.total.cells, summarize_quality(transport, r.piece), std::nullopt};
  if (counts_violations(r.run)) m.not_delaunay = count_not_delaunay(transport, r);
  return m;
}

template <int D>
void fill(Report& report, const MeshArguments& a, const Threads& threads, const Bounds<D>& bounds, const RefineResult<D>& r,
          const Measured& measured) {
  const RefineStatistics& s = r.statistics;
  report.set("vertices", measured.vertices);
  report.set("cells", measured.cells);
  report.set("threads", JsonObject{{"requested", threads.requested()}, {"ran", threads_that_ran(r)}});
  report.set("schedule", name(a.schedule));
  report.set("claims", name(a.claims));
  report.set("reproducible", a.schedule != Schedule::greedy && r.stop != StopCause::time_limit && r.stop != StopCause::cancelled);
  report.set("stop", name(r.stop));
  report.set("refined", !a.no_refine);
  report.set("selector", a.selector.value_or(usual_selector<D>()));
  report.set("seconds", nullptr);  // their places; the values come last
  report.set("peak_rss_bytes", nullptr);
  JsonObject quality = to_json(measured.quality);
  quality.set("not_delaunay", json_of(measured.not_delaunay));
  report.set("quality", quality);
  report.set("delaunay", r.delaunay);
  if (r.optimization.target > 0) report.set("optimization", to_json(r.optimization, r.stop == StopCause::finished));
  report.set("bounds", JsonObject{{"radius_edge", bounds.radius_edge},
                                  {"size_met", r.size_met},
                                  {"poor_left", r.poor_left},
                                  {"poor_unavoidable", r.poor_unavoidable},
                                  {"reasons", to_json(r.reasons)}});
  set_kept(report, a.kept, s);
  report.set("unused_points", JsonObject{{"count", r.unused_points.size()}, {"dropped", a.drop_unused_points}});
  report.set("regions", to_json(r.regions));
  report.set("scheduler", to_json(r.scheduler));
  report.set("stages", to_json(s.stages));
  report.set("insertions", JsonObject{{"committed", s.insertions_committed}, {"refused", s.insertions_refused}});
  report.set("predicates", to_json(s.predicates));
  report.set("selector_outside", s.selector_outside);
  report.set("selector_further", s.selector_further);
  report.set("selector_dropped", s.selector_dropped);
  report.set("warnings", to_json(r.warnings));
  report.set("repairs", to_json(r.repairs));
}

template <int D>
void print_summary(const MeshArguments& a, const std::string& inputs, std::size_t points, const Bounds<D>& bounds,
                   const RefineResult<D>& r, const Measured& measured, const Seconds& seconds, double seconds_of_surface) {
  const QualitySummary& q = measured.quality;
  print_row("input", format("%s (%dD, %s)", inputs.c_str(), D, count(points, "point", "points").c_str()));
  if (!r.repairs.empty()) print_row("repaired", count(r.repairs.size(), "defect", "defects") + ", see --report");
  print_row("mesh", count(measured.vertices, "vertex", "vertices") + ", " + count_cells<D>(measured.cells));
  if (!r.unused_points.empty())
    print_row("unused", count(r.unused_points.size(), "point is in no cell", "points are in no cell") +
                            (a.drop_unused_points ? " and dropped" : ", as nodes; --drop-unused-points leaves them out"));
  if (measured.cells > 0) {
    const std::string least = r.optimization.target > 0 ? format(" (bound %.4g)", r.optimization.target) : "";
    print_row("quality",
              format("radius-edge up to %.4f (bound %.4g), %s %.2f to %.2f degrees%s", q.max_radius_edge, bounds.radius_edge,
                     D == 3 ? "dihedral angles" : "angles", q.min_angle_deg, q.max_angle_deg, least.c_str()));
  }
  if (r.stop != StopCause::finished && measured.cells == 0)
    print_row("stopped", format("%s, before the boundary was there: there is no mesh to write", stop_words(r.stop)));
  else if (r.stop != StopCause::finished)
    print_row("stopped",
              format("%s: the mesh is valid, ", stop_words(r.stop)) + count(r.poor_left, "element is poor", "elements are poor"));
  else if (a.no_refine)
    print_row("bounds", "not refined: " + count(r.poor_left, "element is", "elements are") + " over a bound");
  else
    print_row("bounds", verdict(r));
  print_kept(r.statistics);
  if (D == 3 && !a.surface.tolerance && has_needles(r))
    print_row("needles",
              "cells stay poor beside small angles of the surface; --surface-tolerance 0.1% meshes another one as near to it");
  print_row("time", format("%.3f s meshing (%.3f s read, %.3f s write)", r.statistics.seconds_mesh + seconds_of_surface,
                           seconds.read, seconds.write));
  print_row("threads", words(r.scheduler, threads_that_ran(r)));
  print_row("memory", format("%.1f MiB at most", static_cast<double>(peak_rss_bytes()) / (1 << 20)));
  if (measured.cells > 0) print_row("wrote", a.output);
}

template <int D>
void write_trace(const MeshArguments& a, const RefineResult<D>& r, const Seconds& seconds) {
  const RefineStatistics& s = r.statistics;
  const double refine_at = seconds.mesh_at + s.seconds_initial, optimize_at = refine_at + s.seconds_refine;
  const double compact_at = optimize_at + s.seconds_optimize;
  std::vector<Phase> phases{{"read", seconds.read_at, seconds.read_at + seconds.read},
                            {"initial", seconds.mesh_at, refine_at},
                            {"refine", refine_at, optimize_at},
                            {"optimize", optimize_at, compact_at},
                            {"compact", compact_at, seconds.mesh_at + s.seconds_mesh},
                            {"write", seconds.write_at, seconds.write_at + seconds.write}};
  write_trace(a.trace, phases, s.stages, r.trace, seconds.mesh_at);
}

#define PGDR_INSTANTIATE(D)                                                                                      \
  template Measured measure<D>(const RefineResult<D>&);                                                          \
  template Measured measure<D>(Transport&, const DistributedResult<D>&);                                         \
  template void fill<D>(Report&, const MeshArguments&, const Threads&, const Bounds<D>&, const RefineResult<D>&, \
                        const Measured&);                                                                        \
  template void print_summary<D>(const MeshArguments&, const std::string&, std::size_t, const Bounds<D>&,        \
                                 const RefineResult<D>&, const Measured&, const Seconds&, double);               \
  template void write_trace<D>(const MeshArguments&, const RefineResult<D>&, const Seconds&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
