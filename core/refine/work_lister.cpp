// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/work_lister.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "mesh/locally_delaunay.hpp"
#include "refine/encroachment.hpp"
#include "refine/subsegment_ring.hpp"

namespace pgdr {

template <int D>
void WorkLister<D>::list_poor(CellId c, int why, const FilterSphere<D>& sphere, std::uint32_t order) {
  list(w_->entry(c, EntryKind::cell, why, w_->context.bucket_of(sphere), order), sphere.center);
}

template <int D>
bool WorkLister<D>::is_home(const Entry<D>& e, const Point<D>& place) const {
  const NodeVisit<D>& visit = *w_->visit;
  assert(!visit.area || visit.area->owns(*mesh_, e.cell));
  return !visit.area || visit.area->is_home(place, w_->context.radius_of(e));
}

template <int D>
void WorkLister<D>::list(const Entry<D>& e, const Point<D>& place) {
  const bool home = is_home(e, place);
  if (home ? unasked_.has(e.bucket) : !unasked_elsewhere_.empty()) return put_off({e, true, {}, 0}, home);
  if (home) return w_->visit->list->push_poor(e);
  elsewhere_.push_back(e);
}

/// The cell may be poor; what it is depends on a size that is not asked yet.
template <int D>
void WorkLister<D>::put_off(CellId c, const CellShape& shape, const FilterSphere<D>& sphere) {
  const Entry<D> e = w_->entry(c, EntryKind::cell, Entry<D>::over_size, w_->context.bucket_of(sphere));
  put_off({e, false, {mesh_->cell(c).vertices, mesh_->region(c), shape}, sphere.radius2}, is_home(e, sphere.center));
}

template <int D>
void WorkLister<D>::put_off(const typename UnaskedCells<D>::Cell& cell, bool home) {
  UnaskedCells<D>& to = home ? unasked_ : unasked_elsewhere_;
  to.push(cell);
  if (to.size() < UnaskedCells<D>::most) return;
  home ? ask_sizes() : ask_elsewhere();
}

/// The entry of a cell that waited for its size; nothing if it is not poor.
template <int D>
std::optional<Entry<D>> WorkLister<D>::if_poor(const typename UnaskedCells<D>::Cell& cell, double size) const {
  if (cell.is_known) return cell.entry;
  const Entry<D>& e = cell.entry;
  const auto entry = [&e](int why, std::uint32_t order) {
    return Entry<D>(e.cell, e.birth, EntryKind::cell, why, e.bucket, order);
  };
  const std::uint32_t over_size = w_->context.bounds.over_size(*mesh_, cell.made, size);
  if (over_size > 0) return entry(Entry<D>::over_size, over_size);
  if (!w_->context.bounds.over_radius_edge(*mesh_, cell.made)) return {};
  return entry(Entry<D>::over_radius_edge, order_of(cell.made.shape.shortest_edge_squared, cell.squared_circumradius));
}

template <int D>
void WorkLister<D>::ask_sizes() {
  unasked_.ask(*mesh_, w_->context.bounds, [this](const auto& cell, double size) {
    if (const auto e = if_poor(cell, size)) w_->visit->list->push_poor(*e);
  });
}

template <int D>
void WorkLister<D>::ask_elsewhere() {
  unasked_elsewhere_.drop_dead(*mesh_);
  unasked_elsewhere_.ask(*mesh_, w_->context.bounds, [this](const auto& cell, double size) {
    if (const auto e = if_poor(cell, size)) elsewhere_.push_back(*e);
  });
}

/// The shortest edge, shortest first, then the circumradius: smallest first, but largest first below the smallest proved
/// bound, where it makes the smaller meshes (docs/selectors.md). Of both squares the exponent and four bits of the mantissa.
template <int D>
std::uint32_t WorkLister<D>::order_of(double shortest_edge_squared, double squared_circumradius) const {
  auto leading = [](double v) { return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(v) >> 48); };
  const std::uint32_t edge = leading(shortest_edge_squared), radius = leading(squared_circumradius);
  const bool proved = w_->options.radius_edge_bound >= smallest_proved_bound<D>();
  return edge << 16 | (proved ? radius : 0xffffu - radius);
}

template <int D>
void WorkLister<D>::list_entities(CellId c, const ConstraintRecord<D>& k) {
  const KeptEntities<D>& kept = w_->context.kept;
  const bool any_kept = kept.any();
  const auto& vertices = mesh_->cell(c).vertices;
  for (int f = 0; f <= D; ++f)
    if (k.has_face(f) && !(any_kept && kept.has(mesh_->entity_of_face(c, f))) &&
        is_face_encroached_by<D>(*mesh_, w_->domain, c, f, vertices[f], w_->options))
      w_->visit->list->push(w_->entry(c, EntryKind::face, f, w_->context.bucket_of(squared_radius_of_face<D>(*mesh_, c, f))));
  if constexpr (D == 3)
    for (int e = 0; e < 6; ++e)
      if (k.has_edge(e) && !(any_kept && kept.has({EntityKind::segment, k.edge_entity[e]})) &&
          is_edge_encroached(*mesh_, w_->domain, c, e) && !is_refused_by_ring(c, e))
        w_->visit->list->push(w_->entry(c, EntryKind::edge, e, w_->context.bucket_of(squared_radius_of_edge(*mesh_, c, e))));
}

