// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// From input to finished mesh: triangulate, recover the boundary, carve, refine, compact.
#include "pgdr/refine.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "compact/compact.hpp"
#include "compact/point_data.hpp"
#include "compact/region_volumes.hpp"
#include "graph/float_environment.hpp"
#include "input/words.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/mesh_maps.hpp"
#include "reasons/given_names.hpp"
#include "reasons/poor_reasons.hpp"
#include "reasons/sharp_corners.hpp"
#include "rule/cell_bounds.hpp"
#include "run/cells_ahead.hpp"
#include "run/folded_facets.hpp"
#include "run/kept_boundary.hpp"
#include "run/refinement.hpp"
#include "run/unused_points.hpp"
#include "run/valid_options.hpp"
#include "size/region_sizes.hpp"
#include "visits/cell_parts.hpp"
#include "visits/deadline.hpp"
#include "visits/run_pieces.hpp"

namespace pgdr {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double most_practical_dihedral = 30;  // degrees
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

/// The optimiser's target in degrees; 0: there is no optimiser.
template <int D>
double target_of(const RefineOptions<D>& options) {
  if (D == 2 || !options.refine) return 0;
  const bool is_usual = !options.selector;  // circumcentres are the default selector of 3D
  return options.min_dihedral.value_or(is_usual ? default_min_dihedral : 0);
}

template <int D>
CellBounds<D> bounds_of(const RefineOptions<D>& options, const RegionTable& regions) {
  CellBounds<D> bounds;
  bounds.radius_edge_bound = options.radius_edge_bound;
  bounds.size = options.size;
  bounds.max_measure = options.max_volume;
  bounds.region_measure = regions.measure;
  detail::require_labels<D>(options.region_sizes, regions.attribute);
  if (!options.region_sizes.empty())
    for (const double label : regions.attribute)
      bounds.region_size.push_back(detail::sizes_of_label<D>(options.region_sizes, label));
  return bounds;
}

/// The cells over a bound. `sizes_are_met`: none is over one of size, so that the size function need not be called.
template <int D>
PoorCount count_poor(const RefineContext<D>& context, bool sizes_are_met, const detail::RunPieces& pieces) {
  const std::uint32_t cells = context.mesh.cell_bound();
  std::vector<PoorCount> parts(detail::count_parts(cells));
  detail::each_part(cells, pieces, [&](const detail::CellPart& part) {
    if (!sizes_are_met) {
      parts[part.number] = count_poor_cells<D>(context.mesh, context.bounds, part.first, part.last);
      return;
    }
    for (std::uint32_t i = part.first; i < part.last; ++i)
      if (context.mesh.alive(CellId{i}) && context.bounds.over_radius_edge(context.mesh, CellId{i})) ++parts[part.number].cells;
  });
  PoorCount poor;
  for (const PoorCount& part : parts) {
    poor.cells += part.cells;
    poor.over_size = poor.over_size || part.over_size;
  }
  return poor;
}

/// Was the run ended by a clock or a person, who wants it to return now? The mesh is chance then, and so may its numbering be.
bool was_interrupted(StopCause stop) { return stop == StopCause::cancelled || stop == StopCause::time_limit; }

/// Has the run been cancelled, and is no partial mesh wanted?
template <int D>
bool is_unwanted(const RefineOptions<D>& options, StopCause stop) {
  return !options.partial_mesh && (options.stop.stop_requested() || stop == StopCause::cancelled);
}

/// The label of each region number; none where there are no labels.
std::span<const double> attributes_of(const RegionTable& regions) {
  if (!regions.labelled) return {};
  return regions.attribute;
}

template <int D>
Compacted<D> compact_mesh(Mesh<D>& mesh, const Domain<D>& domain, const RegionTable& regions, const PointData<D>& data,
                          const RefineOptions<D>& options, bool was_interrupted, const detail::RunPieces& pieces) {
  const std::span<const double> attributes = attributes_of(regions);
  // The mesh is used up: where a partial one is wanted its numbering goes on to the end, in haste.
  const std::stop_token none, stop = options.partial_mesh ? none : options.stop;
  const std::stop_token hurry = options.partial_mesh ? options.stop : none;
  const FillPoints<D> fill = [&](const Mesh<D>& m, Compacted<D>& out) { data.fill(m, out, pieces, stop); };
  return was_interrupted ? compact_by_slots<D>(mesh, domain, attributes, pieces, fill)
                         : compact<D>(std::move(mesh), domain, attributes, pieces, stop, fill, hurry);
}

/// For each cell of the mesh, the rank of the leaf that holds its circumcentre among the leaves in Morton order.
template <int D>
std::vector<std::uint32_t> leaves_of(const OutputMesh<D>& mesh, const Orthtree<D>& tree, const detail::Bulk& bulk) {
  std::vector<std::uint32_t> leaves(mesh.cells.size()), ranks(tree.node_count());
  std::uint32_t rank = 0;
  for (const auto leaf : tree.leaves()) ranks[leaf] = rank++;
  bulk.each(leaves.size(), [&](std::size_t c) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
    leaves[c] = ranks[tree.leaf_at(circumsphere<D>(s).center)];
  });
  return leaves;
}

