// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/progress_meter.hpp"

#include <algorithm>
#include <string_view>

namespace pgdr::detail {
namespace {

// Parts of the time before, measured on models of tests and of users, from some thousand cells to a million. The optimiser takes
// 0.3 of the insertions' time in solids that are mostly interior, and 0.7 to 4 of it where most cells are at facets.
constexpr double optimizer_of_interior = 0.3, more_at_facets = 2;
constexpr double rest_after_all = 0.15, rest_after_reasons = 0.08;
constexpr double least_known = 0.005;  // of the vertices: before, one cannot tell how fast the insertions are
constexpr double between_looks = 0.03, least_optimizing = 0.05;  // seconds
constexpr double unknown = -1;

/// In a mesh that is mostly interior; the slots of cells tell less, as many are free after the exterior was carved away.
template <int D>
constexpr double cells_a_vertex = D == 3 ? 5 : 2;

}  // namespace

template <int D>
ProgressMeter<D>::ProgressMeter(RefineContext<D>& context, const WaitingWork<D>& waiting)
    : context_(&context), waiting_(&waiting) {
  context.remaining = [this] { return remaining(); };
}

template <int D>
void ProgressMeter<D>::begin(const char* stage) {
  context_->at = stage;
  if (!context_->options.progress) return;
  const std::string_view name = stage;
  if (name == "insert" && insertions_since_ < 0) {
    insertions_since_ = seconds();
    first_vertices_ = static_cast<double>(context_->vertices);
    update();
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
  phase_since_ = seconds();
  evaluated_at_phase_ = evaluated;
  of_phase_ = evaluations;
  others_ = others;
}

template <int D>
void ProgressMeter<D>::update() {
  if (!context_->options.progress || context_->stage || seconds() < next_look_) return;
  next_look_ = seconds() + between_looks;
  const auto to_come = waiting_->to_come();
  is_by_size_ = is_by_size_ || to_come.by_size > to_come.waiting;
  if (is_by_size_)
    all_vertices_ = static_cast<double>(context_->vertices) + (to_come.by_size + to_come.waiting) / cells_a_vertex<D>;
}

/// Seconds that remain of the run; below 0: nobody knows. Any thread.
template <int D>
double ProgressMeter<D>::remaining() const {
  if (rest_ >= 0) return rest_;
  return context_->stage ? of_optimizer() : of_insertions();
}

template <int D>
double ProgressMeter<D>::of_insertions() const {
  if (insertions_since_ < 0 || !(all_vertices_ > 0)) return unknown;
  const double vertices = static_cast<double>(context_->vertices), so_far = seconds(), made = vertices - first_vertices_;
  const double share = made / std::max({all_vertices_ - first_vertices_, made, 1.0});
  if (!(share > least_known)) return unknown;
  const double insertions = (so_far - insertions_since_) / share;
  const double at_facets = std::min(context_->mesh.constraint_bound() / (cells_a_vertex<D> * vertices), 1.0);
  const double optimizer = optimizes_ ? optimizer_of_interior + more_at_facets * at_facets : 0;
  const double before_rest = insertions_since_ + insertions * (1 + optimizer);
  return (1 + rest_after_all) * before_rest - so_far;
}

template <int D>
double ProgressMeter<D>::of_optimizer() const {
  constexpr double least_part = 0.1;  // of what a phase evaluates: so much tells how fast it is; and so much is always to come
  const double so_far = seconds(), evaluated = static_cast<double>(context_->evaluated);
  const double in_phase = evaluated - static_cast<double>(evaluated_at_phase_);
  const bool is_phase_known = in_phase > least_part * of_phase_;
  const double since = is_phase_known ? phase_since_ : optimizing_since_;
  const double done_since = is_phase_known ? in_phase : evaluated - static_cast<double>(evaluated_before_);
  if (optimizing_since_ < 0 || so_far - since < least_optimizing || !(done_since > 0)) return unknown;
  const double to_come = std::max(of_phase_ - in_phase, least_part * of_phase_) + others_ * of_phase_;
  const double all = so_far + to_come * (so_far - since) / done_since;
  return (1 + rest_after_all) * all - so_far;
}

template class ProgressMeter<2>;
template class ProgressMeter<3>;

}  // namespace pgdr::detail
