// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Finished meshes: their arrays, read in place, and what is computed of them when asked for.
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bind.hpp"
#include "errors.hpp"
#include "mesh_data.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/output_files.hpp"
#include "pgdr/voronoi.hpp"
#include "reports.hpp"
#include "words.hpp"

namespace pgdr::python {
namespace {

/// What pgdr/_mesh.py pickles: the arrays of a mesh.
template <int D>
std::shared_ptr<MeshData<D>> mesh_of(const py::array& points, const py::array& cells) {
  auto data = std::make_shared<MeshData<D>>();
  data->mesh = mesh_from_arrays<D>(coordinates_of(points), indices_of(cells));
  require_finite<D>(data->mesh.points, "point");
  return data;
}

template <int K, class Given>
void set_constraints(std::vector<Given>& constraints, std::size_t points, const Dense<std::uint32_t>& vertices,
                     const Dense<int>& markers, const Dense<std::uint32_t>& entities) {
  const auto all = span_of(vertices), entity = span_of(entities);
  const auto marker = span_of(markers);
  const std::size_t count = all.size() / K;
  if (marker.size() != count || entity.size() != count) bad_argument("there must be one marker a constraint");
  if (std::ranges::any_of(all, [&](std::uint32_t v) { return v >= points; })) bad_argument("a constraint without its vertex");
  constraints.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(i * K), K, constraints[i].vertices.begin());
    constraints[i].marker = marker[i];
    constraints[i].entity = entity[i];
  }
}

template <int D>
void set_labels(MeshData<D>& data, const Dense<double>& regions, std::size_t input_points, const Dense<int>& point_markers,
                const Dense<double>& point_attributes, const Dense<std::int64_t>& point_of_input) {
  OutputMesh<D>& mesh = data.mesh;
  const auto fits = [](std::size_t size, std::size_t count) { return size == 0 || size == count; };
  if (!fits(span_of(regions).size(), mesh.cells.size())) bad_argument("there must be one label a cell");
  if (!fits(span_of(point_markers).size(), mesh.points.size())) bad_argument("there must be one marker a point");
  if (const std::size_t all = span_of(point_attributes).size(); all > 0 && (mesh.points.empty() || all % mesh.points.size() != 0))
    bad_argument("there must be equally many attributes a point");
  if (input_points > mesh.points.size()) bad_argument("there are more points of the input than points");
  mesh.regions = vector_of(regions);
  mesh.input_points = input_points;
  mesh.point_markers = vector_of(point_markers);
  mesh.point_attributes = vector_of(point_attributes);
  data.point_of_input = vector_of(point_of_input);
}

template <int D>
void set_reasons(MeshData<D>& data, const Dense<std::uint32_t>& cells, const Dense<std::uint8_t>& codes,
                 const Dense<std::uint8_t>& kinds, const Dense<std::uint32_t>& facets, const Dense<double>& ends,
                 const Dense<double>& angles) {
  const auto cell = span_of(cells), facet = span_of(facets);
  const auto code = span_of(codes), kind = span_of(kinds);
  const auto angle = span_of(angles), end = span_of(ends);
  const std::size_t count = cell.size();
  if (code.size() != count || angle.size() != count || kind.size() != 2 * count || facet.size() != 2 * count ||
      end.size() != 12 * count)
    bad_argument("the arrays of reasons have different lengths");
  data.reasons.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (cell[i] >= data.mesh.cells.size() || code[i] >= tool::code_names.size() ||
        kind[2 * i] > static_cast<std::uint8_t>(EntityKind::volume) ||
        kind[2 * i + 1] > static_cast<std::uint8_t>(EntityKind::volume))
      bad_argument("a reason that cannot be");
    data.reasons[i] = {cell[i], static_cast<PoorReason::Code>(code[i]), {}, angle[i]};
    for (std::size_t k = 0; k < 2; ++k) {
      const double* x = &end[12 * i + 6 * k];
      data.reasons[i].entities[k] = {
          static_cast<EntityKind>(kind[2 * i + k]), facet[2 * i + k], {{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}}};
    }
  }
}

