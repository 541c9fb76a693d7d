// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A change keeps the surface within e of the given one S, both ways. New faces are covered by given triangles. For the other way
// let X be the box of the faces that go, grown by e. A point of S outside of it is farther than e from all of these, so that the
// face that it is near stays. A point inside is of a given triangle that is looked at, or whose box meets no grown box of a face
// that goes; then the same holds.
#include <set>

#include "replace/coverage.hpp"
#include "replace/numbers.hpp"
#include "replace/patch_tests.hpp"

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

bool is_near_given(const ChangingSurface& s, const SurfaceChange& change, double e) {
  Cover cover(e);
  for (const SurfaceFace& f : change.come) {
    const auto t = sorted(triangle_after(s.complex, change, f));
    cover.clear();
    s.given.triangles_meeting(Box<3>::of(t).widened(e), f.klass,
                              [&](std::uint32_t g) { cover.add(s.given.triangles()[g].corners); });
    if (!cover.covers(CutPolygon(t), numbers::more_parts, numbers::more_parts_each)) return false;
  }
  return true;
}

bool is_given_near(const ChangingSurface& s, const SurfaceChange& change, double e) {
  const SurfaceComplex& c = s.complex;
  std::set<std::uint32_t> classes;
  Box<3> all = Box<3>::empty();
  std::vector<Box<3>> gone;
  for (const std::uint32_t f : change.gone) {
    classes.insert(c.faces[f].klass);
    gone.push_back(Box<3>::of(c.triangle(f)).widened(e));
    all.add(gone.back());
  }
  for (const std::uint32_t klass : classes) {
    Cover come(e);
    for (const SurfaceFace& f : change.come)
      if (f.klass == klass) come.add(sorted(triangle_after(c, change, f)));
    const auto is_near = [&](std::uint32_t g) {
      const auto& corners = s.given.triangles()[g].corners;
      const Box<3> box = Box<3>::of(corners);
      bool is_asked = false;
      for (std::size_t k = 0; k < gone.size(); ++k)
        is_asked = is_asked || (c.faces[change.gone[k]].klass == klass && gone[k].meets(box));
      if (!is_asked) return true;
      CutPolygon part(corners);
      if (!cut_to_box(part, all)) return false;
      if (part.count == 0 || come.covers(part, numbers::first_parts, numbers::first_parts_each)) return true;
      Cover more(come);
      s.boxes.meeting(Box<3>::of(part.all()).widened(e), [&](std::uint32_t f) {
        if (c.faces[f].klass == klass && !change.is_gone(f)) more.add(sorted(c.triangle(f)));
      });
      return more.covers(part, numbers::more_parts, numbers::more_parts_each);
    };
    bool are_near = true;
    s.given.triangles_meeting(all, klass, [&](std::uint32_t g) { are_near = are_near && is_near(g); });
    if (!are_near) return false;
  }
  return true;
}

}  // namespace pgdr::detail
