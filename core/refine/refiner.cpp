// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The order in which the lists of a visit are worked off, and its limits.
#include "refine/refiner.hpp"

#include <algorithm>
#include <limits>

#include "refine/numbers.hpp"

namespace pgdr {

template <int D>
Refiner<D>::Refiner(RefineContext<D>& context, Pools pools)
    : workspace_(context, std::move(pools)),
      lister_(workspace_),
      repair_(workspace_, lister_),
      inserter_(workspace_, lister_, repair_),
      entities_(workspace_, inserter_),
      elements_(workspace_, lister_, inserter_, repair_, entities_) {}

template <int D>
Refiner<D>::~Refiner() = default;

template <int D>
void Refiner<D>::begin(NodeVisit<D>& visit) {
  const RefineContext<D>& context = workspace_.context;
  workspace_.visit = &visit;
  workspace_.trace.clear();
  workspace_.cavity.set_area(visit.area);
  workspace_.pools.log = visit.log;
  lister_.begin_visit();
  repair_.begin_visit();
  entities_.begin_visit();
  elements_.begin_visit();
  if (stage_ != context.stage) {
    stage_ = context.stage;
    treatment_ = stage_ ? stage_->treatment(workspace_, lister_, repair_) : nullptr;
  }
  if (treatment_) treatment_->begin_visit();
  treated_ = checked_at_ = reported_ = evaluations_reported_ = 0;
}

template <int D>
void Refiner<D>::look_at_budget() {
  RefineContext<D>& context = workspace_.context;
  const RefineOptions<D>& options = workspace_.options;
  const auto& counts = workspace_.visit->counts;
  if (options.stop.stop_requested()) context.stop = static_cast<int>(StopCause::cancelled);
  if (treated_ < checked_at_) return;
  const std::uint64_t vertices = context.vertices.fetch_add(counts.committed - reported_) + counts.committed - reported_;
  reported_ = counts.committed;
  context.evaluated += counts.evaluated - evaluations_reported_;
  evaluations_reported_ = counts.evaluated;
  const auto now = std::chrono::steady_clock::now();
  // Callbacks may be slow: the clock is looked at about every other millisecond.
  stride_ = now - checked_time_ > std::chrono::milliseconds(2) ? std::max<std::uint64_t>(stride_ / 4, 1)
                                                               : std::min<std::uint64_t>(stride_ * 2, 256);
  checked_at_ = treated_ + stride_;
  checked_time_ = now;
  context.ended();
  context.tell(vertices, workspace_.visit->list->size());
}

template <int D>
bool Refiner<D>::may_go_on() {
  look_at_budget();
  const NodeVisit<D>& visit = *workspace_.visit;
  if (workspace_.context.stop.load(std::memory_order_relaxed) != 0) return false;
  return treatment_ || visit.counts.committed < visit.most_insertions;  // without points a treatment still has something to do
}

/// The cells that it took to decide about e, each once.
template <int D>
std::vector<CellName> Refiner<D>::distinct_trace(const Entry<D>& e) {
  std::vector<CellId>& trace = workspace_.trace;
  trace.push_back(e.cell);
  distinct_.reset(trace.size());
  std::erase_if(trace, [this](CellId c) { return !distinct_.insert(index(c)); });
  std::vector<CellName> names;
  names.reserve(trace.size());
  for (const CellId c : trace) names.push_back({c, workspace_.mesh.birth(c)});
  return names;
}

template <int D>
void Refiner<D>::record_refusal(const Entry<D>& e) {
  NodeVisit<D>& visit = *workspace_.visit;
  Refusal<D> refusal{e, workspace_.refused_by, visit.order, {}, 0, false, 0, 0};
  if (treatment_) {
    refusal.versions = treatment_->version(e.cell) ^ (undecided_ ? 1 : 0);  // another: it is not known that nothing helps
  } else {
    refusal.seen = distinct_trace(e);
    // Of a cell that it does not own the visit has not read the neighbours.
    const auto is_owned = [&](const CellName& c) { return !visit.area || visit.area->owns(workspace_.mesh, c.cell); };
    const auto others = std::stable_partition(refusal.seen.begin(), refusal.seen.end(), is_owned);
    if (!workspace_.trace_alone) refusal.owned = static_cast<std::size_t>(others - refusal.seen.begin());
    refusal.surroundings = surroundings_of<D>(workspace_.mesh, refusal.seen, refusal.owned).value_or(0);
  }
  visit.list->refused.push_back(std::move(refusal));
  visit.entities_refused = visit.entities_refused || e.kind() != EntryKind::cell;
}

/// Within the visit's share of the budget.
template <int D>
Outcome Refiner<D>::treat_in_stage(const Entry<D>& e) {
  NodeVisit<D>& visit = *workspace_.visit;
  Outcome outcome = Outcome::refused;
  const std::uint64_t paid = std::min(visit.counts.evaluated, numbers::evaluations_a_change * visit.counts.changes());
  undecided_ = visit.counts.evaluated >= most_evaluated_ || visit.counts.evaluated - paid >= visit.most_unpaid;
  if (!undecided_) {
    outcome = treatment_->treat(e);
  } else {
    ++visit.counts.out_of_budget;
  }
  visit.counts.refused += outcome == Outcome::refused ? 1 : 0;
  return outcome;
}

/// One entry. Whether one that the visit does not own is still alive depends on timing: of those set aside, what is dead by
/// the end of the generation is left out (defer), so that what remains does not.
template <int D>
void Refiner<D>::treat(const Entry<D>& e) {
  ++treated_;
  NodeVisit<D>& visit = *workspace_.visit;
  workspace_.mesh.make_room(workspace_.pools);
  std::array<VertexId, D + 1> vertices;
  if (!workspace_.mesh.read_vertices(e.cell, e.birth, vertices)) return;
  if (visit.area && !visit.area->owns(workspace_.mesh, vertices)) return visit.set_aside.push_back(e);
  workspace_.refused_by.reset();
  workspace_.trace.clear();
  workspace_.trace_alone = false;
  Outcome outcome = Outcome::committed;
  switch (e.kind()) {
    case EntryKind::edge:
      if (lister_.is_refused_by_ring(e.cell, e.which())) return;
      [[fallthrough]];
    case EntryKind::face: outcome = entities_.split(e, nullptr); break;
    case EntryKind::flip: return repair_.treat(e);
    case EntryKind::cell: outcome = treat_poor(e); break;
  }
  if (outcome == Outcome::refused && workspace_.alive(e)) record_refusal(e);
  if (outcome == Outcome::not_owned) visit.set_aside.push_back(e);
}

/// Is there a poor element so large that it goes before the entity that is next?
template <int D>
bool Refiner<D>::is_larger_than_entities() {
  WorkList<D>& list = *workspace_.visit->list;
  const int largest = list.entities.top().bucket - workspace_.context.buckets_before_entities;
  const auto any = [&] { return list.poor() > 0 && list.first_bucket() <= largest; };
  if (any()) return true;
  if (lister_.unasked().empty() || lister_.unasked().first_bucket() > largest) return false;
  lister_.ask_sizes();
  return any();
}

/// Treats entities and violations that wait: all, or until an element is next. False if the visit may not go on.
template <int D>
bool Refiner<D>::treat_entities(Until until) {
  WorkList<D>& list = *workspace_.visit->list;
  while (may_go_on()) {
    if (!list.entities.empty() && (until == Until::none_wait || !is_larger_than_entities())) {
      treat(list.entities.pop());
    } else if (!list.flips.empty()) {
      treat(list.flips.pop());
    } else {
      return true;
    }
  }
  return false;
}

/// True if a size that is still unknown can change the next entry or end the visit. Not as long as an element
/// that is too big waits in their buckets or a larger one, and it is certain, where it counts, whether the list is crowded.
template <int D>
bool Refiner<D>::sizes_decide() {
  const UnaskedCells<D>& unasked = lister_.unasked();
  if (unasked.empty()) return false;
  const NodeVisit<D>& visit = *workspace_.visit;
  WorkList<D>& list = *visit.list;
  const int next = list.first_bucket_of_too_big();
  if (unasked.first_bucket() < next) return true;
  if (visit.small_radius == 0 || list.is_crowded(visit.floor)) return false;
  const bool counts = list.first_bucket() < next || workspace_.context.largest_radius(next) <= visit.small_radius;
  return counts && list.may_be_crowded_with(unasked.size(), visit.floor);
}

/// Does a poor element wait? Asks for sizes where they decide what it is.
template <int D>
bool Refiner<D>::any_poor() {
  if (sizes_decide()) lister_.ask_sizes();
  return workspace_.visit->list->poor() > 0;
}

/// All elements of the list, with the entities before them, until the visit is to end.
template <int D>
void Refiner<D>::treat_elements() {
  NodeVisit<D>& visit = *workspace_.visit;
  const RefineContext<D>& context = workspace_.context;
  WorkList<D>& list = *visit.list;
  const bool is_short = visit.granularity < RefineContext<D>::buckets;
  int last_bucket = std::numeric_limits<int>::max();
  bool go_on = treat_entities(Until::element_is_next);
  if (is_short) lister_.ask_sizes();
  if (is_short && list.poor() > 0) last_bucket = list.first_bucket() + visit.granularity;
  while (go_on && any_poor()) {
    const int bucket = list.first_bucket();
    const bool crowded = list.is_crowded(visit.floor);
    if (bucket > last_bucket || (crowded && context.largest_radius(bucket) <= visit.small_radius)) {
      treat_entities(Until::none_wait);  // no visit leaves any
      break;
    }
    // The largest go first before smaller entities, where the node is to be split, or where the visit is to end by size.
    const bool by_size = !list.entities.empty() || (crowded && visit.small_radius > 0) || is_short;
    const Entry<D> e = by_size ? list.pop_largest(workspace_.mesh) : list.pop_poor(workspace_.mesh);
    if (workspace_.alive(e)) {
      treat(e);
    } else if (constexpr std::uint64_t between_looks = 256; ++treated_ % between_looks != 0 && list.entities.empty()) {
      continue;  // most are dead
    }
    go_on = treat_entities(Until::element_is_next);
  }
}

template <int D>
void Refiner<D>::run(NodeVisit<D>& visit) {
  begin(visit);
  RefineContext<D>& context = workspace_.context;
  WorkList<D>& list = *visit.list;
  repair_.allow_for(list.flips.size());
  for (const Entry<D>& e : visit.given) repair_.allow_for(e.kind() == EntryKind::flip ? 1 : 0);
  most_evaluated_ = std::min(visit.most_evaluated,
                             visit.most_evaluated_an_entry * std::max<std::uint64_t>(list.size() + visit.given.size(), 1));
  bool go_on = visit.treat_list || treat_entities(Until::none_wait);
  for (std::size_t i = 0; i < visit.given.size(); ++i) {
    if (go_on) {
      treat(visit.given[i]);
      go_on = treat_entities(Until::none_wait);
    } else {
      visit.set_aside.push_back(visit.given[i]);
    }
  }
  lister_.ask_sizes();
  if (visit.treat_list && go_on) treat_elements();
  context.vertices += visit.counts.committed - reported_ - visit.counts.removed;
  context.evaluated += visit.counts.evaluated - evaluations_reported_;
  lister_.fill_outboxes();
  workspace_.visit = nullptr;
}

template <int D>
void Refiner<D>::repair(NodeVisit<D>& visit) {
  begin(visit);
  auto& flips = visit.list->flips;
  repair_.allow_for(flips.size());
  while (!flips.empty() && !workspace_.context.ended())
    if (const Entry<D> e = flips.pop(); workspace_.alive(e)) repair_.treat(e);
  lister_.ask_sizes();
  workspace_.visit = nullptr;
}

template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr
