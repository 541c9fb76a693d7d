// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flips that restore the local Delaunay property where an insertion could not keep it. A constrained Delaunay triangulation of
// space need not exist while a subsegment is encroached upon from behind a wall. The cavity is then cut back, and a face of its
// rim may have a vertex of the one side in the sphere of the other. Once the subsegment is split such faces are flipped away. In
// 2D two triangles become two others. In 3D two tetrahedra become three, or an edge leaves a ring of up to seven, if need be
// together with the two subfacets of one facet that it lies between.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "change/edge_ring.hpp"
#include "change/replacement.hpp"
#include "change/rewrap.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// Flips at the faces and edges of cells. One thread at a time, as the cavity.
template <int D>
class LocalFlips {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of the worker
  /// What became of an attempt. Stuck: no flip does it. Not owned: to find that out would need cells that the visit does not own.
  enum class Outcome { flipped, stuck, not_owned };

  /// Both must outlive it.
  LocalFlips(Mesh<D>& mesh, const Domain<D>& domain) : mesh_(&mesh), domain_(&domain), rewrap_(mesh), replacer_(mesh) {}

  /// A function that gift wrapping asks often; once it says true, gift wrapping ends.
  void set_ended(std::function<bool()> ended) { rewrap_.set_ended(std::move(ended)); }
  /// What the visit may change; null: everything.
  void set_area(const VisitArea<D>* area) {
    area_ = area;
    rewrap_.begin_visit(area);
    replacer_.set_area(area);
  }

  /// Flips the face, or an edge of it, if that leaves fewer violations.
  Outcome repair(Pools& pools, CellId c, int face);
  /// 3D: makes the cells about the face anew by gift wrapping, if that leaves fewer violations (change/rewrap.hpp); slower.
  Outcome rewrap(Pools& pools, CellId c, int face, LocalRewrap::Effort effort);
  /// Removes c if all its vertices lie on one facet, and two of its faces are subfacets of that: it is flat but for rounding.
  /// This flips the facet's triangulation there. Stuck: c is no such cell, or has to stay.
  Outcome remove_flat_cell(Pools& pools, CellId c);
  /// Has gift wrapping paid in this visit so far? `allowance`: the work that may be without effect in any case.
  bool rewrap_pays(std::uint64_t allowance) const;
  /// The cells that the last success made, or laid bare.
  const std::vector<CellId>& new_cells() const { return new_cells_; }

 private:
  bool owns(CellId c) const { return !area_ || area_->owns(*mesh_, c); }
  bool flip_face(Pools& pools, CellId c, int face);
  /// The condition on the number of violations. Better: fewer, or as many if three cells become two. No worse: at most as many.
  enum class Condition { better, no_worse };
  Outcome remove_edge(Pools& pools, CellId c, int edge, Condition condition);
  void fill_about(VertexId hub);
  bool commit_if(Pools& pools, int most);
  int violations_before() const;
  std::optional<std::array<int, 2>> faces_of_flat(CellId c) const;

  struct NoRewrap {
    explicit NoRewrap(Mesh<D>&) {}
    void begin_visit(const VisitArea<D>*) {}
    void set_ended(const std::function<bool()>&) {}
  };

  Mesh<D>* mesh_;
  const Domain<D>* domain_;
  const VisitArea<D>* area_ = nullptr;
  std::conditional_t<D == 3, LocalRewrap, NoRewrap> rewrap_;
  Replacer<D> replacer_;
  Replacement<D> tried_;
  EdgeRing ring_;  ///< 3D
  std::vector<CellId> new_cells_;
};

extern template class LocalFlips<2>;
extern template class LocalFlips<3>;

}  // namespace pgdr