/// What a run returns that was ended before there was a mesh, or was cancelled where no partial one is wanted.
template <int D>
RefineResult<D> without_mesh(RefineResult<D> result, Clock::time_point start, StopCause cause = StopCause::cancelled) {
  result.mesh = {};
  result.reasons.clear();
  result.regions.clear();
  result.stop = cause;
  result.size_met = false;
  result.statistics.seconds_mesh = seconds_since(start);
  return result;
}

template <int D>
void warn_beyond_theory(const RefineOptions<D>& options, std::vector<Diagnostic>& warnings) {
  if (D == 2 && options.radius_edge_bound < smallest_proved_bound<D>() && options.refine)
    warnings.push_back({Errc::beyond_theory,
                        "the bound on circumradius over shortest edge is below sqrt 2 (angles above 20.7 degrees): the "
                        "refinement ends, but elements may stay poor without a small angle of the input",
                        {},
                        0,
                        {},
                        {}});
  if (target_of(options) > most_practical_dihedral)
    warnings.push_back({Errc::beyond_theory,
                        "the bound on dihedral angles is beyond practice: above " + detail::to_text(most_practical_dihedral) +
                            " degrees some cells mostly stay below it",
                        {},
                        0,
                        {},
                        {}});
}

/// Makes the mesh before its refinement: all input points, the boundary, no exterior. Where the run is stopped before the
/// boundary is there, `result.stop` says why.
template <int D>
RegionTable make_initial(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Domain<D>& domain, const RefineOptions<D>& options,
                         Clock::time_point start, const detail::Deadline& deadline, const detail::RunPieces& pieces,
                         RefineResult<D>& result) {
  detail::RunClock& clock = pieces.clock();
  Delaunay<D> delaunay(mesh, pools);
  bool is_solid = false;
  detail::Islands islands;
  try {
    const detail::RunClock::Stage timed(clock, "triangulate");
    islands = detail::islands_of<D>(domain, options.regions == RegionMode::automatic, detail::Bulk(pieces, deadline.token()),
                                    detail::StopCheck(deadline.token()));
    is_solid = delaunay.build(domain.points(), pieces, deadline.token(), islands.of_point);
  } catch (const CancelledError&) {
    result.stop = deadline.cause();
    return {};
  }
  if (!is_solid)
    throw InputError({Errc::no_volume, D == 3 ? "all points lie in one plane" : "all points lie on one line", {}, 0, {}, {}});
  result.stop = deadline.cause();
  if (result.stop == StopCause::finished) {  // else the triangulation may lack points
    const detail::RunClock::Stage timed(clock, "recover");
    RecoveryCounts counts;
    result.stop = recover_boundary<D>(mesh, pools, delaunay, domain, options, start, counts, pieces);
    result.statistics.segment_points = counts.segment_points;
    result.statistics.facet_points = counts.facet_points;
  }
  if (result.stop != StopCause::finished) return {};
  std::optional<detail::RunClock::Stage> timed(std::in_place, clock, "carve");
  RegionTable regions = carve<D>(mesh, pools, delaunay, domain, options.regions, result.warnings, pieces, islands);
  if constexpr (D == 3)
    if (options.keep_boundary) {
      timed.emplace(clock, "withdraw");
      detail::keep_boundary(mesh, pools, domain, options, deadline.token(), result);
    }
  try {
    if constexpr (D == 3) require_unfolded(mesh, domain, options.regions, attributes_of(regions), pieces, deadline.token());
  } catch (const CancelledError&) {
    result.stop = deadline.cause();  // nobody knows whether the boundary is right
  }
  return regions;
}

