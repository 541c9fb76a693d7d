// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces of work that do not wait for each other, as a library layer hands them to whoever has the threads. What comes out must
// not depend on which run at once, nor in which order.
#pragma once

#include <cstddef>
#include <functional>

namespace pgdr::detail {

/// Runs pieces side by side. One thread calls; the pieces run on any, with the floating-point environment of the caller's run.
class Pieces {
 public:
  virtual ~Pieces() = default;
  /// Calls piece(i) once for each i < count, in any order, several at once, and returns when all have ended. No further piece
  /// starts once one has thrown; the exception of the least number among those that did comes out.
  virtual void run(std::size_t count, const std::function<void(std::size_t)>& piece) const = 0;
  /// Can several run at once? For those who would choose another way on one thread that gives the same.
  virtual bool is_parallel() const = 0;
};

/// One after the other, on the calling thread.
class OneByOne final : public Pieces {
 public:
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    for (std::size_t i = 0; i < count; ++i) piece(i);
  }
  bool is_parallel() const override { return false; }
};

}  // namespace pgdr::detail
