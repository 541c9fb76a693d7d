// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The ranks that make one mesh together, as pgdr-mpi has them; the plain command is alone. What is read, written and printed is
// by the first of them.
#pragma once

#include <exception>

#include "pgdr/ranks.hpp"

namespace pgdr::tool {

class Ranks {
 public:
  Ranks() = default;
  explicit Ranks(Transport& transport) : transport_(&transport) {}

  /// Null: the command is alone.
  Transport* transport() const { return transport_; }
  bool is_first() const { return !transport_ || transport_->rank() == 0; }
  /// Can the others not be reached any more?
  bool are_lost() const { return transport_ && transport_->has_failed(); }

  /// Runs f on all ranks. Throws on all if it threw on any.
  template <class F>
  void together(F f) const {
    if (!transport_) return f();
    std::exception_ptr error;
    try {
      f();
    } catch (...) {
      error = std::current_exception();
    }
    throw_together(*transport_, error);
  }
  /// The same with the first rank alone.
  template <class F>
  void on_first(F f) const {
    together([&] {
      if (is_first()) f();
    });
  }
  /// The largest of the numbers of all ranks that can be reached.
  int largest(int number) const { return transport_ && !are_lost() ? largest_of_ranks(*transport_, number) : number; }

 private:
  Transport* transport_ = nullptr;
};

}  // namespace pgdr::tool
