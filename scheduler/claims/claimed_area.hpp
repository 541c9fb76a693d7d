// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The area that a visit may change, as the refiner asks for it: the leaves of its claim. One thread.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "claims/claim.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class ClaimedArea final : public VisitArea<D> {
 public:
  ClaimedArea(const Orthtree<D>& tree, const Claim<D>& claim) : tree_(&tree), claim_(&claim) {
    this->inner_low = claim.inner().low;
    this->inner_high = claim.inner().high;
    const auto box = unbounded_box(tree, claim.leaf());
    this->home_low = box.low;
    this->home_high = box.high;
    // A visit of the whole tree has no leaf of its own.
    if (claim.whole()) this->home_low[0] = infinity;
  }
  /// The box of all points that belong to the leaf: points beyond the root belong to the leaf nearest to them.
  static typename Orthtree<D>::Box unbounded_box(const Orthtree<D>& tree, std::uint32_t leaf) {
    auto box = tree.box(leaf);
    for (int i = 0; i < D; ++i) {
      const std::uint64_t low = tree.position(leaf, i);
      if (low == 0) box.low[i] = -infinity;
      if (low + tree.extent(leaf) == tree.extent(Orthtree<D>::root)) box.high[i] = infinity;
    }
    return box;
  }
  /// Is the point in a claimed leaf? Answers are kept, as the vertices around an element are asked for again and again.
  bool claimed(const Point<D>& p) const override {
    std::uint64_t hash = 0;
    for (int i = 0; i < D; ++i) hash = (std::rotl(hash, 21) ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9e3779b97f4a7c15u;
    Answer& a = answers_[hash >> (64 - answer_bits)];
    if (!(a.p == p)) a = {p, claim_->contains(p)};
    return a.claimed;
  }
  std::uint32_t leaf_of(const Point<D>& p) const override { return tree_->leaf_at(p); }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  static constexpr int answer_bits = 8;
  struct Answer {
    Point<D> p = nowhere();
    bool claimed = false;
  };
  static Point<D> nowhere() {
    Point<D> p;
    p[0] = std::numeric_limits<double>::quiet_NaN();
    return p;
  }

  const Orthtree<D>* tree_;
  const Claim<D>* claim_;
  mutable std::array<Answer, 1 << answer_bits> answers_;
};

}  // namespace pgdr::detail
