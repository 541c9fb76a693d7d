// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a cavity must not take away: vertices, and subsegments. Of a Delaunay triangulation no cavity could, but for
// subsegments that the point encroaches upon and that no wall shields: loose ones, and those at the free rim of a facet.
#include <algorithm>

#include "pgdr/cavity.hpp"

namespace pgdr {

template <int D>
auto Cavity<D>::find_swallowed(std::vector<CellId>& behind) -> Status {
  auto edge_key = [](VertexId a, VertexId b) {
    const std::uint64_t low = std::min(index(a), index(b)), high = std::max(index(a), index(b));
    return high << 32 | low;  // never the key of a vertex, whose high half is zero and lies below any edge's
  };
  auto vertex_key = [](VertexId v) { return std::uint64_t{index(v)}; };
  bool any_edges = false;
  if constexpr (D == 3)
    for (const CellId c : cells_) {
      const auto* k = mesh_->constraints(c);
      any_edges = any_edges || (k && k->edges);
    }
  rim_keys_.reset((any_edges ? 6 : 3) * boundary_.size());
  for (const BoundaryFace& f : boundary_) {
    const auto& k = mesh_->cell(f.cell);
    const Link out = k.links[f.face];
    if (out && mesh_->marked(out.cell())) return Status::not_star_shaped;
    for (int i = 0; i <= D; ++i)
      if (i != f.face) rim_keys_.insert(vertex_key(k.vertices[i]));
    if (!any_edges) continue;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (i != f.face && j != f.face) rim_keys_.insert(edge_key(k.vertices[i], k.vertices[j]));
  }
  for (const CellId c : cells_) {
    const auto& k = mesh_->cell(c);
    for (const VertexId v : k.vertices)
      if (!rim_keys_.contains(vertex_key(v))) return Status::swallows;
    if constexpr (D == 3) {
      const auto* constraints = mesh_->constraints(c);
      if (!constraints || !constraints->edges) continue;
      for (int e = 0; e < 6; ++e) {
        if (!(constraints->edges >> e & 1)) continue;
        const VertexId a = k.vertices[edge_ends[e][0]], b = k.vertices[edge_ends[e][1]];
        const bool split = (a == split_edge_[0] && b == split_edge_[1]) || (a == split_edge_[1] && b == split_edge_[0]);
        if (split || rim_keys_.contains(edge_key(a, b))) continue;
        find_behind(a, b, behind);
        return Status::swallows;
      }
    }
  }
  return Status::ok;
}

/// The cells of the cavity at ab that the point sees through faces at ab alone: without them ab is at the boundary, which
/// is visible there.
template <int D>
void Cavity<D>::find_behind(VertexId a, VertexId b, std::vector<CellId>& behind) const {
  for (const CellId c : cells_) {
    const auto& v = mesh_->cell(c).vertices;
    if (std::find(v.begin(), v.end(), a) == v.end() || std::find(v.begin(), v.end(), b) == v.end()) continue;
    bool in_front = false;
    for (int i = 0; i <= D && !in_front; ++i) {
      if (v[i] == a || v[i] == b) continue;
      Simplex<D> s = mesh_->simplex(c);
      s[i] = point_;
      in_front = orient<D>(s) == Sign::positive;
    }
    if (!in_front) behind.push_back(c);
  }
}

/// Two subsegments that the middle of each encroaches upon the other would wait for each other for ever. So the first cuts
/// its cavity back to keep the second, whose turn it then is.
template <int D>
auto Cavity<D>::check_nothing_swallowed() -> Status {
  std::vector<CellId> behind;
  while (true) {
    behind.clear();
    const Status swallowed = find_swallowed(behind);
    if (behind.empty()) return swallowed;
    if (const Status s = drop_cells(behind); s != Status::ok) return s == Status::not_owned ? s : Status::swallows;
    if (const Status s = make_star_shaped(); s != Status::ok) return s == Status::not_owned ? s : Status::swallows;
  }
}

// The members defined in this file.
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
