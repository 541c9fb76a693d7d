// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// That no faces meet is not enough: a surface may jump over a small one. With B in the place of A, the cone from the vertex that
// is new or moves over A is a chain of tetrahedra with the boundary A - B. The rest of the surface meets neither, so each part of
// it without the rim is all inside of the cone or all outside; it has a face, whose centroid says which. None may be inside, and
// no seed: then volumes keep their seeds, their walls and their nesting.
#include <cmath>

#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "replace/patch_tests.hpp"
#include "replace/shape.hpp"
#include "space/contact.hpp"
#include "space/distances.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

using Triangle = std::array<Point3, 3>;

std::vector<Box<3>> boxes_of_faces(const SurfaceComplex& s) {
  std::vector<Box<3>> out;
  for (std::uint32_t f = 0; f < s.faces.size(); ++f) out.push_back(Box<3>::of(s.triangle(f)));
  return out;
}

/// A piece of one to three vertices, with where these are after a change.
struct PlacedPiece {
  std::array<std::uint32_t, 3> corners{no_index, no_index, no_index};
  std::array<Point3, 3> places{};
  std::uint8_t count = 3;
  std::uint8_t axis = 2;  ///< of a projection in which a triangle has an area; it runs round positively there
  bool is_flat = false;   ///< a triangle that has none in any
};

/// Finds the axis of a triangle, and turns it.
void turn_to_axis(PlacedPiece& p) {
  const auto n = cross(difference(p.places[1], p.places[0]), difference(p.places[2], p.places[0]));
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&n](int i, int j) { return std::fabs(n[static_cast<std::size_t>(i)]) > std::fabs(n[static_cast<std::size_t>(j)]); });
  for (const int axis : axes) {
    const Sign way = orient_projected(p.places[0], p.places[1], p.places[2], axis);
    if (way == Sign::zero) continue;
    if (way == Sign::negative) {
      std::swap(p.places[1], p.places[2]);
      std::swap(p.corners[1], p.corners[2]);
    }
    p.axis = static_cast<std::uint8_t>(axis);
    return;
  }
  p.is_flat = true;
}

PlacedPiece placed(const SurfaceComplex& s, const SurfaceChange& change, const SurfaceFace& f) {
  PlacedPiece piece{.corners = f.corners, .places = triangle_after(s, change, f)};
  turn_to_axis(piece);
  return piece;
}

/// Do two pieces meet but in the hull of their common vertices? Exact. A flat triangle does.
bool meet(const PlacedPiece& a, const PlacedPiece& b) {
  std::array<Point3, 6> points;
  std::array<std::uint32_t, 6> names;
  std::size_t count = 0;
  const auto piece_of = [&](const PlacedPiece& p) {
    Piece piece{.count = p.count, .axis = p.axis};
    for (std::size_t k = 0; k < p.count; ++k) {
      const auto at = static_cast<std::size_t>(
          std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count), p.corners[k]) - names.begin());
      piece.corners[k] = static_cast<std::uint32_t>(at);
      if (at < count) continue;
      names[count] = p.corners[k];
      points[count++] = p.places[k];
    }
    return piece;
  };
  if (a.is_flat || b.is_flat) return true;
  const Piece p = piece_of(a), q = piece_of(b);
  return contact<3>(std::span(points).first(count), p, q).kind != Contact::Kind::none;
}

Box<3> box_of_change(const SurfaceComplex& s, const SurfaceChange& change) {
  Box<3> box = Box<3>::empty();
  for (const SurfaceFace& f : change.come)
    for (const Point3& p : triangle_after(s, change, f)) box.add(p);
  return box;
}

/// The least angle of a triangle, by the tangent of its half.
HalfTangent least_angle(const Triangle& t) {
  HalfTangent least = wide_corner;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto u = difference(t[(i + 1) % 3], t[i]), v = difference(t[(i + 2) % 3], t[i]);
    const auto n = cross(u, v);
    const double s = std::sqrt(dot(n, n)), c = dot(u, v), sum = std::sqrt(s * s + c * c) + c;
    least = std::min(least, sum > 0 ? s / sum : s > 0 || c < 0 ? wide_corner : 0.0);
  }
  return least;
}

bool are_angles_fine(const SurfaceComplex& s, const SurfaceChange& change) {
  HalfTangent was = wide_corner, is = wide_corner;
  for (const std::uint32_t f : change.gone) was = std::min(was, least_angle(s.triangle(f)));
  for (const SurfaceFace& f : change.come) is = std::min(is, least_angle(triangle_after(s, change, f)));
  return is >= numbers::flat_corner / 2 && is >= std::min(numbers::thin_corner / 2, was / 2);
}

