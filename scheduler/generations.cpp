// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Generations: what is visited, and what takes effect at the end.
#include "detail/generations.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "detail/mesh_whole.hpp"

namespace pgdr::detail {
namespace {

template <int D>
Orthtree<D> tree_over(std::span<const Point<D>> points) {
  Point<D> low = points[0], high = points[0];
  for (const Point<D>& p : points)
    for (int i = 0; i < D; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  return Orthtree<D>(low, high);
}

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

template <int D>
Generations<D>::Generations(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far)
    : context_(context),
      options_(context.options.schedule),
      tree_(tree_over<D>(context.domain.points())),
      works_(tree_),
      conflicts_(tree_, context.options.schedule.claim_order),
      vertices_(vertices_so_far) {
  workers_.push_back({std::make_unique<Refiner<D>>(context, std::move(pools))});
}

template <int D>
void Generations<D>::list_everything() {
  Worker worker = check_out();
  RegionVisit<D> listing;
  listing.list = &works_[Orthtree<D>::root].list;
  worker.refiner->begin(listing);
  const Mesh<D>& mesh = context_.mesh;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i})) worker.refiner->list_cell(CellId{i});
  check_in(std::move(worker));
}

/// A violation left standing may have moved off the walls, where insertions do not look for it. The slots of cells depend
/// on timing, so the faces are put in the order of their cells' vertices.
template <int D>
void Generations<D>::list_violations_everywhere() {
  Worker worker = check_out();
  WorkList<D> found;
  RegionVisit<D> listing;
  listing.list = &found;
  worker.refiner->begin(listing);
  const Mesh<D>& mesh = context_.mesh;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i})) worker.refiner->list_violations(CellId{i});
  check_in(std::move(worker));
  std::vector<Entry<D>> faces;
  found.drain([&](const Entry<D>& e) { faces.push_back(e); });
  std::sort(faces.begin(), faces.end(), [&mesh](const Entry<D>& a, const Entry<D>& b) {
    for (int i = 0; i <= D; ++i)
      if (a.vertices[i] != b.vertices[i]) return lex_less<D>(mesh.point(a.vertices[i]), mesh.point(b.vertices[i]));
    return a.which < b.which;
  });
  for (const Entry<D>& e : faces) {
    LeafWork<D>& work = works_[tree_.leaf_at(mesh.cell(e.cell).center)];
    if (!work.has_list()) work.since = generation_;
    work.list.push(e);
  }
}

/// All that was refused, once more.
template <int D>
bool Generations<D>::relist_refused() {
  const Mesh<D>& mesh = context_.mesh;
  for (Node n = 0; n <= tree_.node_count(); ++n) {
    auto& list = n == tree_.node_count() ? whole_list_ : works_[n].list;
    for (Refusal<D>& r : std::exchange(list.refused, {})) {
      if (!r.entry.alive(mesh)) continue;
      LeafWork<D>& work = works_[tree_.leaf_at(mesh.cell(r.entry.cell).center)];
      if (!work.has_list()) work.since = generation_;
      work.list.push(r.entry);
    }
  }
  return !requests().empty();
}

template <int D>
StopCause Generations<D>::run() {
  const auto start = Clock::now();
  list_everything();
  StopCause stop = StopCause::finished;
  while (true) {
    const std::uint64_t before = counts_.committed;
    stop = drain();
    if (stop != StopCause::finished || counts_.committed == before) break;
    if (violations_seen_) list_violations_everywhere();
    if (!relist_refused()) break;
  }
  statistics_.leaves = tree_.leaf_count();
  for (const auto& [thread, seconds] : busy_) statistics_.busy_seconds.push_back(seconds);
  double in_visits = 0;
  for (const double s : statistics_.busy_seconds) in_visits += s;
  statistics_.serial_seconds = seconds_between(start, Clock::now()) - statistics_.seconds_in_generations;
  statistics_.work_seconds = in_visits + statistics_.serial_seconds;
  statistics_.critical_path_seconds += statistics_.serial_seconds;
  if (stop == StopCause::finished && min_edge_hit_) return StopCause::min_edge;
  return stop;
}

template <int D>
StopCause Generations<D>::drain() {
  while (true) {
    if (context_.options.stop.stop_requested()) return StopCause::cancelled;
    if (vertices_ >= context_.options.max_vertices) return StopCause::max_vertices;
    if (!one_generation()) return StopCause::finished;
    if (const int stop = context_.stop; stop != 0) return static_cast<StopCause>(stop);
  }
}

template <int D>
std::vector<VisitRequest> Generations<D>::requests() {
  std::vector<VisitRequest> r;
  for (Node n = 0; n < tree_.node_count(); ++n) {
    if (!tree_.is_leaf(n)) continue;
    const LeafWork<D>& work = works_[n];
    if (work.has_list()) r.push_back({n, 1, work.since});
    for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
      if (!work.set_aside[level].empty()) r.push_back({n, set_aside_orders[level], work.set_aside_since[level]});
  }
  if (!whole_set_aside_.empty() || !whole_list_.empty())
    r.push_back({tree_.leaf_at(context_.domain.points()[0]), whole_tree, 0});
  return r;
}

