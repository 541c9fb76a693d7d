// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/contraction.hpp"

#include <algorithm>
#include <cassert>

#include "pgdr/facet_flip.hpp"
#include "pgdr/insertion_rule.hpp"
#include "pgdr/pinched_edges.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

template <class T>
void add_new(std::vector<T>& list, const T& x) {
  if (std::find(list.begin(), list.end(), x) == list.end()) list.push_back(x);
}

}  // namespace

/// Of the vertex in the cell; -1 if it has none such.
int Contraction::number_of(CellId c, VertexId v) const {
  const auto& vertices = mesh_->cell(c).vertices;
  const auto at = std::find(vertices.begin(), vertices.end(), v);
  return at == vertices.end() ? -1 : static_cast<int>(at - vertices.begin());
}

auto Contraction::collect(VertexId v, CellId c, std::size_t most_cells) -> Status {
  v_ = v;
  cells_.clear();
  const Home home = mesh_->vertex(v).home;
  if (home.kind() == EntityKind::vertex) return Status::stays;
  // No walk across faces leads to all cells at a subsegment with several fans.
  const auto* pinched = mesh_->pinched_edges();
  if (home.kind() == EntityKind::segment && pinched && pinched->has(home.id())) return Status::stays;
  Status status = Status::ok;
  const auto take = [&](CellId x) {
    mesh_->mark(x);
    cells_.push_back(x);
  };
  take(c);
  for (std::size_t i = 0; i < cells_.size() && status == Status::ok; ++i)
    for (const Link next : mesh_->cell(cells_[i]).links) {
      if (!next || mesh_->marked(next.cell()) || number_of(next.cell(), v) < 0) continue;
      if (cells_.size() >= most_cells) status = Status::stays;
      if (status == Status::ok && !owns(next.cell())) status = Status::not_owned;
      if (status != Status::ok) break;
      take(next.cell());
    }
  facets_.clear();
  for (const CellId x : cells_) {
    mesh_->unmark(x);
    if (const auto* k = mesh_->constraints(x))
      for (int f = 0; f < 4; ++f)
        if (k->faces >> f & 1) add_new(facets_, k->face_entity[f]);
  }
  return status;
}

std::vector<VertexId> Contraction::targets() const {
  std::vector<VertexId> to;
  const Home home = mesh_->vertex(v_).home;
  for (const CellId c : cells_) {
    const auto& vertices = mesh_->cell(c).vertices;
    const int at = number_of(c, v_);
    const auto* k = mesh_->constraints(c);
    for (int i = 0; i < 4; ++i) {
      if (i == at) continue;
      bool may = home.kind() == EntityKind::volume;
      if (home.kind() == EntityKind::segment) may = k && (k->edges >> edge_of_ends[at][i] & 1);
      for (int f = 0; f < 4 && home.kind() == EntityKind::facet && k && !may; ++f) may = f != at && f != i && (k->faces >> f & 1);
      if (may) add_new(to, vertices[i]);
    }
  }
  return to;
}

/// Faces that become one may not both be constrained, nor edges that become one both be subsegments.
bool Contraction::may_flatten(const Flattened& x) {
  if (mesh_->constrained(x.cell, x.of_u) && mesh_->constrained(x.cell, x.of_v)) return false;
  const auto* k = mesh_->constraints(x.cell);
  if (!k) return true;
  for (int i = 0; i < 4; ++i) {
    if (i == x.of_u || i == x.of_v) continue;
    if (k->edges >> edge_of_ends[x.of_v][i] & 1) return false;
    const int e = edge_of_ends[x.of_u][i];
    if (k->edges >> e & 1) edges_.push_back({mesh_->cell(x.cell).vertices[i], k->edge_entity[e]});
  }
  return true;
}

/// Do the subfacets at the vertex, of a cell without the target, stay on the side of their other edge where they are?
bool Contraction::keeps_subfacets(CellId c, int of_v) const {
  const auto* k = mesh_->constraints(c);
  if (!k) return true;
  const auto& v = mesh_->cell(c).vertices;
  for (int f = 0; f < 4; ++f) {
    if (f == of_v || !(k->faces >> f & 1)) continue;
    const int i = f == 0 ? (of_v == 1 ? 2 : 1) : (of_v == 0 ? (f == 1 ? 2 : 1) : 0), j = 6 - f - of_v - i;
    const int axis = domain_->facets()[k->face_entity[f]].axis;
    if (lie_in_line<3>(*mesh_, *domain_, {u_, v[i], v[j]})) return false;
    const auto side = [&](VertexId x) { return orient_projected(mesh_->point(v[i]), mesh_->point(v[j]), mesh_->point(x), axis); };
    if (side(u_) == Sign::zero || side(u_) != side(v_)) return false;
  }
  return true;
}

