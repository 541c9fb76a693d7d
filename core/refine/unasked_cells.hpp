// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells that a visit has made, and of which it is not known yet whether they are poor, since a size function that is asked by
// blocks says so. They wait here in the order in which they were made, until it depends on one of them what is treated next, or
// the visit ends. Then all are asked for in one block, and the poor ones are listed in that order.
//
// Why that makes the mesh that asking at once makes: elements of one bucket go first in, first out, and none is taken before
// those of larger buckets. So nothing that waits here in a bucket that is not before that of the next element can be next, and
// what is listed later than it would have been is listed behind the same elements. Also dead cells are asked for, as they count
// in WorkList::is_crowded. Plain containers; one thread at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "refine/context.hpp"
#include "refine/work_list.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// See above.
template <int D>
class UnaskedCells {
 public:
  /// As many as this are asked for at the latest, which bounds the memory of a visit to all of space.
  static constexpr std::size_t most = 8192;

  /// One that waits: an element that may be poor, or one that is known to be and must not overtake the others.
  struct Cell {
    Entry<D> entry;                         ///< but for why it is listed and its order, if it is not known to be poor
    bool is_known;                          ///< is it poor, for what the entry says?
    typename CellBounds<D>::MadeCell made;  ///< if that is not known
    double squared_circumradius;            ///< of the cell, the same
  };

  bool empty() const { return cells_.empty(); }       ///< does none wait?
  std::size_t size() const { return cells_.size(); }  ///< so many wait
  int first_bucket() const { return first_bucket_; }  ///< of the largest; behind all buckets if there is none
  /// Does one wait in this bucket?
  bool has(int bucket) const { return in_bucket_[static_cast<std::size_t>(bucket)] > 0; }
  /// Adds it behind the others.
  void push(const Cell& c) {
    cells_.push_back(c);
    ++in_bucket_[c.entry.bucket];
    first_bucket_ = std::min<int>(first_bucket_, c.entry.bucket);
  }
  /// Forgets all.
  void clear() {
    cells_.clear();
    in_bucket_ = {};
    first_bucket_ = RefineContext<D>::buckets;
  }
  /// Forgets those that are dead.
  void drop_dead(const Mesh<D>& mesh) {
    std::erase_if(cells_, [&](const Cell& c) { return !c.entry.alive(mesh); });
  }
  /// Asks the sizes of all in one block, calls `f(cell, size)` for each in order, where size is 0 for one that is known to be
  /// poor, and forgets them. @throws UsageError bad_size; what the size function throws
  template <class F>
  void ask(const Mesh<D>& mesh, const CellBounds<D>& bounds, F f) {
    centroids_.clear();
    regions_.clear();
    for (const Cell& c : cells_) {
      if (c.is_known) continue;
      centroids_.push_back(centroid<D>(mesh.points(c.made.vertices)));
      regions_.push_back(c.made.region);
    }
    sizes_.resize(centroids_.size());
    if (!sizes_.empty()) bounds.sizes_at(centroids_, regions_, sizes_);
    std::size_t next = 0;
    for (const Cell& c : cells_) f(c, c.is_known ? 0 : sizes_[next++]);
    clear();
  }

 private:
  std::vector<Cell> cells_;
  std::array<std::uint32_t, RefineContext<D>::buckets> in_bucket_{};
  int first_bucket_ = RefineContext<D>::buckets;
  std::vector<Point<D>> centroids_;  // scratch of ask()
  std::vector<int> regions_;
  std::vector<double> sizes_;
};

}  // namespace pgdr
