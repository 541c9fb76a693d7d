// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The entry of a run on ranks. By the uniform schedule ranks share the run (uniform_on_ranks.hpp). By the reproducible one, or
// where there is too little to share, every rank makes the whole mesh, which is the same on all, and keeps its piece.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "output/piece_join.hpp"
#include "pgdr/ranks.hpp"
#include "ranks/alike.hpp"
#include "ranks/id_table.hpp"
#include "ranks/numbering.hpp"
#include "ranks/uniform_on_ranks.hpp"
#include "ranks/values.hpp"
#include "ranks/volumes_on_ranks.hpp"
#include "run/run_hooks.hpp"
#include "run/unused_points.hpp"
#include "run/violation_scan.hpp"
#include "space/system.hpp"
#include "transport/collectives.hpp"

namespace pgdr {
namespace {

/// The bytes of the values: no type of an OutputMesh has padding.
template <class T>
void add(detail::WordHash& hash, const std::vector<T>& values) {
  const std::size_t size = values.size() * sizeof(T);
  hash.add(size);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof word, size - i));
    hash.add(word);
  }
}

template <int D>
std::uint64_t hash_of(const OutputMesh<D>& mesh) {
  detail::WordHash hash;
  add(hash, mesh.points);
  add(hash, mesh.point_markers);
  add(hash, mesh.point_attributes);
  add(hash, mesh.cells);
  add(hash, mesh.regions);
  add(hash, mesh.subsegments);
  add(hash, mesh.subfacets);
  return hash.value();
}

bool was_interrupted(StopCause stop) { return stop == StopCause::cancelled || stop == StopCause::time_limit; }

/// What a rank's own mesh, the same on all, leaves it with.
template <int D>
DistributedResult<D> keep_piece(const detail::Collectives& ranks, RefineResult<D> run) {
  DistributedResult<D> result;
  if (ranks.size() == 1)
    result.piece = detail::whole_piece(std::move(run.mesh));
  else
    result.piece = piece_of(run.mesh, static_cast<std::uint64_t>(ranks.rank()), static_cast<std::uint64_t>(ranks.size()));
  run.mesh = {};
  result.run = std::move(run);
  return result;
}

/// The result of rank 0, in pieces: where a clock or a signal has ended the runs, at another point on each rank.
template <int D>
DistributedResult<D> share_of_first(detail::Collectives& ranks, RefineResult<D> run) {
  const std::vector<Bytes> messages = ranks.together([&] {
    std::vector<Bytes> to_each;
    for (int q = 1; ranks.rank() == 0 && q < ranks.size(); ++q) {
      detail::MessageWriter message;
      detail::put_result(message, run);
      detail::put_piece(message, piece_of(run.mesh, static_cast<std::uint64_t>(q), static_cast<std::uint64_t>(ranks.size())));
      to_each.push_back(message.take());
    }
    return to_each;
  });
  std::vector<Bytes> to_each(1);
  to_each.insert(to_each.end(), messages.begin(), messages.end());
  const Bytes own = ranks.scatter(0, std::move(to_each));
  if (ranks.rank() == 0) return keep_piece(ranks, std::move(run));
  detail::MessageReader message(own);
  DistributedResult<D> result;
  result.run = detail::get_result<D>(message);
  result.piece = detail::get_piece<D>(message);
  message.require_end();
  return result;
}

/// The pieces of a run of which each rank has the whole mesh, or rank 0 alone (`of_first`, on any rank).
template <int D>
DistributedResult<D> share_whole(detail::Collectives& ranks, RefineResult<D> run, bool of_first) {
  if (ranks.max(of_first || was_interrupted(run.stop) ? 1 : 0) != 0) return share_of_first(ranks, std::move(run));
  if (ranks.size() > 1) detail::require_alike(ranks, hash_of(run.mesh));
  return ranks.together([&] { return keep_piece(ranks, std::move(run)); });
}

/// What the visits of this rank were, and those that all ranks have made alike.
struct OwnVisits {
  SchedulerStatistics all, alike;
};

