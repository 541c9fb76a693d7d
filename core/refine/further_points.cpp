// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/further_points.hpp"

#include <algorithm>

#include "refine/encroachment.hpp"
#include "refine/visibility.hpp"

namespace pgdr {

template <int D>
void FurtherPoints<D>::take(const SelectedPoints<D>& selected, const PoorElement<D>& element) {
  points_.assign(selected.begin() + (selected.empty() ? 0 : 1), selected.end());
  center_ = element.circumcenter;
  circumradius_ = element.circumradius;
  least_ = circumradius_ - std::max(element.disk.radius, 0.0);
}

/// Those that are outside of the circumsphere are marked as nowhere: they count as left out if the first goes in.
template <int D>
bool FurtherPoints<D>::look_ahead(CellId c, double least) {
  using Status = typename Cavity<D>::Status;
  constexpr double surely_outside = 1 + 0x1p-10;  // of the rounded circumradius; which keeps NaN and infinity from what follows
  least_ = std::max(least_, least);
  for (Point<D>& p : points_) {
    Status status = Status::not_in_conflict;
    if (squared_distance(p, center_) < surely_outside * circumradius_ * circumradius_) status = w_->cavity.collect(p, c);
    w_->cavity.release();
    if (status == Status::not_owned && !wall_in_claim<D>(*w_, c, p)) return false;
    if (status != Status::ok) p = SelectedPoints<D>::nowhere();
  }
  return true;
}

template <int D>
void FurtherPoints<D>::remember_star() {
  std::erase_if(star_, [this](const Entry<D>& e) { return !w_->alive(e); });
  for (const CellId c : w_->cavity.new_cells()) star_.push_back(w_->entry(c, EntryKind::cell, 0));
}

template <int D>
void FurtherPoints<D>::insert() {
  star_.clear();
  remember_star();
  w_->cavity.release();
  RefineCounts& counts = w_->visit->counts;
  for (const Point<D>& p : points_) {
    const bool went_in = p == p && counts.committed < w_->visit->most_insertions && go_in(p);
    if (went_in) remember_star();
    w_->cavity.release();
    ++(went_in ? counts.selector_further : counts.selector_dropped);
  }
  points_.clear();
}

/// Collects the cavity of the point. @returns whether nothing is in its way
template <int D>
bool FurtherPoints<D>::collect(const Point<D>& p) {
  const auto begin = std::find_if(star_.begin(), star_.end(), [&](const Entry<D>& e) { return w_->mesh.conflicts(e.cell, p); });
  if (begin == star_.end()) return false;
  const CellId seed = begin->cell;
  if (w_->cavity.collect(p, seed) != Cavity<D>::Status::ok) return false;
  return !encroached_entity<D>(w_->context, w_->cavity, p) && !wall_that_hides<D>(*w_, seed, p);
}

template <int D>
bool FurtherPoints<D>::go_in(const Point<D>& p) {
  using Status = typename Cavity<D>::Status;
  Cavity<D>& cavity = w_->cavity;
  w_->mesh.make_room(w_->pools);
  if (!collect(p) || cavity.make_star_shaped() != Status::ok) return false;
  if ((cavity.cut_back() || cavity.touches_constraints()) && cavity.keep_entities() != Status::ok) return false;
  const double r = insertion_radius<D>(w_->mesh, cavity);
  if (!(r >= std::max({least_, w_->context.least_apart, w_->options.min_edge}))) return false;
  inserter_->commit(Home(EntityKind::volume, 0), r);
  return true;
}

template class FurtherPoints<2>;
template class FurtherPoints<3>;

}  // namespace pgdr
