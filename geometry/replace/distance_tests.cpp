// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A change keeps the surface within e of the given one S, both ways. New faces are covered by given triangles. For the other way
// let X be the box of the faces that go, grown by e. A point of S outside of it is farther than e from all of these, so that the
// face that it is near stays. A point inside is of a given triangle that is looked at, or whose box meets no grown box of a face
// that goes; then the same holds.
#include <map>
#include <set>

#include "replace/coverage.hpp"
#include "replace/height_proof.hpp"
#include "replace/numbers.hpp"
#include "replace/patch_tests.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

using Kept = SurfaceChange::Kept;

Box<3> box_of(const Point3& a, const Point3& b) {
  Box<3> box = Box<3>::around(a);
  box.add(b);
  return box;
}

std::array<Point3, 3> sorted(std::array<Point3, 3> t) {
  sort_corners(t);
  return t;
}

/// The part of a segment in a box; false if none is.
bool cut_to_box(Point3& a, Point3& b, const Box<3>& box) {
  double from = 0, to = 1;
  for (int i = 0; i < 3; ++i) {
    const double along = b[i] - a[i];
    if (along == 0) {
      if (a[i] < box.low[i] || a[i] > box.high[i]) return false;
      continue;
    }
    const double s = (box.low[i] - a[i]) / along, t = (box.high[i] - a[i]) / along;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  if (from > to) return false;
  const Point3 start = a;
  const auto at = [&](double t) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = start[i] + t * (b[i] - start[i]);
    return p;
  };
  const Point3 p = at(from), q = at(to);
  a = p;
  b = q;
  return true;
}

/// Edges of a curve that stay, from the ends of those that go or come on, as long as they meet the box.
void add_staying(const ChangingSurface& s, const SurfaceChange& change, std::uint32_t curve, const Box<3>& box,
                 SegmentCover& cover) {
  const SurfaceComplex& c = s.complex;
  const auto is_gone = [&](std::uint32_t a, std::uint32_t b) {
    return std::any_of(change.kept_gone.begin(), change.kept_gone.end(),
                       [&](const Kept& k) { return (k.ends[0] == a && k.ends[1] == b) || (k.ends[0] == b && k.ends[1] == a); });
  };
  std::set<std::array<std::uint32_t, 2>> seen;
  std::vector<std::uint32_t> stack;
  for (const Kept& k : change.kept_gone) stack.insert(stack.end(), k.ends.begin(), k.ends.end());
  while (!stack.empty()) {
    const std::uint32_t v = stack.back();
    stack.pop_back();
    for (const KeptEdge& e : c.kept_at[v]) {
      if (e.curve != curve || is_gone(v, e.other) || !box_of(c.at(v), c.at(e.other)).meets(box)) continue;
      if (!seen.insert({std::min(v, e.other), std::max(v, e.other)}).second) continue;
      cover.add(c.at(v), c.at(e.other));
      stack.push_back(e.other);
    }
  }
}

bool is_curve_near(const ChangingSurface& s, const SurfaceChange& change, std::uint32_t curve, double e) {
  const SurfaceComplex& c = s.complex;
  const auto end = [&](const Kept& k, std::size_t i) { return place_after(c, change, k.ends[i]); };
  SegmentCover given(e), now(e);
  for (const Kept& k : change.kept_come) {
    if (k.curve != curve) continue;
    given.clear();
    s.given.segments_meeting(box_of(end(k, 0), end(k, 1)).widened(e), curve,
                             [&](const GivenSurface::Segment& g) { given.add(g.ends[0], g.ends[1]); });
    if (!given.covers(end(k, 0), end(k, 1))) return false;
    now.add(end(k, 0), end(k, 1));
  }
  Box<3> all = Box<3>::empty();
  for (const Kept& k : change.kept_gone)
    if (k.curve == curve) all.add(box_of(c.at(k.ends[0]), c.at(k.ends[1])).widened(e));
  add_staying(s, change, curve, all, now);
  bool is_near = true;
  s.given.segments_meeting(all, curve, [&](const GivenSurface::Segment& g) {
    Point3 a = g.ends[0], b = g.ends[1];
    is_near = is_near && (!cut_to_box(a, b, all) || now.covers(a, b));
  });
  return is_near;
}

}  // namespace

