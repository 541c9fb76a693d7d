// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which edges or triangles of a mesh are there, asked again and again of a mesh that changes little in between: each is
// remembered with a cell that had it, and cells are passed over for those alone that this one does not have any more.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "detail/wanted_simplices.hpp"
#include "pgdr/mesh.hpp"

namespace pgdr::detail {

inline constexpr CellId not_seen{0xffffffff};  ///< no cell

/// Is this a cell that has these corners?
template <std::size_t K>
bool has_corners(const Mesh<3>& mesh, CellId c, const std::array<VertexId, K>& vertices) {
  if (c == not_seen || !mesh.alive(c)) return false;
  const auto& corners = mesh.cell(c).vertices;
  return std::all_of(vertices.begin(), vertices.end(), [&](VertexId v) { return std::find(corners.begin(), corners.end(), v) != corners.end(); });
}

/// For one look at a mesh. K: how many vertices each has, 2 or 3.
template <std::size_t K>
class PresentSimplices {
 public:
  explicit PresentSimplices(const Mesh<3>& mesh) : mesh_(&mesh) {}

  /// `seen`: where it was seen last, or not_seen; to stay where it is until find() has set it.
  void ask(const std::array<VertexId, K>& vertices, CellId& seen) {
    if (has_corners(*mesh_, seen, vertices)) return;
    seen = not_seen;
    wanted_.add(vertices, static_cast<EntityId>(seen_.size()));
    seen_.push_back(&seen);
  }
  /// Sets for each simplex that was asked for the cell that has it; not_seen if there is none. Once, after all ask()s.
  void find() {
    if (seen_.empty()) return;
    wanted_.index_by_first(mesh_->vertex_bound());
    std::vector<bool> is_corner(mesh_->vertex_bound());
    for (const auto& item : wanted_.items())
      for (const VertexId v : item.vertices) is_corner[index(v)] = true;
    for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i)
      if (const CellId c{i}; mesh_->alive(c)) look_at(c, is_corner);
    const auto& items = wanted_.items();
    for (std::size_t i = 1; i < items.size(); ++i)  // those asked for twice
      if (items[i].vertices == items[i - 1].vertices) *seen_[items[i].entity] = *seen_[items[i - 1].entity];
  }

 private:
  void look_at(CellId c, const std::vector<bool>& is_corner) {
    const auto& v = mesh_->cell(c).vertices;
    std::array<VertexId, 4> corners;
    std::size_t n = 0;
    for (const VertexId w : v)
      if (index(w) < is_corner.size() && is_corner[index(w)]) corners[n++] = w;
    if (n < K) return;
    const auto note = [&](const std::array<VertexId, K>& vertices) {
      if (const auto* item = wanted_.find(vertices)) *seen_[item->entity] = c;
    };
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b) {
        if constexpr (K == 2) note({corners[a], corners[b]});
        else for (std::size_t d = b + 1; d < n; ++d) note({corners[a], corners[b], corners[d]});
      }
  }

  const Mesh<3>* mesh_;
  WantedSimplices<K> wanted_;
  std::vector<CellId*> seen_;
};

}  // namespace pgdr::detail
