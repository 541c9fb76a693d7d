// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as inputs, and what lives on them.
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bind.hpp"
#include "mesh_data.hpp"
#include "pgdr/field_io.hpp"
#include "pgdr/remesh_input.hpp"
#include "pgdr/transfer.hpp"
#include "run.hpp"

namespace pgdr::python {
namespace {

using Mask = Dense<std::uint8_t>;

/// (Plc, of each of its facets one of the boundary's). `keep_boundary`: the boundary as it is; `keep_vertices`: all vertices,
/// too.
template <int D>
py::tuple input_of(const MeshData<D>& data, const Mask& required, std::optional<double> tolerance, bool keep_boundary,
                   bool keep_vertices) {
  auto plc = std::make_shared<Plc<D>>();
  std::vector<std::uint32_t> facets;
  const std::vector<std::uint8_t> mask = vector_of(required);
  run_watched([&](const std::stop_token& stop) {
    WholeFacets<D> whole = remesh_input<D>(
        data.mesh,
        {.required = mask, .tolerance = tolerance, .keep_boundary = keep_boundary, .keep_vertices = keep_vertices, .stop = stop});
    *plc = std::move(whole.plc);
    facets = std::move(whole.facet_of_input);
  });
  return py::make_tuple(plc, own(std::move(facets)));
}

/// (Plc, of each of its points: is it required). `plain`: without the segments that drop_plain_segments takes out.
template <int D>
py::tuple boundary_of(const MeshData<D>& data, const Mask& required, bool plain) {
  MeshBoundary<D> boundary;
  std::vector<std::uint8_t> points;
  const std::vector<std::uint8_t> mask = vector_of(required);
  {
    const py::gil_scoped_release others_run;
    boundary = boundary_with_vertices<D>(data.mesh, mask);
    points = required_points(boundary, mask);
    if constexpr (D == 3)
      if (plain) drop_plain_segments(boundary.plc);
  }
  return py::make_tuple(std::make_shared<Plc<D>>(std::move(boundary.plc)), own(std::move(points)));
}

/// Reasons of a new mesh name facets of the old boundary, and points have the attributes of the old mesh.
template <int D>
void finish(MeshData<D>& data, const MeshData<D>& from, const Dense<std::uint32_t>& facets) {
  const auto facet_of_input = span_of(facets);
  const py::gil_scoped_release others_run;
  name_given_facets(facet_of_input, data.reasons);
  transfer_attributes<D>(from.mesh, data.mesh);
}

template <class Transfer>
py::array rows(const Transfer& transfer, const Dense<double>& values, std::size_t width) {
  const auto given = span_of(values);
  std::vector<double> made;
  {
    const py::gil_scoped_release others_run;
    made = transfer(given, width);
  }
  return own(std::move(made));
}

/// A list of (name, of cells, width, whole numbers, values).
py::list fields_of(const std::string& file) {
  MeshFields fields;
  {
    const py::gil_scoped_release others_run;
    fields = InputFile(file).read_fields();
  }
  py::list out;
  for (MeshField& f : fields)
    out.append(py::make_tuple(f.name, !f.of_points, f.components, f.is_integer, own(std::move(f.values))));
  return out;
}

using Row = std::tuple<std::string, bool, std::size_t, bool, Dense<double>>;

template <int D>
void write_fields(const MeshData<D>& data, const std::vector<Row>& rows, const std::string& file) {
  MeshFields fields;
  for (const auto& [name, of_cells, width, is_integer, values] : rows)
    fields.push_back({name, !of_cells, width, vector_of(values), is_integer});
  const py::gil_scoped_release others_run;
  write_mesh<D>(data.mesh, fields, file);
}

template <int D>
void bind(py::module_& module) {
  const auto named = [](const char* name) { return with_dimension<D>(name); };
  module.def(named("remesh_input").c_str(), &input_of<D>);
  module.def(named("remesh_boundary").c_str(), &boundary_of<D>);
  module.def(named("finish_remesh").c_str(), &finish<D>);
  module.def(named("write_fields").c_str(), &write_fields<D>);
  py::class_<PointTransfer<D>>(module, named("PointTransfer").c_str())
      .def(py::init([](const MeshData<D>& from, const Dense<double>& to) {
        const std::vector<Point<D>> at = points_of<D>(to);
        const py::gil_scoped_release others_run;
        return std::make_unique<PointTransfer<D>>(from.mesh, at);
      }))
      .def("means",
           [](const PointTransfer<D>& t, const Dense<double>& values, std::size_t width) {
             return rows([&t](auto given, std::size_t n) { return t(given, n); }, values, width);
           })
      .def("nearest", [](const PointTransfer<D>& t, const Dense<double>& values, std::size_t width) {
        return rows([&t](auto given, std::size_t n) { return t.of_nearest_corners(given, n); }, values, width);
      });
  py::class_<CellTransfer<D>>(module, named("CellTransfer").c_str())
      .def(py::init([](const MeshData<D>& from, const MeshData<D>& to) {
        const py::gil_scoped_release others_run;
        return std::make_unique<CellTransfer<D>>(from.mesh, to.mesh);
      }))
      .def("means",
           [](const CellTransfer<D>& t, const Dense<double>& values, std::size_t width) {
             return rows([&t](auto given, std::size_t n) { return t.means(given, n); }, values, width);
           })
      .def("largest_share", [](const CellTransfer<D>& t, const Dense<double>& values) {
        return rows([&t](auto given, std::size_t) { return t.largest_share(given); }, values, 1);
      });
}

}  // namespace

void bind_remesh(py::module_& module) {
  module.def("read_fields", &fields_of);
  bind<2>(module);
  bind<3>(module);
}

}  // namespace pgdr::python