/// What is known of the poor cells, and of the tree, once the refinement has ended.
template <int D>
struct Refined {
  std::vector<PoorCell> explained;         ///< with their reasons, if the refinement has finished
  std::optional<PoorCount> counted;        ///< how many there are, if the run was interrupted, where the lists tell
  bool sizes_are_met = false;              ///< none is over a bound of size: known once the optimiser has begun
  std::optional<Orthtree<D>> tree;         ///< as it is in the end, if the leaves of cells are asked for
  std::optional<double> optimizing_since;  ///< seconds after the run began
};

template <int D>
Refined<D> refine_mesh(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices,
                       const detail::RunPieces& pieces, const detail::RunHooks<D>* hooks, RefineResult<D>& result) {
  detail::Refinement<D> refinement(context, std::move(pools), vertices, target_of(context.options), pieces, hooks);
  detail::RunState<D>& state = refinement.state();
  state.meter.expect_optimizer(target_of(context.options) > 0);
  result.stop = refinement.run();
  const detail::OptimizerRun* optimizing = refinement.optimizing();
  const RefineCounts& counts = optimizing ? optimizing->counts_before() : state.totals.counts;
  if (optimizing) result.optimization = optimizing->statistics();
  // Who interrupts a run does not wait for the repair of what is not locally Delaunay.
  result.delaunay = context.begins_delaunay && !optimizing && !(was_interrupted(result.stop) && state.totals.violations_seen);
  result.violations_seen = state.totals.violations_seen || optimizing;
  result.statistics.insertions_committed = counts.committed;
  result.statistics.insertions_refused = counts.refused;
  result.statistics.selector_outside = state.totals.counts.selector_outside;
  result.statistics.selector_further = state.totals.counts.selector_further;
  result.statistics.selector_dropped = state.totals.counts.selector_dropped;
  result.statistics.predicates += state.recorder.predicates_elsewhere();
  result.scheduler = state.recorder.statistics();
  result.scheduler.threads = detail::threads_of(context.options.schedule);
  result.trace = state.recorder.take_trace();
  if (is_unwanted(context.options, result.stop)) return {};
  Refined<D> refined;
  refined.optimizing_since = refinement.optimizing_since();
  refined.explained = refinement.take_explained();
  if (was_interrupted(result.stop)) refined.counted = state.waiting.count_poor(pieces);
  refined.sizes_are_met = refinement.sizes_are_met();
  if (context.options.leaves) refined.tree = state.waiting.take_tree();
  return refined;
}

/// Counts the cells that stay poor. Unless the refinement has finished, and has explained them, every cell is looked at, or none
/// where the run was interrupted and the lists tell.
template <int D>
void count_poor_left(const RefineContext<D>& context, const Refined<D>& refined, const detail::RunPieces& pieces,
                     RefineResult<D>& result) {
  const RefineOptions<D>& options = context.options;
  if (!options.refine || result.stop != StopCause::finished) {
    const PoorCount count = refined.counted ? *refined.counted : count_poor(context, refined.sizes_are_met, pieces);
    result.poor_left = count.cells;
    result.size_met = !count.over_size;
    return;
  }
  std::vector<CellId> over_bound;
  for (const PoorCell& p : refined.explained) {
    if (!p.over_bound) continue;
    ++result.poor_left;
    if (result.delaunay || context.bounds.test(context.mesh, p.cell)) over_bound.push_back(p.cell);
    result.size_met = result.size_met && !p.over_size;
  }
  result.poor_unavoidable = count_in_sharp_corners<D>(context.mesh, context.domain, options.radius_edge_bound, over_bound,
                                                      detail::Bulk(pieces));
}

/// The numbers that compact_by_slots() gives these cells, which are in the order of their slots.
template <int D>
std::vector<std::uint32_t> numbers_by_slots(const Mesh<D>& mesh, std::span<const PoorCell> cells) {
  std::vector<std::uint32_t> numbers;
  std::uint32_t number = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound() && numbers.size() < cells.size(); ++i) {
    if (CellId{i} == cells[numbers.size()].cell) numbers.push_back(number);
    number += mesh.alive(CellId{i}) ? 1 : 0;
  }
  return numbers;
}