bool keeps_curves(const ChangingSurface& s, const SurfaceChange& change, double e) {
  std::set<std::uint32_t> curves;
  for (const Kept& k : change.kept_gone) curves.insert(k.curve);
  return std::all_of(curves.begin(), curves.end(), [&](std::uint32_t curve) { return is_curve_near(s, change, curve, e); });
}

namespace {

/// The centre of a triangle and the middles of its edges.
std::array<Point3, 4> samples_of(const std::array<Point3, 3>& t) {
  Point3 centre;
  for (int i = 0; i < 3; ++i) centre[i] = (t[0][i] + t[1][i] + t[2][i]) / 3;
  return {centre, on_edge(t[0], t[1], 0.5), on_edge(t[1], t[2], 0.5), on_edge(t[0], t[2], 0.5)};
}

/// Covers faces that come by given triangles of their classes, where HeightProof shows nothing.
class FaceCover {
 public:
  FaceCover(const ChangingSurface& s, const SurfaceChange& change, double e, std::span<const NearGiven> given)
      : s_(s), change_(change), given_(given), cover_(e), e_(e) {}

  /// Is there a given triangle of this class within e of a point?
  bool reaches(const Point3& p, std::uint32_t klass) const {
    return std::any_of(given_.begin(), given_.end(), [&](const NearGiven& near) {
      if (near.box.squared_distance_to(p) > e_ * e_) return false;
      const GivenSurface::Triangle& t = s_.given.triangles()[near.number];
      return t.klass == klass && closest_to_triangle(p, t.corners[0], t.corners[1], t.corners[2]).square <= e_ * e_;
    });
  }
  bool covers(const SurfaceFace& f) {
    const auto t = sorted(triangle_after(s_.complex, change_, f));
    find_near(Box<3>::of(t), f.klass);
    // One point that is farther from all proves a no, mostly before anything is cut.
    for (const Point3& p : samples_of(t))
      if (!cover_.reaches(p, near_)) return false;
    const Box<3> box = Box<3>::of(t).widened(e_);
    cover_.use(near_, [&](std::uint32_t i) { return cover_.box(i).meets(box); });
    return cover_.covers(CutPolygon(t), numbers::more_parts, numbers::more_parts_each);
  }

 private:
  void find_near(const Box<3>& box, std::uint32_t klass) {
    if (cover_.size() == 0)
      for (const NearGiven& g : given_) cover_.add(s_.given.triangles()[g.number].corners);
    const Box<3> reach = cover_.with_margin(box);
    near_.clear();
    for (std::uint32_t i = 0; i < given_.size(); ++i)
      if (s_.given.triangles()[given_[i].number].klass == klass && cover_.box(i).meets(reach)) near_.push_back(i);
  }

  const ChangingSurface& s_;
  const SurfaceChange& change_;
  std::span<const NearGiven> given_;
  Cover cover_;  // the given ones, once one is asked for
  double e_;
  std::vector<std::uint32_t> near_;
};

/// Is each face that comes within e of the given triangles of its class?
bool are_faces_near(const SurfaceChange& change, HeightProof& proof, FaceCover cover) {
  std::vector<std::size_t> left;
  for (const std::size_t k : proof.longest_first()) {
    if (proof.shows_face(k)) continue;
    if (proof.far_point() && !cover.reaches(*proof.far_point(), change.come[k].klass)) return false;
    left.push_back(k);
  }
  return std::all_of(left.begin(), left.end(), [&](std::size_t k) { return cover.covers(change.come[k]); });
}

/// Covers given triangles of one class by faces that come, or by these and those that stay.
class GivenCover {
 public:
  /// @param all  the box of the faces that go, grown by e
  GivenCover(const ChangingSurface& s, const SurfaceChange& change, double e, std::uint32_t klass, const Box<3>& all)
      : s_(s), change_(change), e_(e), klass_(klass), all_(all), cover_(e) {
    for (const SurfaceFace& f : change.come)
      if (f.klass == klass) cover_.add(sorted(triangle_after(s.complex, change, f)));
    come_ = static_cast<std::uint32_t>(cover_.size());
  }

