// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The claim of a visit as the refiner asks for it.
#pragma once

#include <limits>

#include "pgdr/claim.hpp"
#include "pgdr/visit_area.hpp"

namespace pgdr::detail {

template <int D>
class ClaimedArea final : public VisitArea<D> {
 public:
  ClaimedArea(const Orthtree<D>& tree, const Claim<D>& claim) : tree_(&tree), claim_(&claim) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    this->inner_low = claim.inner().low;
    this->inner_high = claim.inner().high;
    const auto box = tree.box(claim.leaf());
    for (int i = 0; i < D; ++i) {
      const std::uint64_t low = tree.position(claim.leaf(), i), end = tree.extent(Orthtree<D>::root);
      this->home_low[i] = low == 0 ? -infinity : box.low[i];
      this->home_high[i] = low + tree.extent(claim.leaf()) == end ? infinity : box.high[i];
      // A visit of the whole tree has no leaf of its own.
      if (claim.whole()) this->home_low[i] = infinity;
    }
  }
  bool claimed(const Point<D>& p) const override { return claim_->contains(p); }
  std::uint32_t leaf_of(const Point<D>& p) const override { return tree_->leaf_at(p); }

 private:
  const Orthtree<D>* tree_;
  const Claim<D>* claim_;
};

}  // namespace pgdr::detail
