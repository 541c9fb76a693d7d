// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The area that a visit may change, as the refiner asks for it: its claim. One thread.
#pragma once

#include <cstdint>

#include "claims/claim.hpp"
#include "claims/placement.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class ClaimedArea final : public VisitArea<D> {
 public:
  ClaimedArea(const Placement<D>& placement, const Claim<D>& claim) : placement_(&placement), claim_(&claim) {
    this->inner_low = claim.inner().low;
    this->inner_high = claim.inner().high;
    const auto box = unbounded_box(placement.tree(), claim.node());
    this->home_low = box.low;
    this->home_high = box.high;
    this->radius_above = placement.radius_below(claim.node());
    this->most_radius = placement.most_radius(claim.node());
  }
  /// The box of all points that belong to the node: points beyond the root belong to the node nearest to them.
  static typename Orthtree<D>::Box unbounded_box(const Orthtree<D>& tree, std::uint32_t node) {
    return Claim<D>::of_box(tree, node, GridBox<D>::around(tree, node, 0)).inner();
  }
  bool claimed(const Point<D>& p) const override { return claim_->contains(p); }
  std::uint32_t node_of(const Point<D>& p, double radius) const override { return placement_->node_of(p, radius); }

 private:
  const Placement<D>* placement_;
  const Claim<D>* claim_;
};

}  // namespace pgdr::detail
