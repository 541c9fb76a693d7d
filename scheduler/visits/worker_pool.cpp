// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/worker_pool.hpp"

#include "graph/float_environment.hpp"

namespace pgdr::detail {

template <int D>
WorkerPool<D>::WorkerPool(RefineContext<D>& context, Pools pools)
    : context_(&context), random_(static_cast<std::uint64_t>(context.options.schedule.threads)) {
  make_room();
  idle_.push_back(std::make_unique<Refiner<D>>(context, std::move(pools)));
}

/// For one more worker, so that giving it back takes no memory.
template <int D>
void WorkerPool<D>::make_room() {
  idle_.reserve(++made_);
}

template <int D>
auto WorkerPool<D>::make() const -> Worker {
  return std::make_unique<Refiner<D>>(*context_, context_->mesh.make_pools());
}

template <int D>
auto WorkerPool<D>::take() -> Worker {
  {
    const std::lock_guard lock(mutex_);
    if (context_->options.schedule.executor == Executor::shuffled) shuffle();
    if (!idle_.empty()) {
      Worker worker = std::move(idle_.back());
      idle_.pop_back();
      return worker;
    }
    make_room();
  }
  return make();
}

/// Any of as many workers as there are threads may be the next, as if they ran at once.
template <int D>
void WorkerPool<D>::shuffle() {
  if (static_cast<int>(idle_.size()) < context_->options.schedule.threads) {
    make_room();
    idle_.push_back(make());
  }
  if (!idle_.empty()) std::swap(idle_[random_() % idle_.size()], idle_.back());
}

template <int D>
void WorkerPool<D>::give_back(Worker worker) noexcept {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

template <int D>
void WorkerPool<D>::forget_cells() {
  const std::lock_guard lock(mutex_);
  for (const Worker& worker : idle_) worker->forget_cells();
}

template <int D>
bool WorkerPool<D>::run(const VisitArea<D>& area, NodeVisit<D>& visit) {
  if (context_->stop.load(std::memory_order_relaxed) != 0) return false;
  const DefaultFloats floats;
  const Lease worker = lease();
  visit.area = &area;
  worker->run(visit);
  visit.area = nullptr;
  return true;
}

template class WorkerPool<2>;
template class WorkerPool<3>;

}  // namespace pgdr::detail
