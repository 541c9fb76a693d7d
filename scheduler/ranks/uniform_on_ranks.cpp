// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/uniform_on_ranks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "ranks/alike.hpp"
#include "ranks/sent_entry.hpp"

namespace pgdr::detail {
namespace {

/// Adds the seconds of a scope.
class Timed {
 public:
  explicit Timed(double& seconds) : seconds_(&seconds) {}
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  ~Timed() { *seconds_ += VisitRecorder::seconds_since(start_); }

 private:
  double* seconds_;
  VisitRecorder::Clock::time_point start_ = VisitRecorder::Clock::now();
};

template <int D>
std::uint64_t count_cells(const Mesh<D>& mesh) {
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) count += mesh.alive(CellId{i}) ? 1 : 0;
  return count;
}

/// Of the points of all cells, whatever slots they are in, and of the sizes that are asked for there. @throws what the caller's
/// function throws
template <int D>
std::uint64_t hash_of_cells(const RefineContext<D>& context) {
  const Mesh<D>& mesh = context.mesh;
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh.alive(c)) continue;
    WordHash hash;
    for (const auto& point : points_of(mesh, c))
      for (const double x : point) hash.add(std::bit_cast<std::uint64_t>(x));
    hash.add(std::bit_cast<std::uint64_t>(context.bounds.size_at(mesh.simplex(c), mesh.region(c))));
    sum += hash.value();
  }
  return sum;
}

}  // namespace

template <int D>
UniformOnRanks<D>::UniformOnRanks(RunState<D>& state, Collectives& ranks, bool needs_all, Part<D>& part,
                                  DistributedStatistics& statistics)
    : state_(&state),
      uniform_(state, [this](Node node) { return is_own(node); }),
      ranks_(&ranks),
      needs_all_(needs_all),
      statistics_(&statistics),
      part_(&part),
      territory_(part.territory),
      held_(part.held) {}

template <int D>
void UniformOnRanks<D>::begin() {
  if (territory_) look_ahead(state_->totals, nullptr);
}

template <int D>
StopCause UniformOnRanks<D>::stop() {
  if (stop_ != StopCause::finished || territory_) return stop_;  // while ranks do parts they stop together
  return uniform_.stop();
}

/// Before the cut in the order of one process, and so where rank 0 has all in the end.
template <int D>
std::optional<PlannedVisits<D>> UniformOnRanks<D>::next() {
  if (!territory_ && ranks_->size() > 1 && !statistics_->gathered) meet_before_halving();
  if (stop_ != StopCause::finished) return std::nullopt;
  if (territory_) return next_together();
  std::optional<PlannedVisits<D>> plan = uniform_.next();
  phases_ += plan ? 1 : 0;
  return plan;
}

/// For the others it goes on, or has ended elsewhere.
template <int D>
void UniformOnRanks<D>::leave(Left why) {
  part_->left = why;
  stop_ = StopCause::cancelled;
}

/// Until nothing waits that ranks do side by side, or one of them has to stop; then the end.
template <int D>
std::optional<PlannedVisits<D>> UniformOnRanks<D>::next_together() {
  while (outlook_.stop == StopCause::finished && outlook_.first == no_phase && outlook_.is_any_left) {
    halve_parts();
    look_ahead(state_->totals, nullptr);
  }
  if (outlook_.stop == StopCause::finished && outlook_.first != no_phase) return plan_together();
  if (outlook_.stop == StopCause::finished && !is_alone_at_the_end()) {
    share_unsent();
    return std::nullopt;
  }
  gather();
  if (ranks_->rank() != 0) {
    leave(Left::gathered);
  } else {
    stop_ = outlook_.stop;
  }
  return next();
}

/// What all ranks have done since their totals were these, and what they do next. If there is an error on any, all throw.
template <int D>
void UniformOnRanks<D>::look_ahead(const RunTotals& before, std::exception_ptr error) {
  RunTotals& totals = state_->totals;
  Outlook own;
  if (!error) {
    error = Collectives::caught([&] {
      own.stop = state_->stop_between_visits();
      own.first = uniform_.first_phase_near_windows();
      if (own.first != no_phase) own.visits = uniform_.visits_of(uniform_.phase_of(own.first)).visits.size();
      own.is_any_left = uniform_.is_any_left();
      own.totals = totals - before;
    });
  }
  outlook_ = Outlook::of_all(ranks_->all_gather(own.to_row(), error), ranks_->rank(), before);
  totals = outlook_.totals;
  if (state_->is_full()) outlook_.stop = std::max(outlook_.stop, StopCause::max_vertices);
}

