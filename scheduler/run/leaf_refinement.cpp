// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The passes over the whole mesh, and what waits where.
#include "run/leaf_refinement.hpp"

#include <algorithm>
#include <utility>

#include "input/bent_facets.hpp"
#include "mesh/surroundings.hpp"
#include "space/box.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

static_assert(VisitTrace::whole_tree == whole_tree);
namespace {

template <int D>
Orthtree<D> tree_over(std::span<const Point<D>> points) {
  const Box<D> box = Box<D>::of(points);
  return Orthtree<D>(box.low, box.high);
}

/// Subfacets that are Delaunay in the projection of an uneven facet may have violations beside them though no cavity was cut
/// back.
template <int D>
bool has_uneven_facets(const Domain<D>& domain) {
  if constexpr (D == 3)
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      if (is_uneven(domain, f)) return true;
  return false;
}

}  // namespace

template <int D>
LeafRefinement<D>::LeafRefinement(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far)
    : context_(context),
      options_(context.options.schedule),
      tree_(tree_over<D>(context.domain.points())),
      works_(tree_),
      vertices_(vertices_so_far),
      uneven_(has_uneven_facets(context.domain)),
      random_(static_cast<std::uint64_t>(options_.threads)),
      numbers_(options_.executor) {
  workers_.push_back(std::make_unique<Refiner<D>>(context, std::move(pools)));
}

template <int D>
void LeafRefinement<D>::list_everything() {
  Worker worker = check_out();
  RegionVisit<D> listing;
  listing.list = &works_[Orthtree<D>::root].list;
  worker->begin(listing);
  const Mesh<D>& mesh = context_.mesh;
  for (std::uint32_t i = 0; i < mesh.cell_bound() && !cancelled(i); ++i)
    if (mesh.alive(CellId{i})) worker->list_cell(CellId{i});
  check_in(std::move(worker));
  all_listed_ = context_.stop == 0;
}

/// All of these parts count as serial, but on the critical path the longest alone.
template <int D>
void LeafRefinement<D>::each_cell_part(const std::function<void(const CellPart&)>& f) {
  const PartSeconds seconds = each_part(context_.mesh.cell_bound(), options_, f);
  statistics_.critical_path_seconds += seconds.longest - seconds.all;
}

/// The slots with another cell than at the last call, or with none now, or with a cell beside such: of a given cell, born
/// before or since, dead or alive, that says the same whatever slot it was given.
template <int D>
SlotSet LeafRefinement<D>::changed_surroundings() {
  const Mesh<D>& mesh = context_.mesh;
  const bool is_first = births_looked_at_.empty();
  if (is_first) births_looked_at_ = vector_of_capacity<std::uint16_t>(mesh.cell_bound());
  births_looked_at_.resize(mesh.cell_bound(), Mesh<D>::last_birth);
  SlotSet changed(mesh.cell_bound());
  std::vector<std::vector<CellId>> beside(count_parts(mesh.cell_bound()));
  each_cell_part([&](const CellPart& part) {
    for (std::uint32_t i = part.first; i < part.last; ++i) {
      const CellId c{i};
      const bool alive = mesh.alive(c);
      const std::uint16_t born = alive ? mesh.birth(c) : Mesh<D>::last_birth;
      if (std::exchange(births_looked_at_[i], born) == born && alive) continue;
      changed.add(i);
      if (!alive || is_first) continue;
      for (const Link next : mesh.cell(c).links)
        if (next) beside[part.number].push_back(next.cell());
    }
  });
  for (const auto& part : beside)
    for (const CellId c : part) changed.add(index(c));
  return changed;
}

/// A violation left standing may have moved off the walls, where insertions do not look for it. Returned: those with other
/// surroundings than at the last look.
template <int D>
std::vector<Entry<D>> LeafRefinement<D>::look_for_violations() {
  const Mesh<D>& mesh = context_.mesh;
  // Nothing but what is new since then, or beside such, can have a violation that was not found.
  const SlotSet changed = changed_surroundings();
  std::erase_if(violations_, [&](const Entry<D>& e) {
    if (!e.alive(mesh) || mesh.constrained(e.cell, e.which())) return true;  // constrained: a flat cell beside it was taken off
    return changed[index(e.cell)];
  });
  std::vector<std::vector<Entry<D>>> parts(count_parts(mesh.cell_bound()));
  each_cell_part([&](const CellPart& part) {
    for (std::uint32_t i = part.first; i < part.last && !context_.options.stop.stop_requested(); ++i)
      if (changed[i] && mesh.alive(CellId{i})) add_violations(mesh, CellId{i}, changed, parts[part.number]);
  });
  cancelled(0);
  std::vector<Entry<D>> found;
  for (const auto& part : parts) found.insert(found.end(), part.begin(), part.end());
  sort_by_vertices(found);
  violations_.insert(violations_.end(), found.begin(), found.end());
  return found;
}