  bool covers(const std::array<Point3, 3>& given) {
    if (cover_.has_one_near(given, cover_.between(0, come_))) return true;
    find_staying();
    const auto come = cover_.between(0, come_), staying = cover_.between(come_, cover_.size());
    if (cover_.has_one_near(given, staying)) return true;
    CutPolygon part(given);
    if (!cut_to_box(part, all_)) return false;
    const auto corners = part.all();
    if (corners.empty()) return true;
    const bool may_come_alone = std::all_of(corners.begin(), corners.end(),
                                            [&](const Point3& p) { return cover_.reaches(p, come); });
    if (may_come_alone) {
      cover_.use(come, [](std::uint32_t) { return true; });
      if (cover_.covers(part, numbers::first_parts, numbers::first_parts_each)) return true;
    }
    const Box<3> box = Box<3>::of(corners).widened(e_);
    cover_.use(cover_.between(0, cover_.size()), [&](std::uint32_t t) { return t < come_ || cover_.box(t).meets(box); });
    return cover_.covers(part, numbers::more_parts, numbers::more_parts_each);
  }

 private:
  void find_staying() {
    if (has_staying_) return;
    has_staying_ = true;
    constexpr double with_rounding = 1.001;  // what is cut to the box may be off it by some ulps
    s_.boxes.meeting(all_.widened(with_rounding * e_), [&](std::uint32_t f) {
      if (s_.complex.faces[f].klass == klass_ && !change_.is_gone(f)) cover_.add(sorted(s_.complex.triangle(f)));
    });
  }

  const ChangingSurface& s_;
  const SurfaceChange& change_;
  double e_;
  std::uint32_t klass_;
  Box<3> all_;
  Cover cover_;  // faces that come, then, once they are looked for, those that stay
  std::uint32_t come_ = 0;
  bool has_staying_ = false;
};

}  // namespace

bool keeps_distance(const ChangingSurface& s, const SurfaceChange& change, double e) {
  const SurfaceComplex& c = s.complex;
  Box<3> near = Box<3>::empty();
  std::vector<Box<3>> gone;
  for (const std::uint32_t f : change.gone) {
    gone.push_back(Box<3>::of(c.triangle(f)).widened(e));
    near.add(gone.back());
  }
  Box<3> all = near;
  for (const SurfaceFace& f : change.come) all.add(Box<3>::of(triangle_after(c, change, f)).widened(e));
  std::vector<NearGiven> given;
  s.given.triangles_meeting(all, [&](std::uint32_t g, const Box<3>& box) { given.push_back({g, box}); });
  HeightProof proof(s, change, e, given, near);
  if (!are_faces_near(change, proof, FaceCover(s, change, e, given))) return false;
  std::map<std::uint32_t, GivenCover> covers;  // by class
  const auto is_asked = [&](std::size_t place, std::uint32_t klass) {
    for (std::size_t k = 0; k < gone.size(); ++k)
      if (gone[k].meets(given[place].box) && c.faces[change.gone[k]].klass == klass && proof.may_be_near(k, place)) return true;
    return false;
  };
  // Those over faces that come lead to the faces beyond, which others are over.
  for (const bool is_over : {true, false})
    for (std::size_t place = 0; place < given.size(); ++place) {
      if (proof.is_over_face(place) != is_over) continue;
      const GivenSurface::Triangle& t = s.given.triangles()[given[place].number];
      if (!is_asked(place, t.klass) || proof.shows_given(place)) continue;
      if (!covers.try_emplace(t.klass, s, change, e, t.klass, near).first->second.covers(t.corners)) return false;
    }
  return true;
}

}  // namespace pgdr::detail
