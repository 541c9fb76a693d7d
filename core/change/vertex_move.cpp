// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/vertex_move.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "cavity/cavity.hpp"
#include "change/facet_flip.hpp"
#include "mesh/pinched_edges.hpp"
#include "pgdr/predicates.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {
namespace {

template <class T>
void add_new(std::vector<T>& list, const T& x) {
  if (std::find(list.begin(), list.end(), x) == list.end()) list.push_back(x);
}

}  // namespace

/// Of the vertex in the cell; -1 if it has none such.
int VertexMove::number_of(CellId c, VertexId v) const {
  const auto& vertices = mesh_->cell(c).vertices;
  const auto at = std::find(vertices.begin(), vertices.end(), v);
  return at == vertices.end() ? -1 : static_cast<int>(at - vertices.begin());
}

auto VertexMove::collect(VertexId v, CellId c, std::size_t most_cells) -> Status {
  v_ = v;
  cells_.clear();
  corners_.clear();
  const Home home = mesh_->vertex(v).home;
  if (home.kind() == EntityKind::vertex) return Status::stays;
  // No walk across faces leads to all cells at a subsegment with several fans.
  const auto* pinched = mesh_->pinched_edges();
  if (home.kind() == EntityKind::segment && pinched && pinched->has(home.id())) return Status::stays;
  Status status = Status::ok;
  const auto take = [&](CellId x) {
    mesh_->mark(x);
    cells_.push_back(x);
    corners_.push_back(number_of(x, v));
  };
  take(c);
  for (std::size_t i = 0; i < cells_.size() && status == Status::ok; ++i)
    for (int f = 0; f < 4; ++f) {
      const Link next = mesh_->cell(cells_[i]).links[f];
      if (f == corners_[i] || !next || mesh_->marked(next.cell())) continue;
      if (cells_.size() >= most_cells) status = Status::stays;
      if (status == Status::ok && !owns(next.cell())) status = Status::not_owned;
      if (status != Status::ok) break;
      take(next.cell());
    }
  for (const CellId x : cells_) mesh_->unmark(x);
  facets_ = facets_at(*mesh_, cells_);
  return status;
}

std::vector<VertexId> VertexMove::neighbours() const {
  std::vector<VertexId> all;
  for (const CellId c : cells_)
    for (const VertexId w : mesh_->cell(c).vertices)
      if (w != v_) add_new(all, w);
  return all;
}

std::vector<VertexId> VertexMove::targets() const {
  std::vector<VertexId> to;
  const Home home = mesh_->vertex(v_).home;
  if (home.kind() == EntityKind::volume) return neighbours();
  for (const CellId c : cells_) {
    const auto& vertices = mesh_->cell(c).vertices;
    const int at = number_of(c, v_);
    const auto* k = mesh_->constraints(c);
    for (int i = 0; i < 4; ++i) {
      if (i == at) continue;
      bool may = false;
      if (home.kind() == EntityKind::segment) may = k && k->has_edge(edge_of_ends[at][i]);
      for (int f = 0; f < 4 && home.kind() == EntityKind::facet && k && !may; ++f) may = f != at && f != i && k->has_face(f);
      if (may) add_new(to, vertices[i]);
    }
  }
  return to;
}

/// Faces that become one may not both be constrained, nor edges that become one both be subsegments.
bool VertexMove::may_flatten(const Flattened& x) {
  if (mesh_->constrained(x.cell, x.of_u) && mesh_->constrained(x.cell, x.of_v)) return false;
  const auto* k = mesh_->constraints(x.cell);
  if (!k) return true;
  for (int i = 0; i < 4; ++i) {
    if (i == x.of_u || i == x.of_v) continue;
    if (k->has_edge(edge_of_ends[x.of_v][i])) return false;
    const int e = edge_of_ends[x.of_u][i];
    if (k->has_edge(e)) edges_.push_back({mesh_->cell(x.cell).vertices[i], k->edge_entity[e]});
  }
  return true;
}

/// Do the subfacets at the vertex, of a cell without the target, stay on the side of their other edge where they are?
bool VertexMove::keeps_subfacets(const Turned& t) const {
  const auto [c, of_v] = t;
  const auto* k = mesh_->constraints(c);
  if (!k) return true;
  const auto& v = mesh_->cell(c).vertices;
  for (int f = 0; f < 4; ++f) {
    if (f == of_v || !k->has_face(f)) continue;
    const auto [i, j] = corners_without(f, of_v);
    const int axis = domain_->facets()[k->face_entity[f]].axis;
    if (lie_in_line<3>(*mesh_, *domain_, {u_ == no_vertex ? v_ : u_, v[i], v[j]})) return false;
    const auto side = [&](const Point3& x) { return orient_projected(mesh_->point(v[i]), mesh_->point(v[j]), x, axis); };
    if (side(x_) == Sign::zero || side(x_) != side(mesh_->point(v_))) return false;
  }
  return true;
}

/// Would all four corners of the cell lie on one facet, so that it has a volume by rounding alone?
bool VertexMove::is_flat(const Turned& t) const {
  std::array<Home, 4> homes;
  for (int i = 0; i < 4; ++i) homes[i] = i == t.corner ? home_ : mesh_->vertex(mesh_->cell(t.cell).vertices[i]).home;
  return lie_on_one(*domain_, homes, facets_);
}

void VertexMove::aim(VertexId u) {
  u_ = u;
  x_ = mesh_->point(u);
  home_ = mesh_->vertex(u).home;
  find_turned();
}

void VertexMove::aim(const Point3& x) {
  u_ = no_vertex;
  x_ = x;
  home_ = mesh_->vertex(v_).home;
  find_turned();
}

