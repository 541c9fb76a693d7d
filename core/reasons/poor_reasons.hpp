// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Why elements stay poor: the two input entities that meet at a small angle next to them. What refused the element's
// insertion is named if it is such a pair, else a pair among the entities that the element and its neighbours touch. One of the
// two has to be near: docs/small-angles.md says how near, and why.
// Reads the whole mesh, while nothing else is running; one thread where nothing else is said.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "input/sharp_angles.hpp"
#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/poor_reason.hpp"
#include "refine/work_list.hpp"
#include "rule/cell_bounds.hpp"
#include "rule/kept_entities.hpp"
#include "space/bulk.hpp"

namespace pgdr {

/// Is it a segment or a facet, and no point, so that it makes angles with others?
inline bool has_extent(EntityRef e) { return e.kind == EntityKind::segment || e.kind == EntityKind::facet; }

/// A PoorReason that names entities of the Domain, as long as it is found.
struct DomainReason {
  PoorReason::Code code = PoorReason::Code::small_angle;
  std::array<EntityRef, 2> entities;
  double angle = 0;  ///< degrees
};

/// An element that stays poor, or has a face that is not locally Delaunay, and why. `PoorReason::cell` is filled when
/// the mesh is compacted.
struct PoorCell {
  CellId cell;              ///< the element
  bool over_bound = false;  ///< over any bound
  bool over_size = false;   ///< over one of size, volume or area
  DomainReason reason;      ///< why it is poor
  bool beside = false;      ///< has a vertex on one of the entities named
};

/// Cells over a bound.
struct PoorCount {
  std::uint64_t cells = 0;  ///< so many
  bool over_size = false;   ///< any of them
};

/// How many of the cells numbered [first, last) are over a bound: of a run that a budget ended, or of none. Several
/// threads at once.
template <int D>
PoorCount count_poor_cells(const Mesh<D>& mesh, const CellBounds<D>& bounds, std::uint32_t first, std::uint32_t last);

/// As the checker will ask: does the segment (3D: the facet) meet the ball, the circumball of a cell doubled but for a hair, or
/// does its centre lie in the smallest sphere about the segment, or about a triangle of the facet?
template <int D>
bool is_beside(const Domain<D>& domain, EntityRef entity, const Ball<D>& doubled);

/// The circumball, doubled, a hair less, so that another's rounding cannot disagree.
template <int D>
Ball<D> doubled_circumball(const Simplex<D>& cell);

/// Finds the reasons of elements that stay poor.
template <int D>
class PoorReasons {
 public:
  /// All must outlive it. `kept`: what was not split. `meshed`: whose angles count.
  PoorReasons(const Mesh<D>& mesh, const Domain<D>& domain, const CellBounds<D>& bounds, const KeptEntities<D>& kept,
              CountedTriangles meshed, const detail::Bulk& bulk);

  /// What was refused in one region. What is said of a cell last counts, if it names a pair.
  void add(std::span<const Refusal<D>> refused);

  /// Every cell numbered [first, last) that is over a bound, with its reason, and every one with a face that is not locally
  /// Delaunay beside a small angle, with that. `violated`, by cell: those with a face that is not locally Delaunay.
  /// @pre the refinement has finished. Several threads at once. Ends early, with some of them, once `must_end` says so.
  std::vector<PoorCell> of_cells(std::uint32_t first, std::uint32_t last, const std::vector<bool>& violated,
                                 const std::function<bool()>& must_end) const;
  /// of_cells() for the cells that were refused, which are all poor cells where every face is locally Delaunay.
  std::vector<PoorCell> of_refused(const std::function<bool()>& must_end, const detail::Bulk& bulk) const;
  /// The reasons of those of these cells, each with a face that is not locally Delaunay, that are beside a small angle: of a run
  /// that a limit has ended. Ends early, with some of them, once `ended` says so.
  std::vector<PoorCell> of_violated(std::span<const CellId> cells, const std::function<bool()>& ended) const;

 private:
  DomainReason explain(CellId c, bool beside) const;
  std::optional<DomainReason> small_angle(const std::array<EntityRef, 2>& pair) const;
  std::optional<DomainReason> explain_by_piece(CellId c, std::span<const CellId> cells, std::span<const EntityRef> near) const;
  bool explains(const std::array<EntityRef, 2>& pair, const Ball<D>& doubled, DomainReason& reason) const;
  bool meets(EntityRef e, const Ball<D>& ball) const;
  template <class F>
  bool any_entity_of(Home home, F f) const;
  template <class F>
  bool any_constrained(CellId c, F f) const;
  void look_at(CellId c, bool violated, std::vector<PoorCell>& found) const;

  const Mesh<D>* mesh_;
  const Domain<D>* domain_;
  const CellBounds<D>* bounds_;
  const KeptEntities<D>* kept_;
  CountedTriangles meshed_;
  std::vector<std::uint8_t> meshed_segments_;
  double largest_ = 0;  ///< coordinate of the input
  /// Of each input point its segments: segments_at_ from segments_begin_ on.
  std::vector<std::uint32_t> segments_begin_, segments_at_;
  /// Of the refused elements that are still there: by what; no entities if no pair was at fault.
  std::unordered_map<std::uint32_t, std::optional<EntityPair>> why_;
};

extern template class PoorReasons<2>;
extern template class PoorReasons<3>;

}  // namespace pgdr
