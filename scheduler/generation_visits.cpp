// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Generations: how a visit runs.
#include <algorithm>
#include <limits>

#include "detail/arena.hpp"
#include "detail/float_environment.hpp"
#include "detail/generations.hpp"

namespace pgdr::detail {
namespace {

/// The claim of a visit as the refiner asks for it.
template <int D>
class ClaimedArea final : public VisitArea<D> {
 public:
  ClaimedArea(const Orthtree<D>& tree, const Claim<D>& claim) : tree_(&tree), claim_(&claim) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    this->inner_low = claim.inner().low;
    this->inner_high = claim.inner().high;
    const auto box = tree.box(claim.leaf());
    for (int i = 0; i < D; ++i) {
      const std::uint64_t low = tree.position(claim.leaf(), i), end = tree.extent(Orthtree<D>::root);
      this->home_low[i] = low == 0 ? -infinity : box.low[i];
      this->home_high[i] = low + tree.extent(claim.leaf()) == end ? infinity : box.high[i];
      // A visit of the whole tree has no leaf of its own.
      if (claim.whole()) this->home_low[i] = infinity;
    }
  }
  bool claimed(const Point<D>& p) const override { return claim_->contains(p); }
  std::uint32_t leaf_of(const Point<D>& p) const override { return tree_->leaf_at(p); }

 private:
  const Orthtree<D>* tree_;
  const Claim<D>* claim_;
};

}  // namespace

template <int D>
auto Generations<D>::check_out() -> Worker {
  {
    const std::lock_guard lock(workers_mutex_);
    if (!workers_.empty()) {
      Worker worker = std::move(workers_.back());
      workers_.pop_back();
      return worker;
    }
  }
  return {std::make_unique<Refiner<D>>(context_, context_.mesh.make_pools())};
}

template <int D>
void Generations<D>::check_in(Worker worker) {
  const std::lock_guard lock(workers_mutex_);
  workers_.push_back(std::move(worker));
}

template <int D>
void Generations<D>::visit(const Visit<D>& v, Planned& planned) {
  if (context_.stop.load(std::memory_order_relaxed) != 0) return;
  const DefaultFloats floats;
  const HeldClaim<D> held(registry_, v.claim);
  const auto start = Clock::now();
  Worker worker = check_out();
  try {
    const ClaimedArea<D> area(tree_, v.claim);
    planned.work.area = &area;
    if (v.request.order == 1) works_[v.request.leaf].open_inbox();
    worker.refiner->run(planned.work);
    planned.work.area = nullptr;
  } catch (...) {
    check_in(std::move(worker));
    throw;
  }
  check_in(std::move(worker));
  const auto end = Clock::now();
  planned.seconds = std::chrono::duration<double>(end - start).count();
  record(v, planned, start, end);
}

template <int D>
void Generations<D>::record(const Visit<D>& v, const Planned& planned, Clock::time_point start, Clock::time_point end) {
  const std::lock_guard lock(workers_mutex_);
  const auto self = std::this_thread::get_id();
  auto thread = std::find_if(busy_.begin(), busy_.end(), [self](const auto& t) { return t.first == self; });
  if (thread == busy_.end()) thread = busy_.insert(thread, {self, 0.0});
  thread->second += planned.seconds;
  if (!options_.trace) return;
  auto since_start = [this](Clock::time_point t) { return std::chrono::duration<double>(t - context_.start).count(); };
  trace_.push_back({static_cast<std::uint32_t>(thread - busy_.begin()), since_start(start), since_start(end),
                    v.request.leaf, static_cast<std::uint32_t>(tree_.level(v.request.leaf)), v.request.order, generation_,
                    planned.work.counts.committed, planned.work.set_aside.size()});
}

template <int D>
void Generations<D>::execute(const VisitGraph& graph, const VisitBody& body) {
  if (graph.visits() == 0) return;
  VisitRun run;
  if (graph.visits() == 1 || options_.executor == Executor::serial) {
    run = run_serial(graph, body);
  } else if (options_.executor == Executor::threads) {
    run = run_threads(graph, body, static_cast<unsigned>(std::max(options_.threads, 1)));
  } else {
    in_arena(options_.threads, [&] { run = run_flow_graph(graph, body); });
  }
  if (!run.complete()) context_.stop = static_cast<int>(StopCause::cancelled);
  statistics_.max_concurrent = std::max(statistics_.max_concurrent, run.max_concurrent);
}

template class Generations<2>;
template class Generations<3>;

}  // namespace pgdr::detail
