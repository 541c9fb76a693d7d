// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The floating-point environment that signs and coordinates rest on: round to nearest, denormals kept. A caller may have
// changed that of its own thread (a library built with -ffast-math is enough), while worker threads have another.
#pragma once

#include <cfenv>

namespace pgdr::detail {

/// Sets the default environment while it lives, and restores the thread's own. It is destroyed on the thread that made it.
class DefaultFloats {
 public:
  DefaultFloats() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloats() { std::fesetenv(&saved_); }
  DefaultFloats(const DefaultFloats&) = delete;
  DefaultFloats& operator=(const DefaultFloats&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace pgdr::detail