/// The squared distance of two triangles that do not meet.
double squared_distance_of(const Triangle& a, const Triangle& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, closest_to_triangle(a[i], b[0], b[1], b[2]).square);
    least = std::min(least, closest_to_triangle(b[i], a[0], a[1], a[2]).square);
    for (std::size_t j = 0; j < 3; ++j)
      least = std::min(least, closest_of_edges(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).square);
  }
  return least;
}

/// May x be inside of the hull of the four points, or within 4 ulps of it? Planes through three of them separate it from a
/// tetrahedron; planes along an edge, normal to such, from a flat one.
bool may_be_inside(const std::array<Point3, 4>& s, const Point3& x) {
  double largest = 0;
  for (const Point3& q : s)
    for (const double c : q.x) largest = std::max(largest, std::fabs(c));
  const double near = 4 * largest * 0x1p-52;
  const auto separates = [&](const Vector<3>& n) {
    const double reach = near * std::sqrt(dot(n, n));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point3& q : s) {
      const double h = dot(n, difference(q, s[0]));
      low = std::min(low, h);
      high = std::max(high, h);
    }
    const double h = dot(n, difference(x, s[0]));
    return reach > 0 && (h > high + reach || h < low - reach);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<Point3, 3> t{s[(i + 1) % 4], s[(i + 2) % 4], s[(i + 3) % 4]};
    const auto n = cross(difference(t[1], t[0]), difference(t[2], t[0]));
    if (separates(n)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (separates(cross(n, difference(t[(k + 1) % 3], t[k])))) return false;
  }
  return true;
}

}  // namespace

ChangingSurface::ChangingSurface(SurfaceComplex s, LoosePieces pieces, std::vector<Point3> points)
    : complex(std::move(s)), loose(std::move(pieces)), seeds(std::move(points)), given(complex), boxes(boxes_of_faces(complex)) {}

bool meets_nothing(const ChangingSurface& s, const SurfaceChange& change) {
  const SurfaceComplex& c = s.complex;
  if (!are_angles_fine(c, change)) return false;
  std::vector<PlacedPiece> come;
  for (const SurfaceFace& f : change.come) come.push_back(placed(c, change, f));
  bool any = false;
  for (std::size_t k = 0; k < come.size() && !any; ++k) {
    for (std::size_t i = 0; i < k && !any; ++i) any = meet(come[k], come[i]);
    const Box<3> box = Box<3>::of(come[k].places);
    s.boxes.meeting(box, [&](std::uint32_t f) {
      if (any || change.is_gone(f)) return;
      any = meet(come[k], placed(c, change, c.faces[f]));
    });
    for (const auto& [a, b] : s.loose.edges) {
      Box<3> edge = Box<3>::around(c.at(a));
      edge.add(c.at(b));
      if (!any && edge.meets(box)) any = meet(come[k], {{a, b, no_index}, {c.at(a), c.at(b), {}}, 2});
    }
    for (const std::uint32_t v : s.loose.points)
      if (!any && Box<3>::around(c.at(v)).meets(box)) any = meet(come[k], {{v, no_index, no_index}, {c.at(v), {}, {}}, 1});
  }
  return !any;
}

bool keeps_gaps(const ChangingSurface& s, const SurfaceChange& change, double least) {
  const SurfaceComplex& c = s.complex;
  std::vector<Triangle> come;
  std::vector<Box<3>> reaches;  // what is outside of is farther than `least`, with room for rounding
  for (const SurfaceFace& f : change.come) {
    come.push_back(triangle_after(c, change, f));
    reaches.push_back(Box<3>::of(come.back()).widened(1.0625 * least));
  }
  const auto touches_patch = [&](const std::array<std::uint32_t, 3>& corners) {
    return std::any_of(change.gone.begin(), change.gone.end(), [&](std::uint32_t g) {
      return c.has_corner(g, corners[0]) || c.has_corner(g, corners[1]) || c.has_corner(g, corners[2]);
    });
  };
  const auto is_kept = [&](const Triangle& t) {
    double is = least * least;
    const Box<3> box = Box<3>::of(t);
    for (std::size_t k = 0; k < come.size(); ++k)
      if (reaches[k].meets(box)) is = std::min(is, squared_distance_of(t, come[k]));
    if (is >= least * least) return true;
    double was = std::numeric_limits<double>::infinity();
    for (const std::uint32_t g : change.gone) was = std::min(was, squared_distance_of(t, c.triangle(g)));
    return is >= was;
  };
  bool are_kept = true;
  s.boxes.meeting(box_of_change(c, change).widened(least), [&](std::uint32_t f) {
    if (are_kept && !change.is_gone(f) && !touches_patch(c.faces[f].corners)) are_kept = is_kept(c.triangle(f));
  });
  for (const auto& [a, b] : s.loose.edges)
    if (are_kept && !touches_patch({a, b, b})) are_kept = is_kept({c.at(a), c.at(b), c.at(b)});
  return are_kept;
}

