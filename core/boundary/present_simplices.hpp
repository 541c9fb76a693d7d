// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A look-up of which edges or triangles are in a mesh, for a mesh that changes little from one look to the next. Each is
// remembered with a cell that had it, and needs another look only once this cell was deleted. If it is still there, one of the
// cells made since has it: an edge or triangle that is left of a cavity is in a face of its boundary, and so in the new cell on
// that face. The same holds for those that were missing, and for those that have a new vertex.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "boundary/wanted_simplices.hpp"
#include "mesh/changed_cells.hpp"
#include "mesh/mesh.hpp"

namespace pgdr::detail {

inline constexpr CellId not_seen{0xffffffff};     ///< no cell had it at the last look
inline constexpr CellId never_asked{0xfffffffe};  ///< it was not asked for

/// Is this a cell that has these corners?
template <std::size_t K>
bool has_corners(const Mesh<3>& mesh, CellId c, const std::array<VertexId, K>& vertices) {
  if (c == not_seen || c == never_asked || !mesh.alive(c)) return false;
  const auto& corners = mesh.cell(c).vertices;
  return std::all_of(vertices.begin(), vertices.end(), [&](VertexId v) { return has_corner(corners, v); });
}

/// The edges (K = 2) or triangles (K = 3) that were asked for. A look is take_due(), then ask() for all simplices of these owners
/// and of owners that have new ones, then find(). The mesh must not change during a look.
template <std::size_t K>
class PresentSimplices {
 public:
  explicit PresentSimplices(const Mesh<3>& mesh) : mesh_(&mesh) {}

  ChangedCells& changed() { return changed_; }  ///< gets every cell that is made or deleted

  /// The owners of simplices that were seen in a cell which was deleted; with repetitions.
  std::vector<EntityId> take_due() {
    std::vector<EntityId> due;
    for (const CellId c : changed_.list()) {
      if (index(c) >= first_.size()) continue;
      for (std::uint32_t w = first_[index(c)]; w != none;) {
        due.push_back(watches_[w].owner);
        const std::uint32_t next = std::exchange(watches_[w].next, free_);
        free_ = std::exchange(w, next);
      }
      first_[index(c)] = none;
    }
    return due;
  }
  /// Asks for a simplex. `seen`: the cell where it was seen last, not_seen, or never_asked; find() sets it, so it must live until
  /// then.
  void ask(EntityId owner, const std::array<VertexId, K>& vertices, CellId& seen) {
    if (has_corners(*mesh_, seen, vertices)) {
      if (changed_.contains(seen)) watch(seen, owner);  // another cell, in its place
      return;
    }
    const auto is_new = [this](VertexId v) { return index(v) >= known_vertices_; };
    if (seen == never_asked && std::none_of(vertices.begin(), vertices.end(), is_new)) anywhere_ = true;
    seen = not_seen;
    wanted_.add(vertices, static_cast<EntityId>(asked_.size()));
    asked_.push_back({owner, &seen});
  }
  /// Answers: sets `seen` of each simplex that was asked for to a cell that has it, or to not_seen.
  void find() {
    for (const CellId c : changed_.list())
      if (mesh_->alive(c)) note_vertices(c);
    if (!asked_.empty()) search();
    for (const Asked& a : asked_)
      if (*a.seen != not_seen) watch(*a.seen, a.owner);
    asked_.clear();
    wanted_.clear();
    changed_.clear();
    anywhere_ = false;
    known_vertices_ = met_vertices_;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  struct Asked {
    EntityId owner;
    CellId* seen;
  };
  struct Watch {
    EntityId owner;
    std::uint32_t next;  ///< of the same cell, or of those that are free
  };

  void watch(CellId c, EntityId owner) {
    if (index(c) >= first_.size()) first_.resize(std::max<std::size_t>(mesh_->cell_bound(), first_.size() * 3 / 2), none);
    std::uint32_t& first = first_[index(c)];
    if (free_ == none) {
      watches_.push_back({owner, first});
      first = static_cast<std::uint32_t>(watches_.size() - 1);
      return;
    }
    const std::uint32_t w = std::exchange(free_, watches_[free_].next);
    watches_[w] = {owner, first};
    first = w;
  }
  void search() {
    const auto& items = wanted_.items();
    not_found_.resize(mesh_->vertex_bound(), 0);
    for (const auto& item : items) ++not_found_[index(item.vertices[0])];
    if (anywhere_) {
      wanted_.index_by_first(mesh_->vertex_bound());
      for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
        if (!mesh_->alive(CellId{i})) continue;
        note_vertices(CellId{i});
        look_at(CellId{i});
      }
    } else {
      wanted_.sort();
      for (const CellId c : changed_.list())
        if (mesh_->alive(c)) look_at(c);
    }
    for (const auto& item : items) not_found_[index(item.vertices[0])] = 0;
    for (std::size_t i = 1; i < items.size(); ++i)  // those asked for twice
      if (items[i].vertices == items[i - 1].vertices) *asked_[items[i].entity].seen = *asked_[items[i - 1].entity].seen;
  }
  /// Ids rise: what is made later has larger ones.
  void note_vertices(CellId c) {
    for (const VertexId v : mesh_->cell(c).vertices)
      if (v != infinite_vertex) met_vertices_ = std::max(met_vertices_, index(v) + 1);
  }
  void look_at(CellId c) {
    std::array<VertexId, 4> v = mesh_->cell(c).vertices;
    std::sort(v.begin(), v.end());
    const auto note = [&](const std::array<VertexId, K>& vertices) {
      const auto* item = wanted_.find(vertices);
      if (item == nullptr) return;
      CellId& seen = *asked_[item->entity].seen;
      if (seen == not_seen) --not_found_[index(vertices[0])];
      seen = c;
    };
    for (std::size_t a = 0; a + K <= 4; ++a) {
      if (index(v[a]) >= not_found_.size() || not_found_[index(v[a])] == 0) continue;
      for (std::size_t b = a + 1; b < 4; ++b) {
        if constexpr (K == 2)
          note({v[a], v[b]});
        else
          for (std::size_t d = b + 1; d < 4; ++d) note({v[a], v[b], v[d]});
      }
    }
  }

  const Mesh<3>* mesh_;
  ChangedCells changed_;
  bool anywhere_ = false;                      ///< one that was asked for may be in cells that have not changed
  std::uint32_t known_vertices_ = 0xffffffff;  ///< bound of those there were at the last look; all, at the first one
  std::uint32_t met_vertices_ = 0;             ///< bound of those met in cells
  WantedSimplices<K> wanted_;
  std::vector<std::uint32_t> not_found_;  ///< by vertex, of those that are wanted and have it first; 0 between looks
  std::vector<Asked> asked_;
  std::vector<std::uint32_t> first_;  ///< of each cell, its first watch, or none
  std::vector<Watch> watches_;
  std::uint32_t free_ = none;
};

}  // namespace pgdr::detail
