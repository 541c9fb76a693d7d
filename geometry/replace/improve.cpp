// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The worst face is given to the changes that may cure it, one after the other, until one is made. (The idea of a greatest least
// angle, worst first, is that of Hu, Yan, Bommes, Alliez and Benes 2017.) A face for which none is made waits until a face at its
// vertices changes. Last are faces whose corners are as wanted, but with an edge that will get points: for these fewer cells
// expected count. A split cures no corner by itself: the corner stays, at the end of a shorter needle, until a flip, a move or
// a contraction takes it away, which a split may only make possible. So a split is made with what follows from it, as one
// transaction.
#include <algorithm>
#include <optional>
#include <utility>

#include "replace/ahead.hpp"
#include "replace/coarsen.hpp"
#include "replace/numbers.hpp"
#include "space/distances.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

/// A face that waits, by its least corner and its corners.
struct WaitingFace {
  HalfTangent corner;
  std::array<Point3, 3> at;  ///< in the order of coordinates
  std::uint32_t face;
  std::uint32_t touched;  ///< sum of how often its vertices had been
  double key() const { return corner; }
  bool operator<(const WaitingFace& o) const {  // the worst is the top of a queue
    return corner != o.corner ? corner > o.corner : triangle_less(o.at, at);
  }
  bool is_same(const WaitingFace& o) const { return face == o.face && touched == o.touched; }
};

class Improving {
 public:
  Improving(Changer& changer, double distance, HalfTangent wanted, std::uint64_t most_splits, Improved what)
      : changer_(changer),
        s_(changer.complex()),
        goal_{CornerRule::improve, distance, wanted},
        split_goal_{CornerRule::split, distance, wanted},
        splits_left_(most_splits),
        what_(what),
        queue_(changer) {}

  bool run(const std::stop_token& stop) {
    std::uint64_t faces = 0;
    for (std::uint32_t f = 0; f < s_.faces.size(); ++f) {
      if (!s_.faces[f].alive) continue;
      ++faces;
      push(f);
    }
    const auto try_it = [this](const WaitingFace& w, Trial& trial) { return try_face(w, trial); };
    const std::uint64_t most = changer_.attempts() + numbers::effort * faces;
    while (!queue_.empty()) {
      if (stop.stop_requested()) return false;
      if (changer_.attempts() > most) return give_up();
      const WaitingFace w = queue_.pop(try_it);
      if (!is_waiting(w)) continue;
      const Trial trial = queue_.trial(w, try_it);
      const auto first = static_cast<std::uint32_t>(s_.faces.size());
      const bool is_split = trial.change && trial.change->kind == SurfaceChange::Kind::split;
      if (is_split ? !cure(trial) : !changer_.settle(trial)) {
        note_refused(w.face);
        continue;
      }
      push_near(first);
      if (is_waiting(w)) push(w.face);  // a split farther away
    }
    return true;
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  std::uint32_t touched(std::uint32_t f) const {
    const auto& c = s_.faces[f].corners;
    return changer_.touched(c[0]) + changer_.touched(c[1]) + changer_.touched(c[2]);
  }
  /// It is there, and nothing at its vertices has changed.
  bool is_waiting(const WaitingFace& w) const { return s_.faces[w.face].alive && w.touched == touched(w.face); }
  /// A face, if it has a corner that is smaller than wanted, or an edge that will get points and is asked for.
  std::optional<WaitingFace> waiting(std::uint32_t f) const {
    if (s_.is_fixed(f)) return {};
    const HalfTangent corner = least_corner(s_, f);
    const bool is_small = corner < goal_.floor;
    if (!is_small && !(what_ == Improved::corners_and_edges && has_encroached_edge(SurfaceView(s_), f))) return {};
    WaitingFace w{corner, s_.triangle(f), f, touched(f)};
    sort_corners(w.at);
    return w;
  }
  void push(std::uint32_t f) {
    if (const auto w = waiting(f)) queue_.push(*w);
  }
  /// Faces at the vertices of those that have come, from this one on.
  void push_near(std::uint32_t first) {
    std::vector<std::uint32_t> near;
    for (std::uint32_t f = first; f < s_.faces.size(); ++f)
      for (const std::uint32_t v : s_.faces[f].corners) near.insert(near.end(), s_.faces_at[v].begin(), s_.faces_at[v].end());
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t f : near) push(f);
  }

