// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "space/distances.hpp"
#include "space/make_set.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

/// The angle at p, as cosine and sine times a length.
std::array<double, 2> turn_at(const Point3& p, const Point3& a, const Point3& b) {
  const auto u = difference(a, p), v = difference(b, p);
  const auto n = cross(u, v);
  return {dot(u, v), std::sqrt(dot(n, n))};
}

HalfTangent half_tangent_of(const std::array<double, 2>& turn) {
  const double sum = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1]) + turn[0];
  return sum > 0 ? turn[1] / sum : turn[1] > 0 || turn[0] < 0 ? wide_corner : 0.0;
}

/// Sums angles until they are 180 degrees or more.
class AngleSum {
 public:
  void add(const std::array<double, 2>& turn) {
    const double length = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1]);
    if (!(length > 0)) return;
    const double c = turn[0] / length, s = turn[1] / length;
    const double sum_c = cosine_ * c - sine_ * s, sum_s = sine_ * c + cosine_ * s;
    if (sum_s < 0 || (sum_s == 0 && sum_c < 0)) is_wide_ = true;
    cosine_ = sum_c;
    sine_ = sum_s;
  }
  HalfTangent value() const { return is_wide_ ? wide_corner : half_tangent_of({cosine_, sine_}); }

 private:
  double cosine_ = 1, sine_ = 0;
  bool is_wide_ = false;
};

struct Corner {
  std::uint32_t a, b;  ///< the other two vertices of a face
};
Corner corner_at(const SurfaceFace& f, std::uint32_t v) {
  const auto& c = f.corners;
  return c[0] == v ? Corner{c[1], c[2]} : c[1] == v ? Corner{c[2], c[0]} : Corner{c[0], c[1]};
}

}  // namespace

HalfTangent half_tangent(double degrees) {
  const double c = claimed_cosine(degrees);
  return c > -1 ? std::sqrt((1 - c) * (1 + c)) / (1 + c) : wide_corner;
}

double degrees_of(HalfTangent t) { return 360 / std::numbers::pi * std::atan(t); }

PatchIndex::PatchIndex(const SurfaceChange& change) : gone_(change.gone) {
  std::sort(gone_.begin(), gone_.end());
  std::vector<std::array<std::uint32_t, 2>> all;  // vertex, face
  for (std::uint32_t k = 0; k < change.come.size(); ++k)
    for (const std::uint32_t v : change.come[k].corners) all.push_back({v, k});
  std::sort(all.begin(), all.end());
  for (const auto& [vertex, face] : all) {
    vertices_.push_back(vertex);
    come_.push_back(face);
  }
}

std::span<const std::uint32_t> PatchIndex::come_at(std::uint32_t v) const {
  const auto first = std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin();
  const auto last = std::upper_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin();
  return std::span(come_).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first));
}

bool SurfaceView::is_kept(std::uint32_t a, std::uint32_t b) const {
  if (after_) {
    const auto has = [&](const std::vector<SurfaceChange::Kept>& list) {
      return std::any_of(list.begin(), list.end(), [&](const SurfaceChange::Kept& k) {
        return (k.ends[0] == a && k.ends[1] == b) || (k.ends[0] == b && k.ends[1] == a);
      });
    };
    if (has(after_->kept_come)) return true;
    if (has(after_->kept_gone) || a >= s_.points.size() || b >= s_.points.size()) return false;
  }
  return s_.is_kept(a, b);
}

Sector sector_at(const SurfaceView& view, std::uint32_t face, std::uint32_t vertex) {
  const std::uint32_t group = view.face(face).group;
  const Corner first = corner_at(view.face(face), vertex);
  Sector sector;
  if (group == no_index) {
    sector.angle = half_tangent_of(turn_at(view.at(vertex), view.at(first.a), view.at(first.b)));
    sector.between_kept = view.is_kept(vertex, first.a) && view.is_kept(vertex, first.b);
    return sector;
  }
  constexpr std::size_t usual = 8;
  sector.faces.reserve(usual);
  sector.faces.push_back(face);
  std::vector<std::array<double, 2>> all;
  all.reserve(usual);
  int kept_ends = 0;
  for (const std::uint32_t start : {first.a, first.b}) {
    if (start == first.b) {
      std::reverse(all.begin(), all.end());
      all.push_back(turn_at(view.at(vertex), view.at(first.a), view.at(first.b)));
    }
    std::uint32_t f = face, edge = start;
    while (true) {
      if (view.is_kept(vertex, edge)) {
        ++kept_ends;
        break;
      }
      const std::uint32_t g = view.beyond(f, vertex, edge);
      if (g == face) {  // all round
        sector.angle = wide_corner;
        sector.is_all_round = true;
        return sector;
      }
      if (g == no_index || view.face(g).group != group) break;
      const Corner c = corner_at(view.face(g), vertex);
      all.push_back(turn_at(view.at(vertex), view.at(c.a), view.at(c.b)));
      sector.faces.push_back(g);
      edge = c.a == edge ? c.b : c.a;
      f = g;
    }
  }
  AngleSum sum;  // from the same end, whichever face was asked for
  if (all.back() < all.front()) std::reverse(all.begin(), all.end());
  for (const auto& turn : all) sum.add(turn);
  sector.angle = sum.value();
  sector.between_kept = kept_ends == 2;
  return sector;
}