/// Of a run that has seen any, or should look for them, those with other surroundings than at the last look. Beside entities
/// that were refused a constrained Delaunay triangulation need not exist, so that whole cavities may bring violations, too.
template <int D>
std::vector<Entry<D>> LeafRefinement<D>::new_violations() {
  if (!violations_seen_ && !uneven_ && !entities_refused_) return {};
  std::vector<Entry<D>> found = look_for_violations();
  violations_seen_ = violations_seen_ || !found.empty();
  return found;
}

/// In an order that does not depend on timing, as the slots of cells do.
template <int D>
void LeafRefinement<D>::sort_by_vertices(std::vector<Entry<D>>& entries) const {
  const Mesh<D>& mesh = context_.mesh;
  std::sort(entries.begin(), entries.end(), [&mesh](const Entry<D>& a, const Entry<D>& b) {
    const int order = compare_vertices<D>(mesh, a.cell, b.cell);
    return order != 0 ? order < 0 : a.which() < b.which();
  });
}

template <int D>
void LeafRefinement<D>::relist(const Entry<D>& e) {
  LeafWork<D>& work = works_[tree_.leaf_at(context_.mesh.center(e.cell))];
  if (!work.has_list()) work.since = generation_;
  work.list.push(e);
}

/// Has anything changed that the visit could see? `work`: of the leaf that was visited; null: the whole tree.
template <int D>
bool LeafRefinement<D>::may_have_changed(const LeafWork<D>* work, const Refusal<D>& refusal) const {
  if (whole_changed_ >= refusal.generation) return true;
  if (!work || refusal.order == whole_tree) return last_change_ >= refusal.generation;
  const auto zone = work->zones.find(refusal.order);
  return zone == work->zones.end() || std::any_of(zone->second.begin(), zone->second.end(), [&](Node n) {
           return works_[n].changed >= refusal.generation;
         });
}

/// What was refused, is still there and may be decided otherwise now; taken off the lists.
template <int D>
std::vector<Refusal<D>> LeafRefinement<D>::take_refused() {
  bool any = false;
  for_each_refused([&any](std::span<const Refusal<D>> refused) { any = any || !refused.empty(); });
  if (!any) return {};
  works_.pass_up_changes();
  const auto has_changed = [this](const Refusal<D>& r) {
    if (context_.stage && context_.stage->version(r.entry.cell) != r.versions) return true;
    return r.seen.empty() || surroundings_of<D>(context_.mesh, r.seen) != r.surroundings;
  };
  std::vector<Refusal<D>> refused, kept;
  for (Node n = 0; n <= tree_.node_count(); ++n) {
    const LeafWork<D>* work = n == tree_.node_count() ? nullptr : &works_[n];
    auto& list = work ? works_[n].list.refused : whole_list_.refused;
    for (Refusal<D>& r : list) {
      if (!r.entry.alive(context_.mesh)) continue;
      const bool again = may_have_changed(work, r) && has_changed(r);
      (again ? refused : kept).push_back(std::move(r));
    }
    list = std::exchange(kept, {});
  }
  return refused;
}

/// What was refused, once more where the mesh has changed since, with the claim that it took to refuse it.
template <int D>
bool LeafRefinement<D>::relist_refused() {
  for (const Refusal<D>& r : take_refused()) {
    const Node leaf = tree_.leaf_at(context_.mesh.center(r.entry.cell));
    if (r.order == 1) {
      relist(r.entry);
    } else {
      set_aside(leaf, r.order, r.entry);
    }
  }
  return !requests().empty();
}

