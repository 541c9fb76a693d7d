// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The writing phase of an insertion. New cells take the place of old ones in the numbering of their vertices: the cell
// on boundary face f of old cell k is k with vertex f replaced by the new vertex, so that orientation, constrained
// faces and edges of f keep their numbers.
#include <algorithm>
#include <cassert>
#include <utility>

#include "cavity/cavity.hpp"

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
  return sorted(face_without(face_without(k.vertices, std::max(i, j)), std::min(i, j)));
}

/// Calls f(link, slot) for the faces of the new cells at the ridges of the boundary; slot is that of the ridge in the table.
template <int D, class Boundary, class F>
void each_new_face(const Mesh<D>& mesh, const Boundary& boundary, const std::vector<CellId>& cells, const PairTable& ridges,
                   F f) {
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const CellId c = cells[i];
    const auto& corners = face_corners<D>[boundary[i].face];
    const auto& vertices = mesh.cell(c).vertices;
    std::uint64_t hash[D], all = 0;
    for (int n = 0; n < D; ++n) all ^= hash[n] = index(vertices[corners[n]]) * 0x9e3779b97f4a7c15u;
    for (int n = 0; n < D; ++n) f(Link(c, corners[n]), ridges.slot_of(all ^ hash[n]));
  }
}

}  // namespace

template <int D>
void Cavity<D>::commit(Pools& pools, VertexId v) {
  assert(owns_point() && mesh_->point(v) == point_);
  assert(std::all_of(cells_.begin(), cells_.end(), [this](CellId c) { return mesh_->alive(c) && owns(c); }));
  // The rim of the part: ridges of one part face of their entity alone, the split subsegment itself left out.
  rim_.clear();
  for (const PartFace& f : part_)
    for (int corner = 0; corner <= D; ++corner)
      if (corner != f.face) rim_.push_back({ridge_without<D>(mesh_->cell(f.cell), f.face, corner), f.entity});
  if (!rim_.empty()) {
    auto less = [](const RimRidge& a, const RimRidge& b) { return a.ridge != b.ridge ? a.ridge < b.ridge : a.entity < b.entity; };
    std::sort(rim_.begin(), rim_.end(), less);
    std::size_t kept = 0;
    for (std::size_t i = 0, j; i < rim_.size(); i = j) {
      for (j = i + 1; j < rim_.size() && !less(rim_[i], rim_[j]);) ++j;
      bool split = false;
      if constexpr (D == 3) split = split_segment_ != no_entity && rim_[i].ridge == sorted(split_edge_);
      if (j == i + 1 && !split) rim_[kept++] = rim_[i];
    }
    rim_.resize(kept);
  }

  if (!shapes_known_) look_at_shapes();
  make_cells(pools, v);
  set_spheres();
  if (rim_.empty()) {
    boundary_.size() <= most_numbered ? link_by_numbers() : link_by_ridges();
  } else {
    link_by_walks(pools);
  }
  if (split_segment_ != no_entity) mark_split_entities(pools, v);
  if (touches_constraints_)
    for (const CellId c : new_cells_) mesh_->enlist(c);
  part_.clear();
  for (const CellId c : cells_) mesh_->free_cell(pools, c);
  cells_.clear();
  boundary_.clear();
  protected_.clear();
}

/// Makes the new cells on the boundary faces, in their order, and of their links those across these faces.
template <int D>
void Cavity<D>::make_cells(Pools& pools, VertexId v) {
  Mesh<D>& mesh = *mesh_;
  new_cells_.resize(boundary_.size());
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const auto [old_cell, face] = boundary_[i];
    const CellId c = new_cells_[i] = mesh.new_cell(pools, mesh.region(old_cell));
    const CellRecord<D>& old = mesh.cell(old_cell);
    CellRecord<D>& k = mesh.cell(c);
    auto vertices = old.vertices;
    const Link outside = old.links[face];
    vertices[face] = v;
    assert(!area_ || area_->owns(mesh, vertices));
    assert(!claim_ || claim_->owns(vertices));
    mesh.set_vertices(c, vertices);
    k.links.fill(Link{});
    k.links[face] = outside;
    assert(!outside || may_read(outside.cell()));
    if (outside) mesh.cell(outside.cell()).links[outside.face()] = Link(c, face);
    if (touches_constraints_) inherit_constraints(pools, boundary_[i], c);
  }
}

template <int D>
void Cavity<D>::inherit_constraints(Pools& pools, const BoundaryFace& f, CellId c) {
  const ConstraintRecord<D>* old = mesh_->constraints(f.cell);
  if (!old) return;
  const bool face = old->has_face(f.face);
  unsigned edges = 0;
  if constexpr (D == 3) {
    edges = old->edges;
    for (int j = 0; j <= D; ++j)
      if (j != f.face) edges &= ~(1u << edge_of_ends[f.face][j]);
  }
  if (!face && !edges) return;
  ConstraintRecord<D>& k = mesh_->ensure_constraints(pools, c);
  if (face) k.set_face(f.face, old->face_entity[f.face]);
  k.edges = static_cast<std::uint8_t>(edges);
  if (edges) k.edge_entity = old->edge_entity;
}

