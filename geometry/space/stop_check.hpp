// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A check for cancellation, asked between steps and in loops over the whole input: an exception ends what the caller has
// cancelled.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <utility>

#include "pgdr/error.hpp"

namespace pgdr::detail {

class StopCheck {
 public:
  explicit StopCheck(std::stop_token stop) : stop_(std::move(stop)) {}

  /// @throws CancelledError once the token is requested
  void operator()() const {
    if (stop_.stop_requested()) throw CancelledError({Errc::cancelled, "cancelled by the caller", {}, 0, {}, {}});
  }
  /// Sorts what has one order alone, and asks now and then.
  template <class Bulk, class Items, class Less = std::less<>>
  void sort(const Bulk& bulk, Items& items, const Less& less = {}) const {
    if (bulk.is_parallel()) {
      bulk.sort(items, less);
      return (*this)();
    }
    std::uint32_t compared = 0;
    std::sort(items.begin(), items.end(), [&](const auto& a, const auto& b) {
      if (++compared % 65536 == 0) (*this)();
      return less(a, b);
    });
  }

 private:
  std::stop_token stop_;
};

}  // namespace pgdr::detail
