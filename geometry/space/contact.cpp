// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;

constexpr bool opposite(Sign a, Sign b) { return a != Sign::zero && a == -b; }

template <int D>
class Tester {
 public:
  Tester(std::span<const Point<D>> points, const Piece& a, const Piece& b) : p_(points), a_(a), b_(b) {}

  Contact run(bool same_plane) {
    if constexpr (D == 3)
      if (a_.count == 3 && b_.count == 3) {
        if (!same_plane) {
          if (apart(a_, b_) || (!flat_ && apart(b_, a_))) return {};
          same_plane = flat_;
        }
        if (same_plane) return run_in_plane();
      }
    collect_corners(true);
    collect_crossings();
    if (!found_.corners.empty()) found_.kind = Contact::Kind::touch;
    if (!found_.crossings.empty()) found_.kind = Contact::Kind::cross;
    return std::move(found_);
  }

 private:
  const Point<D>& at(std::uint32_t v) const { return p_[v]; }

  Sign flat_orient(std::uint32_t i, std::uint32_t j, std::uint32_t k, int axis) const {
    if constexpr (D == 2)
      return orient2d(at(i), at(j), at(k));
    else
      return orient_projected(at(i), at(j), at(k), axis);
  }

  Sign side(const Piece& t, std::uint32_t v) const {
    return orient3d(at(t.corners[0]), at(t.corners[1]), at(t.corners[2]), at(v));
  }

  // True only if t and u meet in their common corners alone, because the plane of t does not pass through the inside of
  // u, and an edge of t has what u has in the plane beyond it. Finds out, too, whether u lies in the plane.
  bool apart(const Piece& t, const Piece& u) requires(D == 3) {
    bool positive = false, negative = false;
    std::array<std::uint32_t, 3> in_plane;
    std::size_t in_plane_count = 0;
    for (const std::uint32_t v : u.corners) {
      const Sign s = t.has(v) ? Sign::zero : side(t, v);
      positive |= s == Sign::positive;
      negative |= s == Sign::negative;
      if (s == Sign::zero) in_plane[in_plane_count++] = v;
      if (positive && negative) return false;
    }
    flat_ = !positive && !negative;
    return !flat_ && beyond_an_edge(t, std::span(in_plane).first(in_plane_count));
  }

  bool beyond_an_edge(const Piece& t, std::span<const std::uint32_t> corners) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t e0 = t.corners[i], e1 = t.corners[(i + 1) % 3], opposite_corner = t.corners[(i + 2) % 3];
      if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
            if (v == e0 || v == e1) return true;
            return v != opposite_corner && flat_orient(e0, e1, v, t.axis) == Sign::negative;
          }))
        return true;
    }
    return false;
  }

  // The insides of convex polygons are disjoint iff a line through an edge of one separates them.
  bool separated_by(const Piece& t, const Piece& u) const {
    for (std::size_t i = 0; i < 3; ++i) {
      bool apart = true;
      for (const std::uint32_t v : u.corners) {
        const std::uint32_t e0 = t.corners[i], e1 = t.corners[(i + 1) % 3];
        if (v == e0 || v == e1) continue;
        apart = flat_orient(e0, e1, v, t.axis) != Sign::positive;
        if (!apart) break;
      }
      if (apart) return true;
    }
    return false;
  }

  Contact run_in_plane() requires(D == 3) {
    const bool overlap = !separated_by(a_, b_) && !separated_by(b_, a_);
    collect_corners(false);
    if (overlap) {
      collect_edge_crossings();
      found_.kind = Contact::Kind::overlap;
    } else if (!found_.corners.empty()) {
      found_.kind = Contact::Kind::touch;
    }
    return std::move(found_);
  }

  bool on_segment(std::uint32_t v, const Edge& e) const {
    const Point<D>&p = at(v), &q = at(e[0]), &r = at(e[1]);
    for (int i = 0; i < D; ++i)
      if ((p[i] < q[i] && p[i] < r[i]) || (p[i] > q[i] && p[i] > r[i])) return false;
    return collinear<D>(q, r, p);  // and between them, by the comparison
  }

  // Where on t (a triangle whose plane has v) v lies.
  std::optional<Contact::Corner> on_triangle(std::uint32_t v, const Piece& t) const {
    Contact::Corner corner{v};
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge e{t.corners[i], t.corners[(i + 1) % 3]};
      const Sign s = flat_orient(e[0], e[1], v, t.axis);
      if (s == Sign::negative) return {};
      if (s == Sign::zero) corner.edge = e;
    }
    return corner;
  }

  void collect_corners_of(const Piece& a, const Piece& b, bool of_second, bool check_plane) {
    for (std::size_t i = 0; i < a.count; ++i) {
      const std::uint32_t v = a.corners[i];
      if (b.has(v)) continue;
      if (b.count == 2 && on_segment(v, {b.corners[0], b.corners[1]}))
        found_.corners.push_back({v, {b.corners[0], b.corners[1]}, of_second});
      if constexpr (D == 3) {
        if (b.count != 3 || (check_plane && side(b, v) != Sign::zero)) continue;
        if (auto corner = on_triangle(v, b)) {
          corner->of_second = of_second;
          found_.corners.push_back(*corner);
        }
      }
    }
  }

  void collect_corners(bool check_plane) {
    collect_corners_of(a_, b_, false, check_plane);
    collect_corners_of(b_, a_, true, check_plane);
  }

  template <class Visit>
  static void each_edge(const Piece& t, Visit&& visit) {
    if (t.count == 2) visit(Edge{t.corners[0], t.corners[1]});
    if (t.count == 3)
      for (std::size_t i = 0; i < 3; ++i) visit(Edge{t.corners[i], t.corners[(i + 1) % 3]});
  }

  // An axis along which the common plane of four points can be seen; none if they lie on one line.
  std::optional<int> common_axis(const Edge& e, const Edge& f) const {
    if constexpr (D == 2)
      return flat_orient(e[0], e[1], f[0], 2) != Sign::zero ? std::optional(2) : std::nullopt;
    else
      for (int axis = 0; axis < 3; ++axis)
        if (flat_orient(e[0], e[1], f[0], axis) != Sign::zero || flat_orient(e[0], e[1], f[1], axis) != Sign::zero) return axis;
    return {};
  }

  bool edges_cross(const Edge& e, const Edge& f) const {
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
    if constexpr (D == 3)
      if (orient3d(at(e[0]), at(e[1]), at(f[0]), at(f[1])) != Sign::zero) return false;
    const auto axis = common_axis(e, f);
    return axis && opposite(flat_orient(e[0], e[1], f[0], *axis), flat_orient(e[0], e[1], f[1], *axis)) &&
           opposite(flat_orient(f[0], f[1], e[0], *axis), flat_orient(f[0], f[1], e[1], *axis));
  }

  bool crosses_inside(const Edge& e, const Piece& t) const requires(D == 3) {
    if (t.has(e[0]) || t.has(e[1]) || !opposite(side(t, e[0]), side(t, e[1]))) return false;
    std::array<Sign, 3> turn;
    for (std::size_t i = 0; i < 3; ++i) turn[i] = orient3d(at(e[0]), at(e[1]), at(t.corners[i]), at(t.corners[(i + 1) % 3]));
    return turn[0] != Sign::zero && turn[0] == turn[1] && turn[1] == turn[2];
  }

  void collect_edge_crossings() {
    each_edge(a_, [&](const Edge& e) {
      each_edge(b_, [&](const Edge& f) {
        if (edges_cross(e, f)) found_.crossings.push_back({e, {f[0], f[1], no_entity}});
      });
    });
  }

  void collect_crossings() {
    collect_edge_crossings();
    if constexpr (D == 3) {
      if (b_.count == 3)
        each_edge(a_, [&](const Edge& e) {
          if (crosses_inside(e, b_)) found_.crossings.push_back({e, b_.corners});
        });
      if (a_.count == 3)
        each_edge(b_, [&](const Edge& e) {
          if (crosses_inside(e, a_)) found_.crossings.push_back({e, a_.corners});
        });
    }
  }

  std::span<const Point<D>> p_;
  const Piece &a_, &b_;
  Contact found_;
  bool flat_ = false;
};

