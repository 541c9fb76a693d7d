// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cavity/delaunay.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "mesh/changed_cells.hpp"
#include "space/spatial_order.hpp"

namespace pgdr {
namespace {

template <int D>
int corner_at_infinity(const CellRecord<D>& k) {
  for (int i = 0; i <= D; ++i)
    if (k.vertices[i] == infinite_vertex) return i;
  return -1;
}

constexpr unsigned in_turn = 10000;  // steps of a walk before chance takes over

[[noreturn]] void broken(const char* what) { throw ResourceError({Errc::internal, what, {}, 0, {}, {}}); }

}  // namespace

// In a Delaunay triangulation, perturbed or not, a visibility walk cannot cycle (Edelsbrunner 1990), whichever of the
// faces that hide p it crosses. In another one it ends if that is left to chance (Devillers, Pion, Teillaud 2002).
template <int D>
CellId locate(const Mesh<D>& mesh, const Point<D>& p, CellId hint) {
  CellId c = hint;
  if (const int i = corner_at_infinity<D>(mesh.cell(c)); i >= 0) c = mesh.cell(c).links[i].cell();
  int from = -1;
  std::uint32_t random = 1;
  for (unsigned step = 0;; ++step) {
    random = random * 1664525 + 1013904223;
    const unsigned turn = step < in_turn ? step : random >> 16;
    const CellRecord<D>& k = mesh.cell(c);
    const Simplex<D> corners = mesh.simplex(c);
    int exit = -1;
    for (int j = 0; j <= D && exit < 0; ++j) {
      const int i = static_cast<int>((j + turn) % (D + 1));
      if (i == from) continue;
      Simplex<D> s = corners;
      s[i] = p;
      if (orient<D>(s) == Sign::negative) exit = i;
    }
    if (exit < 0) return c;
    from = k.links[exit].face();
    c = k.links[exit].cell();
    if (corner_at_infinity<D>(mesh.cell(c)) >= 0) return c;
  }
}

template <int D>
bool Delaunay<D>::first_simplex(std::span<const Point<D>> points, std::array<std::uint32_t, D + 1>& corners) const {
  if (points.size() < D + 1) return false;
  corners[0] = 0;
  corners[1] = 1;  // the points are distinct
  std::uint32_t next = 2;
  if constexpr (D == 3) {
    while (next < points.size() && collinear<3>(points[0], points[1], points[next])) ++next;
    if (next == points.size()) return false;
    corners[2] = next++;
  }
  for (; next < points.size(); ++next) {
    Simplex<D> s;
    for (int i = 0; i < D; ++i) s[i] = points[corners[i]];
    s[D] = points[next];
    const Sign side = orient<D>(s);
    if (side == Sign::zero) continue;
    corners[D] = next;
    if (side == Sign::negative) std::swap(corners[0], corners[1]);
    return true;
  }
  return false;
}

template <int D>
void Delaunay<D>::make_first_cells(std::span<const Point<D>> points, const std::array<std::uint32_t, D + 1>& corners) {
  std::array<CellId, D + 2> cells;  // the simplex, then the ghost beyond each of its faces
  for (CellId& c : cells) c = mesh_->new_cell(*pools_);
  auto& first = mesh_->cell(cells[0]);
  for (int i = 0; i <= D; ++i) {
    const std::uint32_t p = corners[i];
    first.vertices[i] = vertices_[p] = mesh_->new_vertex(*pools_, points[p], Home(EntityKind::vertex, p),
                                                         std::numeric_limits<float>::infinity());
  }
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
      if (v != infinite_vertex) {
        if (cell_at_.size() <= index(v)) cell_at_.resize(index(v) + 1, no_cell);
        cell_at_[index(v)] = c;
      }
  }
}

template <int D>
bool Delaunay<D>::build(std::span<const Point<D>> points, const std::stop_token& stop) {
  vertices_.assign(points.size(), no_vertex);
  std::array<std::uint32_t, D + 1> corners;
  if (!first_simplex(points, corners)) return false;
  make_first_cells(points, corners);
  CellId hint = cell_at(vertices_[corners[0]]);
  std::size_t inserted = 0;
  for (const std::uint32_t i : insertion_order<D>(points)) {
    if (vertices_[i] != no_vertex) continue;
    if (++inserted % 1024 == 0 && stop.stop_requested()) break;
    if (prepare(points[i], hint) != no_vertex) broken("two input points coincide");
    vertices_[i] = commit(Home(EntityKind::vertex, i), std::numeric_limits<float>::infinity());
    hint = cell_at(vertices_[i]);
  }
  return true;
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
  for (const VertexId v : mesh_->cell(seed).vertices)
    if (v != infinite_vertex && mesh_->point(v) == p) return v;
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
  note_cells(v);
  return v;
}

template <int D>
void Delaunay<D>::note_cells(VertexId v) {
  if (cell_at_.size() <= index(v)) cell_at_.resize(std::max<std::size_t>(index(v) + 1, cell_at_.size() * 3 / 2), no_cell);
  for (const CellId c : cavity_.new_cells())
    for (const VertexId u : mesh_->cell(c).vertices)
      if (u != infinite_vertex) cell_at_[index(u)] = c;
}

template CellId locate<2>(const Mesh<2>&, const Point<2>&, CellId);
template CellId locate<3>(const Mesh<3>&, const Point<3>&, CellId);
template class Delaunay<2>;
template class Delaunay<3>;

}  // namespace pgdr
