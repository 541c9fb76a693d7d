// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which part of space is whose, once the mesh has been cut. Every node of the cut's level, and all below it, has one owner, which
// alone visits it. A rank holds the cells with a vertex in the claims of its nodes of that level: the nodes' boxes, grown by half
// their side. Claims of nodes below lie in these. So it holds all cells that its visits own, and all that share a face with one.
//
// A cell with a vertex in what a rank holds is made or deleted only by a visit that claims this vertex, as a visit claims all
// vertices of the cells that it deletes. So a rank's part of the mesh stays right if the rank hears of the changes, by visits
// with claims that meet what it holds, of cells with a vertex there. A link across a face may be out of date only if no vertex of
// the face is held; a visit that reads the link owns the cell, so that all vertices of the face are.
//
// Immutable; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "claims/grid_box.hpp"
#include "tree/orthtree.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class Territory {
 public:
  using Node = typename Orthtree<D>::Node;
  /// A part of space that has one owner, and is held by the same ranks. Their number grows with that of the ranks.
  enum class Zone : std::uint32_t {};

  /// `nodes`: all of the level, in Morton order; `owners`: of each. What is asked of nodes and boxes needs the tree, which may be
  /// split; what is asked of points does not.
  Territory(const Orthtree<D>& tree, std::span<const Node> nodes, std::span<const int> owners, int ranks, int rank);

  /// Once the nodes have been split, what the same ranks hold of their parts: the claims of these reach less far beyond them.
  Territory of_next_level() const;

  int level() const { return level_; }  ///< of the nodes that have one owner each
  int rank() const { return rank_; }
  int ranks() const { return count_; }  ///< how many there are
  /// Who visits the node; -1: nobody, as it is above level().
  int owner(Node node) const;
  /// The part of space that the point is in.
  Zone zone(const Point<D>& p) const;
  /// Who owns the nodes of the cut's level that the zone is in.
  int owner(Zone zone) const { return record(zone).owner; }
  /// The ranks that hold the zone, ascending.
  std::span<const int> holders(Zone zone) const { return record(zone).holders; }
  /// Does this rank hold the zone?
  bool holds(Zone zone) const { return record(zone).is_held; }
  bool holds(Zone zone, int rank) const {
    const auto ranks = holders(zone);
    return std::find(ranks.begin(), ranks.end(), rank) != ranks.end();
  }
  /// Does another rank hold the zone?
  bool is_shared(Zone zone) const { return record(zone).is_shared; }
  /// Does another rank hold a part of the box?
  bool is_shared(const GridBox<D>& box) const;
  /// Of a weight spread over each of the nodes, in the order of the constructor, the share that each rank holds.
  std::vector<double> held_of(std::span<const Node> nodes, std::span<const double> weights) const;
  /// The ranks that hold points that this one holds, too, without this one, ascending.
  const std::vector<int>& neighbours() const { return neighbours_; }

 private:
  // Who holds a point depends on the half of a node, along each axis, that it is in.
  using Halves = std::array<std::uint64_t, D>;
  std::uint64_t across() const { return std::uint64_t{2} << level_; }
  std::uint64_t half_of(const Point<D>& p, int axis) const;
  std::vector<int> ranks_around(const Halves& halves) const;
  struct ZoneRecord {
    int owner;
    std::vector<int> holders;  ///< ascending
    bool is_held, is_shared;
  };

  const Orthtree<D>* tree_;
  int level_, rank_, count_;
  std::array<std::vector<double>, D> borders_;  ///< of halves, along each axis, from the root's low one to its high one
  double halves_a_unit_ = 0;                    ///< of length, about
  std::vector<int> owners_;                     ///< by place of the node
  const ZoneRecord& record(Zone zone) const { return zones_[static_cast<std::size_t>(zone)]; }
  std::vector<Zone> zone_;  ///< by place of the half
  std::vector<ZoneRecord> zones_;
  std::vector<int> neighbours_;
};

extern template class Territory<2>;
extern template class Territory<3>;

}  // namespace pgdr::detail