/// Visits that ranks made alike count once; the others, and all work, are sums. Who waits for a message does not work.
template <int D>
void sum_up_visits(detail::Collectives& ranks, const OwnVisits& own, DistributedResult<D>& result) {
  SchedulerStatistics& s = result.run.scheduler;
  if (result.distributed.cut_cells > 0) {
    const auto since = ranks.sum(std::array<std::uint64_t, 2>{own.all.visits - own.alike.visits,  //
                                                              own.all.set_aside - own.alike.set_aside});
    s.visits = own.alike.visits + since[0];
    s.set_aside = own.alike.set_aside + since[1];
  }
  const auto without_waiting = [waiting = ranks.traffic().seconds_waiting](double seconds) {
    return std::max(0.0, seconds - waiting);
  };
  s.work_seconds = ranks.sum(std::array{without_waiting(own.all.work_seconds)}).front();
  const auto largest = ranks.max(
      std::array{without_waiting(own.all.critical_path_seconds), without_waiting(own.all.serial_seconds)});
  s.critical_path_seconds = largest[0];
  s.serial_seconds = largest[1];
}

/// Counts and bytes of all ranks, the longest seconds of any.
template <int D>
void set_statistics(detail::Collectives& ranks, const OwnVisits& own, DistributedResult<D>& result) {
  sum_up_visits(ranks, own, result);
  const std::uint64_t peak = detail::system::peak_resident();
  DistributedStatistics& s = result.distributed;
  const detail::Traffic traffic = ranks.traffic();
  const auto counts = ranks.sum(std::array<std::uint64_t, 3>{traffic.messages, traffic.bytes_sent, s.cells_applied});
  const auto seconds = ranks.max(
      std::array<double, 5>{s.seconds_prologue, s.seconds_pack, s.seconds_apply, traffic.seconds_waiting, s.seconds_finish});
  s.ranks = ranks.size();
  s.messages = counts[0];
  s.bytes_sent = counts[1];
  s.cells_applied = counts[2];
  s.seconds_prologue = seconds[0];
  s.seconds_pack = seconds[1];
  s.seconds_apply = seconds[2];
  s.seconds_wait = seconds[3];
  s.seconds_finish = seconds[4];
  s.least_peak_rss = ranks.min(peak);
  s.largest_peak_rss = ranks.max(peak);
}

/// Looks up once for each vertex whether it is in this rank's part. All vertices of most cells are, or none.
template <int D>
detail::IsOwnCell own_cells(const detail::HeldMesh<D>& held, const Mesh<D>& mesh) {
  enum State : unsigned char { unknown, here, elsewhere };
  return [&held, &mesh, states = std::make_shared<std::vector<unsigned char>>(mesh.vertex_bound(), unknown)](CellId c) {
    std::size_t own = 0;
    for (const VertexId v : mesh.cell(c).vertices) {
      const std::atomic_ref state((*states)[index(v)]);  // two threads may find the same
      unsigned char known = state.load(std::memory_order_relaxed);
      if (known == unknown) {
        known = held.territory().owner(held.zone(v)) == held.territory().rank() ? here : elsewhere;
        state.store(known, std::memory_order_relaxed);
      }
      own += known == here ? 1 : 0;
    }
    return own == D + 1 || (own > 0 && held.is_own(c));
  };
}

/// A uniform run, of which ranks do parts.
template <int D>
class SharedRun {
 public:
  explicit SharedRun(detail::Collectives& ranks) : ranks_(ranks) {}

  /// One run of all ranks, or of rank 0 in the end.
  DistributedResult<D> run(const Plc<D>& plc, const RefineOptions<D>& options, OwnVisits& visits);

 private:
  std::unique_ptr<detail::VisitSchedule<D>> make_schedule(detail::RunState<D>& state, bool optimizes);
  bool finish_part(const RefineContext<D>& context, const RegionTable& regions, const PointData<D>& data,
                   const detail::RunPieces& pieces, RefineResult<D>& result);
  OwnVisits visits_of(const RefineResult<D>& run) const;

