// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/segment_insertion.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "boundary/named_points.hpp"
#include "mesh/cell_blocks.hpp"
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

SegmentInsertion::SegmentInsertion(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay, const Domain<2>& domain,
                                   Bulk bulk)
    : mesh_(&mesh),
      pools_(&pools),
      domain_(&domain),
      bulk_(std::move(bulk)),
      ends_(domain.segments().size()),
      present_(ends_.size(), 0),
      fixed_(mesh.cell_bound(), 0),
      cell_at_(mesh.vertex_bound(), no_cell) {
  bulk_.each(ends_.size(), [&](std::size_t s) {
    const auto& points = domain.segments()[s].points;
    ends_[s] = {delaunay.vertices()[points[0]], delaunay.vertices()[points[1]]};
  });
  wanted_.set(bulk_.gather<Wanted::Item>(ends_.size(),
                                         [this](std::size_t s, std::vector<Wanted::Item>& out) {
                                           out.push_back(Wanted::item(ends_[s], static_cast<EntityId>(s)));
                                         }),
              mesh.vertex_bound(), bulk_);
}

/// One pass over all cells: which segments are edges, and a cell at each vertex. Of the cells at a vertex the one with the
/// largest id counts, whichever thread comes last.
void SegmentInsertion::find_segments() {
  bulk_.each(mesh_->cell_bound(), [this](std::size_t i) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!mesh_->alive(c)) return;
    const auto& corners = mesh_->cell(c).vertices;
    for (const VertexId v : corners) {
      if (v == infinite_vertex) continue;
      const std::atomic_ref<CellId> at(cell_at_[index(v)]);
      for (CellId now = at.load(std::memory_order_relaxed); now == no_cell || now < c;)
        if (at.compare_exchange_weak(now, c, std::memory_order_relaxed)) break;
    }
    each_segment_of(c, [&](int face, EntityId s) {
      fix(c, face);
      std::atomic_ref<std::uint8_t>(present_[s]).store(1, std::memory_order_relaxed);
    });
  });
}

/// Calls f(face, segment) for the faces of the cell that are segments.
template <class F>
void SegmentInsertion::each_segment_of(CellId c, const F& f) const {
  const auto& corners = mesh_->cell(c).vertices;
  std::array<VertexId, 3> v = corners;
  std::sort(v.begin(), v.end());
  wanted_.each_of(v, [&](const Wanted::Item& edge) {
    // The corners' numbers add up to 3.
    f(3 - corner_of(corners, edge.vertices[0]) - corner_of(corners, edge.vertices[1]), edge.what);
  });
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
  each_cell(*mesh_, *pools_, bulk_, [this](CellId c, Mesh<2>::Pools& own) {
    if (fixed_[index(c)] == 0) return;
    each_segment_of(c, [&](int face, EntityId s) { mesh_->constrain_face(own, c, face, s); });
  });
}

}  // namespace pgdr::detail
