// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "thread_gil.hpp"

#include <chrono>
#include <thread>

namespace pgdr::python {
namespace {

constexpr std::chrono::microseconds a_short_call(100);

/// The state of a thread that is not one of Python's, which drops its own when they end.
class KeptState {
 public:
  KeptState() : before_(PyGILState_Ensure()), state_(PyEval_SaveThread()) {}
  KeptState(const KeptState&) = delete;
  KeptState& operator=(const KeptState&) = delete;
  /// Workers of TBB may outlive Python, which has dropped all states then. Where it ends just now, it ends this thread instead,
  /// which the compiler sees as an exception.
  ~KeptState() noexcept(false) {
    if (!Py_IsInitialized()) return;
    PyEval_RestoreThread(state_);
    PyGILState_Release(before_);
  }

 private:
  PyGILState_STATE before_;
  PyThreadState* state_;
};

}  // namespace

ThreadGil::Turn::Turn(Callers& callers) : callers_(&callers) {
  if (!PyGILState_GetThisThreadState()) thread_local const KeptState kept;
  const auto is_next = [&callers] {
    int nobody = 0;
    return callers.compare_exchange_strong(nobody, 1);
  };
  if (is_next()) return;
  const auto patience = std::chrono::steady_clock::now() + a_short_call;
  while (std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
    if (is_next()) return;
  }
  callers.fetch_add(1);
}

}  // namespace pgdr::python
