// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/given_surface.hpp"

#include <algorithm>
#include <limits>

#include "replace/shape.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

std::vector<GivenSurface::Triangle> triangles_of(const SurfaceComplex& s) {
  std::vector<std::uint32_t> number(s.faces.size());
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < s.faces.size(); ++f)
    if (s.faces[f].alive) number[f] = count++;
  const SurfaceView view(s);
  std::vector<GivenSurface::Triangle> out;
  out.reserve(count);
  for (std::uint32_t f = 0; f < s.faces.size(); ++f) {
    if (!s.faces[f].alive) continue;
    auto c = s.faces[f].corners;
    std::sort(c.begin(), c.end(), [&](std::uint32_t a, std::uint32_t b) { return lex_less(s.at(a), s.at(b)); });
    GivenSurface::Triangle t{{s.at(c[0]), s.at(c[1]), s.at(c[2])}, s.faces[f].klass};
    for (std::size_t i = 0; i < 3; ++i)
      if (const std::uint32_t other = view.only_other(f, c[i], c[(i + 1) % 3]); other != no_index) t.beyond[i] = number[other];
    out.push_back(t);
  }
  return out;
}

std::vector<GivenSurface::Segment> segments_of(const SurfaceComplex& s) {
  std::vector<GivenSurface::Segment> out;
  for (std::uint32_t v = 0; v < s.points.size(); ++v)
    for (const KeptEdge& e : s.kept_at[v])
      if (lex_less(s.at(v), s.at(e.other))) out.push_back({{s.at(v), s.at(e.other)}, e.curve});
  return out;
}

template <class Items, class Corners>
std::vector<Box<3>> boxes_of(const Items& items, const Corners& corners) {
  std::vector<Box<3>> out;
  for (const auto& item : items) out.push_back(Box<3>::of(corners(item)));
  return out;
}

}  // namespace

GivenSurface::GivenSurface(const SurfaceComplex& surface)
    : triangles_(triangles_of(surface)),
      segments_(segments_of(surface)),
      triangle_tree_(boxes_of(triangles_, [](const Triangle& t) { return std::span<const Point3>(t.corners); }),
                     TreeCut::at_medians),
      segment_tree_(boxes_of(segments_, [](const Segment& s) { return std::span<const Point3>(s.ends); }), TreeCut::at_medians) {}

GivenSurface::Nearest GivenSurface::nearest(const Point3& x, std::uint32_t klass) const {
  Nearest best{no_index, x, std::numeric_limits<double>::infinity()};
  const auto bound = [&x](const Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); };
  triangle_tree_.nearest(bound, [&](std::uint32_t i) {
    const Triangle& t = triangles_[i];
    if (t.klass != klass) return best.square;
    const auto c = closest_to_triangle(x, t.corners[0], t.corners[1], t.corners[2]);
    const bool is_tie = c.square == best.square && best.triangle != no_index;
    if (c.square < best.square || (is_tie && triangle_less(t.corners, triangles_[best.triangle].corners)))
      best = {i, c.points[1], c.square};
    return best.square;
  });
  return best;
}

Point3 GivenSurface::nearest_on_curve(const Point3& x, std::uint32_t curve) const {
  Point3 best = x;
  double least = std::numeric_limits<double>::infinity();
  const auto bound = [&x](const Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); };
  segment_tree_.nearest(bound, [&](std::uint32_t i) {
    const Segment& s = segments_[i];
    if (s.curve != curve) return least;
    const auto c = closest_to_edge(x, s.ends[0], s.ends[1]);
    if (c.square < least || (c.square == least && lex_less(c.points[1], best))) {
      least = c.square;
      best = c.points[1];
    }
    return least;
  });
  return best;
}

}  // namespace pgdr::detail