  detail::Collectives& ranks_;
  DistributedResult<D> result_;
  detail::Part<D> part_;
};

template <int D>
std::unique_ptr<detail::VisitSchedule<D>> SharedRun<D>::make_schedule(detail::RunState<D>& state, bool optimizes) {
  const RefineContext<D>& context = state.context;
  const bool needs_all = optimizes || context.options.leaves || detail::has_uneven_facets(context.domain);
  return std::make_unique<detail::PlannedSchedule<D>>(
      state, std::make_unique<detail::UniformOnRanks<D>>(state, ranks_, needs_all, part_, result_.distributed));
}

/// Nothing was refused and nothing is left, so that all cells are within the bounds.
template <int D>
bool SharedRun<D>::finish_part(const RefineContext<D>& context, const RegionTable& regions, const PointData<D>& data,
                               const detail::RunPieces& pieces, RefineResult<D>& result) {
  if (!part_.held) return false;
  const detail::RunClock::Stage timed(pieces.clock(), "number");
  const double start = pieces.clock().now();
  result.statistics.seconds_refine = start - result.statistics.seconds_initial;
  const detail::IsOwnCell is_own = own_cells<D>(*part_.held, context.mesh);
  const std::span<const double> attributes = regions.labelled ? std::span<const double>(regions.attribute)
                                                              : std::span<const double>();
  detail::VolumesOnRanks volumes(ranks_, is_own);
  result.regions = region_volumes<D>(context.mesh, context.domain, attributes, pieces, volumes);
  std::vector<std::uint32_t> unused;
  result_.piece = detail::number_on_ranks<D>(ranks_, context.mesh, is_own, context.domain, attributes, data, pieces, unused,
                                             context.options.drop_unused_points);
  result_.piece.mesh.names = context.domain.names();
  detail::note_unused_points<D>(context.domain, std::move(unused), result);
  result_.distributed.cells_applied += part_.held->cells_applied();
  result_.distributed.seconds_finish = pieces.clock().now() - start;
  return true;
}

/// What the visits of this rank were in a run that has ended so, or that it left.
template <int D>
OwnVisits SharedRun<D>::visits_of(const RefineResult<D>& run) const {
  const bool has_left = part_.left == detail::Left::gathered;
  OwnVisits own{has_left ? part_.until_gather : run.scheduler, part_.until_cut};
  if (has_left)  // all else that it did is not known
    for (const double busy : own.all.busy_seconds) own.all.work_seconds += busy;
  return own;
}

template <int D>
DistributedResult<D> SharedRun<D>::run(const Plc<D>& plc, const RefineOptions<D>& options, OwnVisits& visits) {
  detail::RunHooks<D> hooks;
  hooks.make_schedule = [this](detail::RunState<D>& state, bool optimizes) { return make_schedule(state, optimizes); };
  hooks.finish_part = [this](const auto& context, const auto& regions, const auto& data, const auto& pieces, auto& result) {
    return finish_part(context, regions, data, pieces, result);
  };
  RefineResult<D> run;
  try {
    run = detail::refine_with<D>(plc, options, hooks);
  } catch (const RankFailure&) {
    throw;
  } catch (...) {
    if (!ranks_.has_failed()) ranks_.together([] { throw; });  // where the others meet next
    throw;
  }
  bool is_first_alone = part_.left == detail::Left::interrupted;
  if (result_.distributed.cut_cells == 0 && !is_first_alone) is_first_alone = detail::has_another_gone_on(ranks_);
  ranks_.together([&] { visits = visits_of(run); });
  // Where one has ended, and another goes on, a clock or a signal has ended it, or they do not the same.
  const bool is_interrupted = part_.left == detail::Left::no && was_interrupted(run.stop);
  if (ranks_.max(is_first_alone ? 1 : 0) != 0 && ranks_.max(is_interrupted ? 1 : 0) == 0) detail::fail_unlike_ranks();
  if (part_.held) {
    result_.run = std::move(run);
    return std::move(result_);
  }
  const DistributedStatistics statistics = result_.distributed;
  result_ = share_whole(ranks_, std::move(run), statistics.gathered || is_first_alone);
  result_.distributed = statistics;
  return std::move(result_);
}

}  // namespace

