// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/optimizing.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"
#include "reasons/optimized_reasons.hpp"
#include "rule/cell_quality.hpp"
#include "rule/sizes_of_cells.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

/// The budget of a phase: so many evaluations for each cell of the mesh, and for each poor cell that it begins with. For these it
/// is at most some hundred for each cell of the mesh, which take about as long as its refinement took.
constexpr std::uint64_t evaluations_a_cell = 20, evaluations_a_listed_cell = 1000, most_for_listed = 100;

/// The budget of what is tried for the cells that nothing excuses: so many evaluations for each of these, ten times as many as
/// one look at it may take; but no more than a phase has for each cell of the mesh, or in small meshes a million, some half
/// second.
constexpr std::uint64_t evaluations_an_unexplained_cell = 100000, least_of_most_for_unexplained = 1000000;

/// For the progress report: what a phase evaluates for each poor cell that it begins with, of some models, within its budget; and
/// how many times as much the phases after it do, which begin with a part of these.
struct UsualPhase {
  double a_listed_cell, others;
};
UsualPhase usual(Optimization::Phase phase, bool is_first_of_its_kind) {
  switch (phase) {
    case Optimization::Phase::cheap: return {200, 3};
    case Optimization::Phase::strong: return {1400, is_first_of_its_kind ? 1.3 : 0.0};
    default: return {1400, 1};
  }
}

}  // namespace

Optimizing::Optimizing(RunState<3>& state, VisitSchedule<3>& schedule, double min_dihedral)
    : state_(&state),
      schedule_(&schedule),
      min_dihedral_(min_dihedral),
      claimed_cosine_(claimed_cosine(min_dihedral)),
      stage_(state.context.mesh, min_dihedral),
      before_(state.totals.counts) {
  // After the refinement a cell that is poor was refused.
  state.refused.for_each_list([this](std::span<const Refusal<3>> refused) {
    for (const Refusal<3>& r : refused)
      if (r.entry.kind() == EntryKind::cell && r.entry.which() != Entry<3>::over_radius_edge &&
          r.entry.alive(state_->context.mesh))
        sizes_are_met_ = false;
  });
  state.waiting.set_all_listed(false);  // what is listed from now on need not be over a bound of size or shape
}

/// All poor cells, in an order that does not depend on their slots, which depend on timing.
std::vector<Entry<3>> Optimizing::find_poor() {
  RefineContext<3>& context = state_->context;
  const Mesh<3>& mesh = context.mesh;
  struct Part {
    std::vector<Entry<3>> poor;
    std::uint64_t cells = 0;
  };
  std::vector<Part> parts(count_parts(mesh.cell_bound()));
  const auto look_at = [&](const CellPart& part) {
    Part& found = parts[part.number];
    const CellQuality quality(context.bounds, min_dihedral_);
    SizesOfCells<3> cells(mesh, context.bounds);
    for (std::uint32_t i = part.first; i < part.last && !context.ended();) {  // the clock is looked at as often
      i = cells.look(i, part.last);
      found.cells += cells.alive().size();
      for (std::size_t k = 0; k < cells.alive().size(); ++k) {
        const CellId c = cells.alive()[k];
        const Simplex<3> s = mesh.simplex(c);
        const double q = cells.asks_blocks() ? quality.of_sized(s, mesh.region(c), cells.size(k)) : quality.of(s, mesh.region(c));
        if (q >= 1) continue;
        const std::uint32_t order = order_by_level(mesh, c, CellQuality::level(q));
        found.poor.push_back({c, mesh.birth(c), EntryKind::cell, Entry<3>::over_radius_edge, 0, order});
      }
    }
  };
  each_part(mesh.cell_bound(), state_->pieces, look_at);
  state_->is_cancelled();
  std::vector<Entry<3>> all;
  cells_ = 0;
  for (const Part& part : parts) {
    all.insert(all.end(), part.poor.begin(), part.poor.end());
    cells_ += part.cells;
  }
  state_->totals.counts.evaluated += cells_;
  Bulk(state_->pieces).sort(all, [&mesh](const Entry<3>& a, const Entry<3>& b) {
    return a.order != b.order ? a.order < b.order : compare_vertices<3>(mesh, a.cell, b.cell) < 0;
  });
  return all;
}

/// Returns how many it has listed, as list_refused().
std::size_t Optimizing::list_all_poor() {
  state_->refused.take_all();
  const std::vector<Entry<3>> poor = find_poor();
  for (const Entry<3>& e : poor) state_->waiting.relist(e);
  return poor.size();
}

std::size_t Optimizing::list_refused(Phase next) {
  std::size_t count = 0;
  std::vector<bool> listed(state_->context.mesh.cell_bound());
  const std::vector<Refusal<3>> refused = state_->refused.take_all();
  left_some_ = !refused.empty();
  for (const Refusal<3>& r : refused) {
    const std::uint32_t slot = index(r.entry.cell);
    if (listed[slot]) continue;
    listed[slot] = true;
    const std::uint64_t place = place_hash<3>(state_->context.mesh, r.entry.cell);
    if (last_ == Phase::strong) refused_strongly_[place] = r.versions;
    const auto before = refused_strongly_.find(place);
    if (next == Phase::strong && before != refused_strongly_.end() && before->second == r.versions) continue;
    state_->waiting.relist(r.entry);
    ++count;
  }
  return count;
}