/// If the lattice is to be halved next: cuts the mesh then if it pays. This is where ranks meet for the first time: one that has
/// failed, or whose run has ended, says so there.
template <int D>
void UniformOnRanks<D>::meet_before_halving() {
  while (uniform_.first_phase_near_windows() == no_phase && uniform_.is_any_left()) {
    const Windows left = windows();
    auto territory = std::make_unique<Territory<D>>(tree(), left.nodes, owners_of(left), ranks_->size(), ranks_->rank());
    const bool pays = may_cut() && pays_to_cut(left, *territory);
    if (!do_all_go_on(*ranks_)) return leave(Left::interrupted);
    const bool is_due = ranks_->max(pays ? 0 : 1) == 0;
    if (!ranks_->together([this] { return uniform_.halve(); })) return;
    if (!is_due) continue;
    cut(std::move(territory), left);
    return look_ahead(state_->totals, nullptr);
  }
}

/// Lists of the nodes above are empty, but for what was found for them last.
template <int D>
bool UniformOnRanks<D>::may_cut() const {
  for (Node node = 0; node < tree().node_count(); ++node)
    if (tree().level(node) < uniform_.finest() && !state_->waiting[node].list.empty()) return false;
  return true;
}

/// The nodes of the finest level, in Morton order, with the elements that are to come there.
template <int D>
auto UniformOnRanks<D>::windows() const -> Windows {
  Windows windows;
  for (unsigned parity = 0; parity < Uniform<D>::parities; ++parity)
    windows.nodes.insert(windows.nodes.end(), uniform_.nodes(uniform_.finest(), parity).begin(),
                         uniform_.nodes(uniform_.finest(), parity).end());
  std::sort(windows.nodes.begin(), windows.nodes.end(), [this](Node a, Node b) { return tree().morton(a) < tree().morton(b); });
  for (const Node node : windows.nodes) {
    const WorkList<D>& list = state_->waiting[node].list;
    windows.to_come.push_back(static_cast<double>(list.to_come() + list.poor()));
  }
  return windows;
}

/// Successive nodes for each rank, so that the elements to come are shared out evenly.
template <int D>
std::vector<int> UniformOnRanks<D>::owners_of(const Windows& windows) const {
  double all = 0, before = 0;
  for (const double w : windows.to_come) all += w + 1;
  std::vector<int> owners;
  for (const double w : windows.to_come) {
    const double middle = (before + (w + 1) / 2) / all * ranks_->size();
    owners.push_back(std::min(static_cast<int>(middle), ranks_->size() - 1));
    before += w + 1;
  }
  return owners;
}

/// Until the next level is due there will be 2^D times as many cells. To cut the mesh now saves that all ranks make these alike;
/// it costs that they put in what they hold beside their own, and that they share all that is to come by coarser nodes: what the
/// rank with the most gets more than an even share. If no level will be due it is now or never.
template <int D>
bool UniformOnRanks<D>::pays_to_cut(const Windows& windows, const Territory<D>& territory) const {
  bool is_last = true;
  double all = 0;
  std::vector<double> own(static_cast<std::size_t>(ranks_->size()));
  for (std::size_t n = 0; n < windows.nodes.size(); ++n) {
    const double w = windows.to_come[n];
    is_last = is_last && !uniform_.is_halved_with(static_cast<std::uint64_t>(w) / Uniform<D>::parities);
    all += w;
    own[static_cast<std::size_t>(territory.owner(windows.nodes[n]))] += w;
  }
  const std::vector<double> held = territory.held_of(windows.nodes, windows.to_come);
  const double most = *std::max_element(held.begin(), held.end()), most_own = *std::max_element(own.begin(), own.end());
  if (is_last) return most < all;
  const auto cells = static_cast<double>(count_cells(state_->context.mesh));
  const double uneven = most_own - all / ranks_->size(), beside = Uniform<D>::parities * cells * (most - most_own) / all;
  return uneven + beside < (Uniform<D>::parities - 1) * cells;
}

