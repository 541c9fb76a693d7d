// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/change.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "replace/shape.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

/// The face with w in the place of u.
SurfaceFace with(SurfaceFace face, std::uint32_t u, std::uint32_t w) {
  for (std::uint32_t& c : face.corners)
    if (c == u) c = w;
  return face;
}

void add_come(SurfaceChange& change, const SurfaceFace& face, std::uint32_t from) {
  change.come.push_back(face);
  change.from.push_back(from);
}

}  // namespace

bool is_contractible(const SurfaceComplex& s, std::uint32_t u, std::uint32_t v) {
  std::vector<std::uint32_t> third, common;
  s.each_face_at(u, v, [&](std::uint32_t f) { third.push_back(corner_beside(s.faces[f].corners, u, v)); });
  std::sort(third.begin(), third.end());
  third.erase(std::unique(third.begin(), third.end()), third.end());
  const auto of_u = s.neighbours(u), of_v = s.neighbours(v);
  std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(), std::back_inserter(common));
  if (common != third) return false;
  for (const std::uint32_t f : s.faces_at[u]) {  // (u, x, y) and (v, x, y)
    const auto& c = s.faces[f].corners;
    if (s.has_corner(f, v)) continue;
    const std::uint32_t x = c[0] == u ? c[1] : c[0], y = corner_beside(c, u, x);
    bool is_twice = false;
    s.each_face_at(v, x, [&](std::uint32_t g) { is_twice = is_twice || s.has_corner(g, y); });
    if (is_twice) return false;
  }
  return true;
}

std::optional<SurfaceChange> contraction(const SurfaceComplex& s, std::uint32_t u, std::uint32_t v, const Point3& place) {
  const std::uint32_t curve = s.curve_of(u, v);
  const bool moves = !(place == s.at(v));
  if (s.order[u] == VertexOrder::fixed || (s.order[u] == VertexOrder::on_curve && curve == no_index)) return {};
  if (moves && (s.order[u] != VertexOrder::free || s.order[v] != VertexOrder::free)) return {};
  SurfaceChange change;
  change.u = u;
  change.v = v;
  change.moved = moves ? v : no_index;
  change.place = place;
  if (s.order[u] == VertexOrder::on_curve) {
    const auto& kept = s.kept_at[u];
    const std::uint32_t w = kept[0].other == v ? kept[1].other : kept[0].other;
    if (w == v || s.is_kept(v, w)) return {};
    change.kept_gone = {{{u, v}, curve}, {{u, w}, curve}};
    change.kept_come = {{{v, w}, curve}};
  }
  for (const std::uint32_t f : s.faces_at[u]) {
    change.gone.push_back(f);
    if (!s.has_corner(f, v)) add_come(change, with(s.faces[f], u, v), f);
  }
  if (moves)
    for (const std::uint32_t f : s.faces_at[v])
      if (!s.has_corner(f, u)) {
        change.gone.push_back(f);
        add_come(change, with(s.faces[f], v, v), f);
      }
  if (change.come.empty()) return {};
  return change;
}

std::optional<SurfaceChange> flip(const SurfaceComplex& s, std::uint32_t a, std::uint32_t b) {
  if (s.is_kept(a, b)) return {};
  auto faces = s.faces_of_edge(a, b);
  if (faces.size() != 2 || s.is_fixed(faces[0])) return {};
  // The new faces run round as the first one does, which no number may say.
  if (triangle_less(s.triangle(faces[1]), s.triangle(faces[0]))) std::swap(faces[0], faces[1]);
  const std::uint32_t c = corner_beside(s.faces[faces[0]].corners, a, b), d = corner_beside(s.faces[faces[1]].corners, a, b);
  const auto near = s.neighbours(c);
  if (c == d || std::binary_search(near.begin(), near.end(), d)) return {};
  SurfaceChange change;
  change.kind = SurfaceChange::Kind::flip;
  change.u = a;
  change.v = b;
  change.gone = faces;
  add_come(change, with(s.faces[faces[0]], b, d), faces[0]);  // (a, d, c), the way that (a, b, c) runs
  add_come(change, with(s.faces[faces[0]], a, d), faces[0]);
  if (s.faces[faces[0]].group != s.faces[faces[1]].group)
    for (SurfaceFace& f : change.come) f.group = no_index;
  return change;
}

SurfaceChange move(const SurfaceComplex& s, std::uint32_t v, const Point3& place) {
  SurfaceChange change;
  change.kind = SurfaceChange::Kind::move;
  change.u = change.moved = v;
  change.place = place;
  for (const std::uint32_t f : s.faces_at[v]) {
    change.gone.push_back(f);
    add_come(change, with(s.faces[f], v, v), f);
  }
  for (const KeptEdge& e : s.kept_at[v]) change.kept_gone.push_back({{v, e.other}, e.curve});
  change.kept_come = change.kept_gone;
  return change;
}

