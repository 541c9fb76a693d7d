// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pages that show meshes in a browser, as `pgdr view -o X.html` makes them.
#include <pybind11/stl.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "mesh_data.hpp"
#include "pgdr/output_files.hpp"
#include "view/page.hpp"

namespace pgdr::python {
namespace {

using GivenField = std::tuple<std::string, bool, Dense<double>>;  // name, of points?, (n, components)

template <int D>
void write_page_of(const MeshData<D>& data, const std::string& file, const std::string& title, const std::string& color,
                   const std::vector<GivenField>& given) {
  std::vector<MeshField> fields;
  for (const auto& [name, of_points, numbers] : given) {
    const std::size_t rows = of_points ? data.mesh.points.size() : data.mesh.cells.size();
    if (numbers.ndim() != 2 || static_cast<std::size_t>(numbers.shape(0)) != rows || numbers.shape(1) == 0)
      bad_argument(name + " must have a number, or a row of them, for each " + (of_points ? "point" : "cell"));
    fields.push_back({name, of_points, static_cast<std::size_t>(numbers.shape(1)), vector_of(numbers)});
  }
  if (data.mesh.cells.empty()) bad_argument("there are no cells to show");
  const py::gil_scoped_release others_run;
  write_file(file, [&](std::ostream& out) {
    tool::write_page<D>(data.mesh, std::move(fields), {.title = title, .color = color, .cut = {}, .from = {}}, out);
  });
}

}  // namespace

void bind_page(py::module_& module) {
  module.def("has_page", &tool::has_page);
  module.def("write_page2", &write_page_of<2>);
  module.def("write_page3", &write_page_of<3>);
}

}  // namespace pgdr::python
