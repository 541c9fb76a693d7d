// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How what takes long runs: on a thread of its own, without the GIL, while the thread that called looks every few hundredths of a
// second whether a signal has come, as only a thread of Python can, and asks a function of the caller.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>
#include <stop_token>

#include "errors.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr::python {

/// One run, watched.
class Watch {
 public:
  /// The run also stops by the caller's token. `poll`: a function of Python of the numbers of vertices and of what waits, the
  /// stage and the share done (or None), which says whether to stop; or None.
  Watch(const std::stop_token& given, py::object poll);

  std::stop_token token() const { return stop_.get_token(); }  ///< for the run
  void note(const Progress& progress);                         ///< of any thread of the run

  /// Runs `work` in an arena of so many threads (0: as many as there are), and waits for it. What a signal's handler or `poll`
  /// raises stops it, and is kept. Has the GIL, and gives it away meanwhile.
  /// @throws what `work` throws
  void run(int threads, const std::function<void()>& work);

  /// What was raised meanwhile: an exception of Python, or None.
  py::object raised() const { return raised_; }
  void raise() const;  ///< raises it, if there was any

 private:
  void look();  // has the GIL

  std::stop_source stop_;
  std::stop_callback<std::function<void()>> forward_;
  py::object poll_, raised_ = py::none();
  std::atomic<std::uint64_t> vertices_{0}, waiting_{0};
  std::atomic<const char*> stage_{""};
  std::atomic<double> done_{-1};  // below 0: not known
};

/// Runs what takes a stop token as a Watch does, with all threads. @throws what a signal's handler raises, or `work` throws
void run_watched(const std::function<void(const std::stop_token&)>& work);

}  // namespace pgdr::python
