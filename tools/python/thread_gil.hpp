// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The GIL in threads of the library. Python wants a state of each thread that takes it, and makes and drops one, with a stack in
// memory of its own, for each time that a thread without one does so: that takes some ten times as long as a short call. Here a
// thread keeps its state until it ends. And who waits for the GIL sleeps, which takes as long. Where a function is called by
// several threads, and each call is short, they look some times whether it is their turn instead.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>

namespace pgdr::python {

/// Has the GIL as long as it lives. In any thread that is not one of Python's, and in these.
class ThreadGil {
 public:
  /// How many threads call a function, or wait for the GIL for it.
  using Callers = std::atomic<int>;

  /// `callers`: of the function that is to be called, which must outlive it.
  explicit ThreadGil(Callers& callers) : turn_(callers) {}
  ThreadGil(const ThreadGil&) = delete;
  ThreadGil& operator=(const ThreadGil&) = delete;

 private:
  /// Comes first, and goes last: it waits until nobody else is a caller, or for so long that the others' calls are no short ones,
  /// and sees to it that the thread has a state.
  class Turn {
   public:
    explicit Turn(Callers& callers);
    ~Turn() { callers_->fetch_sub(1); }

   private:
    Callers* callers_;
  };

  Turn turn_;
  pybind11::gil_scoped_acquire gil_;
};

}  // namespace pgdr::python