/// Numbers the finished mesh, which uses `mesh` up, and the poor cells in it. Where the run is cancelled meanwhile and no partial
/// mesh is wanted, the result has none.
template <int D>
void number_mesh(const RefineContext<D>& context, const RegionTable& regions, const PointData<D>& data, Refined<D>& refined,
                 const detail::RunPieces& pieces, RefineResult<D>& result) {
  const RefineOptions<D>& options = context.options;
  const detail::Bulk bulk(pieces);
  std::vector<PoorCell> poor;
  if (options.refine && result.stop != StopCause::cancelled) poor = std::move(refined.explained);
  const bool by_slots = was_interrupted(result.stop);
  const std::vector<std::uint32_t> numbers = by_slots ? numbers_by_slots<D>(context.mesh, poor) : std::vector<std::uint32_t>();
  std::vector<std::array<VertexId, D + 1>> poor_vertices(poor.size());
  bulk.each(poor.size(), [&](std::size_t i) { poor_vertices[i] = context.mesh.cell(poor[i].cell).vertices; });
  Compacted<D> compacted = compact_mesh(context.mesh, context.domain, regions, data, options, by_slots, pieces);
  if (options.stop.stop_requested()) {
    result.stop = StopCause::cancelled;
    poor.clear();
    if (!options.partial_mesh) return;
  }
  GivenNames<D> names(context.domain, compacted.mesh, context.meshed);
  result.reasons.resize(poor.size());
  bulk.each(poor.size(),
            [&](std::size_t i) { result.reasons[i].cell = by_slots ? numbers[i] : compacted.cell_number(poor_vertices[i]); });
  for (std::size_t i = 0; i < poor.size(); ++i) result.reasons[i] = names.named(poor[i].reason, result.reasons[i].cell);
  bulk.sort(result.reasons, [](const PoorReason& a, const PoorReason& b) { return a.cell < b.cell; });
  result.mesh = std::move(compacted.mesh);
  result.mesh.names = context.domain.names();
  detail::note_unused_points<D>(context.domain, unused_points(result.mesh), result);
  if (options.drop_unused_points) drop_points<D>(result.mesh, result.unused_points);
  if (refined.tree) result.mesh.leaves = leaves_of(result.mesh, *refined.tree, bulk);
}

/// The mesh of the domain. `result`: what is known before. `start`: of the run, for its limits.
template <int D>
RefineResult<D> make_mesh(const Domain<D>& domain, const RefineOptions<D>& options, Clock::time_point start,
                          const detail::Deadline& deadline, const detail::RunPieces& pieces, const detail::RunHooks<D>* hooks,
                          RefineResult<D> result) {
  Mesh<D> mesh(domain.points().size());
  auto pools = mesh.make_pools();
  const RegionTable regions = make_initial<D>(mesh, pools, domain, options, start, deadline, pieces, result);
  result.statistics.seconds_initial = seconds_since(start);
  if (result.stop != StopCause::finished) {
    result.size_met = false;
    return result;  // no boundary yet, so no mesh
  }
  const PointData<D> data(mesh, domain, pieces);
  const std::uint64_t vertices = domain.points().size() + result.statistics.segment_points + result.statistics.facet_points +
                                 result.statistics.inner_points;
  RefineContext<D> context(mesh, domain, options, bounds_of(options, regions), vertices, start);
  context.begins_delaunay = result.delaunay;
  Refined<D> refined;
  if (options.refine) refined = refine_mesh<D>(context, std::move(pools), vertices, pieces, hooks, result);
  if (is_unwanted(options, result.stop)) return without_mesh(std::move(result), start);
  if (hooks && hooks->finish_part(context, regions, data, pieces, result)) return result;
  detail::RunClock& clock = pieces.clock();
  {
    const detail::RunClock::Stage timed(clock, "count");
    count_poor_left<D>(context, refined, pieces, result);
    if constexpr (D == 3)
      if (result.statistics.boundary_points > 0)
        result.statistics.boundary_points = detail::count_boundary_points(mesh, context.kept);
    result.regions = region_volumes<D>(mesh, domain, attributes_of(regions), pieces);
  }
  const double end = seconds_since(start), optimizing_since = refined.optimizing_since.value_or(end);
  result.statistics.seconds_refine = optimizing_since - result.statistics.seconds_initial;
  result.statistics.seconds_optimize = end - optimizing_since;
  const detail::RunClock::Stage timed(clock, "number");
  number_mesh<D>(context, regions, data, refined, pieces, result);
  if (is_unwanted(options, result.stop)) return without_mesh(std::move(result), start);
  return result;
}

