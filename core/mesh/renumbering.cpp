// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/renumbering.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pgdr::detail {
namespace {

/// `all`: for each id below a bound, the id itself. `used`: some of them. Deals those out anew.
template <class Id>
void deal(std::vector<Id>& all, const std::vector<Id>& used, std::mt19937_64& random) {
  std::vector<Id> other = used;
  std::shuffle(other.begin(), other.end(), random);
  for (std::size_t i = 0; i < used.size(); ++i) all[index(used[i])] = other[i];
}

template <class Id>
std::vector<Id> ids_below(std::uint32_t bound) {
  std::vector<Id> ids;
  ids.reserve(bound);
  for (std::uint32_t i = 0; i < bound; ++i) ids.push_back(Id{i});
  return ids;
}

}  // namespace

template <int D>
Renumbering<D>::Renumbering(Mesh<D>& mesh, std::mt19937_64& random)
    : mesh_(&mesh), cells_(ids_below<CellId>(mesh.cell_bound())), vertices_(ids_below<VertexId>(mesh.vertex_bound())) {
  std::vector<bool> is_used(mesh.vertex_bound());
  for (const CellId c : cells_) {
    if (!mesh.alive(c)) continue;
    old_cells_.push_back(c);
    for (const VertexId v : mesh.cell(c).vertices) is_used[index(v)] = true;
  }
  for (const VertexId v : vertices_)
    if (is_used[index(v)]) old_vertices_.push_back(v);
  deal(cells_, old_cells_, random);
  deal(vertices_, old_vertices_, random);
}

template <int D>
void Renumbering<D>::apply() {
  move_cells();
  move_vertices();
  if (mesh_->pinched_) mesh_->pinched_->rename(*this);
}

template <int D>
void Renumbering<D>::move_cells() {
  struct Content {
    CellRecord<D> record;
    std::uint32_t constraints;
    std::uint16_t region;
  };
  std::vector<Content> contents;
  contents.reserve(old_cells_.size());
  for (const CellId c : old_cells_) contents.push_back({mesh_->cell(c), mesh_->tag(c).get(), mesh_->region(c)});
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const CellId c = (*this)(old_cells_[i]);
    const std::uint16_t birth = mesh_->birth(c);
    CellRecord<D>& record = mesh_->cell(c) = contents[i].record;
    for (VertexId& v : record.vertices) v = (*this)(v);
    for (Link& link : record.links)
      if (link) link = Link((*this)(link.cell()), link.face());
    assert((contents[i].constraints & CellTag<D>::mark_bit) == 0);
    mesh_->tag(c).set(contents[i].constraints);
    mesh_->tag(c).birth = birth;  // in 2D the record has a tag in it
    mesh_->set_region(c, contents[i].region);
  }
}

template <int D>
void Renumbering<D>::move_vertices() {
  std::vector<std::pair<VertexRecord<D>, VertexNote>> contents;
  contents.reserve(old_vertices_.size());
  for (const VertexId v : old_vertices_) contents.emplace_back(mesh_->vertex(v), D == 3 ? mesh_->note(v) : VertexNote{});
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const VertexId v = (*this)(old_vertices_[i]);
    mesh_->vertex(v) = contents[i].first;
    if constexpr (D == 3) mesh_->note(v) = contents[i].second;
  }
}

template class Renumbering<2>;
template class Renumbering<3>;

}  // namespace pgdr::detail
