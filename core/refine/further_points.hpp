// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The further points of a selector of several (SelectedPoints): once the first point of an element has gone in, each of the
// others goes in too, in their order, if at that time
//
//   (1) it is inside the circumsphere of the element as it was, and no wall hides it;
//   (2) it encroaches upon no subsegment or subfacet, as no volume vertex ever does: nothing is split in its place;
//   (3) its cavity is star-shaped about it and loses no entity, as that of any point;
//   (4) its insertion radius r is at least l, the least relaxed length of the element's edges, and at least R - d, the
//   circumradius
//       less the radius of the selection disk, which is what every point of the disk has from the element's vertices.
//
// So it obeys the insertion rule of a point for a poor element (rule/insertion_rule.hpp) without the halving that beside small
// angles is paid once a chain, and inherits nothing: its relaxed insertion radius is r >= l. The proof there holds as it stands.
//
// Claims: as cells near an element may belong to another visit, all cavities are collected before the first point goes in. Where
// one leaves the claim the element waits for a larger one. What goes in is then no matter of how space is divided into claims:
// a later cavity has of the cells that were there a part of what was collected, and new cells, whose vertices are in the claim.
// Only where walls or violations are about may it reach beyond after all, and then the point is left out.
//
// Where the search for the cavity begins: the ball of the element had no vertex inside. Shrunk about its centre until the first
// of the points inside is on its boundary, then towards that until another one is, it shows that each point, as it goes in, has
// an edge with one that went in before: a cell at one of these is in conflict with it. Walls may hide it, which leaves it out.
#pragma once

#include <vector>

#include "refine/inserter.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// The further points of the element that is split. Part of a worker: one thread at a time.
template <int D>
class FurtherPoints {
 public:
  /// Both must outlive it.
  FurtherPoints(Workspace<D>& workspace, Inserter<D>& inserter) : w_(&workspace), inserter_(&inserter) {}

  /// None are left.
  void clear() { points_.clear(); }
  bool empty() const { return points_.empty(); }  ///< are there none?
  /// Takes all points but the first of what was selected for the element.
  void take(const SelectedPoints<D>& selected, const PoorElement<D>& element);
  /// Looks at the element before the first point goes in. `least` is l of (4). Uses the cavity, which must be empty.
  /// @returns false if the claim is too small to tell
  bool look_ahead(CellId c, double least);
  /// Puts in what may go in. @pre the cavity has just been committed for the first point. It is released after that
  void insert();

 private:
  bool go_in(const Point<D>& p);
  bool collect(const Point<D>& p);
  void remember_star();

  Workspace<D>* w_;
  Inserter<D>* inserter_;
  std::vector<Point<D>> points_;
  Point<D> center_;             ///< of the circumsphere
  double circumradius_ = 0;     ///< its radius, rounded
  double least_ = 0;            ///< insertion radius
  std::vector<Entry<D>> star_;  ///< the cells at the points that went in, as far as they live
};

extern template class FurtherPoints<2>;
extern template class FurtherPoints<3>;

}  // namespace pgdr
