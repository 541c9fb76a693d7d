// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Another surface within a tolerance.
#include "pgdr/surface.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "bind.hpp"
#include "mesh_data.hpp"
#include "pgdr/facet_places.hpp"
#include "run.hpp"
#include "surface_tolerance.hpp"

namespace pgdr::python {
namespace {

py::dict report_of(const SurfaceReport& r) {
  py::dict refused, distance, out;
  refused["angle"] = r.refused.angle;
  refused["fold"] = r.refused.fold;
  refused["cells"] = r.refused.cells;
  refused["size"] = r.refused.size;
  refused["distance"] = r.refused.distance;
  refused["meets"] = r.refused.meets;
  refused["gap"] = r.refused.gap;
  refused["swept"] = r.refused.swept;
  distance["to_given"] = r.to_given;
  distance["from_given"] = r.from_given;
  out["length"] = r.tolerance;
  out["used"] = r.used;
  out["feature_angle"] = r.feature_angle;
  out["triangles"] = r.triangles;
  out["counted_corners_below_14.5"] = r.sharp_triangles;
  out["smallest_counted_corner"] = r.smallest_corner;
  out["heights_below_14.5"] = r.sharp_heights;
  out["creases"] = r.creases;
  out["corners"] = r.corners;
  out["flat_groups"] = r.flat_groups;
  out["contracted"] = r.contracted;
  out["flipped"] = r.flipped;
  out["moved"] = r.moved;
  out["split"] = r.split;
  out["refused"] = refused;
  out["distance"] = distance;
  out["farthest_point"] = r.farthest_point.x;
  out["given_up"] = r.given_up;
  out["stopped"] = r.stopped;
  out["seconds"] = r.seconds;
  return out;
}

/// (Plc, facet of the input of each facet, report). `tolerance`: as the command's.
py::tuple replace(const Plc<3>& plc, const std::string& tolerance, double feature_angle, double wanted_corner,
                  const std::vector<int>& fixed_markers) {
  ReplacedSurface made;
  std::shared_ptr<Plc<3>> other;
  run_watched([&](const std::stop_token& stop) {
    SurfaceOptions options;
    options.tolerance = tool::surface_tolerance(tolerance, plc);
    tool::require_fine_surface_tolerance(options.tolerance, plc);
    options.feature_angle = feature_angle;
    options.wanted_corner = wanted_corner;
    options.fixed_markers = fixed_markers;
    options.stop = stop;
    made = replace_surface(plc, options);
    other = std::make_shared<Plc<3>>(std::move(made.plc));
  });
  return py::make_tuple(other, made.facet_of_input, report_of(made.report));
}

}  // namespace

void bind_surface(py::module_& module) {
  module.def("replace_surface", &replace);
  module.def("name_facets_by_places", [](MeshData<3>& data, const Plc<3>& plc) { name_facets_by_places(plc, data.reasons); });
}

}  // namespace pgdr::python
