// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/encroachment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "numbers/vectors.hpp"
#include "rule/insertion_rule.hpp"
#include "rule/numbers.hpp"
#include "rule/twins.hpp"

namespace pgdr {
namespace {

template <int D>
Entry<D> entry_of(const Mesh<D>& mesh, CellId c, EntryKind kind, int which) {
  return {c, mesh.birth(c), kind, which};
}

/// Does the orthogonal projection of x to the hyperplane of the corners lie among them?
template <int D>
bool projects_into(const std::array<Point<D>, D>& corner, const Point<D>& x) {
  if constexpr (D == 2) {
    double along = 0, length = 0;
    for (int i = 0; i < D; ++i) {
      along += (x[i] - corner[0][i]) * (corner[1][i] - corner[0][i]);
      length += (corner[1][i] - corner[0][i]) * (corner[1][i] - corner[0][i]);
    }
    return along >= 0 && along <= length;
  } else {
    using detail::difference;
    const auto normal = detail::cross(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
    for (int i = 0; i < 3; ++i)
      if (detail::dot(detail::cross(difference(corner[(i + 1) % 3], corner[i]), difference(x, corner[i])), normal) < 0)
        return false;
    return true;
  }
}

/// Is the angle at x, of the triangle with ab, above 180 degrees less twice the smallest that the bound allows? Its cosine is
/// below -(1 - 2 sin^2) then.
bool is_flat_at(const Point2& x, const Point2& a, const Point2& b, double radius_edge_bound) {
  const double limit = 1 - 1 / (2 * radius_edge_bound * radius_edge_bound);
  const double product = (a[0] - x[0]) * (b[0] - x[0]) + (a[1] - x[1]) * (b[1] - x[1]);
  const double cosine = product / std::sqrt(squared_distance(a, x) * squared_distance(b, x));
  return !(cosine >= -limit);
}

/// Is x close beside an end of pq, at a right angle from it, but for 4e-6 of it? Split next to an input vertex (twins.hpp), a
/// subsegment would else be split for it again and again where the rounded point is some ulps off its place.
template <int D>
bool is_beside_end(const Point<D>& p, const Point<D>& q, const Point<D>& x) {
  const double to_p = squared_distance(p, x), to_q = squared_distance(q, x);
  if (std::min(to_p, to_q) > numbers::beside_subsegment * numbers::beside_subsegment * std::max(to_p, to_q)) return false;
  double along = 0;
  for (int i = 0; i < D; ++i) along += (p[i] - x[i]) * (q[i] - x[i]);
  return along * along < 0x1p-36 * to_p * to_q;
}

/// Calls f(entry) for each subsegment of each cell of the cavity in whose diametral ball x lies, until it says true. Has it?
template <int D, class F>
bool any_encroached_edge(const Mesh<D>& mesh, const Cavity<D>& cavity, const Point<D>& x, const F& f) {
  if constexpr (D == 3) {
    for (const CellId c : cavity.cells()) {
      const auto* k = mesh.constraints(c);
      if (!k || !k->edges) continue;
      for (int e = 0; e < 6; ++e) {
        if (!k->has_edge(e)) continue;
        const auto [a, b] = ends_of_edge(mesh.cell(c).vertices, e);
        if (in_diametral_ball<D>(mesh.point(a), mesh.point(b), x) && f(entry_of(mesh, c, EntryKind::edge, e))) return true;
      }
    }
  }
  return false;
}

/// The first such subsegment that is not kept.
template <int D>
std::optional<Entry<D>> encroached_edge(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x) {
  std::optional<Entry<D>> first;
  any_encroached_edge(context.mesh, cavity, x, [&](const Entry<D>& e) {
    if (context.kept.any() && context.kept.has(entity_of(context.mesh, e))) return false;
    first = e;
    return true;
  });
  return first;
}

template <int D>
std::optional<Entry<D>> encroached_face(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x) {
  const Mesh<D>& mesh = context.mesh;
  std::optional<Entry<D>> any;
  for (const auto& f : cavity.boundary()) {
    if (!mesh.constrained(f.cell, f.face)) continue;
    if (context.kept.any() && context.kept.has(mesh.entity_of_face(f.cell, f.face))) continue;
    const Encroachment how = encroachment<D>(mesh, f.cell, f.face, x);
    if (how == Encroachment::before) return entry_of(mesh, f.cell, EntryKind::face, f.face);
    if (how == Encroachment::beside && !any) any = entry_of(mesh, f.cell, EntryKind::face, f.face);
  }
  return any;
}

/// Would a tetrahedron of these and x be over the bound on account of x: farther from a sphere of its size than the ball about
/// them is? (What is over the bound without x, or nearly, is no worse with it.)
template <std::size_t N>
bool is_flattened_by(const std::array<Point3, N>& corners, const Point3& x, double squared_ball, double radius_edge_bound) {
  double squared_radius, shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < N; ++i) {
    shortest = std::min(shortest, squared_distance(corners[i], x));
    for (std::size_t k = 0; k < i; ++k) shortest = std::min(shortest, squared_distance(corners[i], corners[k]));
  }
  if constexpr (N == 3)
    squared_radius = circumsphere<3>({corners[0], corners[1], corners[2], x}).squared_radius;
  else
    squared_radius = equatorial_ball(corners[0], corners[1], x).squared_radius;
  return !(squared_radius <= std::max(radius_edge_bound * radius_edge_bound * shortest, 2 * squared_ball));
}

/// A kept subsegment or subfacet in whose smallest ball x lies, behind it, or so that it would flatten a cell there.
std::optional<Entry<3>> encroached_kept(const RefineContext<3>& context, const Cavity<3>& cavity, const Point3& x) {
  const Mesh<3>& mesh = context.mesh;
  const double bound = context.options.radius_edge_bound;
  std::optional<Entry<3>> found;
  any_encroached_edge(mesh, cavity, x, [&](const Entry<3>& e) {
    if (!context.kept.has(entity_of(mesh, e))) return false;
    const auto ends = mesh.points(ends_of_edge(mesh.cell(e.cell).vertices, e.which()));
    if (!is_flattened_by<2>(ends, x, squared_distance(ends[0], ends[1]) / 4, bound)) return false;
    found = e;
    return true;
  });
  if (found) return found;
  for (const auto& f : cavity.boundary()) {
    if (!mesh.constrained(f.cell, f.face) || !context.kept.has(mesh.entity_of_face(f.cell, f.face))) continue;
    const auto corners = mesh.points(face_without(mesh.cell(f.cell).vertices, f.face));
    const Ball<3> ball = equatorial_ball(corners[0], corners[1], corners[2]);
    if (!in_equatorial_ball(ball, x)) continue;
    const auto inwards = mesh.points(face_inwards(mesh.cell(f.cell).vertices, f.face));
    if (orient3d(inwards[0], inwards[1], inwards[2], x) != Sign::positive) return entry_of(mesh, f.cell, EntryKind::face, f.face);
    if (is_flattened_by<3>(corners, x, ball.squared_radius, bound)) return entry_of(mesh, f.cell, EntryKind::face, f.face);
  }
  return std::nullopt;
}
std::optional<Entry<2>> encroached_kept(const RefineContext<2>& context, const Cavity<2>& cavity, const Point2& x) {
  return flattened_face<2>(context, cavity, x);
}

}  // namespace

template <int D>
Encroachment encroachment(const Mesh<D>& mesh, CellId c, int face, const Point<D>& x) {
  const std::array<Point<D>, D> corner = mesh.points(face_without(mesh.cell(c).vertices, face));
  bool inside;
  if constexpr (D == 2) {
    inside = in_diametral_ball<2>(corner[0], corner[1], x);
  } else {
    inside = in_equatorial_ball(equatorial_ball(corner[0], corner[1], corner[2]), x);
  }
  if (!inside) return Encroachment::none;
  return projects_into<D>(corner, x) ? Encroachment::before : Encroachment::beside;
}

template <int D>
bool is_face_encroached_by(const Mesh<D>& mesh, const Domain<D>& domain, CellId c, int face, VertexId v,
                           const RefineOptions<D>& options) {
  const auto& k = mesh.cell(c).vertices;
  const EntityId id = mesh.constraints(c)->face_entity[face];
  if constexpr (D == 2) {
    const Point<D>&a = mesh.point(k[(face + 1) % 3]), &b = mesh.point(k[(face + 2) % 3]), &x = mesh.point(v);
    const Home home = mesh.vertex(v).home;
    return in_diametral_ball<2>(a, b, x) && !lies_on<D>(domain, home, {EntityKind::segment, id}) &&
           (home.kind() == EntityKind::volume || options.conforming_delaunay || is_flat_at(x, a, b, options.radius_edge_bound));
  } else {
    const Ball<3> ball = equatorial_ball(mesh.point(k[(face + 1) & 3]), mesh.point(k[(face + 2) & 3]),
                                         mesh.point(k[(face + 3) & 3]));
    return in_equatorial_ball(ball, mesh.point(v)) && !lies_on<D>(domain, mesh.vertex(v).home, {EntityKind::facet, id});
  }
}

template <int D>
double squared_radius_of_face(const Mesh<D>& mesh, CellId c, int face) {
  const std::array<Point<D>, D> corner = mesh.points(face_without(mesh.cell(c).vertices, face));
  if constexpr (D == 2)
    return squared_distance(corner[0], corner[1]) / 4;
  else
    return equatorial_ball(corner[0], corner[1], corner[2]).squared_radius;
}

double squared_radius_of_edge(const Mesh<3>& mesh, CellId c, int edge) {
  const auto [a, b] = ends_of_edge(mesh.cell(c).vertices, edge);
  return squared_distance(mesh.point(a), mesh.point(b)) / 4;
}

bool is_edge_encroached(const Mesh<3>& mesh, const Domain<3>& domain, CellId c, int edge) {
  const auto& vertices = mesh.cell(c).vertices;
  const auto [a, b] = edge_ends[edge];
  const EntityRef segment{EntityKind::segment, mesh.constraints(c)->edge_entity[edge]};
  for (int i = 0; i < 4; ++i) {
    if (i == a || i == b || lies_on<3>(domain, mesh.vertex(vertices[i]).home, segment)) continue;
    const Point3 &p = mesh.point(vertices[a]), &q = mesh.point(vertices[b]), &x = mesh.point(vertices[i]);
    if (in_diametral_ball<3>(p, q, x) && !is_beside_end(p, q, x)) return true;
  }
  return false;
}

template <int D>
std::vector<Entry<D>> encroached_edges(const Mesh<D>& mesh, const Cavity<D>& cavity, const Point<D>& x) {
  std::vector<Entry<D>> edges;
  std::unordered_set<std::uint64_t> known;  // an edge is on several cells
  any_encroached_edge(mesh, cavity, x, [&](const Entry<D>& e) {
    const auto [a, b] = ends_of_edge(mesh.cell(e.cell).vertices, e.which());
    if (known.insert(std::uint64_t{index(std::max(a, b))} << 32 | index(std::min(a, b))).second) edges.push_back(e);
    return false;
  });
  return edges;
}

template <int D>
std::optional<Entry<D>> flattened_face(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x) {
  if constexpr (D == 2) {
    const Mesh<D>& mesh = context.mesh;
    for (const auto& f : cavity.boundary()) {
      if (!mesh.constrained(f.cell, f.face) || !context.kept.has(mesh.entity_of_face(f.cell, f.face))) continue;
      const auto& v = mesh.cell(f.cell).vertices;
      const Point<D>&a = mesh.point(v[(f.face + 1) % 3]), &b = mesh.point(v[(f.face + 2) % 3]);
      if (is_flat_at(x, a, b, context.options.radius_edge_bound)) return entry_of(mesh, f.cell, EntryKind::face, f.face);
    }
  }
  return std::nullopt;
}

template <int D>
std::optional<Entry<D>> encroached_entity(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x) {
  if (!cavity.touches_constraints()) return std::nullopt;
  if (context.kept.any())
    if (auto kept = encroached_kept(context, cavity, x)) return kept;
  if (auto edge = encroached_edge<D>(context, cavity, x)) return edge;
  return encroached_face<D>(context, cavity, x);
}

template Encroachment encroachment(const Mesh<2>&, CellId, int, const Point<2>&);
template Encroachment encroachment(const Mesh<3>&, CellId, int, const Point<3>&);
template double squared_radius_of_face(const Mesh<2>&, CellId, int);
template double squared_radius_of_face(const Mesh<3>&, CellId, int);
template bool is_face_encroached_by(const Mesh<2>&, const Domain<2>&, CellId, int, VertexId, const RefineOptions<2>&);
template bool is_face_encroached_by(const Mesh<3>&, const Domain<3>&, CellId, int, VertexId, const RefineOptions<3>&);
template std::vector<Entry<3>> encroached_edges(const Mesh<3>&, const Cavity<3>&, const Point<3>&);
template std::optional<Entry<2>> encroached_entity(const RefineContext<2>&, const Cavity<2>&, const Point<2>&);
template std::optional<Entry<3>> encroached_entity(const RefineContext<3>&, const Cavity<3>&, const Point<3>&);
template std::optional<Entry<2>> flattened_face(const RefineContext<2>&, const Cavity<2>&, const Point<2>&);

}  // namespace pgdr