/// @pre the windows have been split
template <int D>
void UniformOnRanks<D>::cut(std::unique_ptr<Territory<D>> territory, const Windows& windows) {
  const RefineContext<D>& context = state_->context;
  require_alike(*ranks_, ranks_->together([&] {
    WordHash hash;
    hash.add(hash_of_cells(context));
    for (const double w : windows.to_come) hash.add(std::bit_cast<std::uint64_t>(w));
    return hash.value();
  }));
  territory_ = std::move(territory);
  statistics_->cut_cells = count_cells(context.mesh);
  ranks_->together([&] {
    keep_late_work();
    held_ = std::make_unique<HeldMesh<D>>(state_->context.mesh, *territory_);
  });
  statistics_->cut_generation = phases_;
  part_->until_cut = state_->recorder.statistics();
  statistics_->seconds_prologue = state_->pieces.clock().now();
}

/// After the cut. The windows and the nodes right above them are what ranks visit from now on: so they hold less.
template <int D>
void UniformOnRanks<D>::halve_parts() {
  if (!ranks_->together([&] { return uniform_.halve(); })) return;
  std::unique_ptr<Territory<D>> next;
  std::vector<Bytes> to_each = ranks_->together([&] {
    next = std::make_unique<Territory<D>>(territory_->of_next_level());
    for (Node node = 0; node < tree().node_count(); ++node)
      if (tree().level(node) == territory_->level() && is_own(node)) keep_work(node, [](const Entry<D>&) { return true; });
    return late_for_owners();
  });
  const std::vector<Bytes> arrived = ranks_->exchange(std::move(to_each));
  ranks_->together([&] {
    for (const Bytes& bytes : arrived) {
      MessageReader message(bytes);
      late_.get(message, tree(), state_->context.mesh, *held_);
      message.require_end();
    }
    held_->shrink(*next);
    territory_ = std::move(next);
  });
}

/// Late work goes to who owns its cells, and so will hold them to the end.
template <int D>
std::vector<Bytes> UniformOnRanks<D>::late_for_owners() {
  std::vector<Bytes> to_each;
  for (int rank = 0; rank < ranks_->size(); ++rank) {
    MessageWriter message;
    late_.take_if([&](const Entry<D>& e) { return rank != ranks_->rank() && owner_of(e) == rank; })
        .put(message, state_->context.mesh);
    to_each.push_back(message.take());
  }
  return to_each;
}

/// Of the nodes above the cut; and empties the lists of nodes that others visit.
template <int D>
void UniformOnRanks<D>::keep_late_work() {
  for (Node node = 0; node < tree().node_count(); ++node) {
    if (tree().level(node) < territory_->level())
      keep_work(node, [this](const Entry<D>& e) { return ranks_->rank() == owner_of(e); });
    else if (!is_own(node))
      state_->waiting[node] = LeafWork<D>();
  }
}

/// Takes what waits at the node and what was refused there off its lists, and keeps what is(entry) of it.
template <int D>
template <class Is>
void UniformOnRanks<D>::keep_work(Node node, Is is) {
  using Kind = typename LateWork<D>::Kind;
  LeafWork<D>& work = state_->waiting[node];
  std::uint64_t number = 0;
  const auto keep = [&](Kind kind, std::uint32_t order, const Entry<D>& e) {
    if (is(e)) late_.add_entry({phases_, 0, number}, kind, node, order, e);
    ++number;
  };
  for (const SetAside<D>& s : work.set_aside)
    for (const Entry<D>& e : s.entries) keep(Kind::set_aside, s.order, e);
  for (const auto& batch : work.inbox)
    for (const Entry<D>& e : batch) keep(Kind::found, 1, e);
  for (const Refusal<D>& r : work.list.refused) {
    if (is(r.entry)) late_.add({{phases_, 0, number}, Kind::refused, node, 1, r});
    ++number;
  }
  work = LeafWork<D>();
}

/// The first rank keeps the place of what is dead.
template <int D>
int UniformOnRanks<D>::owner_of(const Entry<D>& e) const {
  const Mesh<D>& mesh = state_->context.mesh;
  return e.alive(mesh) && mesh.alive(e.cell) ? territory_->owner(territory_->zone(mesh.point(first_vertex(mesh, e.cell)))) : 0;
}

