// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The lister of work: it puts encroached entities and poor elements at new cells, and violations, on the work list of the visit.
// Elements that belong to another node (VisitArea) go to the outbox for that at the end of the visit. Where sizes are asked by
// blocks, new cells wait until they are asked for (unasked_cells.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/slot_set.hpp"
#include "refine/unasked_cells.hpp"
#include "refine/workspace.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// Fills the work list of a visit. Part of a worker: one thread at a time.
template <int D>
class WorkLister {
 public:
  explicit WorkLister(Workspace<D>& workspace)
      : w_(&workspace),
        mesh_(&workspace.mesh),
        quick_bounds_(workspace.context.bounds),
        asks_blocks_(workspace.context.bounds.asks_blocks()) {}

  /// Must be called before the visit does anything.
  void begin_visit() {
    elsewhere_.clear();
    unasked_.clear();
    unasked_elsewhere_.clear();
  }
  /// Lists what is encroached or poor at a cell that the visit owns.
  void list_cell(CellId c);
  /// Lists the element, if it is poor.
  void list_if_poor(CellId c);
  /// Lists a poor element; `why` is Entry::which, `order` is Entry::order.
  void list_poor(CellId c, int why, const FilterSphere<D>& sphere, std::uint32_t order);
  /// Lists an element in a stage with a treatment; `order` is Entry::order, such as `order_by_level`.
  void list_element(CellId c, std::uint32_t order) {
    list(w_->entry(c, EntryKind::cell, Entry<D>::over_radius_edge, 0, order), w_->context.place_of(c));
  }
  /// Lists the element of the entry again.
  void relist_cell(const Entry<D>& e) { list_poor(e.cell, e.which(), mesh_->sphere(e.cell), e.order); }
  /// Lists what is encroached or poor at the cells that the last commit of the cavity has made.
  void list_inserted();
  /// 3D: is the subsegment, should it be encroached, not to be split as its ring is? Then nothing is to be done about it until
  /// there is another ring, which is listed anew.
  bool is_refused_by_ring(CellId c, int edge) const;
  /// Lists the violations at the cells. @returns how many there were
  std::uint64_t list_violations(std::span<const CellId> cells);
  /// Cells for the visit's list whose sizes are to be asked first.
  const UnaskedCells<D>& unasked() const { return unasked_; }
  /// Asks for these, in one block, and lists the poor ones. @throws UsageError bad_size; what the size function throws
  void ask_sizes();
  /// Asks for these, and for those that belong to other nodes and live, and fills the outboxes of the visit. Most entries do
  /// not live until its end, and the visit, which owns their cells, can tell.
  void fill_outboxes();

 private:
  using MadeCell = typename CellBounds<D>::MadeCell;

  void list(const Entry<D>& e, const Point<D>& place);
  void list_entities(CellId c, const ConstraintRecord<D>& k);
  void list_inserted_if_poor(std::size_t i);
  bool is_home(const Entry<D>& e, const Point<D>& place) const;
  void put_off(CellId c, const CellShape& shape, const FilterSphere<D>& sphere);
  void put_off(const typename UnaskedCells<D>::Cell& cell, bool home);
  void ask_elsewhere();
  std::optional<Entry<D>> if_poor(const typename UnaskedCells<D>::Cell& cell, double size) const;
  std::uint32_t order_of(double shortest_edge_squared, double squared_circumradius) const;

  Workspace<D>* w_;
  Mesh<D>* mesh_;
  const QuickBounds<D> quick_bounds_;
  const bool asks_blocks_;                         ///< are sizes asked by blocks?
  UnaskedCells<D> unasked_, unasked_elsewhere_;    ///< for the visit's list; for other leaves
  std::vector<Entry<D>> elsewhere_;                ///< elements that belong to other leaves
  std::vector<std::uint32_t> box_of_, box_sizes_;  ///< scratch of fill_outboxes: of each element; of each box
  std::vector<Entry<D>> violations_;               ///< at new cells, before they are listed
};

/// Adds the faces of the cell that are not locally Delaunay. Several threads at once.
template <int D>
void add_violations(const Mesh<D>& mesh, CellId c, std::vector<Entry<D>>& to);
/// The same where many cells are looked at: a face between two of them is decided from one, and added for both.
template <int D>
void add_violations(const Mesh<D>& mesh, CellId c, const SlotSet& looked_at, std::vector<Entry<D>>& to);

extern template class WorkLister<2>;
extern template class WorkLister<3>;

}  // namespace pgdr