template <int D>
DistributedResult<D> refine(Transport& transport, const Plc<D>& plc, const RefineOptions<D>& options) {
  if (options.schedule.schedule == Schedule::greedy)
    throw UsageError(
        {.code = Errc::bad_option, .message = "the greedy schedule depends on timing: ranks need one that does not"});
  detail::Collectives ranks(transport);
  RefineOptions<D> own = options;
  if (ranks.rank() > 0) {
    own.progress = nullptr;
    own.time_limit.reset();
    own.stop = {};
    own.memory_guard = false;
    own.partial_mesh = false;  // who leaves the run has none
  }
  DistributedResult<D> result;
  OwnVisits visits;
  // A part of a surface that is kept cannot be recovered, nor its points be withdrawn, without the rest: all make all of it.
  const bool is_kept_surface = D == 3 && options.keep_boundary;
  if (options.schedule.schedule == Schedule::uniform && !is_kept_surface) {
    result = SharedRun<D>(ranks).run(plc, own, visits);
  } else {
    RefineResult<D> run = ranks.together([&] { return refine(plc, own); });
    visits = {run.scheduler, run.scheduler};
    result = share_whole(ranks, std::move(run), false);
  }
  result.sharing = detail::sharing_of(ranks, result.piece);
  set_statistics(ranks, visits, result);
  return result;
}

template <int D>
Plc<D> broadcast(Transport& transport, const Plc<D>& plc) {
  detail::Collectives ranks(transport);
  detail::MessageWriter own;
  if (ranks.rank() == 0) detail::put_plc(own, plc);
  const Bytes bytes = ranks.broadcast(0, own.take());
  if (ranks.rank() == 0) return plc;
  detail::MessageReader message(bytes);
  Plc<D> copy = detail::get_plc<D>(message);
  message.require_end();
  return copy;
}

template <int D>
OutputMesh<D> gather(Transport& transport, const MeshPiece<D>& piece) {
  detail::Collectives ranks(transport);
  detail::MessageWriter own;
  if (ranks.rank() > 0) detail::put_piece(own, piece);
  std::vector<Bytes> messages = ranks.gather(0, own.take());
  return ranks.together([&] {
    std::vector<MeshPiece<D>> pieces;
    for (std::size_t q = 0; q < messages.size(); ++q) {
      const Bytes bytes = std::move(messages[q]);  // freed once it has been read
      detail::MessageReader message(bytes);
      pieces.push_back(q == 0 ? piece : detail::get_piece<D>(message));
      message.require_end();
    }
    return pieces.empty() ? OutputMesh<D>() : join_pieces<D>(pieces);
  });
}

void throw_together(Transport& transport, const std::exception_ptr& error) { detail::Collectives(transport).agree(error); }

int largest_of_ranks(Transport& transport, int number) {
  const auto value = static_cast<double>(number);
  return static_cast<int>(detail::Collectives(transport).max(std::span(&value, 1)).front());
}

template PGDR_API DistributedResult<2> refine<2>(Transport&, const Plc<2>&, const RefineOptions<2>&);
template PGDR_API DistributedResult<3> refine<3>(Transport&, const Plc<3>&, const RefineOptions<3>&);
template PGDR_API OutputMesh<2> gather<2>(Transport&, const MeshPiece<2>&);
template PGDR_API OutputMesh<3> gather<3>(Transport&, const MeshPiece<3>&);
template PGDR_API Plc<2> broadcast<2>(Transport&, const Plc<2>&);
template PGDR_API Plc<3> broadcast<3>(Transport&, const Plc<3>&);

}  // namespace pgdr