/// Cells and codes; of two entities each the kinds, the facets, and the ends of segments; angles.
template <int D>
py::tuple reason_arrays(const MeshData<D>& data) {
  std::vector<std::uint32_t> cells, facets;
  std::vector<std::uint8_t> codes, kinds;
  std::vector<double> ends, angles;
  for (const PoorReason& r : data.reasons) {
    cells.push_back(r.cell);
    codes.push_back(static_cast<std::uint8_t>(r.code));
    for (const GivenEntity& e : r.entities) {
      kinds.push_back(static_cast<std::uint8_t>(e.kind));
      facets.push_back(e.facet);
      for (const auto& end : e.ends) ends.insert(ends.end(), end.begin(), end.end());
    }
    angles.push_back(r.angle);
  }
  const auto count = static_cast<py::ssize_t>(data.reasons.size());
  return py::make_tuple(own(std::move(cells)), own(std::move(codes)), own(std::move(kinds), {count, 2}),
                        own(std::move(facets), {count, 2}), own(std::move(ends), {count, 2, 2, 3}), own(std::move(angles)));
}

/// All edges, each once, sorted.
template <int D>
py::array edges_of(const MeshData<D>& data) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  {
    const py::gil_scoped_release others_run;
    edges.reserve(data.mesh.cells.size() * (D == 2 ? 3 : 6));
    for (const auto& cell : data.mesh.cells)
      for (std::size_t i = 0; i <= D; ++i)
        for (std::size_t k = i + 1; k <= D; ++k) edges.push_back({std::min(cell[i], cell[k]), std::max(cell[i], cell[k])});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    edges.shrink_to_fit();
  }
  return own(std::move(edges));
}

template <int D>
py::array neighbors_of(const MeshData<D>& data) {
  std::vector<std::array<std::uint32_t, D + 1>> found;
  std::vector<std::int64_t> neighbors;
  {
    const py::gil_scoped_release others_run;
    found = neighbors_of_cells(data.mesh);
    neighbors.reserve(found.size() * (D + 1));
    for (const auto& row : found)
      for (const std::uint32_t cell : row) neighbors.push_back(cell == no_cell_beyond ? -1 : static_cast<std::int64_t>(cell));
  }
  return own(std::move(neighbors), {static_cast<py::ssize_t>(found.size()), D + 1});
}

/// Names of regions and of markers.
using NameDicts = std::pair<std::map<double, std::string>, std::map<int, std::string>>;

template <int D>
void write(const MeshData<D>& data, const std::string& file, std::uint32_t first_index, bool edges, bool neighbors,
           std::uint32_t pieces, int order) {
  const py::gil_scoped_release others_run;
  write_mesh(data.mesh, file, {first_index, edges, neighbors, pieces, data.periodic, order});
}