template <int D>
void LeafRefinement<D>::mark_changed(const RegionVisit<D>& visit, std::span<const Node> claim) {
  if (!visit.changed_mesh) return;
  for (const Node leaf : claim) works_[leaf].changed = generation_;
}

/// Treats all that waits, and what was refused as often as its surroundings change.
template <int D>
StopCause LeafRefinement<D>::refine_to_the_end() {
  while (true) {
    const std::uint64_t before = counts_.committed;
    const StopCause stop = drain();
    if (stop != StopCause::finished || counts_.committed == before) return stop;
    for (const Entry<D>& e : new_violations()) relist(e);
    if (!relist_refused()) return stop;
  }
}

/// What is poor beside small angles once more, for a part of the room that it asked for. In that order the meshes are smaller
/// than where all ask for little. False if there is nothing poor, or where nothing proves that most is good by now.
template <int D>
bool LeafRefinement<D>::begin_last_resort() {
  if (D == 2 || context_.options.radius_edge_bound < smallest_proved_bound<D>()) return false;
  context_.last_resort = true;
  std::vector<Refusal<D>> kept;
  for (Node n = 0; n <= tree_.node_count(); ++n) {
    auto& list = n < tree_.node_count() ? works_[n].list.refused : whole_list_.refused;
    for (Refusal<D>& r : std::exchange(list, {})) {
      if (!r.entry.alive(context_.mesh)) continue;
      if (r.entry.kind() == EntryKind::cell)
        relist(r.entry);
      else
        kept.push_back(std::move(r));
    }
    list = std::exchange(kept, {});
  }
  return !requests().empty();
}

/// Of what was done since run() began.
template <int D>
void LeafRefinement<D>::total_statistics() {
  statistics_.leaves = tree_.leaf_count();
  statistics_.busy_seconds = busy_;
  double in_visits = 0;
  for (const double s : statistics_.busy_seconds) in_visits += s;
  statistics_.critical_path_seconds -= statistics_.serial_seconds;
  statistics_.serial_seconds = seconds_since(start_) - statistics_.seconds_in_generations;
  statistics_.work_seconds = in_visits + statistics_.serial_seconds;
  statistics_.critical_path_seconds += statistics_.serial_seconds;
}

template <int D>
StopCause LeafRefinement<D>::run() {
  start_ = Clock::now();
  list_everything();
  StopCause stop = refine_to_the_end();
  if (stop == StopCause::finished && begin_last_resort()) stop = refine_to_the_end();
  if (stop == StopCause::finished) new_violations();  // that the last pass left, so that they are seen
  if (stop == StopCause::finished) stop = static_cast<StopCause>(context_.stop.load());
  total_statistics();
  if (stop == StopCause::finished && min_edge_hit_) return StopCause::min_edge;
  return stop;
}

template <int D>
void LeafRefinement<D>::append_requests(Node leaf, std::vector<VisitRequest>& out) const {
  const LeafWork<D>& work = works_[leaf];
  if (work.has_list()) out.push_back({leaf, 1, work.since});
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
    if (!work.set_aside[level].empty()) out.push_back({leaf, set_aside_orders[level], work.set_aside_since[level]});
}

template <int D>
std::vector<VisitRequest> LeafRefinement<D>::requests() const {
  std::vector<VisitRequest> all;
  for (Node n = 0; n < tree_.node_count(); ++n)
    if (tree_.is_leaf(n)) append_requests(n, all);
  if (whole_tree_waits()) all.push_back({whole_tree_leaf(), whole_tree, 0});
  return all;
}

template <int D>
void LeafRefinement<D>::prepare(const VisitRequest& request, RegionVisit<D>& visit) {
  visit.violations_seen = violations_seen_;
  visit.entities_refused = entities_refused_;
  visit.floor = floor();
  visit.granularity = options_.granularity;
  visit.treat_list = request.order == 1;
  visit.order = request.order;
  visit.generation = generation_;
  visit.level = static_cast<std::uint32_t>(tree_.level(request.leaf));
  if (request.order == whole_tree) {
    visit.list = &whole_list_;
    visit.given = std::exchange(whole_set_aside_, {});
    return;
  }
  visit.list = &works_[request.leaf].list;
  if (request.order == 1 && tree_.can_split(request.leaf)) visit.small_radius = small_radius(request.leaf);
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
    if (set_aside_orders[level] == request.order) visit.given = std::exchange(works_[request.leaf].set_aside[level], {});
}