template <int D>
RefineResult<D> run(const Domain<D>& domain, const RefineOptions<D>& options, Clock::time_point start,
                    const detail::Deadline& deadline, const detail::RunPieces& pieces,
                    const detail::RunHooks<D>* hooks = nullptr) {
  if (domain.points().empty()) detail::bad_option("the Domain is empty: it was moved from");
  const PredicateCounts predicates_before = predicate_counts();
  RefineResult<D> before;
  before.repairs = domain.repairs();
  before.warnings = domain.warnings();
  before.tolerance = domain.tolerance();
  before.largest_move = domain.largest_move();
  warn_beyond_theory(options, before.warnings);
  detail::RunClock& clock = pieces.clock();
  try {
    const detail::RunClock::Stage timed(clock, "diagnose");
    const detail::PiecesHere here(pieces);
    require_no_errors(domain, deadline.token());
    detail::guard_memory(domain, options, deadline.token());
    if (options.prepared) options.prepared(domain);
  } catch (const CancelledError&) {
    return without_mesh(std::move(before), start, deadline.cause());
  }
  RefineResult<D> result = make_mesh<D>(domain, options, start, deadline, pieces, hooks, std::move(before));
  result.statistics.predicates += predicate_counts() - predicates_before;
  result.statistics.predicates += pieces.predicates_elsewhere();
  result.statistics.stages = clock.stages();
  result.statistics.seconds_mesh = clock.now();
  const detail::SectionSeconds total = clock.total();
  result.scheduler.work_seconds = total.work;
  result.scheduler.critical_path_seconds = total.path;
  result.scheduler.serial_seconds = total.wall - clock.sections().wall;
  if (options.progress && result.stop != StopCause::cancelled) options.progress({result.mesh.points.size(), 0, "done", 1.0});
  return result;
}

/// The error takes no memory.
template <class F>
auto with_typed_errors(const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw ResourceError({Errc::out_of_memory, "out of memory", {}, 0, {}, {}});
  }
}

template <int D>
RefineResult<D> prepare_and_run_as_given(const Plc<D>& plc, const RefineOptions<D>& options, Clock::time_point start,
                                         const detail::RunHooks<D>* hooks) {
  const detail::Deadline deadline(options, start);
  std::optional<Domain<D>> domain;
  detail::RunClock clock(start);
  const detail::RunPieces pieces(options.schedule, clock);
  try {
    const detail::RunClock::Stage timed(clock, "prepare");
    const detail::PiecesHere here(pieces);
    domain.emplace(plc, deadline.token());
  } catch (const CancelledError&) {
    RefineResult<D> none;
    none.tolerance = tolerance_of(plc);
    return without_mesh(std::move(none), start, deadline.cause());
  }
  return run<D>(*domain, options, start, deadline, pieces, hooks);
}

template <int D>
RefineResult<D> prepare_and_run(const Plc<D>& plc, const RefineOptions<D>& options, Clock::time_point start,
                                const detail::RunHooks<D>* hooks) {
  const auto run_as_given = [&](const Plc<D>& input) { return prepare_and_run_as_given<D>(input, options, start, hooks); };
  if constexpr (D == 3)
    if (options.keep_boundary) return detail::with_kept_input(plc, options, run_as_given);
  return run_as_given(plc);
}

}  // namespace

template <int D>
RefineResult<D> refine(const Domain<D>& domain, const RefineOptions<D>& options) {
  return with_typed_errors([&] {
    const detail::DefaultFloats floats;
    detail::validate<D>(options);
    const auto start = Clock::now();
    detail::RunClock clock(start);
    return run<D>(domain, options, start, detail::Deadline(options, start), {options.schedule, clock});
  });
}

template <int D>
RefineResult<D> refine(const Plc<D>& plc, const RefineOptions<D>& options) {
  return with_typed_errors([&] {
    const detail::DefaultFloats floats;
    detail::validate<D>(options);
    return prepare_and_run<D>(plc, options, Clock::now(), nullptr);
  });
}

template <int D>
RefineResult<D> detail::refine_with(const Plc<D>& plc, const RefineOptions<D>& options, const RunHooks<D>& hooks) {
  const DefaultFloats floats;
  detail::validate<D>(options);
  return prepare_and_run<D>(plc, options, Clock::now(), &hooks);
}

template RefineResult<2> detail::refine_with<2>(const Plc<2>&, const RefineOptions<2>&, const detail::RunHooks<2>&);
template RefineResult<3> detail::refine_with<3>(const Plc<3>&, const RefineOptions<3>&, const detail::RunHooks<3>&);

template PGDR_API RefineResult<2> refine<2>(const Plc<2>&, const RefineOptions<2>&);
template PGDR_API RefineResult<3> refine<3>(const Plc<3>&, const RefineOptions<3>&);
template PGDR_API RefineResult<2> refine<2>(const Domain<2>&, const RefineOptions<2>&);
template PGDR_API RefineResult<3> refine<3>(const Domain<3>&, const RefineOptions<3>&);

}  // namespace pgdr