HalfTangent least_corner(const SurfaceComplex& s, std::uint32_t face) {
  const SurfaceView view(s);
  HalfTangent least = wide_corner;
  for (const std::uint32_t v : s.faces[face].corners) {
    const Sector sector = sector_at(view, face, v);
    if (!sector.between_kept) least = std::min(least, sector.angle);
  }
  return least;
}

namespace {

/// The corners of the faces that go and that come, each once.
std::vector<std::uint32_t> vertices_of(const SurfaceComplex& s, const SurfaceChange& change) {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t f : change.gone) vertices.insert(vertices.end(), s.faces[f].corners.begin(), s.faces[f].corners.end());
  for (const SurfaceFace& f : change.come) vertices.insert(vertices.end(), f.corners.begin(), f.corners.end());
  make_set(vertices);
  return vertices;
}

/// Calls visit(corner) for each corner of a facet at a vertex that one of these faces has.
template <class IsAsked, class Visit>
void each_corner(const SurfaceView& view, std::uint32_t vertex, const IsAsked& is_asked, const Visit& visit) {
  std::vector<std::uint32_t> seen;  // faces of groups, whose corner has been visited
  view.each_face_of(vertex, [&](std::uint32_t f) {
    if (!is_asked(f)) return;
    const bool is_of_group = view.face(f).group != no_index;
    if (is_of_group && std::find(seen.begin(), seen.end(), f) != seen.end()) return;
    const Sector corner = sector_at(view, f, vertex);
    seen.insert(seen.end(), corner.faces.begin(), corner.faces.end());
    visit(corner);
  });
}

}  // namespace

CornerChange corners_of(const SurfaceComplex& s, const SurfaceChange& change, HalfTangent rim_floor) {
  const SurfaceView before(s), after(s, &change);
  CornerChange out;
  const auto is_gone = [&](std::uint32_t f) { return after.is_gone(f); };
  const auto is_new = [&](std::uint32_t f) { return after.is_new(f); };
  for (const std::uint32_t v : vertices_of(s, change)) {
    each_corner(before, v, is_gone, [&](const Sector& was) {
      HalfTangent& least = was.between_kept ? out.kept_gone : out.gone;
      least = std::min(least, was.angle);
      for (const std::uint32_t g : was.faces) {  // those that stay, beyond the rim
        if (is_gone(g)) continue;
        const Sector is = sector_at(after, g, v);
        if (is.between_kept || std::any_of(is.faces.begin(), is.faces.end(), is_new)) continue;
        if (!(is.angle < was.angle)) continue;
        out.rim = std::min(out.rim, is.angle);
        out.is_rim_fine = out.is_rim_fine && is.angle >= std::min(was.angle, rim_floor);
      }
    });
    each_corner(after, v, is_new, [&](const Sector& is) {
      HalfTangent& least = is.between_kept ? out.kept_come : out.come;
      least = std::min(least, is.angle);
    });
  }
  return out;
}

Expected expected_of(const Sector& corner) {
  using namespace numbers;
  static const HalfTangent poor = half_tangent(poor_corner);
  if (corner.is_all_round) return {};
  const HalfTangent t = corner.angle;
  const double cotangent = t < 1 ? std::min((1 - t * t) / (2 * t), needle_cotangent) : 0.0;
  const auto wide = static_cast<std::int64_t>(parts_of_cell * cells_of_width * cotangent);
  return {static_cast<std::int64_t>(parts_of_cell * cells_of_corner) + wide, !corner.between_kept && t < poor ? wide : 0};
}

