// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A record of the visits that run at this moment, with which debug builds watch the claims: those of visits that run at once must
// not meet. The atomics are relaxed, so that they order nothing and hide no race from a thread sanitizer. A visit reads of
// another one what was there before both began.
#pragma once

#include <array>
#include <atomic>
#include <cassert>

#include "claims/conflict_manager.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class ClaimRegistry {
 public:
  /// Enters the visit, which must stay where it is until it leaves. Any thread. @returns false if it meets one that runs
  bool enter(const Visit<D>& visit) {
    std::size_t own = running_.size();
    for (std::size_t i = 0; i < running_.size() && own == running_.size(); ++i) {
      const Visit<D>* nobody = nullptr;
      if (running_[i].compare_exchange_strong(nobody, &visit, std::memory_order_relaxed)) own = i;
    }
    bool alone = true;
    for (std::size_t i = 0; i < running_.size(); ++i) {
      const Visit<D>* other = i == own ? nullptr : running_[i].load(std::memory_order_relaxed);
      alone = alone && !(other && meet(visit, *other));
    }
    return alone;
  }
  /// Takes it out. Any thread.
  void leave(const Visit<D>& visit) {
    for (auto& slot : running_) {
      const Visit<D>* own = &visit;
      if (slot.compare_exchange_strong(own, nullptr, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::array<std::atomic<const Visit<D>*>, 256> running_{};  ///< more than run at once; a visit that finds no room is not watched
};

/// Holds a claim while it lives, in debug builds; in others it does nothing.
template <int D>
class TakenClaim {
 public:
  TakenClaim([[maybe_unused]] ClaimRegistry<D>& registry, [[maybe_unused]] const Visit<D>& visit)
#ifndef NDEBUG
      : registry_(registry), visit_(visit) {
    const bool alone = registry.enter(visit);
    assert(alone && "the claims of two running visits meet");
    static_cast<void>(alone);
  }
  ~TakenClaim() { registry_.leave(visit_); }

 private:
  ClaimRegistry<D>& registry_;
  const Visit<D>& visit_;
#else
  {
  }
#endif
 public:
  TakenClaim(const TakenClaim&) = delete;
  TakenClaim& operator=(const TakenClaim&) = delete;
};

}  // namespace pgdr::detail