template <int D>
void bind(py::module_& module) {
  using Data = MeshData<D>;
  using Self = const py::object&;
  const auto get = [](auto read) { return [read](const py::object& self) { return read(self, self.cast<const Data&>()); }; };
  const auto vertices = [get](auto member) {
    using Constraint = typename std::remove_cvref_t<decltype(std::declval<Data&>().mesh.*member)>::value_type;
    return get([member](Self self, const Data& d) { return view_member(self, d.mesh.*member, &Constraint::vertices); });
  };
  const auto markers = [get](auto member) {
    using Constraint = typename std::remove_cvref_t<decltype(std::declval<Data&>().mesh.*member)>::value_type;
    return get([member](Self self, const Data& d) { return view_member(self, d.mesh.*member, &Constraint::marker); });
  };
  const auto entities = [get](auto member) {
    using Constraint = typename std::remove_cvref_t<decltype(std::declval<Data&>().mesh.*member)>::value_type;
    return get([member](Self self, const Data& d) { return view_member(self, d.mesh.*member, &Constraint::entity); });
  };
  const auto numbers = [get](auto member) {
    return get([member](Self self, const Data& d) {
      const auto& values = d.mesh.*member;
      return view(self, values.data(), {static_cast<py::ssize_t>(values.size())});
    });
  };
  py::class_<Data, std::shared_ptr<Data>>(module, with_dimension<D>("Mesh").c_str())
      .def(py::init(&mesh_of<D>))
      .def("set_labels", &set_labels<D>)
      .def("set_subsegments",
           [](Data& d, const Dense<std::uint32_t>& v, const Dense<int>& m, const Dense<std::uint32_t>& e) {
             set_constraints<2>(d.mesh.subsegments, d.mesh.points.size(), v, m, e);
           })
      .def("set_subfacets",
           [](Data& d, const Dense<std::uint32_t>& v, const Dense<int>& m, const Dense<std::uint32_t>& e) {
             set_constraints<3>(d.mesh.subfacets, d.mesh.points.size(), v, m, e);
           })
      .def("set_reasons", &set_reasons<D>)
      .def("set_names",
           [](Data& d, const NameDicts& names) {
             d.mesh.names = {names.first, names.second};
           })
      .def_property_readonly("names", [](const Data& d) { return NameDicts(d.mesh.names.regions, d.mesh.names.markers); })
      .def("unfit_names", [](const Data& d, const std::string& file) { return to_python(unfit_names(d.mesh.names, file)); })
      .def_property_readonly("points", get([](Self self, const Data& d) { return view_points<D>(self, d.mesh.points); }))
      .def_property_readonly(
          "cells", get([](Self self, const Data& d) {
            return view(self, flat_cells(d.mesh).data(), {static_cast<py::ssize_t>(d.mesh.cells.size()), D + 1});
          }))
      .def_property_readonly("regions", numbers(&OutputMesh<D>::regions))
      .def_property_readonly("point_markers", numbers(&OutputMesh<D>::point_markers))
      .def_property_readonly("point_attributes", numbers(&OutputMesh<D>::point_attributes))
      .def_property_readonly("input_points", [](const Data& d) { return d.mesh.input_points; })
      .def_property_readonly("subsegments", vertices(&OutputMesh<D>::subsegments))
      .def_property_readonly("subsegment_markers", markers(&OutputMesh<D>::subsegments))
      .def_property_readonly("subsegment_entities", entities(&OutputMesh<D>::subsegments))
      .def_property_readonly("subfacets", vertices(&OutputMesh<D>::subfacets))
      .def_property_readonly("subfacet_markers", markers(&OutputMesh<D>::subfacets))
      .def_property_readonly("subfacet_entities", entities(&OutputMesh<D>::subfacets))
      .def_property_readonly("point_of_input", get([](Self self, const Data& d) {
                               return view(self, d.point_of_input.data(), {static_cast<py::ssize_t>(d.point_of_input.size())});
                             }))
      .def_property_readonly("reason_arrays", &reason_arrays<D>)
      .def("edges", &edges_of<D>)
      .def("neighbors", &neighbors_of<D>)
      .def("quality", &quality_of<D>)
      .def("write", &write<D>);
  module.def(with_dimension<D>("boundary_of_mesh").c_str(), [](const Data& data) {
    const py::gil_scoped_release others_run;
    return std::make_shared<Plc<D>>(boundary_of_mesh(data.mesh));
  });
  module.def(with_dimension<D>("read_mesh").c_str(), [](const std::string& file) {
    const py::gil_scoped_release others_run;
    auto data = std::make_shared<Data>();
    InputFile input(file);
    data->mesh = input.read_mesh<D>();
    std::vector<std::string> left_out;
    for (const Diagnostic& d : input.warnings()) left_out.push_back(d.message);
    return std::pair(data, left_out);
  });
}

/// Numbers as numpy has them.
template <class Number>
py::array longs(const std::vector<Number>& numbers) {
  return own(std::vector<std::int64_t>(numbers.begin(), numbers.end()));
}

void bind_voronoi(py::module_& module) {
  module.def("voronoi_cells", [](const MeshData<2>& data) {
    VoronoiCells made;
    {
      const py::gil_scoped_release others_run;
      made = voronoi_cells(data.mesh);
    }
    std::vector<std::array<std::int64_t, 2>> links;
    for (const auto& [a, b] : made.links) links.push_back({a, b});
    std::vector<std::array<double, 2>> points;
    for (const Point2& p : made.points) points.push_back(p.x);
    return py::make_tuple(own(std::move(points)), longs(made.offsets), longs(made.corners), own(std::move(made.areas)),
                          own(std::move(links)), own(std::move(made.widths)), own(std::move(made.lengths)));
  });
  module.def("write_voronoi", [](const Dense<double>& sites, const Dense<double>& points, const Dense<std::int64_t>& offsets,
                                 const Dense<std::int64_t>& corners, const std::string& file) {
    VoronoiCells cells;
    cells.sites = points_of<2>(sites);
    cells.points = points_of<2>(points);
    for (const std::int64_t at : span_of(offsets)) cells.offsets.push_back(static_cast<std::size_t>(at));
    for (const std::int64_t row : span_of(corners)) cells.corners.push_back(static_cast<std::uint32_t>(row));
    if (cells.offsets.size() != cells.sites.size() + 1 || !std::ranges::is_sorted(cells.offsets) ||
        cells.offsets.back() != cells.corners.size())
      bad_argument("the offsets of Voronoi cells are not those of their corners");
    const py::gil_scoped_release others_run;
    write_file(file, [&](std::ostream& out) { write_voronoi(out, cells); });
  });
}

}  // namespace

void bind_mesh(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
  bind_voronoi(module);
}

}  // namespace pgdr::python
