// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Gift wrapping of the cells about a face that no single flip makes locally Delaunay: they are made anew, as the constrained
// Delaunay triangulation of their vertices. Flips in three dimensions can get stuck although this exists, at an edge whose ring
// is not that of any flip. Gift wrapping cannot.
//
// The region grows from the two cells at the face, over every face that is not constrained, to a cell whose sphere contains a
// vertex of the region. Where that ends, the spheres of the faces at the rim contain no vertices of the region, so that these are
// faces of the new triangulation, but where vertices hide behind walls.
#pragma once

#include <functional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "change/replacement.hpp"
#include "mesh/mesh.hpp"
#include "mesh/visit_area.hpp"
#include "space/gift_wrap.hpp"

namespace pgdr {

/// Makes the cells of a region anew. Part of a worker: one thread at a time.
class LocalRewrap {
 public:
  using Pools = Mesh<3>::Pools;  ///< of the worker

  /// How large a region may grow. Quick: few cells, where this is done for very many faces.
  enum class Effort { quick, wide };

  explicit LocalRewrap(Mesh<3>& mesh) : mesh_(&mesh), replacer_(mesh) {}  ///< the mesh must outlive it
  ~LocalRewrap() { release(); }
  LocalRewrap(const LocalRewrap&) = delete;
  LocalRewrap& operator=(const LocalRewrap&) = delete;

  /// Replaces cells about the unconstrained face by others with fewer violations. False: that cannot be done.
  bool repair(Pools& pools, CellId c, int face, Effort effort);
  /// A function that is asked often; once it says true, nothing more is repaired.
  void set_ended(std::function<bool()> ended) { ended_ = std::move(ended); }
  /// What the visit may change; null: everything.
  void begin_visit(const VisitArea<3>* area) {
    area_ = area;
    replacer_.set_area(area);
    ineffective_work_ = effective_work_ = 0;
    if (!without_effect_.empty()) without_effect_ = {};
  }
  /// Did the last repair end because it would have needed cells that the visit does not own?
  bool reached_border() const { return reached_border_; }
  /// The cells made by the last successful repair.
  const std::vector<CellId>& new_cells() const { return replacer_.new_cells(); }

  /// The cost (cells times vertices) of the repairs of this visit that changed nothing.
  std::uint64_t ineffective_work() const { return ineffective_work_; }
  /// The cost of the repairs of this visit that changed the mesh.
  std::uint64_t effective_work() const { return effective_work_; }

 private:
  using Index = GiftWrap::Index;
  /// A face of the region's rim, or one side of a constrained face inside the region.
  struct RimFace {
    GiftWrap::Face vertices;
    Link link;
    bool constrained;
  };

  bool is_ended() const { return ended_ && ended_(); }
  bool in_volume(VertexId v) const;
  void begin(CellId c, CellId d);
  bool grow();
  bool wrap_again(Pools& pools);
  std::uint64_t attempt_hash() const;
  bool owns(CellId c) const { return !area_ || area_->owns(*mesh_, c); }
  void take(CellId c);
  bool in_conflict(CellId c) const;
  Index number(VertexId v);
  void find_rim();
  bool keeps_subsegments() const;
  int violations_before() const;
  int violations_after(int enough);
  int weight(const std::array<VertexId, 4>& cell, VertexId apex) const;
  int violation(const GiftWrap::Cell& cell, VertexId apex) const;
  void replace(Pools& pools);
  const RimFace* rim_face(const GiftWrap::Face& f) const;
  void release();

  Mesh<3>* mesh_;
  const VisitArea<3>* area_ = nullptr;
  bool reached_border_ = false;
  std::function<bool()> ended_;  ///< may be empty
  GiftWrap wrap_;
  Replacer<3> replacer_;
  Replacement<3> replacement_;
  std::vector<CellId> old_;
  std::vector<VertexId> vertices_;  ///< of the region; gift wrapping knows them by their place here
  std::vector<Point3> points_;
  std::vector<RimFace> rim_;
  std::vector<std::pair<GiftWrap::Face, std::uint32_t>> rim_by_face_;  ///< sorted; places in rim_
  std::vector<GiftWrap::Face> front_;
  struct Side {
    GiftWrap::Face face;
    VertexId apex;
  };
  std::vector<Side> sides_;                        ///< of new cells, and of cells beyond the rim
  std::vector<std::array<Index, 2>> subsegments_;  ///< by their ends
  std::size_t most_cells_ = 0;
  /// Attempts of this visit without effect, by attempt_hash. Each violation of a region leads to the same attempts, and so do
  /// further looks at it when something changes beside it.
  std::unordered_set<std::uint64_t> without_effect_;
  std::uint64_t work_ = 0, ineffective_work_ = 0, effective_work_ = 0;
  std::uint16_t region_ = 0;
};

}  // namespace pgdr
