// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points of a Delaunay triangulation inserted side by side, by visits as a TilePlan has them. What a visit cannot insert within
// its claim is left. The triangulation, its slots and the order of its vertices are functions of the points: a visit reads and
// writes what no other one of its batch writes (mesh/vertex_claim.hpp), and takes slots from a pool of its own, which is filled
// before the batch begins.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "cavity/cavity.hpp"
#include "cavity/tile_plan.hpp"
#include "mesh/mesh.hpp"
#include "space/pieces.hpp"

namespace pgdr::detail {

/// Numbers of vertices, from the first one up to, but without, the last.
struct VertexRange {
  std::uint32_t first, last;
  bool has(std::uint32_t v) const { return first <= v && v < last; }
};

/// See above. One thread calls it.
template <int D>
class BulkInsertion {
 public:
  using Pools = typename Mesh<D>::Pools;

  /// `cell_at`: of each vertex a cell that has it, or no_cell; kept up to date. `range`: of the vertices of the triangulation
  /// that is added to, which need not be the only one in the mesh. All must outlive it.
  BulkInsertion(Mesh<D>& mesh, std::vector<CellId>& cell_at, VertexRange range, const Pieces& pieces, std::stop_token stop)
      : mesh_(&mesh), cell_at_(&cell_at), range_(range), pieces_(&pieces), stop_(std::move(stop)) {}

  /// Inserts vertices that are in no cell, given by number. Returns those that it did not, by number: all, where few could be
  /// inserted at one time.
  std::vector<VertexId> insert(std::span<const VertexId> waiting);
  /// Gives slots that were not used to `pools`.
  void give_slots_to(Pools& pools);

 private:
  /// The visits of batches that have the same place in these: their slots.
  struct Lane {
    Pools pools;
    std::uint32_t visit = 0;
    std::span<const VertexId> waiting;
    CellId hint = no_cell;      ///< a cell that the visit owns, or none: where it was last
    std::vector<CellId> hints;  ///< for every few points that wait, a cell near the first of them, or none
    std::vector<VertexId> left;
    std::vector<std::pair<VertexId, CellId>> outside;  ///< news of cell_at for vertices that are not claimed
  };
  /// A cavity, leased for a visit.
  using Worker = std::unique_ptr<Cavity<D>>;

  static constexpr std::size_t points_a_hint = 4;

  void begin_batch(const TilePlan<D>& plan, std::span<const std::uint32_t> tiles);
  void end_batch(std::size_t visits, std::vector<VertexId>& left);
  VertexClaim<D> claim_of(const Lane& lane) const { return {visit_of_.data(), range_shift_, lane.visit}; }
  void find_hints(Lane& lane, std::span<const std::uint32_t> ranges);
  CellId find_seed(const Lane& lane, const VertexClaim<D>& claim, std::size_t i) const;
  void open_slots();
  void visit(Lane& lane);
  bool insert(Lane& lane, Cavity<D>& cavity, const VertexClaim<D>& claim, std::size_t i);
  void note_cells(Lane& lane, const VertexClaim<D>& claim, const std::vector<CellId>& cells);
  Worker take_worker();
  void give_worker(Worker worker);

  Mesh<D>* mesh_;
  std::vector<CellId>* cell_at_;
  VertexRange range_;
  const Pieces* pieces_;
  std::stop_token stop_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<std::uint32_t> visit_of_;  ///< by range; nobody writes it while visits run
  int range_shift_ = 0;
  std::uint32_t visits_ = 0;  ///< so far
  std::mutex mutex_;          ///< of the workers
  std::vector<Worker> idle_;
};

extern template class BulkInsertion<2>;
extern template class BulkInsertion<3>;

}  // namespace pgdr::detail
