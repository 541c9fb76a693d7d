// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The writing phase of an insertion. New cells take the place of old ones in the numbering of their vertices: the cell
// on boundary face f of old cell k is k with vertex f replaced by the new vertex, so that orientation, constrained
// faces and edges of f keep their numbers.
#include <algorithm>
#include <cassert>
#include <utility>

#include "pgdr/cavity.hpp"

namespace pgdr {
namespace {

template <std::size_t N>
std::array<VertexId, N> sorted(std::array<VertexId, N> r) {
  std::sort(r.begin(), r.end());
  return r;
}

/// The vertices of cell k but numbers i and j.
template <int D>
std::array<VertexId, D - 1> ridge_without(const CellRecord<D>& k, int i, int j) {
  std::array<VertexId, D - 1> r{};
  int n = 0;
  for (int v = 0; v <= D; ++v)
    if (v != i && v != j) r[n++] = k.vertices[v];
  return sorted(r);
}

}  // namespace

template <int D>
VertexId Cavity<D>::commit(Pools& pools, Home home, float relaxed_radius) {
  assert(owns_point());
  assert(std::all_of(cells_.begin(), cells_.end(), [this](CellId c) { return mesh_->alive(c) && owns(c); }));
  const VertexId v = mesh_->new_vertex(pools, point_, home, relaxed_radius);
  // The rim of the part: ridges of one part face of their entity alone, the split subsegment itself left out.
  rim_.clear();
  for (const PartFace& f : part_)
    for (int corner = 0; corner <= D; ++corner)
      if (corner != f.face) rim_.push_back({ridge_without<D>(mesh_->cell(f.cell), f.face, corner), f.entity});
  if (!rim_.empty()) {
    auto less = [](const RimRidge& a, const RimRidge& b) {
      return a.ridge != b.ridge ? a.ridge < b.ridge : a.entity < b.entity;
    };
    std::sort(rim_.begin(), rim_.end(), less);
    std::vector<RimRidge> once;
    for (std::size_t i = 0, j; i < rim_.size(); i = j) {
      for (j = i + 1; j < rim_.size() && !less(rim_[i], rim_[j]);) ++j;
      bool split = false;
      if constexpr (D == 3) split = split_segment_ != no_entity && rim_[i].ridge == sorted(split_edge_);
      if (j == i + 1 && !split) once.push_back(rim_[i]);
    }
    rim_ = std::move(once);
  }

  if (!shapes_known_) look_at_shapes();
  new_cells_.clear();
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    new_cells_.push_back(make_cell(pools, boundary_[i], v));
    set_sphere(new_cells_[i], i);
  }
  if (rim_.empty()) {
    link_by_ridges();
  } else {
    link_by_walks(pools);
  }
  if (split_segment_ != no_entity) mark_split_entities(pools, v);
  if (touches_constraints_)
    for (const CellId c : new_cells_) mesh_->enlist(c);
  part_.clear();
  for (const CellId c : cells_) {
    mesh_->unmark(c);
    mesh_->free_cell(pools, c);
  }
  cells_.clear();
  boundary_.clear();
  protected_.clear();
  return v;
}

template <int D>
CellId Cavity<D>::make_cell(Pools& pools, const BoundaryFace& f, VertexId v) {
  const CellId c = mesh_->new_cell(pools, mesh_->region(f.cell));
  const CellRecord<D>& old = mesh_->cell(f.cell);
  CellRecord<D>& k = mesh_->cell(c);
  auto vertices = old.vertices;
  const Link outside = old.links[f.face];
  vertices[f.face] = v;
  assert(!area_ || area_->owns(*mesh_, vertices));
  mesh_->set_vertices(c, vertices);
  k.links.fill(Link{});
  k.links[f.face] = outside;
  assert(!outside || may_read(outside.cell()));
  if (outside) mesh_->cell(outside.cell()).links[outside.face()] = Link(c, f.face);
  if (touches_constraints_) inherit_constraints(pools, f, c);
  return c;
}

template <int D>
void Cavity<D>::inherit_constraints(Pools& pools, const BoundaryFace& f, CellId c) {
  const ConstraintRecord<D>* old = mesh_->constraints(f.cell);
  if (!old) return;
  const bool face = old->faces >> f.face & 1;
  unsigned edges = 0;
  if constexpr (D == 3) {
    edges = old->edges;
    for (int j = 0; j <= D; ++j)
      if (j != f.face) edges &= ~(1u << edge_of_ends[f.face][j]);
  }
  if (!face && !edges) return;
  ConstraintRecord<D>& k = mesh_->ensure_constraints(pools, c);
  if (face) {
    k.faces |= static_cast<std::uint8_t>(1 << f.face);
    k.face_entity[f.face] = old->face_entity[f.face];
  }
  k.edges = static_cast<std::uint8_t>(edges);
  if (edges) k.edge_entity = old->edge_entity;
}

