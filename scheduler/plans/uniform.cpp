// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "plans/uniform.hpp"

#include <algorithm>
#include <utility>

#include "pgdr/refine.hpp"
#include "visits/numbers.hpp"

namespace pgdr::detail {
template <int D>
Uniform<D>::Uniform(RunState<D>& state, IsOwn is_own) : state_(&state), is_own_(std::move(is_own)) {
  add_level();
}

/// The nodes of the finest level.
template <int D>
void Uniform<D>::add_level() {
  Level level;
  const auto number = static_cast<int>(levels_.size());
  for (Node node = 0; node < tree().node_count(); ++node) {
    if (tree().level(node) != number) continue;
    unsigned parity = 0;
    for (std::size_t i = 0; i < D; ++i) parity |= (tree().place(node)[i] & 1u) << i;
    level.nodes[parity].push_back(node);
  }
  for (std::vector<Node>& nodes : level.nodes)
    std::sort(nodes.begin(), nodes.end(), [this](Node a, Node b) { return tree().morton(a) < tree().morton(b); });
  levels_.push_back(std::move(level));
}

/// Of nodes, from the root's on.
template <int D>
int Uniform<D>::most_levels() const {
  return state_->options.lattice > 0 ? state_->options.lattice : most_lattice<D>();
}

/// Elements of this circumradius or less are small enough for the parts of a window; 0: it will have none.
template <int D>
double Uniform<D>::small_radius() const {
  if (is_final_ || finest() + 1 >= most_levels()) return 0;
  return state_->waiting.placement().most_radius_of_side(tree().side(nodes(finest(), 0).front()) / 2);
}

/// A window is split once this many poor elements wait there, or three times as many will come: a visit takes some milliseconds
/// then, and mostly meets no cell that reaches beyond its claim.
template <int D>
std::size_t Uniform<D>::floor() const {
  if (state_->options.lattice > 0) return 0;
  return state_->options.floor != 0 ? state_->options.floor : numbers::crowded_window;
}

/// Does all that waits in the window wait for its being split?
template <int D>
bool Uniform<D>::is_left(Node node) const {
  LeafWork<D>& work = state_->waiting[node];
  WorkList<D>& list = work.list;
  if (!tree().is_leaf(node) || !work.inbox.empty() || list.poor() == 0 || list.poor() != list.size()) return false;
  return list.is_crowded(floor()) && state_->context.largest_radius(list.first_bucket()) <= small_radius();
}

template <int D>
bool Uniform<D>::is_any_left() const {
  for (unsigned parity = 0; parity < parities; ++parity)
    for (const Node node : nodes(finest(), parity))
      if (is_own_(node) && is_left(node)) return true;
  return false;
}

template <int D>
bool Uniform<D>::is_halved_with(std::uint64_t to_come) const {
  return finest() + 2 < most_levels() && to_come >= 3 * floor();
}

template <int D>
bool Uniform<D>::halve() {
  std::vector<Node> windows;
  for (unsigned parity = 0; parity < parities; ++parity)
    windows.insert(windows.end(), nodes(finest(), parity).begin(), nodes(finest(), parity).end());
  std::sort(windows.begin(), windows.end());
  if (state_->waiting.split(windows, state_->pieces)) {
    add_level();
    state_->refused.try_all_again();  // the mesh about it is about to change
    return true;
  }
  is_final_ = true;  // the doubles are too coarse
  return false;
}

template <int D>
std::optional<PlannedVisits<D>> Uniform<D>::next() {
  std::uint64_t first = first_phase_near_windows();
  while (first == no_phase && is_any_left()) {
    halve();
    first = first_phase_near_windows();
  }
  if (first == no_phase) first = first_phase();
  is_final_ = is_final_ || first == no_phase;
  if (first == no_phase) return std::nullopt;
  PlannedVisits<D> plan{visits_of(take_turn(first))};
  plan.hooks.before = [this](VisitGraph::Visit, NodeVisit<D>& visit) { limit(visit); };
  return plan;
}

template <int D>
bool Uniform<D>::has_work(Node node, std::uint32_t order) const {
  const LeafWork<D>& work = state_->waiting[node];
  if (order == 1) return work.has_list() && !is_left(node);
  return std::any_of(work.set_aside.begin(), work.set_aside.end(),
                     [order](const SetAside<D>& s) { return s.order == order && !s.entries.empty(); });
}

template <int D>
bool Uniform<D>::has_work(int level, unsigned parity, std::uint32_t order) const {
  return std::any_of(nodes(level, parity).begin(), nodes(level, parity).end(),
                     [&](Node node) { return is_own_(node) && has_work(node, order); });
}

// The number of a phase has the order of its requests, its level, and by how many turns its parity is ahead.
namespace {
constexpr std::array<std::uint32_t, 3> orders_in_turn{1, 2, whole_tree};
constexpr std::uint64_t levels_in_turn = 64;
}  // namespace

/// Of the levels [from, to].
template <int D>
std::uint64_t Uniform<D>::first_in_turn(std::size_t order, int from, int to) const {
  for (int level = std::max(from, 0); level <= to; ++level)
    for (unsigned ahead = 0; ahead < parities; ++ahead)
      if (has_work(level, (levels_[static_cast<std::size_t>(level)].turn + ahead) % parities, orders_in_turn[order]))
        return (order * levels_in_turn + static_cast<std::uint64_t>(level)) * parities + ahead;
  return no_phase;
}

template <int D>
std::uint64_t Uniform<D>::first_phase_near_windows() const {
  const std::uint64_t first = first_in_turn(0, finest() - 1, finest());
  return first != no_phase ? first : first_in_turn(1, finest() - 1, finest());
}

template <int D>
std::uint64_t Uniform<D>::first_phase() const {
  for (std::size_t order = 0; order < orders_in_turn.size(); ++order)
    if (const std::uint64_t first = first_in_turn(order, 0, finest()); first != no_phase) return first;
  return no_phase;
}

template <int D>
Phase Uniform<D>::phase_of(std::uint64_t number) const {
  Phase phase;
  phase.level = static_cast<int>(number / parities % levels_in_turn);
  phase.order = orders_in_turn[number / parities / levels_in_turn];
  phase.parity = (levels_[static_cast<std::size_t>(phase.level)].turn + static_cast<unsigned>(number % parities)) % parities;
  return phase;
}

template <int D>
Phase Uniform<D>::take_turn(std::uint64_t number) {
  const Phase phase = phase_of(number);
  Level& level = levels_[static_cast<std::size_t>(phase.level)];
  level.turn = (phase.parity + 1) % parities;
  level.turns += number % parities + 1;
  if (phase.level == finest() && !state_->context.stage) state_->recorder.count_cycles((level.turns + parities - 1) / parities);
  return phase;
}

template <int D>
Visit<D> Uniform<D>::visit_of(Node node, std::uint32_t order) const {
  Visit<D> visit{.request = {node, order, 0}};
  visit.box = GridBox<D>::grown(tree(), order == whole_tree ? Orthtree<D>::root : node, tree().extent(node) / 2);
  return visit;
}

template <int D>
Generation<D> Uniform<D>::visits_of(const Phase& phase) const {
  Generation<D> generation;
  for (const Node node : nodes(phase.level, phase.parity)) {
    if (!is_own_(node) || !has_work(node, phase.order)) continue;
    generation.visits.push_back(visit_of(node, phase.order));
    generation.graph.add_visit({});
  }
  return generation;
}

template <int D>
void Uniform<D>::limit(NodeVisit<D>& visit) const {
  visit.floor = floor();
  visit.small_radius = visit.treat_list && static_cast<int>(visit.level) == finest() ? small_radius() : 0;
}

template class Uniform<2>;
template class Uniform<3>;

}  // namespace pgdr::detail