  /// All that has been tried for a face is in vain until a face that it would take away is another one.
  void note_refused(std::uint32_t face) {
    refused_at_.resize(s_.faces.size(), 0);
    refused_at_[face] = s_.births();
  }
  std::uint64_t refused_at(std::uint32_t face) const { return face < refused_at_.size() ? refused_at_[face] : 0; }
  bool is_newer_at(std::uint32_t v, std::uint64_t since) const { return s_.youngest_at(v) > since; }
  /// Is one of the faces at an edge?
  bool is_newer_at(std::uint32_t a, std::uint32_t b, std::uint64_t since) const {
    bool any = false;
    s_.each_face_at(a, b, [&](std::uint32_t f) { any = any || s_.faces[f].born > since; });
    return any;
  }

  bool give_up() {
    std::uint64_t left = 0;
    while (!queue_.empty()) {
      const WaitingFace w = queue_.pop([](const WaitingFace&, Trial&) { return false; });
      left += is_waiting(w) && w.corner < goal_.floor;
    }
    changer_.give_up(left);
    return true;
  }
  /// The vertex that a split has made is not taken back in this round. With the last split trials come to something else.
  void note_split() {
    held_.resize(s_.points.size(), false);
    held_.back() = true;
    if (--splits_left_ == 0) queue_.forget_trials();
  }

  /// A split and what follows from it, as one change: faces that have come are given to the changes that may cure them, worst
  /// first, as long as less may come of it than the surface makes expect now. What has been made up to where it expects least
  /// stays; the rest is taken back. @returns did anything stay?
  bool cure(const Trial& split) {
    const auto first = static_cast<std::uint32_t>(s_.faces.size());
    const auto expected = [&] { return changer_.growth().weighed(numbers::poor_weight); };
    std::vector<WaitingFace> refused;
    std::size_t kept = 0;
    std::uint64_t splits_left = splits_left_;
    std::int64_t least = expected();
    const auto settle = [&](const Trial& trial) {
      if (!changer_.settle(trial)) return false;
      if (trial.change->kind == SurfaceChange::Kind::split) note_split();
      if (expected() >= least) return true;
      least = expected();
      kept = changer_.made();
      splits_left = splits_left_;
      return true;
    };
    changer_.begin_transaction();
    settle(split);
    while (changer_.made() < numbers::most_in_transaction &&
           expected() - may_be_won(first).weighed(numbers::poor_weight) < least) {
      const std::optional<WaitingFace> worst = worst_since(first, refused);
      if (!worst) break;
      Trial trial;
      try_face(*worst, trial);
      if (!settle(trial)) refused.push_back(*worst);
    }
    changer_.end_transaction(kept);
    splits_left_ = splits_left;
    held_.resize(s_.points.size(), false);
    return kept > 0;
  }
  /// What the small corners of faces that have come since make expect, and the edges of those that may wait: more cannot be won
  /// by what follows.
  Expected may_be_won(std::uint32_t first) const {
    const SurfaceView view(s_);
    Expected sum;
    std::vector<SurfaceFace> with_edges;
    for (std::uint32_t f = first; f < s_.faces.size(); ++f) {
      if (!s_.faces[f].alive) continue;
      bool may_wait = what_ == Improved::corners_and_edges;
      for (const std::uint32_t v : s_.faces[f].corners) {
        const Sector corner = sector_at(view, f, v);
        if (!(corner.angle < goal_.floor)) continue;
        sum += expected_of(corner);
        may_wait = true;
      }
      if (may_wait) with_edges.push_back(s_.faces[f]);
    }
    sum += expected_of_edges(view, with_edges);
    return sum;
  }
  /// The worst of these faces that nothing has been tried for in vain.
  std::optional<WaitingFace> worst_since(std::uint32_t first, const std::vector<WaitingFace>& refused) const {
    std::optional<WaitingFace> worst;
    for (std::uint32_t f = first; f < s_.faces.size(); ++f) {
      if (!s_.faces[f].alive) continue;
      const std::optional<WaitingFace> w = waiting(f);
      const bool was_refused = w && std::any_of(refused.begin(), refused.end(), [&](const WaitingFace& r) {
                                 return r.face == w->face && r.touched == w->touched;
                               });
      if (w && !was_refused && (!worst || *worst < *w)) worst = w;
    }
    return worst;
  }