/// Would all four corners lie on one facet, so that it has a volume by rounding alone?
bool Contraction::is_flat(const Turned& t) const {
  const auto& v = mesh_->cell(t.cell).vertices;
  const auto on = [&](VertexId x, EntityId facet) { return lies_on<3>(*domain_, mesh_->vertex(x).home, {EntityKind::facet, facet}); };
  return std::any_of(facets_.begin(), facets_.end(), [&](EntityId facet) {
    for (int i = 0; i < 4; ++i)
      if (!on(i == t.corner ? u_ : v[i], facet)) return false;
    return true;
  });
}

bool Contraction::aim(VertexId u) {
  u_ = u;
  turned_.clear();
  flattened_.clear();
  edges_.clear();
  for (const CellId c : cells_) {
    const int of_v = number_of(c, v_), of_u = number_of(c, u);
    if (of_u >= 0) {
      flattened_.push_back({c, of_v, of_u});
      if (!may_flatten(flattened_.back())) return false;
      continue;
    }
    turned_.push_back({c, of_v});
    if (orient<3>(prospect(turned_.size() - 1)) != Sign::positive) return false;
    if (!keeps_subfacets(c, of_v) || is_flat(turned_.back())) return false;
  }
  return true;
}

Simplex<3> Contraction::prospect(std::size_t i) const {
  Simplex<3> s = mesh_->simplex(turned_[i].cell);
  s[turned_[i].corner] = mesh_->point(u_);
  return s;
}

auto Contraction::flattened(CellId c) const -> const Flattened* {
  const auto at = std::find_if(flattened_.begin(), flattened_.end(), [c](const Flattened& x) { return x.cell == c; });
  return at == flattened_.end() ? nullptr : &*at;
}

auto Contraction::open_faces() const -> std::vector<OpenFace> {
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

void Contraction::constrain(Pools& pools, CellId c, int face, EntityId entity) {
  auto& k = mesh_->ensure_constraints(pools, c);
  k.faces |= static_cast<std::uint8_t>(1 << face);
  k.face_entity[face] = entity;
}

/// The cell with the target in the place of the vertex, its links still those of the old one.
CellId Contraction::turn(Pools& pools, const Turned& t) {
  auto vertices = mesh_->cell(t.cell).vertices;
  vertices[t.corner] = u_;
  const CellId c = mesh_->new_cell(pools, mesh_->region(t.cell));
  mesh_->set_vertices(c, vertices);
  mesh_->cell(c).links = mesh_->cell(t.cell).links;
  mesh_->set_sphere(c, circumsphere<3>(mesh_->simplex(c)));
  if (const auto* old = mesh_->constraints(t.cell)) {
    const ConstraintRecord<3> copy = *old;
    mesh_->ensure_constraints(pools, c) = copy;
  }
  for (const Edge& edge : edges_) {
    const int i = number_of(c, edge.end);
    if (i < 0) continue;
    auto& k = mesh_->ensure_constraints(pools, c);
    const int e = edge_of_ends[t.corner][i];
    k.edges |= static_cast<std::uint8_t>(1 << e);
    k.edge_entity[e] = edge.entity;
  }
  return c;
}

/// Links the i-th new cell to its neighbours, also to those beyond cells that vanish.
void Contraction::link(Pools& pools, std::size_t i) {
  const CellId c = new_cells_[i];
  for (int f = 0; f < 4; ++f) {
    Link& to = mesh_->cell(c).links[f];
    if (!to) continue;
    if (f != turned_[i].corner) {
      if (const Flattened* x = flattened(to.cell())) {
        if (mesh_->constrained(x->cell, x->of_v)) constrain(pools, c, f, mesh_->constraints(x->cell)->face_entity[x->of_v]);
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
void Contraction::close(Pools& pools, const Flattened& x) {
  if (!mesh_->constrained(x.cell, x.of_u)) return;
  const Link beyond = mesh_->cell(x.cell).links[x.of_v];
  constrain(pools, beyond.cell(), beyond.face(), mesh_->constraints(x.cell)->face_entity[x.of_u]);
  if (!mesh_->cell(x.cell).links[x.of_u]) mesh_->cell(beyond.cell()).links[beyond.face()] = Link{};
}

void Contraction::commit(Pools& pools) {
  new_cells_.clear();
  for (const Turned& t : turned_) new_cells_.push_back(turn(pools, t));
  for (std::size_t i = 0; i < turned_.size(); ++i) link(pools, i);
  for (const Flattened& x : flattened_) close(pools, x);
  for (const CellId c : new_cells_) mesh_->enlist(c);
  for (const CellId c : cells_) mesh_->free_cell(pools, c);
}

}  // namespace pgdr