template <int D>
bool WorkLister<D>::is_refused_by_ring(CellId c, int edge) const {
  bool refused = false;
  if constexpr (D == 3) {
    const SubsegmentRing ring(*w_, c, edge);
    refused = ring.owned() && ring.refuses();
    w_->visit->entities_refused = w_->visit->entities_refused || refused;
  }
  return refused;
}

template <int D>
void WorkLister<D>::list_cell(CellId c) {
  if (const auto* k = mesh_->constraints(c)) list_entities(c, *k);
  list_if_poor(c);
}

template <int D>
void WorkLister<D>::list_if_poor(CellId c) {
  const CellShape shape = shape_of<D>(*mesh_, c);
  const FilterSphere<D> sphere = mesh_->sphere(c);
  if (asks_blocks_) return put_off(c, shape, sphere);
  const CellVerdict verdict = w_->context.bounds.test(*mesh_, c, shape);
  if (!verdict) return;
  if (verdict.over_size > 0) return list_poor(c, Entry<D>::over_size, sphere, verdict.over_size);
  list_poor(c, Entry<D>::over_radius_edge, sphere, order_of(shape.shortest_edge_squared, sphere.radius2));
}

/// list_if_poor() of the i-th cell that the last insertion has made, whose shape is known.
template <int D>
void WorkLister<D>::list_inserted_if_poor(std::size_t i) {
  using Answer = typename QuickBounds<D>::Answer;
  const Cavity<D>& cavity = w_->cavity;
  const FilterSphere<D> sphere = cavity.sphere_of_new(i);
  const CellShape shape = cavity.shape_of_new(i, sphere);
  if (asks_blocks_) return put_off(cavity.new_cells()[i], shape, sphere);
  const Answer answer = quick_bounds_.look(shape);
  if (answer == Answer::within) return;
  const CellId c = cavity.new_cells()[i];
  const bool too_big = answer == Answer::over_size;
  const std::uint32_t over_size = too_big ? quick_bounds_.over_size(shape) : w_->context.bounds.over_size(*mesh_, c, shape);
  if (over_size > 0) {
    list_poor(c, Entry<D>::over_size, sphere, over_size);
  } else if (w_->context.bounds.over_radius_edge(*mesh_, c, shape)) {
    list_poor(c, Entry<D>::over_radius_edge, sphere, order_of(shape.shortest_edge_squared, sphere.radius2));
  }
}

template <int D>
void WorkLister<D>::list_inserted() {
  const std::vector<CellId>& made = w_->cavity.new_cells();
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (const auto* k = mesh_->constraints(made[i])) list_entities(made[i], *k);
    list_inserted_if_poor(i);
  }
}

template <int D>
std::uint64_t WorkLister<D>::list_violations(std::span<const CellId> cells) {
  violations_.clear();
  for (const CellId c : cells) add_violations(*mesh_, c, violations_);
  for (const Entry<D>& e : violations_) w_->visit->list->flips.push(e);
  return violations_.size();
}

template <int D>
void WorkLister<D>::fill_outboxes() {
  ask_sizes();
  ask_elsewhere();
  auto& boxes = w_->visit->outboxes;
  assert(boxes.empty());
  std::erase_if(elsewhere_, [this](const Entry<D>& e) { return !w_->alive(e); });
  box_of_.clear();
  box_sizes_.clear();
  for (const Entry<D>& e : elsewhere_) {
    const std::uint32_t node = w_->visit->area->node_of(w_->context.place_of(e.cell), w_->context.radius_of(e));
    std::size_t box = boxes.size();
    while (box > 0 && boxes[box - 1].node != node) --box;
    if (box == 0) {
      boxes.push_back({node, {}});
      box_sizes_.push_back(0);
      box = boxes.size();
    }
    box_of_.push_back(static_cast<std::uint32_t>(box - 1));
    ++box_sizes_[box - 1];
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].entries.reserve(box_sizes_[i]);
  for (std::size_t i = 0; i < elsewhere_.size(); ++i) boxes[box_of_[i]].entries.push_back(elsewhere_[i]);
  elsewhere_.clear();
}

template <int D>
void add_violations(const Mesh<D>& mesh, CellId c, std::vector<Entry<D>>& to) {
  for (int f = 0; f <= D; ++f)
    if (violates(mesh, c, f)) to.push_back({c, mesh.birth(c), EntryKind::flip, f});
}

template <int D>
void add_violations(const Mesh<D>& mesh, CellId c, const SlotSet& looked_at, std::vector<Entry<D>>& to) {
  for (int f = 0; f <= D; ++f) {
    const Link beyond = mesh.cell(c).links[f];
    const bool both = beyond && looked_at[index(beyond.cell())];
    if ((both && beyond.cell() < c) || !violates(mesh, c, f)) continue;
    to.push_back({c, mesh.birth(c), EntryKind::flip, f});
    if (both) to.push_back({beyond.cell(), mesh.birth(beyond.cell()), EntryKind::flip, beyond.face()});
  }
}

template void add_violations(const Mesh<2>&, CellId, std::vector<Entry<2>>&);
template void add_violations(const Mesh<3>&, CellId, std::vector<Entry<3>>&);
template void add_violations(const Mesh<2>&, CellId, const SlotSet&, std::vector<Entry<2>>&);
template void add_violations(const Mesh<3>&, CellId, const SlotSet&, std::vector<Entry<3>>&);
template class WorkLister<2>;
template class WorkLister<3>;

}  // namespace pgdr