template <int D>
std::array<double, D> minus(const Point<D>& a, const Point<D>& b) {
  std::array<double, D> d;
  for (std::size_t i = 0; i < D; ++i) d[i] = a.x[i] - b.x[i];
  return d;
}

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The parameter along e of the crossing: where it meets the plane of the triangle, or the plane through the other edge
// that is normal to the common plane.
template <int D>
double crossing_parameter(std::span<const Point<D>> p, const Contact::Crossing& c) {
  const auto u = minus(p[c.edge[1]], p[c.edge[0]]), w = minus(p[c.through[1]], p[c.through[0]]);
  const auto from = minus(p[c.through[0]], p[c.edge[0]]);
  if constexpr (D == 2) {
    return (from[0] * w[1] - from[1] * w[0]) / (u[0] * w[1] - u[1] * w[0]);
  } else {
    const auto n = c.through[2] == no_entity ? cross(w, cross(u, w)) : cross(w, minus(p[c.through[2]], p[c.through[0]]));
    return dot(n, from) / dot(n, u);
  }
}

}  // namespace

template <int D>
Contact contact(std::span<const Point<D>> points, const Piece& a, const Piece& b, bool same_plane) {
  if (a.count == 1 && b.count == 1) return {};
  return Tester<D>(points, a, b).run(same_plane);
}

template <int D>
std::vector<Point<D>> contact_points(std::span<const Point<D>> points, const Contact& c) {
  std::vector<Point<D>> out;
  for (const Contact::Corner& corner : c.corners) out.push_back(points[corner.point]);
  for (const Contact::Crossing& x : c.crossings) {
    double t = crossing_parameter<D>(points, x);
    if (!(t >= 0)) t = 0;  // also if products under- or overflowed
    if (t > 1) t = 1;
    const Point<D>&a = points[x.edge[0]], &b = points[x.edge[1]];
    Point<D> q;
    for (int i = 0; i < D; ++i) q[i] = std::clamp(a[i] + t * (b[i] - a[i]), std::min(a[i], b[i]), std::max(a[i], b[i]));
    out.push_back(q);
  }
  std::sort(out.begin(), out.end(), lex_less<D>);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

template Contact contact<2>(std::span<const Point2>, const Piece&, const Piece&, bool);
template Contact contact<3>(std::span<const Point3>, const Piece&, const Piece&, bool);
template std::vector<Point2> contact_points<2>(std::span<const Point2>, const Contact&);
template std::vector<Point3> contact_points<3>(std::span<const Point3>, const Contact&);

}  // namespace pgdr::detail
