// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/vertex_changes.hpp"

#include <algorithm>
#include <cmath>

#include "input/entities.hpp"
#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "optimize/numbers.hpp"

namespace pgdr {
namespace {

/// Of a subfacet of the facet, at one of the cells; the one of the largest area.
detail::Vector<3> normal_of_facet(const Mesh<3>& mesh, EntityId facet, std::span<const CellId> about) {
  detail::Vector<3> best{};
  double largest = 0;
  for (const CellId c : about) {
    const auto* k = mesh.constraints(c);
    for (int f = 0; k && f < 4; ++f) {
      if (!k->has_face(f) || k->face_entity[f] != facet) continue;
      const auto p = mesh.points(face_without(mesh.cell(c).vertices, f));
      const auto n = detail::cross(detail::difference<3>(p[1], p[0]), detail::difference<3>(p[2], p[0]));
      const double area2 = detail::dot(n, n);
      if (!(area2 > largest)) continue;
      largest = area2;
      best = n;
    }
  }
  return best;
}

std::array<double, 3> unit_of(const detail::Vector<3>& v) {
  const double length = std::sqrt(detail::dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

}  // namespace

void set_freedom(const Mesh<3>& mesh, const Domain<3>& domain, Home home, std::span<const CellId> about, Star& star) {
  star.freedom = 3;
  star.onto_entity = nullptr;
  if (home.kind() == EntityKind::facet) {
    star.freedom = 2;
    star.axis = unit_of(normal_of_facet(mesh, home.id(), about));
    star.onto_entity = [&domain, facet = home.id()](const Point3& x) { return point_on_facet(domain, facet, x); };
  } else if (home.kind() == EntityKind::segment) {
    const auto& ends = domain.segments()[home.id()].points;
    star.freedom = 1;
    star.axis = unit_of(detail::difference<3>(domain.points()[ends[1]], domain.points()[ends[0]]));
    star.onto_entity = [&domain, segment = home.id()](const Point3& x) {
      return point_on_segment<3>(domain, segment, segment_parameter<3>(domain, segment, x));
    };
  }
}

bool VertexChanges::move_vertex(CellId c, VertexId v, Judge::Rule rule) {
  Mesh<3>& mesh = *s_->mesh;
  if (s_->note(collect_star(mesh, s_->area(), v, c, numbers::most_star_cells, star_)) != Reach::ok) return false;
  points_.cells.clear();
  for (std::size_t i = 0; i < star_.cells.size(); ++i) {
    const auto& k = mesh.cell(star_.cells[i]);
    Star::Cell cell{{}, mesh.region(star_.cells[i])};
    for (int n = 0; n < 3; ++n) cell.base[n] = mesh.point(k.vertices[face_corners<3>[star_.corners[i]][n]]);
    points_.cells.push_back(cell);
  }
  s_->judge.take_sizes(star_.cells);
  points_.vertex = mesh.point(v);
  set_freedom(mesh, *s_->domain, star_.home, star_.cells, points_);
  const auto place = placement_.find(points_, s_->judge.quality());
  if (!place || !s_->owns(*place)) {
    if (place) s_->note(Reach::not_owned);
    return false;
  }
  const VertexId moved = s_->new_vertex(*place, star_.home);
  if (substitute(mesh, *s_->domain, star_, moved, tried_) && s_->judge.accepts(tried_, s_->judge.standing_of(tried_.old), rule) &&
      s_->commit(tried_)) {
    s_->transaction.add_vertex(moved);
    ++s_->w->visit->counts.moves;
    return true;
  }
  s_->drop_vertex(moved);
  return false;
}

bool VertexChanges::move(CellId c, Judge::Rule rule) {
  const auto vertices = s_->mesh->cell(c).vertices;
  return std::any_of(vertices.begin(), vertices.end(), [&](VertexId v) { return move_vertex(c, v, rule); });
}

/// The corners of the cell, and the vertices beyond its faces, with a cell that has them.
std::vector<std::pair<VertexId, CellId>> VertexChanges::vertices_about(CellId c) {
  const Mesh<3>& mesh = *s_->mesh;
  std::vector<std::pair<VertexId, CellId>> all;
  for (const VertexId v : mesh.cell(c).vertices) all.push_back({v, c});
  for (const Link next : mesh.cell(c).links) {
    if (!next) continue;
    const VertexId v = mesh.cell(next.cell()).vertices[next.face()];
    if (std::any_of(all.begin(), all.end(), [v](const auto& known) { return known.first == v; })) continue;
    if (s_->owns(next.cell()))
      all.push_back({v, next.cell()});
    else
      s_->note(Reach::not_owned);
  }
  return all;
}

bool VertexChanges::contract(CellId c, Judge::Rule rule) {
  Mesh<3>& mesh = *s_->mesh;
  std::optional<Judge::Standing> best;
  for (const auto& [v, cell] : vertices_about(c)) {
    if (s_->note(collect_star(mesh, s_->area(), v, cell, numbers::most_star_cells, star_)) != Reach::ok) continue;
    const Judge::Standing before = s_->judge.standing_of(star_.cells);
    if (before.levels.empty()) continue;
    for (const VertexId to : contraction_targets(mesh, star_)) {
      if (!substitute(mesh, *s_->domain, star_, to, tried_)) continue;
      const auto now = s_->judge.accepts(tried_, before, rule);
      if (!now || (best && !Judge::is_better(*now, *best)) || !s_->replacer.fits(tried_)) continue;
      best = now;
      std::swap(best_, tried_);
    }
  }
  if (!best || !s_->commit(best_)) return false;
  ++s_->w->visit->counts.removed;
  return true;
}

}  // namespace pgdr
