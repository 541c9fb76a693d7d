// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The workers of a run: as many as visits ran at one time. A visit leases one, and gives it back when it ends. Any thread.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <random>
#include <utility>
#include <vector>

#include "refine/refiner.hpp"

namespace pgdr::detail {

/// Part of a run: see above.
template <int D>
class WorkerPool {
 public:
  using Pools = typename Mesh<D>::Pools;
  using Worker = std::unique_ptr<Refiner<D>>;

  /// A worker of one's own, until the end of the scope.
  class Lease {
   public:
    Lease(WorkerPool& pool, Worker worker) : pool_(&pool), worker_(std::move(worker)) {}
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease() { pool_->give_back(std::move(worker_)); }
    Refiner<D>* operator->() const { return worker_.get(); }

   private:
    WorkerPool* pool_;
    Worker worker_;
  };

  /// `pools`: those that made the mesh so far; they go to the first worker. The context must outlive this.
  WorkerPool(RefineContext<D>& context, Pools pools);

  /// Refiner::forget_cells of all workers. @pre none is leased
  void forget_cells();
  Lease lease() { return {*this, take()}; }
  /// Runs the visit in `area` on a worker of its own, with the floating-point environment of a visit; false if the run is over.
  bool run(const VisitArea<D>& area, NodeVisit<D>& visit);

 private:
  Worker take();
  Worker make() const;
  void make_room();
  void shuffle();
  void give_back(Worker worker) noexcept;

  RefineContext<D>* context_;
  std::mutex mutex_;  ///< of the members below
  std::vector<Worker> idle_;
  std::size_t made_ = 0;
  std::mt19937_64 random_;  ///< of the executor that shuffles
};

extern template class WorkerPool<2>;
extern template class WorkerPool<3>;

}  // namespace pgdr::detail
