// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/segment_insertion.hpp"

#include <algorithm>
#include <cassert>

#include "boundary/named_points.hpp"
#include "boundary/wanted_simplices.hpp"

namespace pgdr::detail {
namespace {

int corner(const CellRecord<2>& k, VertexId v) {
  return static_cast<int>(std::find(k.vertices.begin(), k.vertices.end(), v) - k.vertices.begin());
}

}  // namespace

SegmentInsertion::SegmentInsertion(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay,
                                   const Domain<2>& domain)
    : mesh_(&mesh),
      pools_(&pools),
      domain_(&domain),
      fixed_(mesh.cell_bound(), 0),
      cell_at_(mesh.vertex_bound(), no_cell) {
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
      fix({c, f});
      present_[edge->entity] = true;
    }
  }
}

void SegmentInsertion::fail(EntityId s, VertexId through) const {
  const auto& ends = domain_->segments()[s].points;
  Diagnostic d = about_points<2>(Errc::entities_intersect, *domain_, ends);
  d.message = segment_words(d) +
              (through == no_vertex ? " crosses another segment" : " passes through another point");
  const Point2& p = through == no_vertex ? domain_->points()[ends[0]] : mesh_->point(through);
  d.points = {{p[0], p[1], 0}};
  throw InputError(std::move(d));
}

/// The cell at the segment's first end, and its face opposite that, through which the segment leaves; or, if it has become
/// an edge by now, the side of a cell that it is.
auto SegmentInsertion::first_crossing(EntityId s) const -> Side {
  const auto [a, b] = ends_[s];
  const Point2 &p = mesh_->point(a), &q = mesh_->point(b);
  const CellId first = cell_at_[index(a)];
  CellId c = first;
  do {
    const auto& k = mesh_->cell(c);
    const int i = corner(k, a);
    const VertexId u = k.vertices[(i + 1) % 3], w = k.vertices[(i + 2) % 3];
    if (u == b) return {c, (i + 2) % 3};
    if (u != infinite_vertex && w != infinite_vertex && orient2d(p, q, mesh_->point(u)) == Sign::negative &&
        orient2d(p, q, mesh_->point(w)) == Sign::positive)
      return {c, i};
    c = k.links[(i + 1) % 3].cell();
  } while (c != first);
  fail(s, no_vertex);  // along an edge, to a point inside the segment
}

/// Along the segment: what it crosses, and the polygons on both sides of it.
void SegmentInsertion::march(EntityId s, Side at) {
  const auto [a, b] = ends_[s];
  const Point2 &p = mesh_->point(a), &q = mesh_->point(b);
  const auto edge = [this](CellId c, int f) { return ChainEdge{Link(c, f), mesh_->cell(c).links[f], fixed(c, f), {}}; };
  VertexId r = mesh_->cell(at.cell).vertices[(at.face + 1) % 3], l = mesh_->cell(at.cell).vertices[(at.face + 2) % 3];
  crossed_ = {at.cell};
  left_ = {{a, l}, {edge(at.cell, (at.face + 1) % 3)}};
  right_ = {{a, r}, {edge(at.cell, (at.face + 2) % 3)}};
  while (true) {
    if (fixed(at.cell, at.face)) fail(s, no_vertex);
    const Link beyond = mesh_->cell(at.cell).links[at.face];
    const CellId c = beyond.cell();
    const int f = beyond.face();  // the cell is (w, l, r)
    const VertexId w = mesh_->cell(c).vertices[f];
    if (w == infinite_vertex) fail(s, no_vertex);
    const Sign side = w == b ? Sign::zero : orient2d(p, q, mesh_->point(w));
    if (w != b && side == Sign::zero) fail(s, w);
    crossed_.push_back(c);
    if (side != Sign::negative) {
      left_.vertices.push_back(w);
      left_.edges.push_back(edge(c, (f + 2) % 3));
    }
    if (side != Sign::positive) {
      right_.vertices.push_back(w);
      right_.edges.push_back(edge(c, (f + 1) % 3));
    }
    if (w == b) break;
    at = {c, (f + (side == Sign::positive ? 1 : 2)) % 3};
    (side == Sign::positive ? l : r) = w;
  }
  // The right polygon is to the left of the segment from its last point to its first.
  std::reverse(right_.vertices.begin(), right_.vertices.end());
  std::reverse(right_.edges.begin(), right_.edges.end());
}

