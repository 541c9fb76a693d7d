// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cavity/delaunay.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "cavity/bulk_insertion.hpp"
#include "cavity/walk.hpp"
#include "mesh/changed_cells.hpp"
#include "space/spatial_order.hpp"

namespace pgdr {
namespace {

[[noreturn]] void broken(const char* what) { throw ResourceError({Errc::internal, what, {}, 0, {}, {}}); }

}  // namespace

template <int D>
CellId locate(const Mesh<D>& mesh, const Point<D>& p, CellId hint) {
  return detail::walk_to<D>(mesh, p, hint, [](CellId) { return true; });
}

template <int D>
bool Delaunay<D>::first_simplex(std::span<const Point<D>> points, Island& island) {
  const auto& given = island.given;
  auto& corners = island.corners;
  if (given.size() < D + 1) return false;
  corners[0] = given[0];
  corners[1] = given[1];  // the points are distinct
  std::size_t next = 2;
  if constexpr (D == 3) {
    while (next < given.size() && collinear<3>(points[given[0]], points[given[1]], points[given[next]])) ++next;
    if (next == given.size()) return false;
    corners[2] = given[next++];
  }
  for (; next < given.size(); ++next) {
    Simplex<D> s;
    for (int i = 0; i < D; ++i) s[i] = points[corners[i]];
    s[D] = points[given[next]];
    const Sign side = orient<D>(s);
    if (side == Sign::zero) continue;
    corners[D] = given[next];
    if (side == Sign::negative) std::swap(corners[0], corners[1]);
    return true;
  }
  return false;
}

template <int D>
auto Delaunay<D>::islands_of(std::span<const std::uint32_t> island, const CurveOrder& order) -> std::vector<Island> {
  const auto of = [&](std::uint32_t p) { return island.empty() ? 0 : island[p]; };
  std::vector<Island> all(island.empty() ? 1 : *std::max_element(island.begin(), island.end()) + 1);
  for (std::uint32_t p = 0; p < order.points.size(); ++p) all[of(p)].given.push_back(p);
  for (std::uint32_t k = 0; k < order.points.size(); ++k) all[of(order.points[k])].along.push_back(k);
  return all;
}

template <int D>
void Delaunay<D>::make_first_cells(const std::array<std::uint32_t, D + 1>& corners) {
  std::array<CellId, D + 2> cells;  // the simplex, then the ghost beyond each of its faces
  for (CellId& c : cells) c = mesh_->new_cell(*pools_);
  auto& first = mesh_->cell(cells[0]);
  for (int i = 0; i <= D; ++i) first.vertices[i] = vertices_[corners[i]];
  for (int i = 0; i <= D; ++i) {
    auto& ghost = mesh_->cell(cells[i + 1]);
    ghost.vertices = first.vertices;
    ghost.vertices[i] = infinite_vertex;
    std::swap(ghost.vertices[(i + 1) % (D + 1)], ghost.vertices[(i + 2) % (D + 1)]);
    mesh_->set_ghost_sphere(cells[i + 1]);
    first.links[i] = Link(cells[i + 1], i);
    ghost.links[i] = Link(cells[0], i);
  }
  for (int i = 0; i <= D; ++i)
    for (int j = 0; j <= D; ++j) {
      if (i == j) continue;
      // Ghosts i and j share the face without first.vertices[i] and [j].
      auto number = [&](int ghost, VertexId v) {
        const auto& g = mesh_->cell(cells[ghost + 1]).vertices;
        return static_cast<int>(std::find(g.begin(), g.end(), v) - g.begin());
      };
      const int face_of_i = number(i, first.vertices[j]), face_of_j = number(j, first.vertices[i]);
      mesh_->cell(cells[i + 1]).links[face_of_i] = Link(cells[j + 1], face_of_j);
    }
  mesh_->set_sphere(cells[0]);
  for (const CellId c : cells) {
    mesh_->set_region(c, 0);
    for (const VertexId v : mesh_->cell(c).vertices)
      if (v != infinite_vertex) cell_at_[index(v)] = c;
  }
}

template <int D>
bool Delaunay<D>::build(std::span<const Point<D>> points, const detail::Pieces& pieces, const std::stop_token& stop,
                        std::span<const std::uint32_t> island) {
  const detail::Bulk bulk(pieces, stop);
  vertices_.assign(points.size(), no_vertex);
  if (points.empty()) return false;
  const CurveOrder order = curve_order<D>(points, bulk);
  if (stop.stop_requested()) return true;
  std::vector<Island> islands = islands_of(island, order);
  for (Island& i : islands)
    if (!first_simplex(points, i)) return false;
  make_vertices(points, islands, order, detail::Bulk(pieces));  // all, whatever is requested: the first cells have some
  for (const Island& i : islands) {
    first_vertices_.push_back(vertices_[i.corners[0]]);
    make_first_cells(i.corners);
    insert_rounds(i, order, pieces, stop);
  }
  return true;
}

/// All vertices, numbered along the curve, island by island, in no cell yet.
template <int D>
void Delaunay<D>::make_vertices(std::span<const Point<D>> points, std::span<const Island> islands, const CurveOrder& order,
                                const detail::Bulk& bulk) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const Island& island : islands)
    for (const std::uint32_t k : island.along) vertices_[order.points[k]] = VertexId{pools_->vertices.take()};
  bulk.each(points.size(), [&](std::size_t p) {
    mesh_->vertex(vertices_[p]) = {points[p], Home(EntityKind::vertex, static_cast<EntityId>(p)), infinity};
  });
  cell_at_.assign(points.size(), no_cell);
}