StopCause Optimizing::run(Phase phase) {
  begin(phase);
  const std::size_t listed = last_ ? list_refused(phase) : list_all_poor();
  const std::uint64_t budget = evaluations_a_cell * cells_ +
                               std::min<std::uint64_t>(evaluations_a_listed_cell * listed, most_for_listed * cells_);
  const UsualPhase expected = usual(phase, last_ != Phase::worst);
  state_->meter.begin_phase(std::min(expected.a_listed_cell * static_cast<double>(listed), static_cast<double>(budget)),
                            expected.others);
  last_ = phase;
  return work_off(budget);
}

void Optimizing::begin(Phase phase) {
  RefineContext<3>& context = state_->context;
  stage_.phase = phase;
  if (phase == Phase::worst && !sharp_)
    sharp_.emplace(context.domain, AngleBounds{context.bounds.radius_edge_bound, claimed_cosine_});
  if (sharp_) stage_.sharp = &*sharp_;
  context.stage = &stage_;
}

/// Treats what waits, and what was refused as often as its surroundings change, with so many evaluations.
StopCause Optimizing::work_off(std::uint64_t budget) {
  state_->most_evaluated = state_->totals.counts.evaluated + budget;
  bool some_undecided = false;  // when the lists were drained last, had some visit used up its share?
  while (!state_->waiting.is_empty() && !state_->is_spent()) {
    const RefineCounts counts = state_->totals.counts;
    const StopCause stop = schedule_->drain();
    if (stop != StopCause::finished) return stop;
    some_undecided = state_->totals.counts.out_of_budget > counts.out_of_budget;
    if (state_->totals.counts.changes() == counts.changes()) break;
    state_->refused.relist_changed();
  }
  is_limited_ = some_undecided || !state_->waiting.is_empty() || state_->totals.vertices >= state_->context.options.max_vertices;
  return StopCause::finished;
}

/// The poor cells that nothing excuses, in the order of find_poor().
std::vector<Entry<3>> Optimizing::find_unexplained() {
  RefineContext<3>& context = state_->context;
  const std::vector<Entry<3>> poor = find_poor();
  std::vector<Entry<3>> unexplained;
  if (poor.empty()) return unexplained;
  OptimizedReasons reasons(context.mesh, context.domain, context.bounds, claimed_cosine_);
  for (const Entry<3>& e : poor) {
    if (context.ended()) break;
    const auto found = reasons.of_cells(std::array{e.cell}, PoorReason::Code::not_found, [] { return false; });
    if (!found.empty() && !OptimizedReasons::is_excuse(found.front().reason.code)) unexplained.push_back(e);
  }
  return unexplained;
}

/// Phase::rest makes more cells poor, which Phase::strong mends, if it has the evaluations. So it is left out where these are not
/// enough for every cell, and has no more than half of what is left.
StopCause Optimizing::run_for_unexplained() {
  if (!left_some_ && state_->refused.take_all().empty()) return StopCause::finished;
  const std::uint64_t most = std::max(evaluations_a_cell * cells_, least_of_most_for_unexplained);
  std::uint64_t left = most;
  for (const Phase phase : {Phase::strong, Phase::rest, Phase::strong, Phase::rest, Phase::strong}) {
    const std::vector<Entry<3>> unexplained = find_unexplained();
    const std::uint64_t wanted = evaluations_an_unexplained_cell * unexplained.size();
    if (unexplained.empty()) break;
    if (phase == Phase::rest && wanted > left / 2) break;
    state_->refused.take_all();
    state_->waiting.for_each_list([](WorkList<3>& list) { list.drain([](const Entry<3>&) {}); });
    for (const Entry<3>& e : unexplained) state_->waiting.relist(e);
    begin(phase);
    const std::uint64_t evaluated = state_->totals.counts.evaluated;
    if (const StopCause stop = work_off(std::min(left, wanted)); stop != StopCause::finished) return stop;
    left -= std::min(left, state_->totals.counts.evaluated - evaluated);
  }
  return StopCause::finished;
}

std::vector<PoorCell> Optimizing::explain_left() {
  RefineContext<3>& context = state_->context;
  context.stage = nullptr;
  std::vector<CellId> poor;
  for (const Entry<3>& e : find_poor()) poor.push_back(e.cell);
  OptimizedReasons reasons(context.mesh, context.domain, context.bounds, claimed_cosine_);
  const auto otherwise = is_limited_ ? PoorReason::Code::budget : PoorReason::Code::not_found;
  std::vector<PoorCell> left = reasons.of_cells(poor, otherwise, [&context] { return context.ended(); });
  left_ = left.size();
  for (const PoorCell& p : left) unexplained_ += OptimizedReasons::is_excuse(p.reason.code) ? 0 : 1;
  return left;
}

OptimizationStatistics Optimizing::statistics() const {
  const RefineCounts& now = state_->totals.counts;
  OptimizationStatistics s;
  s.target = min_dihedral_;
  s.claimed_cosine = claimed_cosine_;
  s.moves = now.moves;
  s.edge_removals = now.edge_removals;
  s.reconnections = now.reconnections;
  s.inserted = now.committed - before_.committed;
  s.removed = now.removed;
  s.evaluated = evaluated();
  s.left = left_;
  s.unexplained = unexplained_;
  return s;
}

}  // namespace pgdr::detail
