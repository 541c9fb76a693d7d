// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a cavity must not take away: vertices, and subsegments. Of a Delaunay triangulation no cavity could, but for
// subsegments that the point encroaches upon and that no wall shields: loose ones, and those at the free rim of a facet.
#include <algorithm>
#include <array>

#include "cavity/cavity.hpp"

namespace pgdr {

namespace {

/// The vertices and edges of the boundary of a small cavity, edges as bits by the numbers of their ends.
class SmallRim {
 public:
  SmallRim(SmallNumbers& numbers, bool edges) : numbers_(numbers) {
    numbers_.reset();
    if (edges) edges_.fill(0);
  }
  void add(VertexId v) { numbers_.of(index(v)); }
  void add(VertexId a, VertexId b) {
    const std::uint32_t i = numbers_.of(index(a)), j = numbers_.of(index(b));
    edges_[i] |= std::uint64_t{1} << j;
    edges_[j] |= std::uint64_t{1} << i;
  }
  bool has(VertexId v) const { return numbers_.has(index(v)); }
  bool has(VertexId a, VertexId b) const {
    return has(a) && has(b) && (edges_[numbers_.of(index(a))] >> numbers_.of(index(b)) & 1);
  }

 private:
  static_assert(SmallNumbers::bound == 64);
  SmallNumbers& numbers_;
  std::array<std::uint64_t, SmallNumbers::bound> edges_;
};

/// The rim of a boundary of any size.
class LargeRim {
 public:
  LargeRim(KeySet& keys, std::size_t faces, bool edges) : keys_(keys) { keys_.reset((edges ? 6 : 3) * faces); }
  void add(VertexId v) { keys_.insert(index(v)); }
  void add(VertexId a, VertexId b) { keys_.insert(key(a, b)); }
  bool has(VertexId v) const { return keys_.contains(index(v)); }
  bool has(VertexId a, VertexId b) const { return keys_.contains(key(a, b)); }

 private:
  /// Never that of a vertex, whose high half is zero and lies below any edge's.
  static std::uint64_t key(VertexId a, VertexId b) {
    return std::uint64_t{std::max(index(a), index(b))} << 32 | std::min(index(a), index(b));
  }
  KeySet& keys_;
};

}  // namespace

template <int D>
bool Cavity<D>::has_subsegments() const {
  const auto has = [this](CellId c) {
    const auto* k = mesh_->constraints(c);
    return k && k->edges;
  };
  return D == 3 && std::any_of(cells_.begin(), cells_.end(), has);
}

template <int D>
auto Cavity<D>::find_lost_entities(std::vector<CellId>& behind) -> Status {
  for (const BoundaryFace& f : boundary_)
    if (const Link out = mesh_->cell(f.cell).links[f.face]; out && mesh_->marked(out.cell())) return Status::not_star_shaped;
  const bool edges = has_subsegments();
  // F triangles (edges) that are connected through their ridges have at most F + 2 vertices; each piece of the cavity has a
  // protected cell.
  if (boundary_.size() + 2 * protected_.size() <= SmallNumbers::most)
    return find_lost_entities(SmallRim(numbers_, edges), behind);
  return find_lost_entities(LargeRim(rim_keys_, boundary_.size(), edges), behind);
}

template <int D>
template <class Rim>
auto Cavity<D>::find_lost_entities(Rim rim, std::vector<CellId>& behind) const -> Status {
  const bool any_edges = has_subsegments();
  for (const BoundaryFace& f : boundary_) {
    const auto& k = mesh_->cell(f.cell);
    const auto& corners = face_corners<D>[f.face];
    for (const auto i : corners) rim.add(k.vertices[i]);
    if constexpr (D == 3)
      for (int i = 0; i < D && any_edges; ++i) rim.add(k.vertices[corners[i]], k.vertices[corners[(i + 1) % D]]);
  }
  for (const CellId c : cells_) {
    const auto& k = mesh_->cell(c);
    for (const VertexId v : k.vertices)
      if (!rim.has(v)) return Status::loses_entity;
    if constexpr (D == 3) {
      const auto* constraints = any_edges ? mesh_->constraints(c) : nullptr;
      if (!constraints || !constraints->edges) continue;
      for (int e = 0; e < 6; ++e) {
        if (!constraints->has_edge(e)) continue;
        const auto [a, b] = ends_of_edge(k.vertices, e);
        const bool split = (a == split_edge_[0] && b == split_edge_[1]) || (a == split_edge_[1] && b == split_edge_[0]);
        if (split || rim.has(a, b)) continue;
        find_behind(a, b, behind);
        return Status::loses_entity;
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
    if (!has_corner(v, a) || !has_corner(v, b)) continue;
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
auto Cavity<D>::keep_entities() -> Status {
  std::vector<CellId> behind;
  while (true) {
    behind.clear();
    const Status status = find_lost_entities(behind);
    if (behind.empty()) return status;
    if (const Status s = drop_cells(behind); s != Status::ok) return s == Status::not_owned ? s : Status::loses_entity;
    if (const Status s = make_star_shaped(); s != Status::ok) return s == Status::not_owned ? s : Status::loses_entity;
  }
}

// The members defined in this file.
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
