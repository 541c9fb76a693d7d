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

  /// `nodes`: all of the level, in Morton order; `owners`: of each. What is asked of nodes and boxes needs the tree, which may be
  /// split; what is asked of points does not.
  Territory(const Orthtree<D>& tree, std::span<const Node> nodes, std::span<const int> owners, int ranks, int rank);

  int level() const { return level_; }  ///< of the nodes that have one owner each
  int rank() const { return rank_; }
  int ranks() const { return count_; }  ///< how many there are
  /// Who visits the node. @pre its level is level() or below
  int owner(Node node) const;
  /// Who owns the node of the cut's level that the point is in.
  int owner(const Point<D>& p) const;
  /// The ranks that hold the point, ascending.
  std::span<const int> holders(const Point<D>& p) const { return ranks_of(place_of(p)); }
  /// Does this rank hold the point?
  bool holds(const Point<D>& p) const { return is_held_[place_of(p)]; }
  bool holds(const Point<D>& p, int rank) const {
    const auto ranks = holders(p);
    return std::find(ranks.begin(), ranks.end(), rank) != ranks.end();
  }
  /// Does another rank hold the point?
  bool is_shared(const Point<D>& p) const { return is_shared_[place_of(p)]; }
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
  std::size_t place_of(const Point<D>& p) const;
  std::size_t place_of(const Halves& halves) const;
  std::span<const int> ranks_of(std::size_t place) const {
    return {ranks_.data() + first_[place], ranks_.data() + first_[place + 1]};
  }
  std::vector<int> ranks_around(const Halves& halves) const;

  const Orthtree<D>* tree_;
  int level_, rank_, count_;
  std::array<std::vector<double>, D> borders_;  ///< of halves, along each axis, from the root's low one to its high one
  double halves_a_unit_ = 0;                    ///< of length, about
  std::vector<int> owners_;                     ///< by place of the node
  std::vector<std::uint32_t> first_;            ///< by place of the half: the first in ranks_
  std::vector<int> ranks_;
  std::vector<char> is_held_, is_shared_;
  std::vector<int> neighbours_;
};

extern template class Territory<2>;
extern template class Territory<3>;

}  // namespace pgdr::detail