/// Neighbours among the new cells where no constrained face is made: the rim of a star-shaped cavity is a closed surface, two
/// faces of which meet at each ridge.
template <int D>
void Cavity<D>::link_by_ridges() {
  Mesh<D>& mesh = *mesh_;
  ridges_.reset(boundary_.size() * D / 2 + 1);
  new_faces_.resize(boundary_.size() * D);
  NewFace* out = new_faces_.data();
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const CellId c = new_cells_[i];
    const auto& vertices = mesh.cell(c).vertices;
    std::uint64_t hash[D + 1], all = 0;
    for (int k = 0; k <= D; ++k) all ^= hash[k] = k == boundary_[i].face ? 0 : index(vertices[k]) * 0x9e3779b97f4a7c15u;
    for (int j = 0; j <= D; ++j) {
      if (j == boundary_[i].face) continue;
      const std::size_t slot = ridges_.slot_of(all ^ hash[j]);
      *out = {Link(c, j).code, static_cast<std::uint32_t>(slot)};
      ridges_.add(slot, out->code);
      ++out;
    }
  }
  const auto ridge_of = [&mesh](Link l) {
    auto vertices = mesh.cell(l.cell()).vertices;
    vertices[static_cast<std::size_t>(l.face())] = no_vertex;
    return sorted(vertices);
  };
  shared_slots_.clear();
  for (const auto [code, slot] : new_faces_) {
    if (!ridges_.is_pair(slot)) {
      shared_slots_.emplace_back(ridge_of(Link::from_code(code)), code);
      continue;
    }
    const Link self = Link::from_code(code);
    mesh.cell(self.cell()).links[self.face()] = Link::from_code(ridges_.partner(slot, code));
  }
  link_shared_slots();
}

/// The new faces at ridges that share a slot: few, but in the cavities of many thousand cells that fans of needles have.
template <int D>
void Cavity<D>::link_shared_slots() {
  std::sort(shared_slots_.begin(), shared_slots_.end());
  assert(shared_slots_.size() % 2 == 0 && "two faces meet at a ridge");
  for (std::size_t i = 0; i + 1 < shared_slots_.size(); i += 2) {
    assert(shared_slots_[i].first == shared_slots_[i + 1].first && "two faces meet at a ridge");
    const Link one = Link::from_code(shared_slots_[i].second), other = Link::from_code(shared_slots_[i + 1].second);
    mesh_->cell(one.cell()).links[one.face()] = other;
    mesh_->cell(other.cell()).links[other.face()] = one;
  }
}

/// Neighbours among the new cells, found by walking round each ridge of the boundary through the old cells: what lies
/// between the two is a new constrained face, or the hull, at the rim of the part.
template <int D>
void Cavity<D>::link_by_walks(Pools& pools) {
  // Only now do old cells point to their successors: make_cell reads the old links.
  for (std::size_t i = 0; i < boundary_.size(); ++i)
    mesh_->cell(boundary_[i].cell).links[boundary_[i].face] = Link(new_cells_[i], boundary_[i].face);
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const auto [old, face] = boundary_[i];
    const CellId c = new_cells_[i];
    for (int j = 0; j <= D; ++j) {
      if (j == face || mesh_->cell(c).links[j]) continue;
      RidgeWalk<D> walk{old, face, j};
      Link next = walk.link(*mesh_);
      while (next && mesh_->marked(next.cell())) {
        walk.step(*mesh_);
        next = walk.link(*mesh_);
      }
      Link partner;  // none: a new subfacet at the hull
      if (next) {
        partner = Link(next.cell(), walk.entry);
        assert(owns(partner.cell()) && "a new cell");
        mesh_->cell(c).links[j] = partner;
        mesh_->cell(partner.cell()).links[partner.face()] = Link(c, j);
      }
      const auto ridge = ridge_without<D>(mesh_->cell(old), face, j);
      const auto rim = std::lower_bound(rim_.begin(), rim_.end(), ridge,
                                        [](const RimRidge& a, const auto& r) { return a.ridge < r; });
      if (rim == rim_.end() || rim->ridge != ridge) {
        assert(next);
        continue;
      }
      auto constrain = [&](CellId cell, int f) {
        ConstraintRecord<D>& k = mesh_->ensure_constraints(pools, cell);
        k.faces |= static_cast<std::uint8_t>(1 << f);
        k.face_entity[f] = rim->entity;
      };
      constrain(c, j);
      if (partner) constrain(partner.cell(), partner.face());
    }
  }
}

/// 3D: the two halves of a split subsegment, on every new cell that contains one.
template <int D>
void Cavity<D>::mark_split_entities(Pools& pools, VertexId v) {
  if constexpr (D == 3) {
    for (const CellId c : new_cells_) {
      const auto& k = mesh_->cell(c);
      const int p = static_cast<int>(std::find(k.vertices.begin(), k.vertices.end(), v) - k.vertices.begin());
      for (int i = 0; i <= D; ++i) {
        if (k.vertices[i] != split_edge_[0] && k.vertices[i] != split_edge_[1]) continue;
        const int e = edge_of_ends[p][i];
        ConstraintRecord<D>& r = mesh_->ensure_constraints(pools, c);
        r.edges |= static_cast<std::uint8_t>(1 << e);
        r.edge_entity[e] = split_segment_;
      }
    }
  }
}

// The members defined in this file.
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
