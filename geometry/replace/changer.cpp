// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/changer.hpp"

#include <algorithm>

#include "replace/numbers.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

HalfTangent rim_corner() {
  static const HalfTangent corner = half_tangent(numbers::rim_corner);
  return corner;
}
HalfTangent kept_corner() {
  static const HalfTangent corner = half_tangent(numbers::kept_corner);
  return corner;
}
std::size_t level_of(HalfTangent corner, HalfTangent wanted) {
  static const CornerLevels levels;
  return levels.of(corner, wanted);
}

}  // namespace

CornerLevels::CornerLevels() {
  for (HalfTangent t = numbers::flat_corner / 2; t < 1; t *= numbers::level_ratio) least_.push_back(t);
}

std::size_t CornerLevels::of(HalfTangent corner, HalfTangent wanted) const {
  const auto at = std::upper_bound(least_.begin(), least_.end(), std::min(corner, wanted));
  return static_cast<std::size_t>(at - least_.begin());
}

bool Changer::are_corners_fine(const SurfaceChange& change, const ChangeGoal& goal) const {
  const CornerChange c = corners_of(s_.complex, change, rim_corner());
  if (c.kept_come < std::min(c.kept_gone, kept_corner())) return false;
  // Improving, what gets smaller beyond the rim is one of the corners that come: above the worst that goes.
  if (goal.rule == CornerRule::improve) return level_of(c.come, goal.floor) > level_of(c.gone, goal.floor);
  if (!c.is_rim_fine) return false;
  if (goal.rule == CornerRule::coarsen) return c.come >= std::min(c.gone, goal.floor);
  return c.come >= std::min(numbers::split_corner * c.gone, goal.floor) && c.come >= std::min(c.gone, rim_corner()) / 2 &&
         (c.come >= rim_corner() || c.gone < rim_corner());
}

bool Changer::are_edges_short(const SurfaceChange& change) const {
  if (!size_) return true;
  const SurfaceComplex& s = s_.complex;
  for (const SurfaceFace& f : change.come)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = f.corners[i], b = f.corners[(i + 1) % 3];
      const bool is_old = a != change.moved && b != change.moved && !s.faces_of_edge(a, b).empty();
      const Point3 &p = place_after(s, change, a), &q = place_after(s, change, b);
      if (!is_old && distance(p, q) > 2 * std::min(size_(p), size_(q))) return false;
    }
  return true;
}

Verdict Changer::judge(SurfaceChange& change, const ChangeGoal& goal) const {
  const SurfaceComplex& s = s_.complex;
  if (!regroup(s, change) || !are_corners_fine(change, goal)) return Verdict::angle;
  if (!keeps_folds(s, change, numbers::flat_enough)) return Verdict::fold;
  if (!are_edges_short(change)) return Verdict::size;
  if (!is_place_near(s_, change, numbers::farthest_place * tolerance_) || !keeps_curves(s_, change, goal.distance) ||
      !is_near_given(s_, change, goal.distance) || !is_given_near(s_, change, goal.distance))
    return Verdict::distance;
  if (!meets_nothing(s_, change)) return Verdict::meets;
  if (!keeps_gaps(s_, change, numbers::narrow_gap * tolerance_)) return Verdict::gap;
  if (change.kind == SurfaceChange::Kind::split && !avoids_wedges(s_, change)) return Verdict::gap;
  return sweeps_nothing(s_, change) ? Verdict::yes : Verdict::swept;
}

Verdict Changer::attempt(SurfaceChange change, const ChangeGoal& goal) {
  ++attempts_;
  const Verdict verdict = judge(change, goal);
  count(verdict, change.kind);
  if (verdict == Verdict::yes) make(change);
  return verdict;
}

void Changer::count(Verdict verdict, SurfaceChange::Kind kind) {
  using Kind = SurfaceChange::Kind;
  auto& r = report_.refused;
  switch (verdict) {
    case Verdict::angle: ++r.angle; break;
    case Verdict::fold: ++r.fold; break;
    case Verdict::size: ++r.size; break;
    case Verdict::distance: ++r.distance; break;
    case Verdict::meets: ++r.meets; break;
    case Verdict::gap: ++r.gap; break;
    case Verdict::swept: ++r.swept; break;
    case Verdict::yes:
      ++(kind == Kind::contract ? report_.contracted
         : kind == Kind::flip   ? report_.flipped
         : kind == Kind::move   ? report_.moved
                                : report_.split);
  }
}

void Changer::make(const SurfaceChange& change) {
  SurfaceComplex& s = s_.complex;
  for (const std::uint32_t f : change.gone) {
    s.remove_face(f);
    s_.boxes.change(f, Box<3>::empty());
  }
  for (const auto& k : change.kept_gone) s.release(k.ends[0], k.ends[1]);
  if (change.kind == SurfaceChange::Kind::split) {
    s.add_point(change.place, change.kept_come.empty() ? VertexOrder::free : VertexOrder::on_curve);
    touched_.push_back(0);
  } else if (change.moved != no_index) {
    s.points[change.moved] = change.place;
  }
  for (const auto& k : change.kept_come) s.keep(k.ends[0], k.ends[1], k.curve);
  last_.clear();
  for (std::size_t k = 0; k < change.come.size(); ++k) {
    const std::uint32_t f = s.add_face(change.come[k]);
    s_.boxes.add(Box<3>::of(s.triangle(f)), change.from[k]);
    last_.push_back(f);
  }
  for (const std::uint32_t f : last_)
    for (const std::uint32_t v : s.faces[f].corners) ++touched_[v];
}

}  // namespace pgdr::detail
