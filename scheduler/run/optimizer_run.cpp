// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/optimizer_run.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "optimize/cell_quality.hpp"
#include "optimize/order_by_level.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"
#include "reasons/optimized_reasons.hpp"
#include "refine/numbers.hpp"
#include "rule/sizes_of_cells.hpp"
#include "run/numbers.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

/// The budget in evaluations.
std::uint64_t budget_of(std::uint64_t cells, double min_dihedral) {
  std::uint64_t budget = std::max(numbers::evaluations_a_cell * cells, numbers::least_evaluations);
  for (double target = default_min_dihedral; target + 1 <= min_dihedral; ++target)
    budget += numbers::more_tenths_a_degree * budget / 10;
  return budget;
}

constexpr std::uint64_t evaluations_an_unexplained_cell = numbers::looks_at_an_unexplained_cell *
                                                          numbers::evaluations_a_poor_cell;

/// For the progress report: what a phase evaluates for each poor cell that it begins with, of some models, within its budget; and
/// how many times as much the phases after it do, which begin with a part of these.
struct UsualPhase {
  double a_listed_cell, others;
};
UsualPhase usual(OptimizerStage::Phase phase) {
  return phase == OptimizerStage::Phase::cheap ? UsualPhase{200, 1} : UsualPhase{1400, 0.5};
}

}  // namespace

OptimizerRun::OptimizerRun(RunState<3>& state, VisitSchedule<3>& schedule, double min_dihedral)
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
std::vector<Entry<3>> OptimizerRun::find_poor() {
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
std::size_t OptimizerRun::list_all_poor() {
  state_->refused.take_all();
  const std::vector<Entry<3>> poor = find_poor();
  for (const Entry<3>& e : poor) state_->waiting.relist(e);
  return poor.size();
}

std::size_t OptimizerRun::list_refused() {
  std::size_t count = 0;
  std::vector<bool> listed(state_->context.mesh.cell_bound());
  for (const Refusal<3>& r : state_->refused.take_all()) {
    const std::uint32_t slot = index(r.entry.cell);
    if (listed[slot]) continue;
    listed[slot] = true;
    state_->waiting.relist(r.entry);
    ++count;
  }
  return count;
}

StopCause OptimizerRun::run(Phase phase) {
  begin(phase);
  const std::size_t listed = last_ ? list_refused() : list_all_poor();
  if (!last_) budget_ = budget_of(cells_, min_dihedral_);
  const UsualPhase expected = usual(phase);
  state_->meter.begin_phase(std::min(expected.a_listed_cell * static_cast<double>(listed), static_cast<double>(budget_)),
                            expected.others);
  last_ = phase;
  state_->must_pay = true;
  return work_off(listed, budget_);
}

void OptimizerRun::begin(Phase phase) {
  RefineContext<3>& context = state_->context;
  stage_.phase = phase;
  context.stage = &stage_;
}

/// Treats what waits, so many cells, with so many evaluations of the budget; and what was refused and has changed about it, as
/// often as that pays.
StopCause OptimizerRun::work_off(std::size_t waiting, std::uint64_t most) {
  const std::uint64_t evaluated_before = state_->totals.counts.evaluated;
  state_->most_evaluated = evaluated_before + most;
  state_->most_evaluated_an_entry = most / std::max<std::size_t>(waiting, 1);
  bool some_undecided = false;  // when the lists were drained last, had some visit used up its share?
  while (!state_->waiting.is_empty() && !state_->is_spent()) {
    const RefineCounts counts = state_->totals.counts;
    const StopCause stop = schedule_->drain();
    if (stop != StopCause::finished) return stop;
    some_undecided = state_->totals.counts.out_of_budget > counts.out_of_budget;
    const RefineCounts& now = state_->totals.counts;
    const std::uint64_t evaluated = now.evaluated - counts.evaluated, changes = now.changes() - counts.changes();
    if (changes == 0 || (state_->must_pay && evaluated > numbers::evaluations_a_change * changes)) break;
    state_->refused.relist_changed();
  }
  budget_ -= std::min(budget_, state_->totals.counts.evaluated - evaluated_before);
  is_limited_ = some_undecided || !state_->waiting.is_empty() || state_->totals.vertices >= state_->context.options.max_vertices;
  return StopCause::finished;
}

/// The poor cells that nothing excuses, in the order of find_poor().
std::vector<Entry<3>> OptimizerRun::find_unexplained() {
  RefineContext<3>& context = state_->context;
  const std::vector<Entry<3>> poor = find_poor();
  std::vector<Entry<3>> unexplained;
  if (poor.empty()) return unexplained;
  OptimizedReasons reasons(context.mesh, context.domain, context.bounds, context.kept, context.meshed, claimed_cosine_);
  for (const Entry<3>& e : poor) {
    if (context.ended()) break;
    const auto found = reasons.of_cells(std::array{e.cell}, PoorReason::Code::not_found, [] { return false; });
    if (!found.empty() && !OptimizedReasons::is_excuse(found.front().reason.code)) unexplained.push_back(e);
  }
  return unexplained;
}

StopCause OptimizerRun::run_for_unexplained() {
  if (state_->refused.take_all().empty() && state_->waiting.is_empty()) return StopCause::finished;
  if (budget_ < numbers::evaluations_a_poor_cell)
    return StopCause::finished;  // to find reasons takes long where many cells are poor
  const std::vector<Entry<3>> unexplained = find_unexplained();
  if (unexplained.empty()) return StopCause::finished;
  state_->waiting.for_each_list([](WorkList<3>& list) { list.drain([](const Entry<3>&) {}); });
  for (const Entry<3>& e : unexplained) state_->waiting.relist(e);
  begin(Phase::rest);
  state_->must_pay = false;
  stage_.most_a_cell = evaluations_an_unexplained_cell;
  return work_off(unexplained.size(), std::min(budget_, evaluations_an_unexplained_cell * unexplained.size()));
}

std::vector<PoorCell> OptimizerRun::explain_left() {
  RefineContext<3>& context = state_->context;
  context.stage = nullptr;
  std::vector<CellId> poor;
  for (const Entry<3>& e : find_poor()) poor.push_back(e.cell);
  OptimizedReasons reasons(context.mesh, context.domain, context.bounds, context.kept, context.meshed, claimed_cosine_);
  const auto otherwise = is_limited_ ? PoorReason::Code::budget : PoorReason::Code::not_found;
  std::vector<PoorCell> left = reasons.of_cells(poor, otherwise, [&context] { return context.ended(); });
  left_ = left.size();
  for (const PoorCell& p : left) unexplained_ += OptimizedReasons::is_excuse(p.reason.code) ? 0 : 1;
  return left;
}

OptimizationStatistics OptimizerRun::statistics() const {
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
