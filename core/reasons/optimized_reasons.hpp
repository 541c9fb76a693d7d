// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Why cells stay over a bound after the optimiser: angles of the input at which the bounds cannot be met (check/reasons.hpp says
// which, and why no others), or else that nothing better was found. Reads the whole mesh, while nothing else is running.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "input/sharp_angles.hpp"
#include "mesh/key_set.hpp"
#include "reasons/kept_blocks.hpp"
#include "reasons/poor_reasons.hpp"
#include "reasons/vertex_gaps.hpp"

namespace pgdr {

/// Finds the reasons of cells that stay over a bound of shape, size or dihedral angles. It remembers what it has found at
/// entities of the input: each thread has its own.
class OptimizedReasons {
 public:
  /// What it is given must outlive it. `kept`: what was not split. `largest_cosine`: claimed_cosine of the target.
  OptimizedReasons(const Mesh<3>& mesh, const Domain<3>& domain, const CellBounds<3>& bounds, const KeptEntities<3>& kept,
                   CountedTriangles meshed, double largest_cosine);

  /// Of those of the cells that are over a bound, as the checker decides it. Where nothing excuses the cell the code is
  /// `otherwise`: not_found or budget. Ends early, with some of them, once `ended` says so.
  std::vector<PoorCell> of_cells(std::span<const CellId> cells, PoorReason::Code otherwise, const std::function<bool()>& ended);

  /// Is the code one that excuses a cell?
  static bool is_excuse(PoorReason::Code code) { return code != PoorReason::Code::not_found && code != PoorReason::Code::budget; }

 private:
  using Pair = std::array<EntityId, 2>;

  std::optional<DomainReason> wedge_of(CellId c) const;
  std::optional<DomainReason> corner_of_cell(CellId c);
  std::optional<DomainReason> gap_at_corner(CellId c);
  std::optional<DomainReason> angle_near(CellId c);
  std::optional<DomainReason> kept_at(CellId c) const;
  std::optional<DomainReason> kept_before(CellId c);
  std::optional<DomainReason> kept_near(CellId c);
  const std::vector<Pair>& segments_sharp_at(EntityId point);
  const std::vector<Pair>& facets_sharp_at(EntityId segment);
  DomainReason small_angle(EntityKind kind, const Pair& pair) const;

  const Mesh<3>* mesh_;
  const Domain<3>* domain_;
  const CellBounds<3>* bounds_;
  const KeptEntities<3>* kept_;
  CountedTriangles meshed_;
  AngleBounds angles_;
  VertexGaps gaps_;
  double largest_ = 0;                                               ///< coordinate of the input
  std::vector<std::vector<EntityId>> segments_at_;                   ///< of each input point
  std::unordered_map<EntityId, std::vector<Pair>> sharp_segments_;   ///< by input point
  std::unordered_map<EntityId, std::vector<Pair>> sharp_facets_;     ///< by segment
  std::unordered_map<EntityId, std::optional<Pair>> sharp_corners_;  ///< by input point: of two segments of one facet
  std::optional<KeptBlocks> kept_blocks_;                            ///< once it was asked for
  // Scratch of angle_near():
  std::vector<CellId> cells_near_;
  KeySet known_cells_, known_vertices_;
};

}  // namespace pgdr