template <int D>
bool Generations<D>::one_generation() {
  const std::vector<VisitRequest> wanted = requests();
  if (wanted.empty()) return false;
  ++generation_;
  ++statistics_.generations;
  statistics_.visits += wanted.size();
  Generation<D> generation = conflicts_.plan(wanted);
  std::vector<Planned> planned(wanted.size());
  // Of the vertices still allowed each visit gets its share, fixed now.
  const std::uint64_t left = context_.options.max_vertices - vertices_, n = planned.size();
  for (std::size_t v = 0; v < n; ++v) {
    planned[v].work.most_insertions = left / n + (v < left % n ? 1 : 0);
    prepare(generation.visits[v], planned[v]);
  }
  registry_.reset(tree_.node_count());  // grows geometrically; of use to debug builds alone
  const auto start = Clock::now();
  execute(generation.graph, [&](VisitGraph::Visit v) { visit(generation.visits[v], planned[v]); });
  statistics_.seconds_in_generations += seconds_between(start, Clock::now());
  finish(generation, planned);
  return true;
}

template <int D>
void Generations<D>::prepare(const Visit<D>& v, Planned& planned) {
  RegionVisit<D>& work = planned.work;
  const Node leaf = v.request.leaf;
  work.violations_seen = violations_seen_;
  work.floor = options_.floor;
  work.granularity = options_.granularity;
  work.treat_list = v.request.order == 1;
  if (v.request.order == whole_tree) {
    work.list = &whole_list_;
    work.given = std::exchange(whole_set_aside_, {});
    return;
  }
  work.list = &works_[leaf].list;
  if (v.request.order == 1) {
    if (tree_.can_split(leaf)) work.small_radius = options_.split_ratio * tree_.side(leaf) / 2;
    return;
  }
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
    if (set_aside_orders[level] == v.request.order) work.given = std::exchange(works_[leaf].set_aside[level], {});
}

/// For assertions: large meshes are not looked at, lest debug builds take for ever.
template <int D>
bool Generations<D>::looks_whole() const {
  return context_.mesh.cell_bound() > 200000 || is_whole<D>(context_.mesh);
}

template <int D>
void Generations<D>::finish(Generation<D>& generation, std::vector<Planned>& planned) {
  assert(looks_whole());
  const std::uint64_t before = counts_.committed;
  std::vector<double> seconds;
  std::vector<Node> candidates;
  for (std::size_t v = 0; v < planned.size(); ++v) {
    const VisitRequest& request = generation.visits[v].request;
    seconds.push_back(planned[v].seconds);
    deliver(request, planned[v]);
    if (request.order == 1) candidates.push_back(request.leaf);
  }
  statistics_.critical_path_seconds += critical_path(generation.graph, seconds);
  vertices_ += counts_.committed - before;
  split_leaves(std::move(candidates));
}

template <int D>
void Generations<D>::deliver(const VisitRequest& request, Planned& planned) {
  RegionVisit<D>& work = planned.work;
  counts_ += work.counts;
  violations_seen_ = violations_seen_ || work.violations_seen;
  min_edge_hit_ = min_edge_hit_ || work.min_edge_hit;
  statistics_.set_aside += work.set_aside.size();
  for (auto& box : work.outboxes) {
    LeafWork<D>& to = works_[box.leaf];
    if (!to.has_list()) to.since = generation_;
    to.inbox.push_back(std::move(box.entries));
  }
  set_aside(request, work.set_aside);
}

template <int D>
void Generations<D>::set_aside(const VisitRequest& request, std::vector<Entry<D>>& entries) {
  if (entries.empty()) return;
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level) {
    if (set_aside_orders[level] <= request.order || set_aside_orders[level] <= options_.claim_order) continue;
    auto& waiting = works_[request.leaf].set_aside[level];
    if (waiting.empty()) works_[request.leaf].set_aside_since[level] = generation_;
    waiting.insert(waiting.end(), entries.begin(), entries.end());
    return;
  }
  whole_set_aside_.insert(whole_set_aside_.end(), entries.begin(), entries.end());
}

template <int D>
bool Generations<D>::wants_split(Node leaf) {
  WorkList<D>& list = works_[leaf].list;
  return tree_.can_split(leaf) && list.poor() > 0 && list.poor() >= options_.floor &&
         context_.largest_radius(list.first_bucket()) <= options_.split_ratio * tree_.side(leaf) / 2;
}

/// Splits those that may, and their children as long as these may.
template <int D>
void Generations<D>::split_leaves(std::vector<Node> candidates) {
  while (!candidates.empty()) {
    std::vector<Node> parents;
    VisitGraph independent;
    for (const Node leaf : candidates)
      if (wants_split(leaf) && tree_.split(leaf) != Orthtree<D>::none) {
        parents.push_back(leaf);
        independent.add_visit();
      }
    works_.grow();
    execute(independent, [&](VisitGraph::Visit v) { works_.hand_down(context_.mesh, parents[v], generation_); });
    candidates.clear();
    for (const Node parent : parents)
      for (Node child = 0; child < Orthtree<D>::children; ++child) candidates.push_back(tree_.first_child(parent) + child);
  }
}

template <int D>
void Generations<D>::for_each_refused(const std::function<void(std::span<const Refusal<D>>)>& f) {
  for (Node n = 0; n < tree_.node_count(); ++n) f(works_[n].list.refused);
  f(whole_list_.refused);
}

template class Generations<2>;
template class Generations<3>;

}  // namespace pgdr::detail