template <int D>
void Delaunay<D>::insert_rounds(const Island& island, const CurveOrder& order, const detail::Pieces& pieces,
                                const std::stop_token& stop) {
  const VertexId first = vertices_[order.points[island.along.front()]];
  const detail::VertexRange range{index(first), static_cast<std::uint32_t>(index(first) + island.along.size())};
  detail::BulkInsertion<D> side_by_side(*mesh_, cell_at_, range, pieces, stop);
  std::vector<std::vector<VertexId>> rounds(static_cast<std::size_t>(order.round_count));
  for (const std::uint32_t k : island.along)
    if (const VertexId v = vertices_[order.points[k]]; cell_at(v) == no_cell) rounds[order.rounds[k]].push_back(v);
  VertexId near = vertices_[island.corners[0]];
  std::vector<VertexId> waiting;
  for (auto& round : rounds) {
    const auto middle = static_cast<std::ptrdiff_t>(waiting.size());
    waiting.insert(waiting.end(), round.begin(), round.end());
    std::inplace_merge(waiting.begin(), waiting.begin() + middle, waiting.end());
    const bool is_last = &round == &rounds.back();
    while (!waiting.empty() && !stop.stop_requested()) {
      std::vector<VertexId> left = side_by_side.insert(waiting);
      // Where less than a quarter went in side by side, as the claims of most meet, the rest goes in one after the other: another
      // plan would cost more than it gains. Where more did, what is left waits for the next round, or, in the last, for another
      // plan.
      if (4 * (waiting.size() - left.size()) < waiting.size()) {
        near = insert_all(left, near, stop);
        left.clear();
      }
      waiting = std::move(left);
      if (!is_last) break;
    }
  }
  side_by_side.give_slots_to(*pools_);
}

/// One after the other; the first is looked for from vertex `near`. Returns the last one.
template <int D>
VertexId Delaunay<D>::insert_all(std::span<const VertexId> vertices, VertexId near, const std::stop_token& stop) {
  std::size_t inserted = 0;
  for (const VertexId v : vertices) {
    if (++inserted % 1024 == 0 && stop.stop_requested()) break;
    const Point<D> p = mesh_->point(v);
    if (prepare(p, cell_at(near)) != no_vertex) broken("two input points coincide");
    cavity_.commit(*pools_, v);
    note_cells();
    near = v;
  }
  return near;
}

template <int D>
VertexId Delaunay<D>::insert(const Point<D>& p, Home home, VertexId near, double least, std::span<const VertexId> twins) {
  if (const VertexId there = prepare(p, cell_at(near)); there != no_vertex) return least > 0 ? no_vertex : there;
  if (insertion_radius<D>(*mesh_, cavity_) < least) {
    cavity_.release();
    return no_vertex;
  }
  return commit(home, rounded_down(insertion_radius<D>(*mesh_, cavity_, twins)));
}

template <int D>
VertexId Delaunay<D>::prepare(const Point<D>& p, CellId hint) {
  const CellId seed = locate<D>(*mesh_, p, hint);
  if (const VertexId there = detail::vertex_at(*mesh_, seed, p); there != no_vertex) return there;
  if (cavity_.collect(p, seed) != Cavity<D>::Status::ok) broken("a located point is not in conflict with its cell");
    // Perturbed heights make the cavity star-shaped whatever the input; asserted, not tested.
#ifndef NDEBUG
  const auto status = cavity_.make_star_shaped();
  assert(status == Cavity<D>::Status::ok && !cavity_.cut_back());
#endif
  return no_vertex;
}

template <int D>
VertexId Delaunay<D>::commit(Home home, float relaxed_radius) {
  for (auto* changed : listeners_) changed->add(cavity_.cells());
  const VertexId v = cavity_.commit(*pools_, home, relaxed_radius);
  for (auto* changed : listeners_) changed->add(cavity_.new_cells());
  if (cell_at_.size() <= index(v)) cell_at_.resize(std::max<std::size_t>(index(v) + 1, cell_at_.size() * 3 / 2), no_cell);
  note_cells();
  return v;
}

template <int D>
void Delaunay<D>::note_changed(std::span<const CellId> cells) {
  for (auto* changed : listeners_) changed->add(cells);
  for (const CellId c : cells)
    for (const VertexId u : mesh_->cell(c).vertices)
      if (u != infinite_vertex) cell_at_[index(u)] = c;
}

template <int D>
void Delaunay<D>::note_cells() {
  for (const CellId c : cavity_.new_cells())
    for (const VertexId u : mesh_->cell(c).vertices)
      if (u != infinite_vertex) cell_at_[index(u)] = c;
}

template CellId locate<2>(const Mesh<2>&, const Point<2>&, CellId);
template CellId locate<3>(const Mesh<3>&, const Point<3>&, CellId);
template class Delaunay<2>;
template class Delaunay<3>;

}  // namespace pgdr