/// Each visit packs what others have to know of it, on its thread.
template <int D>
PlannedVisits<D> UniformOnRanks<D>::plan_together() {
  ++phases_;
  before_ = state_->totals;
  const Phase phase = uniform_.take_turn(outlook_.first);
  PlannedVisits<D> plan;
  error_ = Collectives::caught([&] {
    Generation<D> generation = uniform_.visits_of(phase);
    changes_ = std::vector<VisitChanges<D>>(generation.visits.size());
    for (std::size_t v = 0; v < changes_.size(); ++v) changes_[v].log.logs_cells(territory_->is_shared(generation.visits[v].box));
    plan.generation = std::move(generation);
  });
  // Ranks own successive nodes of the Morton curve, which orders the visits.
  plan.numbers = {outlook_.visits_before, outlook_.visits};
  plan.hooks.before = [this](VisitGraph::Visit v, NodeVisit<D>& visit) {
    uniform_.limit(visit);
    visit.log = &changes_[v].log;
  };
  plan.hooks.after = [this](VisitGraph::Visit v, NodeVisit<D>& visit) {
    changes_[v].pack(state_->context.mesh, *held_);
    visit.log = nullptr;
  };
  return plan;
}

/// The ranks do not wait for each other but for the messages of their neighbours and, in the end, for how all go on. Who fails
/// says nothing to its neighbours, and what happened to all.
template <int D>
void UniformOnRanks<D>::done(VisitRunner<D>& runner, const PlannedVisits<D>& plan, std::vector<EndedVisit<D>> ended,
                             const std::exception_ptr& error) {
  if (!territory_) return Planner<D>::done(runner, plan, std::move(ended), error);
  look_ahead(before_, tell_neighbours(plan.generation, ended, error_ ? error_ : error));
}

/// @returns what went wrong here
template <int D>
std::exception_ptr UniformOnRanks<D>::tell_neighbours(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended,
                                                      std::exception_ptr error) {
  RankOutbox<D> letters(tree(), *territory_, state_->context.mesh);
  std::vector<Bytes> messages(territory_->neighbours().size());
  if (!error)
    error = Collectives::caught([&] {
      for (std::size_t v = 0; v < ended.size(); ++v)
        letters.take(generation.visits[v].request.node, phases_, ended[v].work, late_);
      messages = messages_for_neighbours(letters);
    });
  if (error) messages.assign(messages.size(), Bytes());
  const std::vector<Bytes> arrived = ranks_->exchange_with(territory_->neighbours(), std::move(messages));
  const bool have_all = std::none_of(arrived.begin(), arrived.end(), [](const Bytes& bytes) { return bytes.empty(); });
  if (error || !have_all) return error;
  return Collectives::caught([&] {
    put_in(arrived, letters);
    take_in(generation, ended);
    letters.post(state_->waiting);
  });
}

/// For each neighbour what has changed where it holds the mesh, and what was found for its nodes.
template <int D>
std::vector<Bytes> UniformOnRanks<D>::messages_for_neighbours(const RankOutbox<D>& letters) const {
  const Timed timed(statistics_->seconds_pack);
  std::vector<Bytes> messages;
  for (std::size_t n = 0; n < territory_->neighbours().size(); ++n) {
    const auto has_part = [n](const VisitChanges<D>& c) { return !c.is_empty_for(n); };
    MessageWriter message;
    message.put(static_cast<std::uint64_t>(std::count_if(changes_.begin(), changes_.end(), has_part)));
    for (const VisitChanges<D>& c : changes_)
      if (has_part(c)) c.parts[n].put(message);
    letters.put(message, n);
    messages.push_back(message.take());
  }
  return messages;
}

/// Puts in what the neighbours have changed and found.
template <int D>
void UniformOnRanks<D>::put_in(const std::vector<Bytes>& arrived, RankOutbox<D>& letters) {
  const Timed timed(statistics_->seconds_apply);
  unsent_.add(state_->context.mesh, changes_);
  for (const VisitChanges<D>& c : changes_) held_->note_gone(c.net);
  for (const VisitChanges<D>& c : changes_) held_->note_made(c.net);
  std::vector<VisitChanges<D>>().swap(changes_);
  for (const Bytes& bytes : arrived) {
    MessageReader message(bytes);
    for (auto parts = message.get<std::uint64_t>(); parts > 0; --parts) held_->apply(SentCells<D>::get(message));
    letters.get(message, *held_);
    message.require_end();
  }
}