/// The cells that vanish and those that turn.
void VertexMove::find_turned() {
  turned_.clear();
  flattened_.clear();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const int of_u = u_ == no_vertex ? -1 : number_of(cells_[i], u_);
    if (of_u < 0) {
      turned_.push_back({cells_[i], corners_[i]});
    } else {
      flattened_.push_back({cells_[i], corners_[i], of_u});
    }
  }
}

bool VertexMove::turns_cell_over() const {
  for (std::size_t i = 0; i < turned_.size(); ++i)
    if (turns_over(i)) return true;
  return false;
}

bool VertexMove::is_valid() {
  if (u_ == no_vertex && area_ && !area_->owns(x_)) return false;
  edges_.clear();
  return std::all_of(flattened_.begin(), flattened_.end(), [this](const Flattened& x) { return may_flatten(x); }) &&
         !turns_cell_over() &&
         std::all_of(turned_.begin(), turned_.end(), [this](const Turned& t) { return keeps_subfacets(t) && !is_flat(t); });
}

Simplex<3> VertexMove::prospect(std::size_t i) const {
  Simplex<3> s = mesh_->simplex(turned_[i].cell);
  s[turned_[i].corner] = x_;
  return s;
}

auto VertexMove::flattened(CellId c) const -> const Flattened* {
  const auto at = std::find_if(flattened_.begin(), flattened_.end(), [c](const Flattened& x) { return x.cell == c; });
  return at == flattened_.end() ? nullptr : &*at;
}

auto VertexMove::open_faces() const -> std::vector<OpenFace> {
  std::vector<OpenFace> faces;
  for (std::size_t i = 0; i < turned_.size(); ++i)
    for (int f = 0; f < 4; ++f) {
      const CellId c = turned_[i].cell;
      if (mesh_->constrained(c, f)) continue;
      Link beyond = mesh_->cell(c).links[f];
      if (const Flattened* x = f == turned_[i].corner ? nullptr : flattened(beyond.cell())) {
        if (mesh_->constrained(x->cell, x->of_v)) continue;
        beyond = mesh_->cell(x->cell).links[x->of_v];
      }
      faces.push_back({i, mesh_->cell(beyond.cell()).vertices[beyond.face()]});
    }
  return faces;
}

/// The cell with the target for the vertex, its links still those of the old one.
CellId VertexMove::turn(Pools& pools, const Turned& t) {
  auto vertices = mesh_->cell(t.cell).vertices;
  vertices[t.corner] = u_;
  const CellId c = mesh_->new_cell(pools, mesh_->region(t.cell));
  mesh_->set_vertices(c, vertices);
  mesh_->cell(c).links = mesh_->cell(t.cell).links;
  mesh_->set_sphere(c);
  if (const auto* old = mesh_->constraints(t.cell)) {
    const ConstraintRecord<3> copy = *old;
    mesh_->ensure_constraints(pools, c) = copy;
  }
  for (const Edge& edge : edges_) {
    const int i = number_of(c, edge.end);
    if (i < 0) continue;
    mesh_->constrain_edge(pools, c, edge_of_ends[t.corner][i], edge.entity);
  }
  return c;
}

/// Links the i-th new cell to its neighbours, also to those beyond cells that vanish.
void VertexMove::link(Pools& pools, std::size_t i) {
  const CellId c = new_cells_[i];
  for (int f = 0; f < 4; ++f) {
    Link& to = mesh_->cell(c).links[f];
    if (!to) continue;
    if (f != turned_[i].corner) {
      if (const Flattened* x = flattened(to.cell())) {
        if (mesh_->constrained(x->cell, x->of_v))
          mesh_->constrain_face(pools, c, f, mesh_->constraints(x->cell)->face_entity[x->of_v]);
        to = mesh_->cell(x->cell).links[x->of_v];
      } else {
        const auto at = std::find_if(turned_.begin(), turned_.end(), [&](const Turned& t) { return t.cell == to.cell(); });
        assert(at != turned_.end());
        to = Link(new_cells_[at - turned_.begin()], to.face());
        continue;
      }
    }
    if (to) mesh_->cell(to.cell()).links[to.face()] = Link(c, f);
  }
}

/// A subfacet at the vertex becomes the face of the cell beyond; at the hull that has no neighbour then.
void VertexMove::close(Pools& pools, const Flattened& x) {
  if (!mesh_->constrained(x.cell, x.of_u)) return;
  const Link beyond = mesh_->cell(x.cell).links[x.of_v];
  mesh_->constrain_face(pools, beyond.cell(), beyond.face(), mesh_->constraints(x.cell)->face_entity[x.of_u]);
  if (!mesh_->cell(x.cell).links[x.of_u]) mesh_->cell(beyond.cell()).links[beyond.face()] = Link{};
}

void VertexMove::commit(Pools& pools) {
  assert(std::all_of(cells_.begin(), cells_.end(), [this](CellId c) { return mesh_->alive(c) && owns(c); }));
  if (u_ == no_vertex) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const CellId c : cells_)
      for (const VertexId w : mesh_->cell(c).vertices)
        if (w != v_) nearest = std::min(nearest, squared_distance(mesh_->point(w), x_));
    u_ = mesh_->new_vertex(pools, x_, home_, rounded_down(std::sqrt(nearest)));
  }
  new_cells_.clear();
  for (const Turned& t : turned_) new_cells_.push_back(turn(pools, t));
  for (std::size_t i = 0; i < turned_.size(); ++i) link(pools, i);
  for (const Flattened& x : flattened_) close(pools, x);
  for (const CellId c : new_cells_) mesh_->enlist(c);
  for (const CellId c : cells_) mesh_->free_cell(pools, c);
}

}  // namespace pgdr
