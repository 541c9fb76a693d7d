// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/progress_meter.hpp"

#include <algorithm>
#include <string_view>

namespace pgdr::detail {
namespace {

// Parts of the time before, measured on models of tests and of users, from some thousand cells to a million. The optimiser takes
// 0.3 of the insertions' time in solids that are mostly interior, and 0.7 to 4 of it where most cells are at facets.
constexpr double optimizer_of_interior = 0.3, more_at_facets = 2;
constexpr double rest_after_all = 0.15, rest_after_reasons = 0.08;
constexpr double least_known = 0.005;  // of the cells: before, one cannot tell how fast the insertions are
constexpr double between_looks = 0.03, least_optimizing = 0.05;  // seconds
constexpr double unknown = -1;

}  // namespace

template <int D>
ProgressMeter<D>::ProgressMeter(RefineContext<D>& context, const WaitingWork<D>& waiting)
    : context_(&context), waiting_(&waiting) {
  context.remaining = [this] { return remaining(); };
}

template <int D>
void ProgressMeter<D>::expect(double cells, bool optimizes) {
  expected_cells_ = cells;
  optimizes_ = optimizes;
}

template <int D>
void ProgressMeter<D>::begin(const char* stage) {
  context_->at = stage;
  if (!context_->options.progress) return;
  const std::string_view name = stage;
  if (name == "insert" && insertions_since_ < 0) {
    insertions_since_ = seconds();
    first_cells_ = context_->mesh.cell_bound();
    look();
  }
  if (name == "reasons") rest_ = rest_after_all * seconds();
  if (name == "number") rest_ = rest_after_reasons * seconds();
  context_->tell(context_->vertices, 0);
}

template <int D>
void ProgressMeter<D>::begin_phase(double evaluations, double others) {
  const std::uint64_t evaluated = context_->evaluated;
  if (optimizing_since_ < 0) {
    optimizing_since_ = seconds();
    evaluated_before_ = evaluated;
  }
  evaluated_at_phase_ = evaluated;
  of_phase_ = evaluations;
  others_ = others;
}

template <int D>
void ProgressMeter<D>::look() {
  if (!context_->options.progress || context_->stage || seconds() < next_look_) return;
  next_look_ = seconds() + between_looks;
  all_cells_ = std::max(expected_cells_, context_->mesh.cell_bound() + waiting_->cells_to_come());
}

/// Seconds that remain of the run; below 0: nobody knows. Any thread.
template <int D>
double ProgressMeter<D>::remaining() const {
  if (rest_ >= 0) return rest_;
  return context_->stage ? of_optimizer() : of_insertions();
}

template <int D>
double ProgressMeter<D>::of_insertions() const {
  if (insertions_since_ < 0) return unknown;
  const double cells = context_->mesh.cell_bound(), so_far = seconds();
  const double share = (cells - first_cells_) / std::max({all_cells_ - first_cells_, cells - first_cells_, 1.0});
  if (!(share > least_known)) return unknown;
  const double insertions = (so_far - insertions_since_) / share;
  const double at_facets = std::min(context_->mesh.constraint_bound() / cells, 1.0);
  const double optimizer = optimizes_ ? optimizer_of_interior + more_at_facets * at_facets : 0;
  const double before_rest = insertions_since_ + insertions * (1 + optimizer);
  return (1 + rest_after_all) * before_rest - so_far;
}

template <int D>
double ProgressMeter<D>::of_optimizer() const {
  const std::uint64_t evaluated = context_->evaluated;
  const double so_far = seconds(), optimizing = so_far - optimizing_since_;
  if (optimizing_since_ < 0 || optimizing < least_optimizing || evaluated <= evaluated_before_) return unknown;
  const double left_of_phase = of_phase_ - static_cast<double>(evaluated - std::min(evaluated, evaluated_at_phase_));
  const double to_come = std::max(left_of_phase, 0.1 * of_phase_) + others_ * of_phase_;
  const double all = so_far + to_come * optimizing / static_cast<double>(evaluated - evaluated_before_);
  return (1 + rest_after_all) * all - so_far;
}

template class ProgressMeter<2>;
template class ProgressMeter<3>;

}  // namespace pgdr::detail
