// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/insertions.hpp"

#include <algorithm>

#include "change/facet_flip.hpp"
#include "input/entities.hpp"
#include "mesh/pinched_edges.hpp"
#include "numbers/corners.hpp"
#include "optimize/numbers.hpp"
#include "optimize/polyhedron_filling.hpp"
#include "optimize/vertex_changes.hpp"
#include "pgdr/predicates.hpp"
#include "refine/split_points.hpp"

namespace pgdr {
namespace {

Point3 middle(const Point3& p, const Point3& q) {
  return lex_less<3>(p, q) ? Point3{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2}
                           : Point3{(q[0] + p[0]) / 2, (q[1] + p[1]) / 2, (q[2] + p[2]) / 2};
}

}  // namespace

/// The halves of the cells of the ring, seen from the new vertex.
void Insertions::add_star_of_ring() {
  const Mesh<3>& mesh = *s_->mesh;
  star_.cells.clear();
  const Point3 &a = mesh.point(ring_.ends[0]), &b = mesh.point(ring_.ends[1]);
  for (std::size_t i = 0; i < ring_.cells.size(); ++i) {
    const Point3 &x = mesh.point(ring_.vertices[i]), &y = mesh.point(ring_.vertex(i + 1));
    const int region = mesh.region(ring_.cells[i]);
    // (a, b, x, y) is positive. So are (a, m, x, y) and (m, b, x, y), which are even permutations of these with m behind.
    star_.cells.push_back({{a, x, y}, region});
    star_.cells.push_back({{b, y, x}, region});
  }
}

/// Does each subfacet at the edge become two that are turned as it is?
bool Insertions::keeps_sides(VertexId m) const {
  const Mesh<3>& mesh = *s_->mesh;
  const auto [a, b] = ring_.ends;
  for (std::size_t i = 0; i < ring_.walls.size(); ++i) {
    if (ring_.walls[i] == no_entity) continue;
    const int axis = s_->domain->facets()[ring_.walls[i]].axis;
    const VertexId tip = ring_.vertices[i];
    const auto side = [&](VertexId u, VertexId v) {
      return orient_projected(mesh.point(u), mesh.point(v), mesh.point(tip), axis);
    };
    const Sign whole = side(a, b);
    if (whole == Sign::zero || side(a, m) != whole || side(m, b) != whole) return false;
    if (lie_in_line<3>(mesh, *s_->domain, {a, m, tip}) || lie_in_line<3>(mesh, *s_->domain, {m, b, tip})) return false;
  }
  return true;
}

bool Insertions::split_ring(const Point3& x, Home home) {
  Mesh<3>& mesh = *s_->mesh;
  add_star_of_ring();
  s_->judge.take_sizes(ring_.cells);
  star_.vertex = x;
  set_freedom(mesh, *s_->domain, home, ring_.cells, star_);
  const Point3 place = placement_.find(star_, s_->judge.quality()).value_or(x);
  if (!s_->owns(place)) return s_->note(Reach::not_owned) == Reach::ok;
  const VertexId m = s_->new_vertex(place, home);
  tried_.clear();
  tried_.old = ring_.cells;
  const auto [a, b] = ring_.ends;
  for (std::size_t i = 0; i < ring_.cells.size(); ++i) {
    const std::uint16_t region = mesh.region(ring_.cells[i]);
    tried_.cells.push_back({{a, m, ring_.vertices[i], ring_.vertex(i + 1)}, region});
    tried_.cells.push_back({{m, b, ring_.vertices[i], ring_.vertex(i + 1)}, region});
  }
  for (std::size_t i = 0; i < ring_.walls.size(); ++i) {
    if (ring_.walls[i] == no_entity) continue;
    tried_.walls.push_back({{a, m, ring_.vertices[i]}, ring_.walls[i]});
    tried_.walls.push_back({{m, b, ring_.vertices[i]}, ring_.walls[i]});
  }
  if (ring_.segment != no_entity) {
    tried_.subsegments.push_back({{a, m}, ring_.segment});
    tried_.subsegments.push_back({{m, b}, ring_.segment});
  }
  if (!keeps_sides(m) || !s_->judge.is_valid(tried_) || !s_->commit(tried_)) {
    s_->drop_vertex(m);
    return false;
  }
  s_->transaction.add_vertex(m);
  ++s_->w->visit->counts.committed;
  return true;
}

bool Insertions::split_edge(CellId c, int edge) {
  const Mesh<3>& mesh = *s_->mesh;
  if (s_->w->visit->counts.committed >= s_->w->visit->most_insertions) return false;
  if (s_->note(collect_ring(mesh, s_->area(), c, edge, numbers::longest_split_ring, ring_)) != Reach::ok) return false;
  const auto [a, b] = ring_.ends;
  const Point3 x = middle(mesh.point(a), mesh.point(b));
  if (ring_.segment != no_entity) {
    if (s_->w->context.kept.has({EntityKind::segment, ring_.segment})) return false;
    const auto* pinched = mesh.pinched_edges();
    if (pinched && pinched->has(ring_.segment)) return false;
    return split_ring(split_point<3>(s_->w->context, ring_.segment, a, b), Home(EntityKind::segment, ring_.segment));
  }
  EntityId facet = no_entity;
  for (const EntityId wall : ring_.walls) {
    if (wall != no_entity && facet != no_entity && wall != facet) return false;
    if (wall != no_entity) facet = wall;
  }
  if (facet == no_entity) return split_ring(x, Home(EntityKind::volume, 0));
  if (s_->w->context.kept.has({EntityKind::facet, facet})) return false;
  return split_ring(point_on_facet(*s_->domain, facet, x), Home(EntityKind::facet, facet));
}

/// Takes neighbours, for as long as a cell from p to a face of the hole would be no better than `enough`. False where that ends
/// at a wall, or at too many: a star needs no search, so that it may take twice the cells of a polyhedron that is filled anew.
bool Insertions::dig_out(CellId c, const Point3& p, double enough) {
  const Mesh<3>& mesh = *s_->mesh;
  take(c);
  while (true) {
    star_.cells.clear();
    rim_.clear();
    const RimFace* worst = nullptr;
    for (const CellId x : cells_)
      for (int f = 0; f < 4; ++f) {
        const Link link = mesh.cell(x).links[f];
        const bool wall = !link || mesh.constrained(x, f);
        if (!wall && mesh.marked(link.cell())) continue;
        Star::Cell cell{mesh.points(face_inwards(mesh.cell(x).vertices, f)), mesh.region(x)};
        const double q = s_->judge.quality().of({cell.base[0], cell.base[1], cell.base[2], p}, cell.region);
        star_.cells.push_back(cell);
        rim_.push_back({x, f, q});
      }
    for (const RimFace& r : rim_) {
      if (r.quality > enough) continue;
      const Link link = mesh.cell(r.cell).links[r.face];
      if (!link || mesh.constrained(r.cell, r.face)) continue;
      if (!worst || r.quality < worst->quality) worst = &r;
    }
    const bool all_better = std::all_of(rim_.begin(), rim_.end(), [&](const RimFace& r) { return r.quality > enough; });
    if (all_better) return true;
    if (!worst || cells_.size() >= 2 * PolyhedronFilling::most_cells) return false;
    const CellId next = mesh.cell(worst->cell).links[worst->face].cell();
    if (!s_->owns(next)) return s_->note(Reach::not_owned) == Reach::ok;
    take(next);
  }
}

/// Is any vertex of the input, or on an entity of it, in the hole, and not on its rim?
bool Insertions::loses_vertex() const {
  const Mesh<3>& mesh = *s_->mesh;
  const auto on_rim = [&](VertexId v) {
    return std::any_of(tried_.cells.begin(), tried_.cells.end(), [v](const auto& cell) { return has_corner(cell.vertices, v); });
  };
  return std::any_of(cells_.begin(), cells_.end(), [&](CellId c) {
    const auto& vertices = mesh.cell(c).vertices;
    return std::any_of(vertices.begin(), vertices.end(), [&](VertexId v) { return !s_->w->in_volume(v) && !on_rim(v); });
  });
}

/// The replacement of the cells that were dug out.
bool Insertions::fill_hole(const Point3& p) {
  Mesh<3>& mesh = *s_->mesh;
  star_.vertex = p;
  star_.freedom = 3;
  star_.onto_entity = nullptr;
  const Point3 place = placement_.find(star_, s_->judge.quality()).value_or(p);
  if (!s_->owns(place)) return s_->note(Reach::not_owned) == Reach::ok;
  const VertexId m = s_->new_vertex(place, Home(EntityKind::volume, 0));
  tried_.clear();
  tried_.old = cells_;
  for (const RimFace& r : rim_) {
    const auto face = face_inwards(mesh.cell(r.cell).vertices, r.face);
    tried_.cells.push_back({{face[0], face[1], face[2], m}, mesh.region(r.cell)});
  }
  return true;
}

bool Insertions::dig(CellId c, Judge::Rule rule) {
  Mesh<3>& mesh = *s_->mesh;
  if (s_->w->visit->counts.committed >= s_->w->visit->most_insertions) return false;
  const Point3 p = centroid<3>(mesh.simplex(c));
  cells_.clear();
  const bool dug = dig_out(c, p, Judge::too_bad(s_->judge.standing_of(std::array{c})));
  for (const CellId x : cells_) mesh.unmark(x);
  if (!dug || !fill_hole(p)) return false;
  const VertexId m = tried_.cells.front().vertices[3];
  if (s_->judge.accepts(tried_, s_->judge.standing_of(tried_.old), rule) && !loses_vertex() && s_->replacer.fits(tried_) &&
      s_->commit(tried_)) {
    s_->transaction.add_vertex(m);
    ++s_->w->visit->counts.committed;
    return true;
  }
  s_->drop_vertex(m);
  return false;
}

}  // namespace pgdr
