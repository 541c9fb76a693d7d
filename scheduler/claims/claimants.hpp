// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which visits have claimed a part of space so far, in their order: for each visit, those that it has to wait for. A tree of
// octants, as fine as the claims are, keeps for each octant the last visit that claimed all of it. Whoever claims all of an
// octant waits for the last one that claimed it, or one around it, or a part of it, and takes their place: all who claim one
// octant form a chain, so that any two visits that meet have a path between them. One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "claims/grid_box.hpp"
#include "graph/visit_graph.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class Claimants {
 public:
  using Visit = VisitGraph::Visit;

  /// For a tree whose root has this extent in positions of the grid.
  explicit Claimants(std::uint64_t extent) : extent_(extent), octants_(1) {}

  /// The next visit claims these boxes. @returns the visits that it has to wait for, sorted; valid until the next call
  const std::vector<Visit>& claim(Visit v, std::span<const GridBox<D>> boxes) {
    predecessors_.clear();
    for (const GridBox<D>& box : boxes) claim_in(0, {}, extent_, v, box);
    std::sort(predecessors_.begin(), predecessors_.end());
    predecessors_.erase(std::unique(predecessors_.begin(), predecessors_.end()), predecessors_.end());
    return predecessors_;
  }

 private:
  static constexpr Visit nobody = 0xffffffffu;
  static constexpr std::uint32_t children = 1 << D;
  struct Octant {
    std::uint32_t first_child = 0;  ///< 0: nobody has claimed a part of it alone
    Visit last = nobody;            ///< who claimed all of it
  };
  using Corner = std::array<std::uint64_t, D>;

  void wait_for(Visit earlier, Visit v) {
    if (earlier != nobody && earlier != v) predecessors_.push_back(earlier);
  }
  void wait_for_parts(std::uint32_t octant, Visit v) {
    const std::uint32_t first = octants_[octant].first_child;
    if (first == 0) return;
    for (std::uint32_t c = 0; c < children; ++c) {
      wait_for(octants_[first + c].last, v);
      wait_for_parts(first + c, v);
    }
    octants_[octant].first_child = 0;
    free_.push_back(first);
  }
  std::uint32_t make_children() {
    if (free_.empty()) {
      const auto first = static_cast<std::uint32_t>(octants_.size());
      octants_.resize(octants_.size() + children);
      return first;
    }
    const std::uint32_t first = free_.back();
    free_.pop_back();
    for (std::uint32_t c = 0; c < children; ++c) octants_[first + c] = {};
    return first;
  }
  void claim_in(std::uint32_t octant, const Corner& low, std::uint64_t extent, Visit v, const GridBox<D>& box) {
    bool all = true;
    for (std::size_t i = 0; i < D; ++i) {
      if (low[i] >= box.high[i] || low[i] + extent <= box.low[i]) return;
      all = all && low[i] >= box.low[i] && low[i] + extent <= box.high[i];
    }
    wait_for(octants_[octant].last, v);
    if (all) {
      wait_for_parts(octant, v);
      octants_[octant].last = v;
      return;
    }
    if (octants_[octant].first_child == 0) {
      const std::uint32_t first = make_children();
      octants_[octant].first_child = first;
    }
    for (std::uint32_t c = 0; c < children; ++c) {
      Corner corner = low;
      for (std::size_t i = 0; i < D; ++i) corner[i] += (c >> i & 1) * (extent / 2);
      claim_in(octants_[octant].first_child + c, corner, extent / 2, v, box);
    }
  }

  std::uint64_t extent_;
  std::vector<Octant> octants_;
  std::vector<std::uint32_t> free_;  ///< first children that nobody has
  std::vector<Visit> predecessors_;
};

}  // namespace pgdr::detail
