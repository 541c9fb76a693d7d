// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reports.hpp"

#include <pybind11/stl.h>

#include "errors.hpp"
#include "pgdr/check.hpp"
#include "pgdr/quality.hpp"
#include "words.hpp"

namespace pgdr::python {
namespace {

using namespace pybind11::literals;

py::dict to_python(const MeasureSummary& m) { return py::dict("min"_a = m.least, "1%"_a = m.one_percent, "mean"_a = m.mean); }

py::dict measures_of(const QualityMeasures& q) {
  const auto& [least, one, five] = q.smallest_angle_quantiles_deg;
  return py::dict("max_radius_edge"_a = q.max_radius_edge, "min_angle_deg"_a = q.min_angle_deg,
                  "max_angle_deg"_a = q.max_angle_deg,
                  "smallest_angles_deg"_a = py::dict("0.1%"_a = least, "1%"_a = one, "5%"_a = five),
                  "radius_ratio"_a = to_python(q.radius_ratio), "scaled_jacobian"_a = to_python(q.scaled_jacobian),
                  "cells_by_smallest_angle"_a = q.cells_by_smallest_angle, "histogram"_a = q.histogram);
}

py::dict to_python(const SchedulerStatistics& s) {
  return py::dict("leaves"_a = s.leaves, "generations"_a = s.generations, "cycles"_a = s.cycles, "visits"_a = s.visits,
                  "set_aside"_a = s.set_aside, "serial_seconds"_a = s.serial_seconds, "work_seconds"_a = s.work_seconds,
                  "critical_path_seconds"_a = s.critical_path_seconds, "max_concurrent"_a = s.max_concurrent,
                  "busy_seconds"_a = s.busy_seconds);
}

py::dict to_python(const OptimizationStatistics& s) {
  return py::dict("target"_a = s.target, "claimed_cosine"_a = s.claimed_cosine, "moves"_a = s.moves,
                  "edge_removals"_a = s.edge_removals, "reconnections"_a = s.reconnections, "inserted"_a = s.inserted,
                  "removed"_a = s.removed, "evaluated"_a = s.evaluated, "left"_a = s.left, "unexplained"_a = s.unexplained);
}

}  // namespace

template <int D>
py::dict quality_of(const MeshData<D>& data) {
  QualitySummary q;
  {
    const py::gil_scoped_release others_run;
    q = summarize_quality(data.mesh);
  }
  py::dict all = measures_of(q);
  py::list regions;
  for (const RegionQuality& r : q.regions) {
    py::dict region = measures_of(r);
    region["label"] = r.label;
    regions.append(region);
  }
  all["regions"] = regions;
  return all;
}

/// CheckOptions::not_delaunay_left. None are left where the refinement met none.
template <int D>
std::uint64_t not_delaunay_left(const RefineResult<D>& result, const OutputMesh<D>& mesh) {
  return result.delaunay && result.violations_seen ? count_not_delaunay(mesh).other : 0;
}

template <int D>
py::dict to_python(const RefineResult<D>& result, const OutputMesh<D>& mesh) {
  const RefineStatistics& s = result.statistics;
  const PredicateCounts& p = s.predicates;
  py::list stages, regions;
  for (const StageTime& t : s.stages)
    stages.append(py::dict("name"_a = t.name, "seconds"_a = t.seconds, "work"_a = t.work, "path"_a = t.path));
  for (const RegionVolume& r : result.regions)
    regions.append(py::dict("label"_a = r.label, "volume_meshed"_a = r.volume_meshed, "volume_given"_a = r.volume_given));
  py::dict all("seconds"_a = py::dict("mesh"_a = s.seconds_mesh, "initial"_a = s.seconds_initial, "refine"_a = s.seconds_refine,
                                      "optimize"_a = s.seconds_optimize),
               "stages"_a = stages, "threads"_a = result.scheduler.threads, "scheduler"_a = to_python(result.scheduler),
               "insertions"_a = py::dict("segment_points"_a = s.segment_points, "facet_points"_a = s.facet_points,
                                         "boundary_points"_a = s.boundary_points, "inner_points"_a = s.inner_points,
                                         "committed"_a = s.insertions_committed, "refused"_a = s.insertions_refused),
               "selector_outside"_a = s.selector_outside, "selector_further"_a = s.selector_further,
               "selector_dropped"_a = s.selector_dropped,
               "predicates"_a = py::dict("filter"_a = p.filter, "expansion"_a = p.expansion, "exact"_a = p.exact,
                                         "perturbed"_a = p.perturbed),
               "unused_points"_a = result.unused_points.size(), "regions"_a = regions, "delaunay"_a = result.delaunay,
               "not_delaunay_left"_a = not_delaunay_left(result, mesh), "tolerance"_a = result.tolerance,
               "largest_move"_a = result.largest_move);
  if (result.optimization.target > 0) all["optimization"] = to_python(result.optimization);
  return py::dict("stop"_a = tool::name(result.stop), "poor_left"_a = result.poor_left,
                  "poor_unavoidable"_a = result.poor_unavoidable, "size_met"_a = result.size_met,
                  "repairs"_a = to_python(result.repairs), "warnings"_a = to_python(result.warnings), "statistics"_a = all);
}

template py::dict quality_of<2>(const MeshData<2>&);
template py::dict quality_of<3>(const MeshData<3>&);
template py::dict to_python<2>(const RefineResult<2>&, const OutputMesh<2>&);
template py::dict to_python<3>(const RefineResult<3>&, const OutputMesh<3>&);

}  // namespace pgdr::python