/// Links neighbours among the new cells, where no constrained face is made: the rim of a star-shaped cavity is a closed surface,
/// two faces of which meet at each ridge, one each way round. Its vertices are numbered, and ridges found by the numbers of their
/// ends.
template <int D>
void Cavity<D>::link_by_numbers() {
  Mesh<D>& mesh = *mesh_;
  numbers_.reset();
  OpenLink* out = open_links_.data();
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const CellId c = new_cells_[i];
    const auto& corners = face_corners<D>[boundary_[i].face];
    CellRecord<D>& k = mesh.cell(c);
    std::uint32_t number[D];
    for (int n = 0; n < D; ++n) number[n] = numbers_.of(index(k.vertices[corners[n]]));
    for (int n = 0; n < D; ++n) {
      std::uint32_t mine, other;
      if constexpr (D == 3) {
        const std::uint32_t from = number[(n + 1) % 3], to = number[(n + 2) % 3];
        mine = from * SmallNumbers::bound + to;
        other = to * SmallNumbers::bound + from;
      } else {
        mine = 2 * number[1 - n] + n;
        other = mine ^ 1;
      }
      links_at_[mine] = Link(c, corners[n]);
      *out++ = {&k.links[corners[n]], other};
    }
  }
  for (const auto [link, other] : std::span(open_links_.data(), out)) *link = links_at_[other];
}

/// Links neighbours among any number of new cells, where no constrained face is made, by hashes of the ridges.
template <int D>
void Cavity<D>::link_by_ridges() {
  ridges_.reserve(boundary_.size() * D / 2 + 1);
  new_faces_.resize(boundary_.size() * D + 1);
  NewFace* out = new_faces_.data();  // the first of each slot
  each_new_face(*mesh_, boundary_, new_cells_, ridges_, [&](Link face, std::size_t slot) {
    *out = {face.code, static_cast<std::uint32_t>(slot)};
    out += ridges_.add(slot, face.code) ? 1 : 0;
  });
  const std::span<const NewFace> firsts(new_faces_.data(), out);
  bool shared = false;
  for (const auto [code, slot] : firsts) {
    if (!ridges_.is_pair(slot)) [[unlikely]] {
      shared = true;
      continue;
    }
    const Link one = Link::from_code(code), other = Link::from_code(ridges_.partner(slot, code));
    mesh_->cell(one.cell()).links[one.face()] = other;
    mesh_->cell(other.cell()).links[other.face()] = one;
  }
  if (shared) link_shared_slots();
  for (const NewFace& f : firsts) ridges_.clear(f.slot);
}

/// The new faces at ridges that share a slot: few, but in the cavities of many thousand cells that fans of needles have.
template <int D>
void Cavity<D>::link_shared_slots() {
  shared_slots_.clear();
  each_new_face(*mesh_, boundary_, new_cells_, ridges_, [this](Link face, std::size_t slot) {
    if (ridges_.is_pair(slot)) return;
    auto ridge = mesh_->cell(face.cell()).vertices;
    ridge[static_cast<std::size_t>(face.face())] = no_vertex;
    shared_slots_.emplace_back(sorted(ridge), face.code);
  });
  std::sort(shared_slots_.begin(), shared_slots_.end());
  assert(shared_slots_.size() % 2 == 0 && "two faces meet at a ridge");
  for (std::size_t i = 0; i + 1 < shared_slots_.size(); i += 2) {
    assert(shared_slots_[i].first == shared_slots_[i + 1].first && "two faces meet at a ridge");
    const Link one = Link::from_code(shared_slots_[i].second), other = Link::from_code(shared_slots_[i + 1].second);
    mesh_->cell(one.cell()).links[one.face()] = other;
    mesh_->cell(other.cell()).links[other.face()] = one;
  }
}

/// Links neighbours among the new cells by walks round each ridge of the boundary through the old cells: what lies
/// between the two is a new constrained face, or the hull, at the rim of the part.
template <int D>
void Cavity<D>::link_by_walks(Pools& pools) {
  // Only now do old cells point to their successors: make_cells() reads the old links.
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
      mesh_->constrain_face(pools, c, j, rim->entity);
      if (partner) mesh_->constrain_face(pools, partner.cell(), partner.face(), rim->entity);
    }
  }
}

/// 3D: marks the two halves of a split subsegment, on every new cell that contains one.
template <int D>
void Cavity<D>::mark_split_entities(Pools& pools, VertexId v) {
  if constexpr (D == 3) {
    for (const CellId c : new_cells_) {
      const auto& vertices = mesh_->cell(c).vertices;
      const int p = corner_of(vertices, v);
      for (int i = 0; i <= D; ++i)
        if (vertices[i] == split_edge_[0] || vertices[i] == split_edge_[1])
          mesh_->constrain_edge(pools, c, edge_of_ends[p][i], split_segment_);
    }
  }
}

// The members defined in this file.
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