bool sweeps_nothing(const ChangingSurface& s, const SurfaceChange& change) {
  const SurfaceComplex& c = s.complex;
  std::vector<std::array<Point3, 4>> cone;
  const auto add = [&cone](const Point3& p, const Triangle& t) { cone.push_back({p, t[0], t[1], t[2]}); };
  if (change.kind == SurfaceChange::Kind::flip) {
    const Triangle t = c.triangle(change.gone[0]);
    const auto& other = c.faces[change.gone[1]].corners;
    add(c.at(corner_beside(other, change.u, change.v)), t);
  } else {
    const Point3 p = change.kind == SurfaceChange::Kind::contract ? place_after(c, change, change.v) : change.place;
    for (const std::uint32_t f : change.gone)
      if (change.kind != SurfaceChange::Kind::contract || change.moved != no_index || !c.has_corner(f, change.v))
        add(p, c.triangle(f));
  }
  const auto is_swept = [&](const Point3& x) {
    return std::any_of(cone.begin(), cone.end(), [&](const std::array<Point3, 4>& t) {
      return Box<3>::of(t).meets(Box<3>::around(x)) && may_be_inside(t, x);
    });
  };
  Box<3> box = Box<3>::empty();
  for (const auto& t : cone)
    for (const Point3& q : t) box.add(q);
  bool any = false;
  s.boxes.meeting(box, [&](std::uint32_t f) {
    if (any || change.is_gone(f)) return;
    auto t = c.triangle(f);
    sort_corners(t);
    Point3 centroid;
    for (int i = 0; i < 3; ++i) centroid[i] = (t[0][i] + t[1][i] + t[2][i]) / 3;
    any = is_swept(centroid);
  });
  for (const Point3& x : s.seeds) any = any || is_swept(x);
  for (const std::uint32_t v : s.loose.points) any = any || is_swept(c.at(v));
  for (const auto& [a, b] : s.loose.edges) any = any || is_swept(on_edge(c.at(a), c.at(b), 0.5));
  return !any;
}

bool is_place_near(const ChangingSurface& s, const SurfaceChange& change, double most) {
  if (change.moved == no_index) return true;
  return std::any_of(change.gone.begin(), change.gone.end(), [&](std::uint32_t f) {
    const Triangle t = s.complex.triangle(f);
    return closest_to_triangle(change.place, t[0], t[1], t[2]).square <= most * most;
  });
}

namespace {

/// Do two of the faces at the edge of a split make so sharp an angle?
bool is_sharp_edge(const SurfaceComplex& c, const SurfaceChange& change) {
  const Point3 a = c.at(change.u);
  const auto along = difference(c.at(change.v), a);
  std::vector<Vector<3>> out;  // normal to the edge, into each face
  for (const std::uint32_t f : change.gone) {
    const auto w = difference(c.at(corner_beside(c.faces[f].corners, change.u, change.v)), a);
    out.push_back(cross(cross(along, w), along));
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (dot(out[i], out[j]) > numbers::wedge_cosine * std::sqrt(dot(out[i], out[i]) * dot(out[j], out[j]))) return true;
  return false;
}

}  // namespace

bool avoids_wedges(const ChangingSurface& s, const SurfaceChange& change) {
  const SurfaceComplex& c = s.complex;
  double reach = std::numeric_limits<double>::infinity();
  std::vector<Vector<3>> normals;
  const auto normal_of = [&](std::uint32_t f) {
    auto t = c.triangle(f);
    return cross(difference(t[1], t[0]), difference(t[2], t[0]));
  };
  const double length = distance(c.at(change.u), c.at(change.v));
  for (const std::uint32_t f : change.gone) {
    normals.push_back(normal_of(f));
    reach = std::min(reach, numbers::wedge_height * std::sqrt(dot(normals.back(), normals.back())) / length);
  }
  if (c.is_kept(change.u, change.v) && is_sharp_edge(c, change)) return false;
  // Another side of the surface lies above or below, whichever way round its corners run; what goes on beside does not.
  bool any = false;
  s.boxes.meeting(Box<3>::around(change.place).widened(reach), [&](std::uint32_t f) {
    if (any || change.is_gone(f)) return;
    const Triangle t = c.triangle(f);
    const auto closest = closest_to_triangle(change.place, t[0], t[1], t[2]);
    if (closest.square > reach * reach) return;
    const auto n = normal_of(f), off = difference(closest.points[1], change.place);
    if (std::fabs(dot(off, n)) < numbers::wedge_beyond * std::sqrt(dot(off, off) * dot(n, n))) return;
    any = std::any_of(normals.begin(), normals.end(), [&](const Vector<3>& m) {
      return std::fabs(dot(m, n)) > numbers::wedge_cosine * std::sqrt(dot(m, m) * dot(n, n));
    });
  });
  return !any;
}

}  // namespace pgdr::detail
