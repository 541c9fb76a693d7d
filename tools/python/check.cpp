// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker, and the diagnosis of inputs.
#include "pgdr/check.hpp"

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bind.hpp"
#include "cures.hpp"
#include "errors.hpp"
#include "mesh_data.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/refine_options.hpp"
#include "run.hpp"
#include "surface_tolerance.hpp"

namespace pgdr::python {
namespace {

using namespace pybind11::literals;

py::dict dict_of(const CheckReport& r) {
  py::list findings;
  for (const CheckFinding& f : r.findings) findings.append(py::make_tuple(std::string(name(f.kind)), f.message, f.ids));
  return py::dict("exit_code"_a = r.exit_code(), "findings"_a = findings, "finding_count"_a = r.finding_count,
                  "over_radius_edge"_a = r.over_radius_edge, "over_size"_a = r.over_size, "below_dihedral"_a = r.below_dihedral,
                  "explained"_a = r.explained, "unexplained"_a = r.unexplained,
                  "not_delaunay_rounding"_a = r.not_delaunay_rounding, "not_delaunay_refused"_a = r.not_delaunay_refused,
                  "not_delaunay_unexplained"_a = r.not_delaunay_unexplained, "undecided_volumes"_a = r.undecided_volumes);
}

/// As the command's `check`: against the input as given. `bounds`: those of a run; infinite: none.
/// `seed_sizes`: CheckOptions::seed_sizes. `surface_tolerance`: as the command's; empty: none.
template <int D>
py::dict check_mesh(const MeshData<D>& data, const Plc<D>* plc, const RefineOptions<D>& bounds, double largest_cosine,
                    bool delaunay, std::uint64_t not_delaunay_left, bool with_reasons, bool seed_sizes,
                    const std::string& surface_tolerance, double feature_angle,
                    const std::optional<Dense<std::uint8_t>>& required) {
  CheckReport report;
  std::optional<std::vector<std::uint8_t>> required_points;
  if (required) required_points = vector_of(*required);
  std::optional<double> length;
  if constexpr (D == 3)
    if (!surface_tolerance.empty() && plc) length = tool::surface_tolerance(surface_tolerance, *plc);
  run_watched([&](const std::stop_token& stop) {
    CheckOptions<D> options;
    options.stop = stop;
    options.input = plc;
    options.required_points = required_points;
    if (plc) options.tolerance = tolerance_of(*plc);
    if (with_reasons) options.reasons = &data.reasons;
    options.regions = bounds.regions;
    options.radius_edge_bound = bounds.radius_edge_bound;
    options.size = bounds.size;
    options.region_sizes = bounds.region_sizes;
    options.max_measure = bounds.max_volume;
    options.seed_sizes = seed_sizes;
    options.largest_cosine = largest_cosine;
    options.delaunay = delaunay;
    options.conforming_delaunay = bounds.conforming_delaunay;
    options.not_delaunay_left = not_delaunay_left;
    options.keep_boundary = bounds.keep_boundary;
    options.kept_markers = bounds.kept_markers;
    for (const PeriodicPairs& p : data.periodic) options.kept_sides.insert(options.kept_sides.end(), {p.from, p.to});
    options.surface_tolerance = length;
    options.feature_angle = feature_angle;
    report = check(data.mesh, options);
  });
  return dict_of(report);
}

/// (k, 2) cells and vertices: cells_not_delaunay().
template <int D>
py::array not_delaunay_of(const MeshData<D>& data) {
  std::vector<std::int64_t> rows;
  run_watched([&](const std::stop_token&) {
    for (const NotDelaunayCell& c : cells_not_delaunay(data.mesh)) {
      rows.push_back(c.cell);
      rows.push_back(c.vertex);
    }
  });
  const auto count = static_cast<py::ssize_t>(rows.size() / 2);
  return own(std::move(rows), {count, 2});
}

/// A list of (kind, count, is_error, [(Diagnostic, measure)]).
template <int D>
py::list diagnose_plc(const Plc<D>& plc, std::size_t most_listed, bool errors_only) {
  Diagnosis<D> diagnosis;
  run_watched([&](const std::stop_token& stop) {
    diagnosis = diagnose(plc, {.most_listed = most_listed, .errors_only = errors_only, .stop = stop});
  });
  py::list found;
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    const auto kind = static_cast<Finding>(k);
    if (diagnosis[kind].count == 0) continue;
    py::list listed;
    for (const FindingList::Item& item : diagnosis[kind].listed)
      listed.append(py::make_tuple(to_python(item.what), item.measure));
    found.append(py::make_tuple(std::string(name(kind)), diagnosis[kind].count, is_error(kind), listed));
  }
  return found;
}

/// What makes a refused input valid, in the words of the command: first in one line, then a sentence each.
template <int D>
std::vector<std::string> cures(const Plc<D>& plc) {
  std::vector<std::string> found;
  run_watched([&](const std::stop_token& stop) {
    const auto all = tool::cures_of<D>(plc, {}, diagnose(plc, {.errors_only = true, .stop = stop}), stop);
    if (!all.empty() && all[0].need() != all[0].words) found.push_back(all[0].need());
    for (const tool::Cure& cure : all) found.push_back(cure.words);
  });
  return found;
}

template <int D>
void bind(py::module_& module) {
  module.def(with_dimension<D>("check").c_str(), &check_mesh<D>);
  module.def(with_dimension<D>("not_delaunay").c_str(), &not_delaunay_of<D>);
  module.def(with_dimension<D>("diagnose").c_str(), &diagnose_plc<D>);
  module.def(with_dimension<D>("cures").c_str(), &cures<D>);
}

}  // namespace

void bind_check(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
}

}  // namespace pgdr::python