  /// @returns false if it does not wait any more
  bool try_face(const WaitingFace& w, Trial& trial) const {
    if (!is_waiting(w)) return false;
    changer_.read_around(s_.faces[w.face].corners, trial);
    const Corners c = by_opposite_edge(w.face);
    const std::uint64_t since = refused_at(w.face);
    const bool may_contract = is_newer_at(c[1], since) || is_newer_at(c[2], since);
    if ((may_contract && contract_edge(c[1], c[2], trial)) || flip_edges(c, since, trial) || move_corners(c, since, trial))
      return true;
    if (!(w.corner < goal_.floor)) return true;  // a split of an edge that will get a point wins nothing
    if (is_newer_at(c[0], c[1], since) || is_newer_at(c[1], c[2], since) || is_newer_at(c[0], c[2], since))
      split_path(w.face, trial);
    return true;
  }
  /// Its corners, by the lengths of the edges opposite of them, shortest first; of equal ones by their coordinates.
  Corners by_opposite_edge(std::uint32_t f) const {
    Corners c = s_.faces[f].corners;
    const auto square = [&](std::uint32_t v) {
      const auto& all = s_.faces[f].corners;
      const std::uint32_t a = all[0] == v ? all[1] : all[0];
      return squared_distance(s_.at(a), s_.at(corner_beside(all, v, a)));
    };
    std::sort(c.begin(), c.end(), [&](std::uint32_t u, std::uint32_t v) {
      const double p = square(u), q = square(v);
      return p != q ? p < q : lex_less(s_.at(u), s_.at(v));
    });
    return c;
  }

  bool passes(SurfaceChange change, Trial& trial) const {
    return changer_.judge(std::move(change), goal_, trial) == Verdict::yes;
  }
  bool is_held(std::uint32_t v) const { return v < held_.size() && held_[v]; }

  bool contract_edge(std::uint32_t a, std::uint32_t b, Trial& trial) const {
    if (!is_contractible(s_, a, b)) return false;
    if (lex_less(s_.at(b), s_.at(a))) std::swap(a, b);
    const Point3 low = s_.at(a), high = s_.at(b);
    const bool both_free = s_.order[a] == VertexOrder::free && s_.order[b] == VertexOrder::free;
    if (both_free && !is_held(a) && !is_held(b) && put(a, b, on_edge(low, high, 0.5), trial)) return true;
    return (!is_held(a) && put(a, b, high, trial)) || (!is_held(b) && put(b, a, low, trial));
  }
  bool put(std::uint32_t u, std::uint32_t v, const Point3& place, Trial& trial) const {
    auto change = contraction(s_, u, v, place);
    return change && passes(std::move(*change), trial);
  }

  /// The longest edge first.
  bool flip_edges(const Corners& c, std::uint64_t since, Trial& trial) const {
    for (std::size_t k = 3; k-- > 0;) {
      const std::uint32_t a = c[(k + 1) % 3], b = c[(k + 2) % 3];
      if (!is_newer_at(a, b, since)) continue;
      auto change = flip_between(a, b);
      if (change && passes(std::move(*change), trial)) return true;
    }
    return false;
  }
  std::optional<SurfaceChange> flip_between(std::uint32_t a, std::uint32_t b) const {
    return lex_less(s_.at(b), s_.at(a)) ? flip(s_, b, a) : flip(s_, a, b);
  }

