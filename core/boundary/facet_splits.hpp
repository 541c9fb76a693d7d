// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a round of the recovery is going to do about triangles of one facet, as far as that can be known before the round: plans
// of all facets are made side by side. Private to this room.
#pragma once

#include <optional>
#include <vector>

#include "boundary/state.hpp"

namespace pgdr::detail {

/// The triangles of one facet that are to be split, largest first, and where. A plan holds for as long as no subsegment of the
/// facet is split. Trees of boxes say what is near a point: strips have many triangles, and the same facet many rounds.
class FacetPatches::SplitPlan {
 public:
  SplitPlan(const FacetPatches& patches, EntityId facet, std::vector<Candidate> candidates);

  EntityId facet() const { return facet_; }
  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// Has no subsegment of the facet been split since?
  bool is_current(const FacetPatches& patches) const;
  /// Finds the places anew, as the facet is now.
  void renew(const FacetPatches& patches);

  /// Where a candidate is to be split: at a point, unless a subsegment is in its way.
  struct Place {
    Point3 point;
    std::optional<Subsegment> in_the_way;
  };
  const Place& place(const FacetPatches& patches, std::size_t candidate);
  /// Calls f(i) for each candidate whose triangle a vertex at p would take away.
  template <class F>
  void each_reached(const Point3& p, const F& f) const {
    tree_.at(p, [&](std::size_t i) {
      if (in_equatorial_ball(candidates_[i].ball, p)) f(i);
    });
  }

 private:
  std::optional<Subsegment> find_in_the_way(const FacetPatches& patches, const Triangle& t, const Point3& x) const;

  EntityId facet_;
  std::vector<Candidate> candidates_;
  std::vector<Subsegment> rim_;
  BoxTree<2> rim_tree_;  ///< over the diametral balls of the rim, in the facet's projection
  BoxTree<3> tree_;      ///< over the equatorial balls of the candidates
  std::vector<std::optional<Place>> places_;
};

}  // namespace pgdr::detail
