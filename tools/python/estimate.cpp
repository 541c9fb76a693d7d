// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is known of a mesh before it is made.
#include "pgdr/estimate.hpp"

#include <pybind11/stl.h>

#include <optional>

#include "bind.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/refine_options.hpp"
#include "proposal.hpp"
#include "run.hpp"
#include "size_measure.hpp"

namespace pgdr::python {
namespace {

/// ("point", number), ("segment", number or None for an edge of facets), ("facet", number), in the numbering of the input.
template <int D>
py::tuple entity_of(const Domain<D>& domain, EntityRef e) {
  const auto number = input_number(domain, e);
  const char* kind = e.kind == EntityKind::vertex ? "point" : e.kind == EntityKind::facet ? "facet" : "segment";
  return number ? py::make_tuple(kind, *number) : py::make_tuple(kind, py::none());
}

template <int D>
py::list entities_of(const Domain<D>& domain, const std::array<EntityRef, 2>& pair) {
  py::list made;
  for (const EntityRef& e : pair) made.append(entity_of(domain, e));
  return made;
}

template <int D>
struct Found {
  std::optional<Domain<D>> domain;
  std::optional<Gap<D>> gap;
  std::optional<SharpAngle<D>> angle;
  CellEstimate<D> cells;
  std::optional<tool::Proposal> proposal;
};

/// @throws DiagnosedError and others for an input that has no mesh
template <int D>
Found<D> look_at(const Plc<D>& plc, const RefineOptions<D>& bounds, const std::stop_token& stop) {
  Found<D> found;
  const Domain<D>& domain = found.domain.emplace(plc, stop);
  require_no_errors(domain, stop);
  const bool voids_by_nesting = bounds.regions == RegionMode::automatic;
  found.gap = narrowest_gap<D>(domain, {.voids_by_nesting = voids_by_nesting, .stop = stop});
  found.angle = least_angle<D>(domain, stop);
  EstimateOptions<D> options;
  options.voids_by_nesting = voids_by_nesting;
  options.radius_edge_bound = bounds.radius_edge_bound;
  options.measure = tool::measure_of_sizes<D>(bounds.size, bounds.region_sizes, bounds.max_volume);
  options.stop = stop;
  found.cells = estimate_cells<D>(domain, options);
  found.proposal = tool::find_proposal(plc, domain);
  return found;
}

/// cells, at_least, (distance, entities, points) or None, (degrees, entities, point) or None, (tolerance, facets, facets_then,
/// joined) or None.
template <int D>
py::tuple estimate(const Plc<D>& plc, const RefineOptions<D>& bounds) {
  Found<D> found;
  run_watched([&](const std::stop_token& stop) { found = look_at(plc, bounds, stop); });
  py::object gap = py::none(), angle = py::none(), proposal = py::none();
  if (const auto& g = found.gap)
    gap = py::make_tuple(g->distance, entities_of(*found.domain, g->entities), py::make_tuple(g->points[0].x, g->points[1].x));
  if (const auto& a = found.angle) angle = py::make_tuple(a->degrees, entities_of(*found.domain, a->entities), a->point.x);
  if (const auto& p = found.proposal) proposal = py::make_tuple(p->tolerance, p->facets, p->facets_then, p->joined);
  return py::make_tuple(found.cells.cells, found.cells.at_least, gap, angle, proposal);
}

template <int D>
void bind(py::module_& module) {
  module.def(with_dimension<D>("estimate").c_str(), &estimate<D>);
}

}  // namespace

void bind_estimate(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
}

}  // namespace pgdr::python
