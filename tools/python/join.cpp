// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are joined.
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "errors.hpp"
#include "mesh_data.hpp"
#include "pgdr/mesh_join.hpp"
#include "run.hpp"

namespace pgdr::python {
namespace {

py::list tuples_of(const std::vector<SharedConstraints>& shared) {
  py::list list;
  for (const SharedConstraints& s : shared) list.append(py::make_tuple(s.meshes, s.markers, s.count));
  return list;
}

/// (mesh, vertices of each mesh, first cells, shared points, interfaces, shared segments, labels, walls added, what is dropped,
/// warnings).
template <int D>
py::tuple join(const std::vector<std::shared_ptr<MeshData<D>>>& meshes, const std::vector<std::string>& names, bool relabel) {
  std::vector<const OutputMesh<D>*> all;
  for (const auto& data : meshes) all.push_back(&data->mesh);
  JoinedMesh<D> joined;
  run_watched(
      [&](const std::stop_token& stop) { joined = join_meshes<D>(all, {.relabel = relabel, .names = names, .stop = stop}); });
  py::list vertices, labels;
  for (std::vector<std::uint32_t>& of_mesh : joined.vertices) vertices.append(own(std::move(of_mesh)));
  for (const JoinedLabel& l : joined.labels) labels.append(py::make_tuple(l.mesh, l.given, l.label));
  auto data = std::make_shared<MeshData<D>>();
  data->mesh = std::move(joined.mesh);
  return py::make_tuple(data, vertices, joined.first_cell, joined.shared_points, tuples_of(joined.interfaces),
                        tuples_of(joined.shared_segments), labels, joined.added_walls, joined.dropped,
                        to_python(joined.warnings));
}

}  // namespace

void bind_join(py::module_& module) {
  module.def("join2", &join<2>);
  module.def("join3", &join<3>);
}

}  // namespace pgdr::python
