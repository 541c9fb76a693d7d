// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run.hpp"

#include <pybind11/stl.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "arrays.hpp"
#include "bind.hpp"
#include "mesh_data.hpp"
#include "pgdr/refine.hpp"
#include "reports.hpp"

namespace pgdr::python {
namespace {

constexpr std::chrono::milliseconds between_looks(30);

/// Runs it in an arena of so many threads; more than there are cores only if nobody else forbids it.
void run_with(int threads, const std::function<void()>& work) {
  if (threads == 0) {
    work();
    return;
  }
  std::optional<tbb::global_control> allowed;
  if (threads > tbb::info::default_concurrency())
    allowed.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

}  // namespace

Watch::Watch(const std::stop_token& given, py::object poll)
    : forward_(given, [this] { stop_.request_stop(); }), poll_(std::move(poll)) {}

void Watch::note(const Progress& progress) {
  vertices_ = progress.vertices;
  waiting_ = progress.waiting;
  stage_ = progress.stage;
  done_ = progress.done.value_or(-1);
}

void Watch::look() {
  const auto keep = [this] {
    py::error_already_set error;
    if (error.trace()) PyException_SetTraceback(error.value().ptr(), error.trace().ptr());
    raised_ = error.value();
    stop_.request_stop();
  };
  if (PyErr_CheckSignals() != 0) keep();
  if (poll_.is_none() || !raised_.is_none()) return;
  const double share = done_;
  const py::object done = share < 0 ? py::object(py::none()) : py::object(py::float_(share));
  PyObject* const wish = PyObject_CallFunction(poll_.ptr(), "KKsO", static_cast<unsigned long long>(vertices_),
                                               static_cast<unsigned long long>(waiting_), stage_.load(), done.ptr());
  const int is_true = wish ? PyObject_IsTrue(wish) : -1;
  Py_XDECREF(wish);
  if (is_true < 0) keep();
  if (is_true > 0) stop_.request_stop();
}

void Watch::raise() const {
  if (raised_.is_none()) return;
  PyErr_SetObject(py::type::handle_of(raised_).ptr(), raised_.ptr());
  throw py::error_already_set();
}

void Watch::run(int threads, const std::function<void()>& work) {
  look();  // a wish that is there already
  std::promise<void> done;
  std::future<void> over = done.get_future();
  std::thread thread;
  {
    const py::gil_scoped_release others_run;
    thread = std::thread([&] {
      try {
        run_with(threads, work);
        done.set_value();
      } catch (...) {
        done.set_exception(std::current_exception());
      }
    });
    while (over.wait_for(between_looks) == std::future_status::timeout) {
      const py::gil_scoped_acquire gil;
      look();
    }
    thread.join();
  }
  over.get();
}

void run_watched(const std::function<void(const std::stop_token&)>& work) {
  Watch watch({}, py::none());
  try {
    watch.run(0, [&] { work(watch.token()); });
  } catch (const CancelledError&) {
    if (watch.raised().is_none()) throw;
  }
  watch.raise();
}

namespace {

/// Renumbers the points of a mesh from which these were dropped, ascending: -1 for them.
void drop(const std::vector<std::uint32_t>& unused, std::vector<std::int64_t>& points) {
  for (std::int64_t& p : points) {
    const auto next = std::lower_bound(unused.begin(), unused.end(), p);
    p = next != unused.end() && *next == p ? -1 : p - (next - unused.begin());
  }
}

/// The mesh, what is known of it, and what was raised meanwhile: an exception, or None. `tells`: does the poll want to know how
/// far the run is?
template <int D>
py::tuple run(const std::shared_ptr<const Plc<D>>& plc, const RefineOptions<D>& given, const std::stop_token& stop,
              py::object poll, bool tells) {
  RefineOptions<D> options = given;
  Watch watch(stop, std::move(poll));
  auto data = std::make_shared<MeshData<D>>();
  RefineResult<D> result;
  options.stop = watch.token();
  if (tells) options.progress = [&](const Progress& p) { watch.note(p); };
  options.prepared = [&](const Domain<D>& domain) {
    data->point_of_input.assign(domain.point_of_input().begin(), domain.point_of_input().end());
  };
  try {
    watch.run(options.schedule.threads, [&] { result = refine(*plc, options); });
  } catch (const CancelledError&) {
    if (watch.raised().is_none()) throw;
    result.stop = StopCause::cancelled;
  }
  if (options.drop_unused_points) drop(result.unused_points, data->point_of_input);
  data->mesh = std::move(result.mesh);
  data->reasons = std::move(result.reasons);
  return py::make_tuple(data, to_python(result, data->mesh), watch.raised());
}

}  // namespace

void bind_run(py::module_& module) {
  py::class_<std::stop_source>(module, "StopSource")
      .def(py::init<>())
      .def("stop", [](std::stop_source& source) { source.request_stop(); })
      .def("is_set", [](const std::stop_source& source) { return source.stop_requested(); });
  const auto token_of = [](const std::stop_source* source) { return source ? source->get_token() : std::stop_token(); };
  module.def("refine2",
             [=](const std::shared_ptr<Plc<2>>& plc, const RefineOptions<2>& options, const std::stop_source* stop,
                 py::object poll, bool tells) { return run<2>(plc, options, token_of(stop), std::move(poll), tells); });
  module.def("refine3",
             [=](const std::shared_ptr<Plc<3>>& plc, const RefineOptions<3>& options, const std::stop_source* stop,
                 py::object poll, bool tells) { return run<3>(plc, options, token_of(stop), std::move(poll), tells); });
}

}  // namespace pgdr::python
