// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule on several ranks, with the mesh that it makes on one. At first all ranks do the same, so that nothing need
// be sent. When the lattice is halved and it pays, the mesh is cut: each rank keeps what it holds (territory.hpp), and visits its
// own nodes alone. After each phase ranks send their neighbours what their visits have changed there, one message each, with the
// elements that were found for the nodes of these; and all tell all how far they are, by which each knows what comes next
// (outlook.hpp).
//
// That is the same run. The visits of a phase read and write nothing in common, so that each finds on its rank what it would find
// in one process; what they found and set aside is put into lists in the order of the visits. What would need a larger claim than
// the nodes of the cut have is kept for the end. When the lattice is halved again claims reach less far, and ranks hold less;
// what was kept goes to who owns its cells, and so holds them on. When nothing else waits, and some of this is left, or something
// was refused or is to be optimised, rank 0 gets all of the mesh and goes on alone, as one process would; for the others the run
// is cancelled then.
//
// A rank holds what it has to: the sides of nodes are four times the circumradii of the elements that wait there (split_ratio
// 0.5), so that their vertices are in the claims of these, and a refusal rests on cells that its visit owned, and on their
// neighbours.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "pgdr/ranks.hpp"
#include "plans/uniform.hpp"
#include "ranks/cell_message.hpp"
#include "ranks/held_mesh.hpp"
#include "ranks/late_work.hpp"
#include "ranks/outlook.hpp"
#include "ranks/rank_outbox.hpp"
#include "ranks/territory.hpp"
#include "ranks/visit_changes.hpp"
#include "transport/collectives.hpp"

namespace pgdr::detail {

/// Why a rank has left the run: its own part of that is cancelled.
enum class Left {
  no,
  gathered,    ///< rank 0 has all of the mesh now, and finishes the run
  interrupted  ///< another rank's run has ended before the ranks parted: it has what there is of the mesh
};

/// What a rank holds, from the cut until all is gathered; null: all of the mesh.
template <int D>
struct Part {
  std::unique_ptr<Territory<D>> territory;
  std::unique_ptr<HeldMesh<D>> held;
  SchedulerStatistics until_cut;     ///< of visits that all ranks do alike
  SchedulerStatistics until_gather;  ///< of all visits of a rank that leaves then
  Left left = Left::no;
};

/// See above.
template <int D>
class UniformOnRanks final : public Planner<D> {
 public:
  using Node = typename Orthtree<D>::Node;

  /// `needs_all`: the run goes on, after the refinement, with what one rank does alone. All must outlive it.
  UniformOnRanks(RunState<D>& state, Collectives& ranks, bool needs_all, Part<D>& part, DistributedStatistics& statistics);

  void begin() override;
  StopCause stop() override;
  /// @throws what any rank's callbacks threw
  std::optional<PlannedVisits<D>> next() override;
  /// The same.
  void done(VisitRunner<D>& runner, const PlannedVisits<D>& plan, std::vector<EndedVisit<D>> ended,
            const std::exception_ptr& error) override;

 private:
  /// Nodes of one level, with the elements that are to come in each.
  struct Windows {
    std::vector<Node> nodes;  ///< in Morton order
    std::vector<double> to_come;
  };

  const Orthtree<D>& tree() const { return uniform_.tree(); }
  bool is_own(Node node) const { return !territory_ || territory_->owner(node) == ranks_->rank(); }
  void leave(Left why);

  // The cut.
  void meet_before_halving();
  Windows windows() const;
  std::vector<int> owners_of(const Windows& windows) const;
  bool may_cut() const;
  bool pays_to_cut(const Windows& windows, const Territory<D>& territory) const;
  void cut(std::unique_ptr<Territory<D>> territory, const Windows& windows);
  void halve_parts();
  std::vector<Bytes> late_for_owners();
  void keep_late_work();
  template <class Is>
  void keep_work(Node node, Is is);
  int owner_of(const Entry<D>& e) const;

  // A phase.
  std::optional<PlannedVisits<D>> next_together();
  PlannedVisits<D> plan_together();
  void look_ahead(const RunTotals& before, std::exception_ptr error);
  std::vector<Bytes> messages_for_neighbours(const RankOutbox<D>& letters) const;
  void put_in(const std::vector<Bytes>& arrived, RankOutbox<D>& letters);
  std::exception_ptr tell_neighbours(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended,
                                     std::exception_ptr error);
  void take_in(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended);

  // The end.
  void share_unsent();
  bool is_alone_at_the_end();
  void gather();
  Bytes pack_all();
  void take_all(const std::vector<Bytes>& all);

  RunState<D>* state_;
  Uniform<D> uniform_;
  Collectives* ranks_;
  const bool needs_all_;
  DistributedStatistics* statistics_;
  Part<D>* part_;
  std::unique_ptr<Territory<D>>& territory_;
  std::unique_ptr<HeldMesh<D>>& held_;
  LateWork<D> late_;
  LateConstraints<D> unsent_;
  std::uint64_t phases_ = 0;
  // After the cut:
  Outlook outlook_;                       ///< what comes next
  std::vector<VisitChanges<D>> changes_;  ///< of the visits that run
  RunTotals before_;                      ///< before these
  std::exception_ptr error_;              ///< what went wrong when these were planned
  StopCause stop_ = StopCause::finished;  ///< of any rank
};

extern template class UniformOnRanks<2>;
extern template class UniformOnRanks<3>;

}  // namespace pgdr::detail
