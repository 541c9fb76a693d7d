// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A record of who holds which leaf at this moment, with which debug builds watch the claims. Concurrent visits must never hold
// the same leaf, and a visit of the whole tree must be alone. The atomics are relaxed, so that they order nothing and hide no
// race from a thread sanitizer.
#pragma once

#include <atomic>
#include <cassert>
#include <cstdint>
#include <memory>

#include "claims/claim.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class ClaimRegistry {
 public:
  /// Makes room for the nodes of a tree. @pre nobody holds anything
  void reset(std::uint32_t nodes) {
    assert(running_.load(std::memory_order_relaxed) == 0);
    if (nodes > size_) holders_ = std::make_unique<std::atomic<bool>[]>(size_ = 2 * nodes);
  }
  /// Holds the claim. Any thread. @returns false if somebody else holds a part of it
  bool enter(const Claim<D>& claim) {
    bool alone = true;
    if (claim.whole()) {
      alone = running_.fetch_add(whole, std::memory_order_relaxed) == 0;
    } else {
      alone = running_.fetch_add(1, std::memory_order_relaxed) < whole;
    }
    for (const auto leaf : claim.leaves()) alone = !holders_[leaf].exchange(true, std::memory_order_relaxed) && alone;
    return alone;
  }
  /// Gives the claim up. Any thread. @returns false if a part of it was not held
  bool leave(const Claim<D>& claim) {
    bool held = true;
    for (const auto leaf : claim.leaves()) held = holders_[leaf].exchange(false, std::memory_order_relaxed) && held;
    running_.fetch_sub(claim.whole() ? whole : 1, std::memory_order_relaxed);
    return held;
  }

 private:
  static constexpr std::uint64_t whole = std::uint64_t{1} << 32;
  std::atomic<std::uint64_t> running_{0};
  std::unique_ptr<std::atomic<bool>[]> holders_;
  std::uint32_t size_ = 0;
};

/// Holds a claim while it lives, in debug builds; in others it does nothing.
template <int D>
class HeldClaim {
 public:
  HeldClaim([[maybe_unused]] ClaimRegistry<D>& registry, [[maybe_unused]] const Claim<D>& claim)
#ifndef NDEBUG
      : registry_(registry), claim_(claim) {
    const bool alone = registry.enter(claim);
    assert(alone && "two running visits hold one leaf");
    static_cast<void>(alone);
  }
  ~HeldClaim() {
    const bool held = registry_.leave(claim_);
    assert(held);
    static_cast<void>(held);
  }

 private:
  ClaimRegistry<D>& registry_;
  const Claim<D>& claim_;
#else
  {
  }
#endif
 public:
  HeldClaim(const HeldClaim&) = delete;
  HeldClaim& operator=(const HeldClaim&) = delete;
};

}  // namespace pgdr::detail
