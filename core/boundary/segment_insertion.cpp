// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/segment_insertion.hpp"

#include "boundary/named_points.hpp"
#include "boundary/wanted_simplices.hpp"
#include "space/edge_forcing.hpp"

namespace pgdr::detail {

/// The mesh closed by ghosts, its constraints as fixed_ has them.
struct SegmentInsertion::Forcible {
  using Vertex = VertexId;
  using Cell = CellId;
  using Side = CellSide<CellId>;
  static constexpr bool from_b = true;

  SegmentInsertion& all;

  const Point2& point(VertexId v) const { return all.mesh_->point(v); }
  VertexId corner(CellId c, int i) const { return all.mesh_->cell(c).vertices[i]; }
  Side across(Side s) const {
    const Link behind = all.mesh_->cell(s.cell).links[s.edge];
    return {behind.cell(), behind.face()};
  }
  bool is_constraint(Side s) const { return all.fixed(s.cell, s.edge); }
  bool is_ghost(VertexId v) const { return v == infinite_vertex; }
  CellId cell_at(VertexId v) const { return all.cell_at_[index(v)]; }
  Sign orient(VertexId a, VertexId b, VertexId c) const { return orient2d(point(a), point(b), point(c)); }
  bool is_ahead(VertexId a, VertexId b, VertexId c) const {
    const int k = point(a)[0] != point(b)[0] ? 0 : 1;
    return point(a)[k] < point(b)[k] ? point(a)[k] < point(c)[k] : point(c)[k] < point(a)[k];
  }
  bool in_circle(VertexId a, VertexId b, VertexId c, VertexId d) const {
    return in_sphere_perturbed<2>({point(a), point(b), point(c)}, point(d)) == Sign::positive;
  }
  void set(CellId c, const std::array<VertexId, 3>& v) {
    all.mesh_->set_vertices(c, v);
    all.fixed_[index(c)] = 0;
    for (const VertexId w : v) all.cell_at_[index(w)] = c;
  }
  void link(Side a, Side b) {
    all.mesh_->cell(a.cell).links[a.edge] = Link(b.cell, b.edge);
    all.mesh_->cell(b.cell).links[b.edge] = Link(a.cell, a.edge);
  }
  void constrain(Side s) { all.fix(s.cell, s.edge); }
};

SegmentInsertion::SegmentInsertion(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay, const Domain<2>& domain)
    : mesh_(&mesh), pools_(&pools), domain_(&domain), fixed_(mesh.cell_bound(), 0), cell_at_(mesh.vertex_bound(), no_cell) {
  for (const DomainSegment& s : domain.segments())
    ends_.push_back({delaunay.vertices()[s.points[0]], delaunay.vertices()[s.points[1]]});
}

/// One pass over all cells: which segments are edges, and a cell at each vertex.
void SegmentInsertion::find_segments() {
  WantedSimplices<2> edges;
  for (EntityId s = 0; s < ends_.size(); ++s) edges.add(ends_[s], s);
  edges.index_by_first(mesh_->vertex_bound());
  present_.assign(ends_.size(), false);
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    const auto& v = mesh_->cell(c).vertices;
    for (int f = 0; f < 3; ++f) {
      if (v[f] != infinite_vertex) cell_at_[index(v[f])] = c;
      const auto* edge = edges.find({v[(f + 1) % 3], v[(f + 2) % 3]});
      if (!edge) continue;
      fix(c, f);
      present_[edge->entity] = true;
    }
  }
}

void SegmentInsertion::fail(EntityId s, VertexId through) const {
  const auto& ends = domain_->segments()[s].points;
  Diagnostic d = about_points<2>(Errc::entities_intersect, *domain_, ends);
  d.message = segment_words(d) + (through == no_vertex ? " crosses another segment" : " passes through another point");
  const Point2& p = through == no_vertex ? domain_->points()[ends[0]] : mesh_->point(through);
  d.points = {{p[0], p[1], 0}};
  throw InputError(std::move(d));
}

void SegmentInsertion::force(EntityId s) {
  using Forcing = EdgeForcing<Forcible>;
  Forcible triangles{*this};
  Forcing forcing;
  const Forcing::Plan plan = forcing.plan(triangles, ends_[s][0], ends_[s][1]);
  switch (plan.status) {
    case Forcing::Status::is_edge:  // by now
      triangles.constrain(plan.side);
      return triangles.constrain(triangles.across(plan.side));
    case Forcing::Status::planned: return forcing.write(triangles);
    case Forcing::Status::meets_vertex: fail(s, plan.met[0]);
    case Forcing::Status::no_fill:
      throw ResourceError({Errc::internal, "a polygon beside a segment has no triangle", {}, 0, {}, {}});
    default: fail(s, no_vertex);
  }
}

/// Writes the constraints.
void SegmentInsertion::mark() {
  WantedSimplices<2> edges;
  for (EntityId s = 0; s < ends_.size(); ++s) edges.add(ends_[s], s);
  edges.index_by_first(mesh_->vertex_bound());
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    for (int f = 0; f < 3; ++f) {
      if (!fixed(c, f)) continue;
      const auto& v = mesh_->cell(c).vertices;
      mesh_->constrain_face(*pools_, c, f, edges.find({v[(f + 1) % 3], v[(f + 2) % 3]})->entity);
    }
  }
}

}  // namespace pgdr::detail
