// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points of one round of a triangulation go in side by side. Vertices are numbered along a curve, so that ranges of numbers
// are compact. Four ranges make a tile: the points that wait in it are inserted by one visit, one after the other. A visit
// claims the ranges of its tile, and those that share a cell with a vertex of it in the triangulation as it is: there the
// cavities of its points mostly are, whatever lies opposite on the far side of a thin or thick body. A range that very many
// visits would claim, as that of a corner of a box about everything, is claimed by none but its own: a tetrahedron may have one
// vertex outside a claim (mesh/vertex_claim.hpp). Visits whose claims are disjoint are of one batch. A function of the
// triangulation and of the points that wait, not of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// See above. One thread makes it; then any thread may read it.
template <int D>
class TilePlan {
 public:
  /// A visit: what it inserts, in this order, and what it claims.
  struct Visit {
    std::span<const VertexId> waiting;
    std::span<const std::uint32_t> claim;  ///< numbers of ranges; those of the tile first
  };

  /// `waiting`: vertices in no cell, by number. `vertices`: above all numbers. No visit at all where few would run at one time.
  TilePlan(const Mesh<D>& mesh, std::span<const VertexId> waiting, std::uint32_t vertices, const Bulk& bulk);

  int range_shift() const { return tile_shift_ - ranges_shift; }   ///< vertex v is in range v >> range_shift()
  std::uint32_t ranges() const { return tiles_ << ranges_shift; }  ///< above the numbers of ranges
  std::size_t batches() const { return batches_.size(); }          ///< which go one after the other
  std::span<const std::uint32_t> batch(std::size_t i) const {
    return batches_[i];
  }  ///< tiles whose visits do not wait for each other
  Visit visit(std::uint32_t tile) const;
  /// The vertices that are in no visit, by number.
  std::vector<VertexId> unplanned() const;

 private:
  using Pair = std::uint64_t;  ///< a tile, above; and a range of another one, which shares a cell with it

  // The triangulation is the same whatever these are: they are about time.
  static constexpr int ranges_shift = 2;
  static constexpr std::size_t points_of_visit = 48;   ///< some hundred microseconds
  static constexpr std::uint32_t slots_a_point = 128;  ///< to look at, for which a plan pays
  static constexpr std::uint32_t fewest_tiles = 32;    ///< fewer could not be side by side
  static constexpr std::uint32_t most_claimants = 64;  ///< of a range, but for its own tile
  static constexpr std::size_t most_batches = 128;
  static constexpr std::size_t fewest_visits = 3;  ///< of a batch

  void find_tiles(std::uint32_t vertices);
  std::vector<std::vector<Pair>> find_pairs(const Mesh<D>& mesh, const Bulk& bulk) const;
  void make_claims(std::vector<std::vector<Pair>> pairs, const Bulk& bulk);
  void drop_wide_ranges();
  void make_batches();

  std::span<const VertexId> waiting_;
  int tile_shift_ = 0;
  std::uint32_t tiles_ = 0;
  std::vector<std::uint32_t> first_waiting_;  ///< by tile
  std::vector<std::uint32_t> first_claimed_;  ///< by tile: where its claim begins
  std::vector<std::uint32_t> last_claimed_;   ///< and ends
  std::vector<std::uint32_t> claims_;
  std::vector<std::vector<std::uint32_t>> batches_;
  std::vector<std::uint32_t> unplanned_;  ///< tiles
};

extern template class TilePlan<2>;
extern template class TilePlan<3>;

}  // namespace pgdr::detail