/// Takes in what the visits did, and puts what they set aside into lists, in their order.
template <int D>
void UniformOnRanks<D>::take_in(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended) {
  RunState<D>& state = *state_;
  for (std::size_t v = 0; v < ended.size(); ++v) {
    const VisitRequest& request = generation.visits[v].request;
    NodeVisit<D>& work = ended[v].work;
    if (tree().level(request.node) == territory_->level()) {  // the node above is nobody's
      const Node above = tree().parent(request.node);
      const std::uint32_t order = above == Orthtree<D>::root ? whole_tree : 2;
      std::uint64_t number = 0;
      for (const Entry<D>& e : work.set_aside)
        if (e.alive(state.context.mesh))
          late_.add_entry({phases_, tree().morton(request.node), number++}, LateWork<D>::Kind::set_aside, above, order, e);
      state.recorder.count_set_aside(number);
      work.set_aside.clear();
    }
    state.account(request, work);
  }
}

template <int D>
void UniformOnRanks<D>::share_unsent() {
  const std::vector<Bytes> all = ranks_->all_gather(ranks_->together([&] {
    MessageWriter own;
    unsent_.put(own);
    return own.take();
  }));
  ranks_->together([&] {
    for (const Bytes& bytes : all) {
      MessageReader message(bytes);
      LateConstraints<D>::apply(message, *held_);
    }
  });
}

/// Is anything left that one rank does alone?
template <int D>
bool UniformOnRanks<D>::is_alone_at_the_end() {
  RunState<D>& state = *state_;
  bool has_refused = false;
  state.refused.for_each_list([&](std::span<const Refusal<D>> list) { has_refused = has_refused || !list.empty(); });
  const bool has_work = uniform_.first_phase() != no_phase;
  const bool needs_one = needs_all_ || has_work || !late_.empty() || has_refused || state.totals.violations_seen ||
                         state.totals.entities_refused;
  return ranks_->max(needs_one ? 1 : 0) != 0;
}

/// Rank 0 gets all cells that it does not hold, each from its owner, and all work that is left. The others leave.
template <int D>
void UniformOnRanks<D>::gather() {
  statistics_->gathered = true;
  part_->until_gather = state_->recorder.statistics();
  const Bytes own = ranks_->together([&] { return pack_all(); });
  const std::vector<Bytes> all = ranks_->gather(0, own);
  ranks_->together([&] {
    if (ranks_->rank() == 0) take_all(all);
  });
  if (ranks_->rank() == 0) statistics_->cells_applied += held_->cells_applied();
  held_.reset();
  territory_.reset();
}

/// What rank 0 has to get from this one.
template <int D>
Bytes UniformOnRanks<D>::pack_all() {
  for (Node node = 0; node < tree().node_count(); ++node)
    if (ranks_->rank() != 0 && tree().level(node) >= territory_->level() && is_own(node))
      keep_work(node, [](const Entry<D>&) { return true; });
  MessageWriter message;
  if (ranks_->rank() != 0) held_->own_beyond(0).put(message);
  unsent_.put(message);
  late_.put(message, state_->context.mesh);
  return message.take();
}

/// Makes the mesh of this rank the whole one, from what all ranks sent.
template <int D>
void UniformOnRanks<D>::take_all(const std::vector<Bytes>& all) {
  std::vector<MessageReader> messages;
  for (const Bytes& bytes : all) messages.emplace_back(bytes);
  for (std::size_t r = 1; r < messages.size(); ++r) held_->add(SentCells<D>::get(messages[r]));
  held_->find_all();
  // Before the links: of a face that has come to lie on the hull, a rank far away may think that a cell is beyond.
  for (MessageReader& message : messages) LateConstraints<D>::apply(message, *held_);
  held_->complete();
  for (MessageReader& message : messages) {
    late_.get(message, tree(), state_->context.mesh, *held_);
    message.require_end();
  }
  late_.deliver(state_->waiting);
}

template class UniformOnRanks<2>;
template class UniformOnRanks<3>;

}  // namespace pgdr::detail