/// The vertex of the chain that makes a triangle with vertices i and j.
std::size_t SegmentInsertion::apex(const std::vector<VertexId>& chain, std::size_t i, std::size_t j) const {
  Simplex<2> s{mesh_->point(chain[i]), mesh_->point(chain[j]), {}};
  std::size_t best = i;
  for (std::size_t k = i + 1; k < j; ++k) {
    if (chain[k] == chain[i] || chain[k] == chain[j] || chain[k] == chain[best]) continue;
    const Point2& p = mesh_->point(chain[k]);
    if (orient2d(s[0], s[1], p) != Sign::positive) continue;
    if (best != i && in_sphere_perturbed<2>(s, p) != Sign::positive) continue;
    best = k;
    s[2] = p;
  }
  if (best == i) throw ResourceError({Errc::internal, "a polygon beside a segment has no triangle", {}, 0, {}, {}});
  return best;
}

void SegmentInsertion::link(Side a, Side b) {
  mesh_->cell(a.cell).links[a.face] = Link(b.cell, b.face);
  mesh_->cell(b.cell).links[b.face] = Link(a.cell, a.face);
}

/// Triangles to the left of the segment from the chain's first vertex to its last; returns the segment's side.
auto SegmentInsertion::fill(Chain& chain) -> Side {
  const auto& v = chain.vertices;
  struct Base {
    std::size_t i, j;
    Side below;  // of the cell on its other side
  };
  std::vector<Base> todo{{0, v.size() - 1, {no_cell, 0}}};
  Side first{no_cell, 2};
  while (!todo.empty()) {
    const Base base = todo.back();
    todo.pop_back();
    if (base.i + 1 == base.j) {
      chain.edges[base.i].now = base.below;
      continue;
    }
    const std::size_t k = apex(v, base.i, base.j);
    const CellId c = crossed_.back();
    crossed_.pop_back();
    mesh_->set_vertices(c, {v[base.i], v[base.j], v[k]});
    fixed_[index(c)] = 0;
    for (const VertexId w : mesh_->cell(c).vertices) cell_at_[index(w)] = c;
    if (first.cell == no_cell) {
      first.cell = c;
    } else {
      link({c, 2}, base.below);
    }
    todo.push_back({base.i, k, {c, 1}});
    todo.push_back({k, base.j, {c, 0}});
  }
  return first;
}

/// Links the edges of both chains to what is behind them.
void SegmentInsertion::join() {
  std::vector<std::pair<std::uint32_t, Side>> now;  // of each old side
  for (const Chain* chain : {&left_, &right_})
    for (const ChainEdge& e : chain->edges) now.push_back({e.old.code, e.now});
  std::sort(now.begin(), now.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  for (const Chain* chain : {&left_, &right_})
    for (const ChainEdge& e : chain->edges) {
      const auto twin = std::partition_point(now.begin(), now.end(), [&](const auto& x) { return x.first < e.beyond.code; });
      const bool dangling = twin != now.end() && twin->first == e.beyond.code;
      link(e.now, dangling ? twin->second : Side{e.beyond.cell(), e.beyond.face()});
      if (e.fixed) fix(e.now);
    }
}

void SegmentInsertion::force(EntityId s) {
  const Side first = first_crossing(s);
  if (mesh_->cell(first.cell).vertices[first.face] != ends_[s][0]) {
    const Link other = mesh_->cell(first.cell).links[first.face];
    fix(first);
    return fix({other.cell(), other.face()});
  }
  march(s, first);
  const Side above = fill(left_), below = fill(right_);
  assert(crossed_.empty());
  join();
  link(above, below);
  fix(above);
  fix(below);
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
      auto& k = mesh_->ensure_constraints(*pools_, c);
      k.faces |= static_cast<std::uint8_t>(1 << f);
      k.face_entity[f] = edges.find({v[(f + 1) % 3], v[(f + 2) % 3]})->entity;
    }
  }
}

}  // namespace pgdr::detail
