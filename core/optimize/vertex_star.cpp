// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/vertex_star.hpp"

#include <algorithm>

#include "change/facet_flip.hpp"
#include "mesh/pinched_edges.hpp"
#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

template <class T>
void add_new(std::vector<T>& list, const T& x) {
  if (std::find(list.begin(), list.end(), x) == list.end()) list.push_back(x);
}

/// Do the two other corners of the subfacet opposite corner `face` see `by` on the side on which they see the vertex?
bool keeps_side(const Mesh<3>& mesh, const Domain<3>& domain, CellId c, int face, int corner, VertexId by) {
  const auto& v = mesh.cell(c).vertices;
  const auto [i, j] = corners_without(face, corner);
  const int axis = domain.facets()[mesh.constraints(c)->face_entity[face]].axis;
  if (lie_in_line<3>(mesh, domain, {by, v[i], v[j]})) return false;
  const Point3 &p = mesh.point(v[i]), &q = mesh.point(v[j]);
  const auto side = [&](VertexId x) { return orient_projected(p, q, mesh.point(x), axis); };
  const Sign now = side(by);
  return now != Sign::zero && now == side(v[corner]);
}

/// What is constrained at the vertex in one of its cells. @returns false as substitute()
bool add_constraints(const Mesh<3>& mesh, const Domain<3>& domain, CellId c, int corner, VertexId by, Replacement<3>& r) {
  const auto* k = mesh.constraints(c);
  if (!k) return true;
  const auto& v = mesh.cell(c).vertices;
  const int target = corner_of(v, by);  // 4: the cell does not vanish
  for (int f = 0; f < 4; ++f) {
    if (f == corner || !k->has_face(f) || (target < 4 && f != target)) continue;
    if (target == f && k->has_face(corner)) return false;  // two subfacets would become one
    if (target == 4 && !keeps_side(mesh, domain, c, f, corner, by)) return false;
    std::array<VertexId, 3> wall = face_without(v, f);
    std::replace(wall.begin(), wall.end(), v[corner], by);
    r.walls.push_back({wall, k->face_entity[f]});
  }
  for (int i = 0; i < 4; ++i) {
    if (i == corner || i == target || !k->has_edge(edge_of_ends[corner][i])) continue;
    if (target < 4) return false;  // two edges would become one
    r.subsegments.push_back({{by, v[i]}, k->edge_entity[edge_of_ends[corner][i]]});
  }
  return true;
}

}  // namespace

Reach collect_star(Mesh<3>& mesh, const VisitArea<3>* area, VertexId v, CellId c, std::size_t most_cells, VertexStar& star) {
  star.vertex = v;
  star.home = mesh.vertex(v).home;
  star.cells.clear();
  star.corners.clear();
  if (star.home.kind() == EntityKind::vertex) return Reach::stays;
  // No walk across faces leads to all cells at a subsegment with several fans.
  const auto* pinched = mesh.pinched_edges();
  if (star.home.kind() == EntityKind::segment && pinched && pinched->has(star.home.id())) return Reach::stays;
  Reach reach = Reach::ok;
  const auto take = [&](CellId x) {
    mesh.mark(x);
    star.cells.push_back(x);
    star.corners.push_back(corner_of(mesh.cell(x).vertices, v));
  };
  take(c);
  for (std::size_t i = 0; i < star.cells.size() && reach == Reach::ok; ++i)
    for (int f = 0; f < 4 && reach == Reach::ok; ++f) {
      const Link next = mesh.cell(star.cells[i]).links[f];
      if (f == star.corners[i] || !next || mesh.marked(next.cell())) continue;
      if (star.cells.size() >= most_cells) reach = Reach::stays;
      if (area && !area->owns(mesh, next.cell())) reach = Reach::not_owned;
      if (reach == Reach::ok) take(next.cell());
    }
  for (const CellId x : star.cells) mesh.unmark(x);
  return reach;
}

std::vector<VertexId> contraction_targets(const Mesh<3>& mesh, const VertexStar& star) {
  std::vector<VertexId> to;
  for (std::size_t n = 0; n < star.cells.size(); ++n) {
    const CellId c = star.cells[n];
    const int at = star.corners[n];
    const auto& v = mesh.cell(c).vertices;
    const auto* k = mesh.constraints(c);
    for (int i = 0; i < 4; ++i) {
      if (i == at) continue;
      bool may = star.home.kind() == EntityKind::volume;
      if (star.home.kind() == EntityKind::segment) may = k && k->has_edge(edge_of_ends[at][i]);
      for (int f = 0; f < 4 && star.home.kind() == EntityKind::facet && k && !may; ++f) may = f != at && f != i && k->has_face(f);
      if (may) add_new(to, v[i]);
    }
  }
  return to;
}

bool substitute(const Mesh<3>& mesh, const Domain<3>& domain, const VertexStar& star, VertexId by, Replacement<3>& r) {
  r.clear();
  r.old = star.cells;
  for (std::size_t n = 0; n < star.cells.size(); ++n) {
    const CellId c = star.cells[n];
    if (!add_constraints(mesh, domain, c, star.corners[n], by, r)) return false;
    auto vertices = mesh.cell(c).vertices;
    if (has_corner(vertices, by)) continue;
    vertices[star.corners[n]] = by;
    r.cells.push_back({vertices, mesh.region(c)});
  }
  return true;
}

}  // namespace pgdr
