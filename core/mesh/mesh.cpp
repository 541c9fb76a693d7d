// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "space/bulk.hpp"

namespace pgdr {

// The filter of `conflicts` in 3D, and the error that FilterSphere allows for.
// Let c~ be the computed centre, d = c - c~ its error, r~ = |v0 - c~|. For any p,
//   (|p-c|^2 - |v0-c|^2) = (|p-c~|^2 - r~^2) - 2 d.(p - v0),
// and |p - v0| <= |p-c~| + r~. Where |p-c~| <= 2 r~ the last term is at most 6 |d| r~; where |p-c~| > 2 r~ the first is
// at least 3/4 |p-c~|^2 and the last at most 3 |d| |p-c~|, so that the sign is right as long as |d| < r~/4, which the
// levels below the last imply. Evaluating both squares costs less than 8 u relative each, and the four bits taken from
// r~^2 cost 2^-48: 2^-46 covers these.
//
// The relative half width of each level's band: 2^-44, 2^-41, ..., 2^-2, and infinity, which leaves all to the exact test.
template <int D>
const std::array<typename Mesh<D>::Band, 16> Mesh<D>::bands = [] {
  std::array<Band, 16> b{};
  for (int i = 0; i < 15; ++i) b[i] = {1 - std::ldexp(1.0, 3 * i - 44), 1 + std::ldexp(1.0, 3 * i - 44)};
  b[15] = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return b;
}();

template <int D>
Mesh<D>::Mesh() : Mesh(std::numeric_limits<std::size_t>::max()) {}

// A triangulation of n points, closed by ghosts, has 2 n - 2 triangles.
template <int D>
Mesh<D>::Mesh(std::size_t points)
    : is_small_(D == 2 && points <= most_used_slots / 2),
      cell_source_("cells", [this](std::uint32_t n) { grow_cells_to(n); }),
      vertex_source_("vertices", [this](std::uint32_t n) { grow_vertices_to(n); }),
      constraint_source_("constrained cells", [this](std::uint32_t n) { constraints_.grow_to(n); }) {
  if (!is_small_) {
    reserve();
    return;
  }
  cells_.begin_small(small_slots);
  vertices_.begin_small(small_slots);
  constraints_.begin_small(small_slots);
  for (IdSource* source : {&cell_source_, &vertex_source_, &constraint_source_}) source->set_capacity(small_slots);
}

template <int D>
void Mesh<D>::reserve() {
  capacity_ = static_cast<std::uint32_t>(ReservedMemory::affordable_elements(IdSource::most));
  cells_.reserve(capacity_);
  vertices_.reserve(capacity_);
  constraints_.reserve(capacity_);
  if constexpr (D == 3) {
    tags_.reserve(capacity_);
    regions_.reserve(capacity_);
    notes_.reserve(capacity_);
  }
  for (IdSource* source : {&cell_source_, &vertex_source_, &constraint_source_}) source->set_capacity(capacity_);
  is_small_ = false;
}

template <int D>
void Mesh<D>::grow_cells_to(std::uint32_t n) {
  cells_.grow_to(n);
  if constexpr (D == 3) {
    tags_.grow_to(n);
    regions_.grow_to(n);
  }
  // Slots of a block that are never taken must read as dead.
  for (std::uint32_t i = n - IdSource::block; i < n; ++i) cells_[i].vertices[0] = no_vertex;
}

template <int D>
void Mesh<D>::grow_vertices_to(std::uint32_t n) {
  vertices_.grow_to(n);
  if constexpr (D == 3) notes_.grow_to(n);
}

template <int D>
std::vector<std::span<std::byte>> Mesh<D>::fresh_pages(std::uint64_t cells, std::uint64_t vertices) {
  std::vector<std::span<std::byte>> all;
  if (is_small_ && cells <= most_used_slots) return all;
  leave_heap();
  const auto add = [&](auto& array, std::uint32_t used, std::uint64_t more) {
    const auto pages = array.fresh_pages(used, static_cast<std::uint32_t>(std::min<std::uint64_t>(used + more, capacity_)));
    all.insert(all.end(), pages.begin(), pages.end());
  };
  add(cells_, cell_bound(), cells);
  if constexpr (D == 3) add(tags_, cell_bound(), cells);
  add(vertices_, vertex_bound(), vertices);
  return all;
}

template <int D>
bool Mesh<D>::conflicts_exactly(CellId c, const Point<D>& p) const {
  const CellRecord<D>& k = cell(c);
  for (int i = 0; i <= D; ++i) {
    if (k.vertices[i] != infinite_vertex) continue;
    Simplex<D> s;
    for (int j = 0; j <= D; ++j) s[j] = j == i ? p : point(k.vertices[j]);
    const Sign side = orient<D>(s);
    return side == Sign::zero ? conflicts(k.links[i].cell(), p) : side == Sign::positive;
  }
  return in_sphere_perturbed<D>(simplex(c), p) == Sign::positive;
}

template <int D>
VertexId Mesh<D>::new_vertex(Pools& pools, const Point<D>& p, Home home, float relaxed_radius) {
  const VertexId v{pools.vertices.take()};
  vertex(v) = {p, home, relaxed_radius};
  return v;
}

template <int D>
ConstraintRecord<D>& Mesh<D>::ensure_constraints(Pools& pools, CellId c) {
  if (pools.log) pools.log->add_changed(c, birth(c));
  if (ConstraintRecord<D>* k = constraints(c)) return *k;
  const std::uint32_t id = pools.constraints.take();
  constraints_[id] = {};
  tag(c).set((tag(c).get() & mark_bit) | (id + 1));
  return constraints_[id];
}

// The fans at a subsegment end at the hull: of each, two faces with the subsegment have nothing beyond.
template <int D>
void Mesh<D>::find_pinched_edges(std::size_t segments, const detail::Bulk& bulk) {
  if constexpr (D == 3) {
    using Fan = std::pair<std::array<VertexId, 2>, EntityId>;
    const auto edges_of = [this](std::uint32_t i) {
      const auto* k = alive(CellId{i}) ? constraints(CellId{i}) : nullptr;
      return k && k->edges != 0 ? k : nullptr;
    };
    std::vector<Fan> ends = bulk.gather<Fan>(cell_bound(), [&](std::size_t at, std::vector<Fan>& out) {
      const auto i = static_cast<std::uint32_t>(at);
      const auto* k = edges_of(i);
      if (k == nullptr) return;
      for (int e = 0; e < 6; ++e) {
        if (!k->has_edge(e)) continue;
        std::array<VertexId, 2> v = ends_of_edge(cell(CellId{i}).vertices, e);
        std::sort(v.begin(), v.end());
        for (int f = 0; f <= D; ++f)
          if (f != edge_ends[e][0] && f != edge_ends[e][1] && !cell(CellId{i}).links[f]) out.emplace_back(v, k->edge_entity[e]);
      }
    });
    bulk.sort(ends, std::less<>());
    std::vector<EntityId> found = bulk.gather<EntityId>(ends.size(), [&](std::size_t i, std::vector<EntityId>& out) {
      if (i >= 2 && ends[i].first == ends[i - 2].first) out.push_back(ends[i].second);
    });
    if (found.empty()) return;
    std::vector<bool> pinched(segments, false);
    for (const EntityId s : found) pinched[s] = true;
    pinched_ = std::make_unique<PinchedEdges>(std::move(pinched));
    const std::vector<CellId> cells = bulk.gather<CellId>(cell_bound(), [&](std::size_t at, std::vector<CellId>& out) {
      const auto i = static_cast<std::uint32_t>(at);
      const auto* k = edges_of(i);
      if (k == nullptr) return;
      for (int e = 0; e < 6; ++e)
        if (k->has_edge(e) && pinched_->has(k->edge_entity[e])) return out.push_back(CellId{i});
    });
    for (const CellId c : cells) enlist(c);
  }
}

template <int D>
void Mesh<D>::change_pinched(CellId c, bool add) {
  if constexpr (D == 3) {
    const auto* k = constraints(c);
    if (k == nullptr || k->edges == 0) return;
    for (int e = 0; e < 6; ++e) {
      if (!k->has_edge(e) || !pinched_->has(k->edge_entity[e])) continue;
      const auto [a, b] = ends_of_edge(cell(c).vertices, e);
      if (add)
        pinched_->add(a, b, c);
      else
        pinched_->remove(a, b, c);
    }
  }
}

template class Mesh<2>;
template class Mesh<3>;

}  // namespace pgdr
