// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A look-up of which edges or triangles are in a mesh, for a mesh that changes little from one look to the next. Each is
// remembered with a cell that had it, and needs another look only once this cell was deleted. If it is still there, one of the
// cells made since has it: an edge or triangle that is left of a cavity is in a face of its boundary, and so in the new cell on
// that face. The same holds for those that were missing, and for those that have a new vertex.
//
// One thread looks; the loops of a look run as pieces. Of several cells that have a simplex the one with the least id counts, so
// that the order of the pieces does not matter.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "boundary/wanted_simplices.hpp"
#include "mesh/changed_cells.hpp"
#include "mesh/mesh.hpp"
#include "space/bulk.hpp"

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

/// The edges (K = 2) or triangles (K = 3) that were asked for. A look is take_due(), then look() with these owners and those that
/// have new simplices. The mesh must not change during a look.
template <std::size_t K>
class PresentSimplices {
 public:
  explicit PresentSimplices(const Mesh<3>& mesh) : mesh_(&mesh) {}

  ChangedCells& changed() { return changed_; }  ///< gets every cell that is made or deleted

  /// The owners of simplices that were seen in a cell which was deleted; with repetitions, in any order.
  std::vector<EntityId> take_due() {
    std::vector<EntityId> due;
    for (const CellId c : changed_.list()) {
      if (index(c) >= first_.size()) continue;
      for (std::uint32_t w = std::exchange(first_[index(c)], none); w != none; w = watches_[w].next) {
        due.push_back(watches_[w].owner);
        free_.push_back(w);
      }
    }
    return due;
  }
  /// Asks for all simplices of these owners, each of which is named once, and finds them: each_of(owner, ask) calls
  /// ask(vertices, seen) for each. `seen` is the cell where it was seen last, not_seen, or never_asked. It becomes a cell that
  /// has the simplex, or not_seen.
  template <class EachOf>
  void look(std::span<const EntityId> owners, const EachOf& each_of, const Bulk& bulk) {
    std::vector<Item> asked = bulk.template gather<Item>(owners.size(), [&](std::size_t i, std::vector<Item>& out) {
      each_of(owners[i], [&](const std::array<VertexId, K>& vertices, CellId& seen) { ask(owners[i], vertices, seen, out); });
    });
    const bool anywhere = anywhere_.exchange(false, std::memory_order_relaxed);
    wanted_.set(std::move(asked), mesh_->vertex_bound(), bulk);
    if (anywhere) {
      search(
          mesh_->cell_bound(), [](std::size_t i) { return CellId{static_cast<std::uint32_t>(i)}; }, bulk);
    } else {
      search(
          changed_.list().size(), [this](std::size_t i) { return changed_.list()[i]; }, bulk);
    }
    remember(bulk);
    wanted_.clear(bulk);
    changed_.clear();
    known_vertices_ = met_vertices_;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  struct Asked {
    EntityId owner;
    CellId* seen;
  };
  using Item = typename WantedSimplices<K, Asked>::Item;
  struct Watch {
    EntityId owner;
    std::uint32_t next;  ///< of the same cell
  };

  /// Lists what a look has to be taken for. One that is seen where another cell is by now is listed as well, for remember().
  void ask(EntityId owner, const std::array<VertexId, K>& vertices, CellId& seen, std::vector<Item>& out) {
    if (has_corners(*mesh_, seen, vertices)) {
      if (!changed_.contains(seen)) return;
    } else {
      const auto is_new = [this](VertexId v) { return index(v) >= known_vertices_; };
      if (seen == never_asked && std::none_of(vertices.begin(), vertices.end(), is_new))
        anywhere_.store(true, std::memory_order_relaxed);
      seen = not_seen;
    }
    out.push_back(WantedSimplices<K, Asked>::item(vertices, {owner, &seen}));
  }
  /// Looks for what is wanted in these cells.
  template <class CellAt>
  void search(std::size_t cells, const CellAt& cell_at, const Bulk& bulk) {
    std::uint32_t met = met_vertices_;
    bulk.blocks(cells, [&](std::size_t first, std::size_t last) {
      std::uint32_t most = 0;
      for (std::size_t i = first; i < last; ++i)
        if (const CellId c = cell_at(i); mesh_->alive(c)) most = std::max(most, look_at(c));
      raise(met, most);
    });
    met_vertices_ = met;
  }
  /// @returns the bound of its vertices. Ids rise: what is made later has larger ones.
  std::uint32_t look_at(CellId c) {
    std::array<VertexId, 4> v = mesh_->cell(c).vertices;
    std::sort(v.begin(), v.end());
    wanted_.each_of(v, [&](const Item& item) { lower(*item.what.seen, c); });
    return index(v[3] != infinite_vertex ? v[3] : v[2]) + 1;
  }
  // Which thread comes first does not matter to what is there in the end, and nobody reads it before all have ended.
  static void lower(CellId& at, CellId c) {
    const std::atomic_ref<CellId> seen(at);
    for (CellId now = seen.load(std::memory_order_relaxed); c < now;)
      if (seen.compare_exchange_weak(now, c, std::memory_order_relaxed)) break;
  }
  static void raise(std::uint32_t& at, std::uint32_t v) {
    const std::atomic_ref<std::uint32_t> most(at);
    for (std::uint32_t now = most.load(std::memory_order_relaxed); now < v;)
      if (most.compare_exchange_weak(now, v, std::memory_order_relaxed)) break;
  }
  /// Remembers where each was seen. The order within the list of a cell is that of the threads, and means nothing.
  void remember(const Bulk& bulk) {
    const std::vector<Asked> found = bulk.template gather<Asked>(wanted_.items().size(), [&](std::size_t i, auto& out) {
      const Asked& asked = wanted_.items()[i].what;
      if (*asked.seen != not_seen) out.push_back(asked);
    });
    if (first_.size() < mesh_->cell_bound())
      first_.resize(std::max<std::size_t>(mesh_->cell_bound(), first_.size() * 3 / 2), none);
    const std::size_t reused = std::min(free_.size(), found.size()), left = free_.size() - reused, fresh = watches_.size();
    watches_.resize(fresh + found.size() - reused);
    bulk.each(found.size(), [&](std::size_t i) {
      const auto w = i < reused ? free_[left + i] : static_cast<std::uint32_t>(fresh + i - reused);
      const std::atomic_ref<std::uint32_t> first(first_[index(*found[i].seen)]);
      watches_[w] = {found[i].owner, first.exchange(w, std::memory_order_relaxed)};
    });
    free_.resize(left);
  }

  const Mesh<3>* mesh_;
  ChangedCells changed_;
  std::atomic<bool> anywhere_ = false;         ///< one that was asked for may be in cells that have not changed
  std::uint32_t known_vertices_ = 0xffffffff;  ///< bound of those there were at the last look; all, at the first one
  std::uint32_t met_vertices_ = 0;             ///< bound of those met in cells
  WantedSimplices<K, Asked> wanted_;
  std::vector<std::uint32_t> first_;  ///< of each cell, its first watch, or none
  std::vector<Watch> watches_;
  std::vector<std::uint32_t> free_;  ///< watches of no cell
};

}  // namespace pgdr::detail