SurfaceChange split(const SurfaceComplex& s, std::uint32_t a, std::uint32_t b, const Point3& place) {
  SurfaceChange change;
  change.kind = SurfaceChange::Kind::split;
  change.u = a;
  change.v = b;
  change.moved = static_cast<std::uint32_t>(s.points.size());
  change.place = place;
  s.each_face_at(a, b, [&](std::uint32_t f) {
    change.gone.push_back(f);
    add_come(change, with(s.faces[f], b, change.moved), f);
    add_come(change, with(s.faces[f], a, change.moved), f);
  });
  if (const std::uint32_t curve = s.curve_of(a, b); curve != no_index) {
    change.kept_gone = {{{a, b}, curve}};
    change.kept_come = {{{a, change.moved}, curve}, {{change.moved, b}, curve}};
  }
  return change;
}

namespace {

/// All of a flat group that hangs together with a face.
std::vector<std::uint32_t> part_of_group(const SurfaceView& view, std::uint32_t face) {
  std::vector<std::uint32_t> part{face};
  for (std::size_t next = 0; next < part.size(); ++next) {
    const auto& c = view.face(part[next]).corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = c[i], b = c[(i + 1) % 3];
      if (view.is_kept(a, b)) continue;
      const std::uint32_t g = view.beyond(part[next], a, b);
      if (g == no_index || view.face(g).group != view.face(face).group) continue;
      if (std::find(part.begin(), part.end(), g) == part.end()) part.push_back(g);
    }
  }
  return part;
}

/// Does the mesher take the part of a group that a face is in for one facet? It must not be bent more than that.
bool is_one_facet(const SurfaceComplex& s, const SurfaceView& view, std::uint32_t face, Box<3>& read) {
  Box<3> box = Box<3>::empty();
  std::vector<std::array<Point3, 3>> triangles;
  for (const std::uint32_t f : part_of_group(view, face)) {
    const auto& c = view.face(f).corners;
    triangles.push_back({view.at(c[0]), view.at(c[1]), view.at(c[2])});
    sort_corners(triangles.back());
    for (const Point3& p : triangles.back()) box.add(p);
  }
  read.add(box);
  const auto normal_of = [](const auto& t) { return cross(difference(t[1], t[0]), difference(t[2], t[0])); };
  const auto largest = *std::max_element(triangles.begin(), triangles.end(), [&](const auto& t, const auto& u) {
    const auto m = normal_of(t), n = normal_of(u);
    return dot(m, m) != dot(n, n) ? dot(m, m) < dot(n, n) : triangle_less(t, u);
  });
  const auto n = normal_of(largest);
  const double most = most_bend_of(s, box) * std::sqrt(dot(n, n));
  return std::all_of(triangles.begin(), triangles.end(), [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](const Point3& p) { return std::fabs(dot(n, difference(p, largest[0]))) <= most; });
  });
}

/// Takes faces that come out of groups that would be bent too much.
void drop_bent(const SurfaceComplex& s, SurfaceChange& change, Box<3>& read) {
  const SurfaceView after(s, &change);
  for (std::size_t k = 0; k < change.come.size(); ++k) {
    const std::uint32_t g = change.come[k].group;
    if (g == no_index) continue;
    const auto t = triangle_after(s, change, change.come[k]);
    const double surely = numbers::surely_flat * s.groups[g].bend;
    if (std::all_of(t.begin(), t.end(), [&](const Point3& p) { return height_over(s.groups[g], p) <= surely; })) continue;
    if (is_one_facet(s, after, static_cast<std::uint32_t>(s.faces.size() + k), read)) continue;
    for (SurfaceFace& face : change.come)
      if (face.group == g) face.group = no_index;
  }
}

}  // namespace

bool regroup(const SurfaceComplex& s, SurfaceChange& change, Box<3>& read) {
  const auto projected = [](const std::array<Point3, 3>& t, int axis) { return orient_projected(t[0], t[1], t[2], axis); };
  for (std::size_t k = 0; k < change.come.size(); ++k) {
    SurfaceFace& face = change.come[k];
    if (face.group != no_index) {
      const FlatGroup& group = s.groups[face.group];
      const auto t = triangle_after(s, change, face);
      const bool is_near = std::all_of(t.begin(), t.end(), [&](const Point3& p) { return height_over(group, p) <= s.flatness; });
      const Sign way = projected(s.triangle(change.from[k]), group.axis);
      if (!is_near || way == Sign::zero || projected(t, group.axis) != way) face.group = no_index;
    }
  }
  drop_bent(s, change, read);
  for (std::size_t k = 0; k < change.come.size(); ++k) {
    const std::uint32_t before = s.faces[change.from[k]].group;
    if (change.come[k].group == no_index && before != no_index && s.groups[before].is_wide) return false;
  }
  if (change.kind != SurfaceChange::Kind::flip) return true;
  for (const std::uint32_t f : change.gone) {  // both faces stand for the first one, above
    const std::uint32_t group = s.faces[f].group;
    if (group != no_index && s.groups[group].is_wide && change.come[0].group != group) return false;
  }
  return true;
}

}  // namespace pgdr::detail
