// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizing fields, those of the library among them, which run without the GIL.
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "callbacks.hpp"
#include "mesh_data.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr::python {
namespace {

template <int D>
py::array evaluate(const SizingField<D>& field, const Dense<double>& points) {
  const std::vector<Point<D>> at = points_of<D>(points);
  std::vector<double> sizes(at.size());
  {
    const py::gil_scoped_release others_run;
    field.at(at, sizes);
  }
  return own(std::move(sizes));
}

SizeUnit unit_of(const std::string& word) {
  return word == "edge"     ? SizeUnit::edge
         : word == "radius" ? SizeUnit::radius
         : word == "area"   ? SizeUnit::area
                            : SizeUnit::volume;
}

template <int D>
void bind(py::module_& module) {
  using Field = SizingField<D>;
  const auto named = [](const char* name) { return with_dimension<D>(name); };
  py::class_<Field>(module, named("Field").c_str())
      .def(py::init([](double constant) { return Field(constant); }))
      .def(py::init([](py::function f) { return sizes_by<D>(std::move(f)); }))
      .def("at", &evaluate<D>);
  module.def(named("smallest").c_str(), [](const std::vector<Field>& fields) { return smallest<D>(fields); });
  module.def(named("sizes_at_points").c_str(), [](const Dense<double>& points, const Dense<double>& sizes, double growth) {
    const std::vector<Point<D>> at = points_of<D>(points);
    const auto values = span_of(sizes);
    const py::gil_scoped_release others_run;
    return sizes_at_points<D>(at, values, growth);
  });
  module.def(named("sizes_along").c_str(), [](const Dense<double>& ends, const Dense<double>& sizes, double growth) {
    const std::vector<Point<D>> at = points_of<D>(ends);
    std::vector<std::array<Point<D>, 2>> lines;
    for (std::size_t i = 0; i + 1 < at.size(); i += 2) lines.push_back({at[i], at[i + 1]});
    const auto values = span_of(sizes);
    const py::gil_scoped_release others_run;
    return sizes_along<D>(lines, values, growth);
  });
  module.def(named("sizes_on_mesh").c_str(), [](const MeshData<D>& data, const Dense<double>& sizes) {
    const auto values = span_of(sizes);
    const py::gil_scoped_release others_run;
    return sizes_on_mesh<D>(data.mesh, values);
  });
  module.def(named("sizes_in_cells").c_str(), [](const MeshData<D>& data, const Dense<double>& bounds) {
    std::vector<double> usual = vector_of(bounds);
    for (double& bound : usual) bound = in_usual_unit<D>(bound, D == 2 ? SizeUnit::area : SizeUnit::volume);
    const py::gil_scoped_release others_run;
    return sizes_in_cells<D>(data.mesh, usual);
  });
  module.def(named("smallest_at_vertices").c_str(), [](const MeshData<D>& data, const Dense<double>& of_cells) {
    const auto values = span_of(of_cells);
    std::vector<double> made;
    {
      const py::gil_scoped_release others_run;
      made = smallest_at_vertices<D>(data.mesh, values);
    }
    return own(std::move(made));
  });
  module.def(named("in_usual_unit").c_str(),
             [](const Field& field, const std::string& unit) { return in_usual_unit<D>(field, unit_of(unit)); });
  module.def(named("usual_sizes").c_str(), [](const Dense<double>& sizes, const std::string& unit) {
    std::vector<double> made = vector_of(sizes);
    for (double& size : made) size = in_usual_unit<D>(size, unit_of(unit));
    return own(std::move(made));
  });
  module.def(named("growth_of_unit").c_str(), [](const std::string& unit) { return growth_of_unit<D>(unit_of(unit)); });
  module.def(named("limit_growth").c_str(), [](const MeshData<D>& data, const Dense<double>& sizes, double growth) {
    const auto values = span_of(sizes);
    std::vector<double> limited;
    {
      const py::gil_scoped_release others_run;
      limited = limit_growth<D>(data.mesh, values, growth);
    }
    return own(std::move(limited));
  });
}

}  // namespace

void bind_fields(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
}

}  // namespace pgdr::python
