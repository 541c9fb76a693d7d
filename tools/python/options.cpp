// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Options of a run, set one by one. Words for people are in pgdr/_run.py.
#include <pybind11/chrono.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "callbacks.hpp"
#include "pgdr/check.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine_options.hpp"
#include "selector.hpp"

namespace pgdr::python {
namespace {

Schedule schedule_of(const std::string& word) {
  return word == "uniform" ? Schedule::uniform : word == "greedy" ? Schedule::greedy : Schedule::reproducible;
}

RegionMode region_mode_of(const std::string& word) {
  return word == "all" ? RegionMode::all : word == "auto" ? RegionMode::automatic : RegionMode::seeds;
}

/// A selector by its name, as the command takes it, with its usual disk.
template <int D>
void select_by_name(RefineOptions<D>& options, const std::string& name) {
  if (const std::string error = tool::selector_error(name); !error.empty())
    throw UsageError({.code = Errc::bad_option, .message = error});
  options.selector = tool::make_selector<D>(name);
  options.disk = {tool::usual_disk(name), 0};
}

template <int D>
void select_by(RefineOptions<D>& options, py::function f) {
  options.selector = selector_by<D>(std::move(f));
  options.disk = {DiskType::type1, 0};
}

template <int D>
void bind(py::module_& module) {
  using Options = RefineOptions<D>;
  py::class_<Options>(module, with_dimension<D>("Options").c_str())
      .def(py::init<>())
      .def_readwrite("radius_edge_bound", &Options::radius_edge_bound)
      .def_readwrite("max_volume", &Options::max_volume)
      .def_readwrite("min_dihedral", &Options::min_dihedral)
      .def_readwrite("refine", &Options::refine)
      .def_readwrite("keep_boundary", &Options::keep_boundary)
      .def_readwrite("conforming_delaunay", &Options::conforming_delaunay)
      .def_readwrite("kept_markers", &Options::kept_markers)
      .def_readwrite("drop_unused_points", &Options::drop_unused_points)
      .def_readwrite("memory_guard", &Options::memory_guard)
      .def_readwrite("min_edge", &Options::min_edge)
      .def_readwrite("max_vertices", &Options::max_vertices)
      .def("set_size", [](Options& o, const SizingField<D>& size) { o.size = size; })
      .def("add_region_size",
           [](Options& o, double label, const SizingField<D>& size) {
             o.region_sizes.push_back({label, size});
           })
      .def("set_regions", [](Options& o, const std::string& word) { o.regions = region_mode_of(word); })
      .def("set_time_limit", [](Options& o, double seconds) { o.time_limit = std::chrono::duration<double>(seconds); })
      .def("set_threads", [](Options& o, int threads) { o.schedule.threads = threads; })
      .def("set_schedule", [](Options& o, const std::string& word) { o.schedule.schedule = schedule_of(word); })
      .def("select_by_name", &select_by_name<D>)
      .def("select_by", &select_by<D>);
}

}  // namespace

void bind_options(py::module_& module) {
  bind<2>(module);
  bind<3>(module);
  module.def("min_angle_degrees", &min_angle_degrees);
  module.def("claimed_cosine", &claimed_cosine);
}

}  // namespace pgdr::python
