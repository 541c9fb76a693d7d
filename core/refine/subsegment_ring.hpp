// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The ring of a subsegment, in 3D: the cells round it, which say where it is split, and mostly whether that is refused. Beside
// small angles most encroached subsegments are: a vertex of the ring is too near to the point. No vertex goes before the
// optimiser begins, so that more vertices elsewhere do not make such a point fit. What the ring refuses is therefore not put on a
// list: only a new ring, whose cells are new, asks again. It may refuse more than the whole cavity would: a vertex beyond the
// ring that is nearer still may demand less.
#pragma once

#include <optional>

#include "mesh/entity_pair.hpp"
#include "refine/workspace.hpp"
#include "rule/insertion_rule.hpp"
#include "rule/twins.hpp"

namespace pgdr {

/// See above. A query; the workspace's thread.
class SubsegmentRing {
 public:
  /// The ring of edge `edge` of c, a subsegment. The workspace must outlive it. @pre the visit owns c
  SubsegmentRing(Workspace<3>& workspace, CellId c, int edge);

  bool owned() const { return owned_; }  ///< does the visit own all of it? Else nothing else is known.
  /// Where to split the subsegment: beside a vertex of the ring that is close to it (twins.hpp), or as split_point() says.
  const Point3& x() const { return x_; }
  /// That place; null if there is no such vertex.
  const SplitPlace* place() const { return place_ ? &*place_ : nullptr; }
  /// If the subsegment is encroached, and a vertex of the ring is nearer to x than the one nearest to x that is not of the
  /// subsegment's ends, nor a twin, demands: the segment, and what the latter lies on.
  std::optional<EntityPair> refuses() const;

 private:
  template <class F>
  void for_vertices(F f) const;

  Workspace<3>* w_;
  CellId cell_;
  int edge_;
  EntityId segment_;
  std::array<VertexId, 2> ends_;
  bool owned_ = true;
  std::optional<SplitPlace> place_;
  Point3 x_{};
};

/// The demand of the entity that is split at x, encroached upon by q, in 3D at less than 60 degrees too.
template <int D>
Demand demand_beside(Workspace<D>& workspace, EntityRef entity, VertexId q);

}  // namespace pgdr
