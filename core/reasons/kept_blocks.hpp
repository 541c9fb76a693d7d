// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which kept entity blocks the places for a point that would take a cell away (select/blocked_places.hpp). It may be far from
// the cell: so kept triangles and segments are found by the boxes about their smallest balls.
#pragma once

#include <optional>
#include <vector>

#include "pgdr/domain.hpp"
#include "rule/kept_entities.hpp"
#include "space/box_tree.hpp"

namespace pgdr {

/// Immutable; any number of threads.
class KeptBlocks {
 public:
  /// The domain must outlive it.
  KeptBlocks(const Domain<3>& domain, const KeptEntities<3>& kept);

  /// The one that blocks both places, and meets the circumball, doubled, nearest to the circumcentre.
  std::optional<EntityRef> of_cell(const Simplex<3>& cell, double radius_edge_bound) const;

 private:
  const Domain<3>* domain_;
  std::vector<EntityRef> entities_;         ///< of each box
  std::optional<detail::BoxTree<3>> tree_;  ///< none if nothing is kept
};

}  // namespace pgdr
