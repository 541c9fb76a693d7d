// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How a visit runs.
#include <algorithm>

#include "graph/float_environment.hpp"
#include "run/leaf_refinement.hpp"

namespace pgdr::detail {

template <int D>
auto LeafRefinement<D>::check_out() -> Worker {
  {
    const std::lock_guard lock(workers_mutex_);
    if (options_.executor == Executor::shuffled) shuffle_workers();
    if (!workers_.empty()) {
      Worker worker = std::move(workers_.back());
      workers_.pop_back();
      return worker;
    }
  }
  return std::make_unique<Refiner<D>>(context_, context_.mesh.make_pools());
}

/// So that any of as many as there are threads may be the last.
template <int D>
void LeafRefinement<D>::shuffle_workers() {
  if (static_cast<int>(workers_.size()) < options_.threads)
    workers_.push_back(std::make_unique<Refiner<D>>(context_, context_.mesh.make_pools()));
  if (!workers_.empty()) std::swap(workers_[random_() % workers_.size()], workers_.back());
}

template <int D>
void LeafRefinement<D>::check_in(Worker worker) {
  const std::lock_guard lock(workers_mutex_);
  workers_.push_back(std::move(worker));
}

template <int D>
bool LeafRefinement<D>::work_off(const VisitArea<D>& area, RegionVisit<D>& visit) {
  if (context_.stop.load(std::memory_order_relaxed) != 0) return false;
  const DefaultFloats floats;
  Worker worker = check_out();
  try {
    visit.area = &area;
    worker->run(visit);
    visit.area = nullptr;
  } catch (...) {
    check_in(std::move(worker));
    throw;
  }
  check_in(std::move(worker));
  return true;
}

template <int D>
double LeafRefinement<D>::record(const VisitRequest& request, const RegionVisit<D>& visit, const Watch& watch) {
  const auto end = Clock::now();
  const double seconds = std::chrono::duration<double>(end - watch.start).count();
  const std::lock_guard lock(workers_mutex_);
  ++statistics_.visits;
  if (!numbers_.at_home()) predicates_elsewhere_ += predicate_counts() - watch.predicates;
  const std::uint32_t thread = numbers_.of_this_one();
  if (thread == busy_.size()) busy_.push_back(0);
  busy_[thread] += seconds;
  if (!options_.trace) return seconds;
  auto since_start = [this](Clock::time_point t) { return std::chrono::duration<double>(t - context_.start).count(); };
  trace_.push_back({thread, since_start(watch.start), since_start(end), request.leaf, visit.level, request.order, generation_,
                    visit.counts.committed, visit.set_aside.size()});
  return seconds;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