template <int D>
void LeafRefinement<D>::account(const VisitRequest& request, RegionVisit<D>& visit, std::span<const Node> claim) {
  if (visit.changed_mesh) (claim.empty() ? whole_changed_ : last_change_) = generation_;
  if (!claim.empty() && visit.counts.refused > 0)
    works_[request.leaf].zones.try_emplace(request.order, claim.begin(), claim.end());
  counts_ += visit.counts;
  vertices_ += visit.counts.committed;
  violations_seen_ = violations_seen_ || visit.violations_seen;
  entities_refused_ = entities_refused_ || visit.entities_refused;
  min_edge_hit_ = min_edge_hit_ || visit.min_edge_hit;
  defer(request, visit.set_aside);
  if (context_.stop != 0) given_and_not_processed_.insert(given_and_not_processed_.end(), visit.given.begin(), visit.given.end());
}

template <int D>
void LeafRefinement<D>::post(Node leaf, std::vector<Entry<D>>&& entries) {
  LeafWork<D>& to = works_[leaf];
  if (!to.has_list()) to.since = generation_;
  to.inbox.push_back(std::move(entries));
}

/// For a larger claim, what is still alive now that the visits that ran beside this one have ended.
template <int D>
void LeafRefinement<D>::defer(const VisitRequest& request, const std::vector<Entry<D>>& entries) {
  std::uint32_t order = whole_tree;
  for (const std::uint32_t larger : set_aside_orders)
    if (larger > request.order && larger > options_.claim_order) order = std::min(order, larger);
  for (const Entry<D>& e : entries) {
    if (!e.alive(context_.mesh)) continue;
    ++statistics_.set_aside;
    set_aside(request.leaf, order, e);
  }
}

/// For a visit of the leaf, or of the whole tree, with the claim of that order.
template <int D>
void LeafRefinement<D>::set_aside(Node leaf, std::uint32_t order, const Entry<D>& e) {
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level) {
    if (set_aside_orders[level] != order) continue;
    auto& waiting = works_[leaf].set_aside[level];
    if (waiting.empty()) works_[leaf].set_aside_since[level] = generation_;
    return waiting.push_back(e);
  }
  whole_set_aside_.push_back(e);
}

template <int D>
bool LeafRefinement<D>::wants_split(Node leaf) {
  WorkList<D>& list = works_[leaf].list;
  return tree_.can_split(leaf) && list.poor() > 0 && list.is_crowded(floor()) &&
         context_.largest_radius(list.first_bucket()) <= small_radius(leaf);
}

template <int D>
void LeafRefinement<D>::for_each_refused(const std::function<void(std::span<const Refusal<D>>)>& f) {
  for (Node n = 0; n < tree_.node_count(); ++n) f(works_[n].list.refused);
  f(whole_list_.refused);
}

template <int D>
std::optional<PoorCount> LeafRefinement<D>::take_poor() {
  if (!all_listed_) return std::nullopt;
  PoorCount poor;
  std::vector<bool> counted(context_.mesh.cell_bound());
  // A poor cell that is listed for a face that is not locally Delaunay was listed, or refused, as poor as well.
  const auto count = [&](const Entry<D>& e) {
    if (e.kind() != EntryKind::cell || e.which() == Entry<D>::not_delaunay) return;
    if (!e.alive(context_.mesh)) return;
    poor.over_size = poor.over_size || e.which() == Entry<D>::over_size;
    poor.cells += counted[index(e.cell)] ? 0 : 1;
    counted[index(e.cell)] = true;
  };
  const auto count_all = [&](const auto& entries) { std::for_each(entries.begin(), entries.end(), count); };
  for (Node n = 0; n < tree_.node_count(); ++n) {
    works_[n].list.drain(count);
    for (const auto& batch : works_[n].inbox) count_all(batch);
    for (const auto& entries : works_[n].set_aside) count_all(entries);
  }
  whole_list_.drain(count);
  count_all(whole_set_aside_);
  count_all(given_and_not_processed_);
  for_each_refused([&](std::span<const Refusal<D>> refused) {
    for (const Refusal<D>& r : refused) count(r.entry);
  });
  return poor;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