  bool move_corners(const Corners& c, std::uint64_t since, Trial& trial) const {
    return std::any_of(c.begin(), c.end(), [&](std::uint32_t v) { return is_newer_at(v, since) && move_corner(v, trial); });
  }
  bool move_corner(std::uint32_t v, Trial& trial) const {
    if (s_.order[v] == VertexOrder::fixed) return false;
    if (s_.order[v] == VertexOrder::on_curve) {
      const auto& kept = s_.kept_at[v];
      const Point3 middle = middle_of(s_.at(kept[0].other), s_.at(kept[1].other));
      return passes(move(s_, v, changer_.given().nearest_on_curve(middle, kept[0].curve)), trial);
    }
    const Point3 from = s_.at(v), to = middle_of_neighbours(v);
    const std::uint32_t klass = s_.faces[s_.faces_at[v].front()].klass;
    for (const double part : {1.0, 0.5, 0.25})
      if (passes(move(s_, v, changer_.given().nearest(on_edge(from, to, part), klass).point), trial)) return true;
    return false;
  }
  static Point3 middle_of(const Point3& a, const Point3& b) { return lex_less(b, a) ? on_edge(b, a, 0.5) : on_edge(a, b, 0.5); }
  Point3 middle_of_neighbours(std::uint32_t v) const {
    std::vector<Point3> around;
    for (const std::uint32_t w : s_.neighbours(v)) around.push_back(s_.at(w));
    std::sort(around.begin(), around.end(), [](const Point3& a, const Point3& b) { return lex_less(a, b); });
    Point3 sum;
    for (const Point3& p : around)
      for (int i = 0; i < 3; ++i) sum[i] += p[i];
    for (int i = 0; i < 3; ++i) sum[i] /= static_cast<double>(around.size());
    return sum;
  }

  /// Splits the longest edge; where that makes a corner of a neighbour too small, first the longest edge of the neighbour.
  bool split_path(std::uint32_t f, Trial& trial) const {
    for (int step = 0; step < numbers::most_path && splits_left_ > 0; ++step) {
      const Corners c = by_opposite_edge(f);
      std::uint32_t a = c[0], b = c[1];
      if (lex_less(s_.at(b), s_.at(a))) std::swap(a, b);
      bool is_fixed = false;
      s_.each_face_at(a, b, [&](std::uint32_t g) { is_fixed = is_fixed || s_.is_fixed(g); });
      if (is_fixed || distance(s_.at(a), s_.at(b)) < numbers::shortest_split * goal_.distance) return false;
      const Verdict verdict = changer_.judge(split(s_, a, b, place_on(a, b)), split_goal_, trial);
      if (verdict == Verdict::yes) return true;
      if (verdict != Verdict::angle || s_.is_kept(a, b)) return false;
      const std::uint32_t g = s_.beyond(f, a, b);
      if (g == no_index || has_longest(g, a, b)) return false;
      f = g;
      changer_.read_around(s_.faces[f].corners, trial);
    }
    return false;
  }
  bool has_longest(std::uint32_t f, std::uint32_t a, std::uint32_t b) const {
    const Corners c = by_opposite_edge(f);
    return (c[0] == a && c[1] == b) || (c[0] == b && c[1] == a);
  }
  Point3 place_on(std::uint32_t a, std::uint32_t b) const {
    const Point3 middle = on_edge(s_.at(a), s_.at(b), 0.5);
    if (const std::uint32_t curve = s_.curve_of(a, b); curve != no_index)
      return s_.curves[curve].is_explicit ? middle : changer_.given().nearest_on_curve(middle, curve);
    bool is_flat = false;
    std::uint32_t klass = 0;
    s_.each_face_at(a, b, [&](std::uint32_t f) {
      is_flat = is_flat || s_.faces[f].group != no_index;
      klass = s_.faces[f].klass;
    });
    return is_flat ? middle : changer_.given().nearest(middle, klass).point;
  }

  Changer& changer_;
  const SurfaceComplex& s_;
  ChangeGoal goal_, split_goal_;
  std::uint64_t splits_left_;
  Improved what_;
  std::vector<bool> held_;                 // vertices that splits have made
  std::vector<std::uint64_t> refused_at_;  // of each face how many had been born when all was refused that was tried for it
  AheadQueue<WaitingFace> queue_;
};

}  // namespace

bool improve(Changer& changer, double distance, HalfTangent wanted, std::uint64_t most_splits, Improved what,
             const std::stop_token& stop) {
  return Improving(changer, distance, wanted, most_splits, what).run(stop);
}

}  // namespace pgdr::detail
