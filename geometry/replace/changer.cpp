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
/// A split that was judged before others were made gets the number that is next now.
void number_new_vertex(SurfaceChange& change, std::uint32_t number) {
  const auto renumber = [&](std::uint32_t& v) {
    if (v == change.moved) v = number;
  };
  for (SurfaceFace& f : change.come) std::for_each(f.corners.begin(), f.corners.end(), renumber);
  for (auto& k : change.kept_come) std::for_each(k.ends.begin(), k.ends.end(), renumber);
  change.moved = number;
}

}  // namespace

CornerLevels::CornerLevels() {
  for (HalfTangent t = numbers::flat_corner / 2; t < 1; t *= numbers::level_ratio) least_.push_back(t);
}

std::size_t CornerLevels::of(HalfTangent corner, HalfTangent wanted) const {
  const auto at = std::upper_bound(least_.begin(), least_.end(), std::min(corner, wanted));
  return static_cast<std::size_t>(at - least_.begin());
}

const Expected& Changer::growth_of(const SurfaceChange& change, Trial& trial) const {
  if (!trial.growth) trial.growth = expected_growth(s_.complex, change);
  return *trial.growth;
}

bool Changer::are_corners_fine(const SurfaceChange& change, const ChangeGoal& goal, Trial& trial) const {
  const CornerChange c = corners_of(s_.complex, change, rim_corner());
  if (c.kept_come < std::min(c.kept_gone, kept_corner())) return false;
  if (goal.rule == CornerRule::improve) {
    const std::size_t gone = level_of(c.gone, goal.floor), come = level_of(c.come, goal.floor);
    if (gone < level_of(wide_corner, goal.floor)) return come > gone;
    return come == gone && level_of(c.rim, goal.floor) == gone && growth_of(change, trial).cells < 0;
  }
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

Verdict Changer::verdict_of(SurfaceChange& change, const ChangeGoal& goal, Trial& trial) const {
  const SurfaceComplex& s = s_.complex;
  trial.growth.reset();
  if (!regroup(s, change, trial.read) || !are_corners_fine(change, goal, trial)) return Verdict::angle;
  if (!keeps_folds(s, change, numbers::flat_enough)) return Verdict::fold;
  if (goal.rule == CornerRule::coarsen && growth_of(change, trial).cells > numbers::parts_of_cell * numbers::cells_of_two_faces)
    return Verdict::cells;
  if (!are_edges_short(change)) return Verdict::size;
  if (!is_place_near(s_, change, numbers::farthest_place * tolerance_) || !keeps_curves(s_, change, goal.distance) ||
      !keeps_distance(s_, change, goal.distance))
    return Verdict::distance;
  if (!meets_nothing(s_, change)) return Verdict::meets;
  if (!keeps_gaps(s_, change, numbers::narrow_gap * tolerance_)) return Verdict::gap;
  if (change.kind == SurfaceChange::Kind::split && !avoids_wedges(s_, change)) return Verdict::gap;
  return sweeps_nothing(s_, change) ? Verdict::yes : Verdict::swept;
}

Verdict Changer::judge(SurfaceChange change, const ChangeGoal& goal, Trial& trial) const {
  if (trial.ahead_of && change.kind == SurfaceChange::Kind::split) {
    // Wedges are looked for as far as half of the heights of the faces at the edge, which is less than their box is long.
    Box<3> box = Box<3>::empty();
    for (const std::uint32_t f : change.gone) box.add(s_.boxes[f]);
    trial.read.add(Box<3>::around(change.place).widened(box.longest_side()));
  }
  const Verdict verdict = verdict_of(change, goal, trial);
  if (verdict == Verdict::yes) {
    growth_of(change, trial);
    trial.change = std::move(change);
  } else {
    trial.refused.push_back(verdict);
  }
  return verdict;
}

void Changer::read_around(std::span<const std::uint32_t> vertices, Trial& trial) const {
  if (!trial.ahead_of) return;
  // Beyond the faces at the neighbours, coverage looks for faces twice as far as the distance, which is E at most, from what
  // goes; what comes is no farther than `farthest_place`, and gaps are looked for beyond that.
  constexpr double margin = std::max(2.01, numbers::farthest_place + 2 * numbers::narrow_gap);
  const SurfaceComplex& s = s_.complex;
  Box<3> box = Box<3>::empty();
  const auto add_faces_at = [&](std::uint32_t v) {
    for (const std::uint32_t f : s.faces_at[v]) box.add(s_.boxes[f]);
  };
  const auto is_one = [&](std::uint32_t w) { return std::find(vertices.begin(), vertices.end(), w) != vertices.end(); };
  for (const std::uint32_t v : vertices) {
    add_faces_at(v);
    for (const std::uint32_t f : s.faces_at[v])
      for (const std::uint32_t w : s.faces[f].corners)
        if (!is_one(w)) add_faces_at(w);
  }
  trial.read.add(box.widened(margin * tolerance_));
}

bool Changer::settle(const Trial& trial) {
  attempts_ += trial.refused.size() + (trial.change ? 1 : 0);
  for (const Verdict verdict : trial.refused) count_refused(verdict);
  if (!trial.change) return false;
  count_made(trial.change->kind);
  SurfaceChange change = *trial.change;
  if (change.kind == SurfaceChange::Kind::split) number_new_vertex(change, static_cast<std::uint32_t>(touched_.size()));
  if (is_transaction_) note(change);
  growth_ += *trial.growth;
  make(change);
  return true;
}

void Changer::note(const SurfaceChange& change) {
  const SurfaceComplex& s = s_.complex;
  const bool moves = change.moved != no_index && change.kind != SurfaceChange::Kind::split;
  made_.push_back({change, moves ? s.at(change.moved) : Point3{}, growth_});
}

void Changer::end_transaction(std::size_t kept) {
  if (kept == 0) count_refused(Verdict::cells);
  while (made_.size() > kept) take_back_last();
  is_transaction_ = false;
}

/// What `make` has done, the other way round.
void Changer::take_back_last() {
  SurfaceComplex& s = s_.complex;
  const SurfaceChange& change = made_.back().change;
  const auto first = static_cast<std::uint32_t>(s.faces.size() - change.come.size());
  for (std::uint32_t f = first; f < s.faces.size(); ++f)
    for (const std::uint32_t v : s.faces[f].corners) --touched_[v];
  const bool is_split = change.kind == SurfaceChange::Kind::split;
  if (!is_split && change.moved != no_index) s.points[change.moved] = made_.back().from;
  for (const std::uint32_t f : change.gone) {
    s.put_back_face(f);
    s_.boxes.put_back(f, Box<3>::of(s.triangle(f)), first);
  }
  for (std::size_t k = 0; k < change.come.size(); ++k) {
    s.drop_last_face();
    s_.boxes.remove_last();
  }
  for (const auto& k : change.kept_come) s.release(k.ends[0], k.ends[1]);
  for (const auto& k : change.kept_gone) s.keep(k.ends[0], k.ends[1], k.curve);
  if (is_split) {
    s.drop_last_point();
    touched_.pop_back();
  }
  count_made(change.kind, true);
  growth_ = made_.back().growth;
  last_.clear();
  made_.pop_back();
}

void Changer::count_refused(Verdict verdict) {
  auto& r = report_.refused;
  switch (verdict) {
    case Verdict::angle: ++r.angle; break;
    case Verdict::fold: ++r.fold; break;
    case Verdict::cells: ++r.cells; break;
    case Verdict::size: ++r.size; break;
    case Verdict::distance: ++r.distance; break;
    case Verdict::meets: ++r.meets; break;
    case Verdict::gap: ++r.gap; break;
    case Verdict::swept: ++r.swept; break;
    case Verdict::yes: break;
  }
}

void Changer::count_made(SurfaceChange::Kind kind, bool is_taken_back) {
  using Kind = SurfaceChange::Kind;
  auto& count = kind == Kind::contract ? report_.contracted
                : kind == Kind::flip   ? report_.flipped
                : kind == Kind::move   ? report_.moved
                                       : report_.split;
  is_taken_back ? --count : ++count;
}

void Changer::make(const SurfaceChange& change) {
  SurfaceComplex& s = s_.complex;
  Box<3> changed = Box<3>::empty();
  for (const std::uint32_t f : change.gone) {
    changed.add(s_.boxes[f]);
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
    const Box<3> box = Box<3>::of(s.triangle(f));
    changed.add(box);
    s_.boxes.add(box, change.from[k]);
    last_.push_back(f);
  }
  changed_.push_back(changed);
  for (const std::uint32_t f : last_)
    for (const std::uint32_t v : s.faces[f].corners) ++touched_[v];
}

}  // namespace pgdr::detail