namespace {

/// For all corners of facets at a vertex.
Expected expected_at(const SurfaceView& view, std::uint32_t vertex) {
  Expected sum;
  each_corner(
      view, vertex, [](std::uint32_t) { return true; }, [&](const Sector& corner) { sum += expected_of(corner); });
  return sum;
}

/// Is it an edge that the mesher does not know?
bool is_inside_group(const SurfaceView& view, std::uint32_t a, std::uint32_t b) {
  if (view.is_kept(a, b)) return false;
  std::uint32_t group = no_index;
  bool is_first = true, is_inside = true;
  view.each_face_at(a, b, [&](std::uint32_t f) {
    is_inside = is_inside && view.face(f).group != no_index && (is_first || view.face(f).group == group);
    group = view.face(f).group;
    is_first = false;
  });
  return is_inside;
}

/// Is the vertex of an obtuse corner in the diametral ball of the edge opposite of it, by more than what is joined?
bool is_encroached(const SurfaceView& view, std::uint32_t a, std::uint32_t b) {
  const double least = view.joined() * distance(view.at(a), view.at(b));
  bool is_one = false;
  view.each_face_at(a, b, [&](std::uint32_t f) {
    const Point3& p = view.at(corner_beside(view.face(f).corners, a, b));
    is_one = is_one || dot(difference(view.at(a), p), difference(view.at(b), p)) < -least;
  });
  return is_one && !is_inside_group(view, a, b);
}

}  // namespace

bool has_encroached_edge(const SurfaceView& view, std::uint32_t face) {
  const auto& c = view.face(face).corners;
  return is_encroached(view, c[0], c[1]) || is_encroached(view, c[1], c[2]) || is_encroached(view, c[2], c[0]);
}

Expected expected_of_edges(const SurfaceView& view, std::span<const SurfaceFace> faces) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const SurfaceFace& f : faces)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(f.corners[i], f.corners[(i + 1) % 3]);
      edges.push_back({low, high});
    }
  make_set(edges);
  const auto count = std::count_if(edges.begin(), edges.end(), [&](const auto& e) { return is_encroached(view, e[0], e[1]); });
  return {count * static_cast<std::int64_t>(numbers::parts_of_cell * numbers::cells_of_two_faces), 0};
}

Expected expected_growth(const SurfaceComplex& s, const SurfaceChange& change) {
  const SurfaceView before(s), after(s, &change);
  Expected growth;
  for (const std::uint32_t v : vertices_of(s, change)) {
    growth += expected_at(after, v);
    growth -= expected_at(before, v);
  }
  std::vector<SurfaceFace> gone;
  for (const std::uint32_t f : change.gone) gone.push_back(s.faces[f]);
  growth += expected_of_edges(after, change.come);
  growth -= expected_of_edges(before, gone);
  return growth;
}

namespace {

/// The cosine between the normals of two faces at an edge, as if they ran the same way round; 1 where one has none.
double cosine_across(const SurfaceView& view, std::uint32_t f, std::uint32_t g, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t c = corner_beside(view.face(f).corners, a, b), d = corner_beside(view.face(g).corners, a, b);
  const auto along = difference(view.at(b), view.at(a));
  const auto m = cross(along, difference(view.at(c), view.at(a))), n = cross(difference(view.at(d), view.at(a)), along);
  const double length = std::sqrt(dot(m, m) * dot(n, n));
  return length > 0 ? dot(m, n) / length : 1;
}

/// Least across plain edges of a face.
double least_cosine(const SurfaceView& view, std::uint32_t f) {
  double least = 1;
  const auto& c = view.face(f).corners;
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t a = c[i], b = c[(i + 1) % 3];
    if (lex_less(view.at(b), view.at(a))) std::swap(a, b);
    if (view.is_kept(a, b)) continue;
    if (const std::uint32_t g = view.beyond(f, a, b); g != no_index) least = std::min(least, cosine_across(view, f, g, a, b));
  }
  return least;
}

}  // namespace

bool keeps_folds(const SurfaceComplex& s, const SurfaceChange& change, double floor) {
  const SurfaceView before(s), after(s, &change);
  double is = 1;
  for (std::uint32_t k = 0; k < change.come.size(); ++k)
    is = std::min(is, least_cosine(after, static_cast<std::uint32_t>(s.faces.size() + k)));
  if (is >= floor) return true;
  double was = 1;
  for (const std::uint32_t f : change.gone) was = std::min(was, least_cosine(before, f));
  return is >= was;
}

}  // namespace pgdr::detail
