// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sides that correspond.
#include "pgdr/periodic.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "mesh_data.hpp"
#include "pgdr/make_periodic.hpp"
#include "run.hpp"

namespace pgdr::python {
namespace {

/// Two markers and a motion; without numbers: the translation.
using Sides = std::tuple<int, int, std::vector<double>>;

template <int D>
PeriodicSides<D> sides_of(const Sides& given) {
  PeriodicSides<D> sides{std::get<0>(given), std::get<1>(given), {}};
  const std::vector<double>& motion = std::get<2>(given);
  if (!motion.empty()) std::copy_n(motion.begin(), D * (D + 1), sides.motion.emplace().begin());
  return sides;
}

/// The input to mesh, its sides with their motions, whether the boundary must be kept, with which markers, and what tells the
/// mesh in terms of the given input.
template <int D>
py::tuple make(const Plc<D>& plc, const std::vector<Sides>& given, const RefineOptions<D>& bounds) {
  std::vector<PeriodicSides<D>> sides;
  for (const Sides& pair : given) sides.push_back(sides_of<D>(pair));
  PeriodicInput<D> made;
  run_watched([&](const std::stop_token& stop) {
    RefineOptions<D> options = bounds;
    options.stop = stop;
    made = make_periodic(plc, sides, options);
  });
  std::vector<Sides> found;
  for (const PeriodicSides<D>& s : made.sides)
    found.emplace_back(s.from, s.to, s.motion ? std::vector<double>(s.motion->begin(), s.motion->end()) : std::vector<double>());
  auto other = std::make_shared<Plc<D>>(made.plc);
  const bool keeps = made.keep_boundary;
  std::vector<int> kept = made.kept_markers;
  return py::make_tuple(other, found, keeps, kept, std::make_shared<PeriodicInput<D>>(std::move(made)));
}

/// The pairs of a mesh, which has them from then on: markers, motion, (n, 2) vertices, walls, exact ones, the largest gap.
template <int D>
py::tuple pair(MeshData<D>& data, const Sides& given, double tolerance) {
  PeriodicPairs pairs;
  run_watched([&](const std::stop_token&) { pairs = periodic_pairs(data.mesh, sides_of<D>(given), tolerance); });
  data.periodic.push_back(pairs);
  return py::make_tuple(pairs.from, pairs.to, pairs.motion, own(std::move(pairs.points)), pairs.walls, pairs.exact,
                        pairs.largest_gap);
}

}  // namespace

void bind_periodic(py::module_& module) {
  py::class_<PeriodicInput<2>, std::shared_ptr<PeriodicInput<2>>>(module, "PeriodicInput2");
  py::class_<PeriodicInput<3>, std::shared_ptr<PeriodicInput<3>>>(module, "PeriodicInput3")
      .def("name_as_given",
           [](const PeriodicInput<3>& made, MeshData<3>& data) { name_as_given(made, data.mesh, data.reasons); });
  module.def("make_periodic", &make<2>);
  module.def("make_periodic", &make<3>);
  module.def("pair2", &pair<2>);
  module.def("pair3", &pair<3>);
}

}  // namespace pgdr::python
