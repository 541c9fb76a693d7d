// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/edge_ring.hpp"

#include <algorithm>

#include "change/facet_flip.hpp"
#include "mesh/ridge.hpp"

namespace pgdr {
namespace {

/// Is (a, b, c, d) of a cell, by their numbers there, an even permutation?
bool is_even(int a, int b, int c, int d) {
  const std::array p{a, b, c, d};
  int inversions = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) inversions += p[i] > p[j];
  return inversions % 2 == 0;
}

EntityId wall_of(const Mesh<3>& mesh, CellId c, int face) {
  return mesh.constrained(c, face) ? mesh.constraints(c)->face_entity[face] : no_entity;
}

/// One way round the edge. Each step adds a cell, the vertex beyond, and the wall of the face between. Ok: it ended at the hull.
Reach walk_ring(const Mesh<3>& mesh, const VisitArea<3>* area, RidgeWalk<3> walk, std::size_t longest, EdgeRing& ring) {
  const CellId begin = walk.cell;
  while (true) {
    const auto& k = mesh.cell(walk.cell);
    ring.walls.push_back(wall_of(mesh, walk.cell, walk.exit));
    ring.vertices.push_back(k.vertices[walk.entry]);
    if (!walk.link(mesh)) return Reach::ok;
    walk.step(mesh);
    if (walk.cell == begin) {
      ring.closed = true;
      return Reach::ok;
    }
    if (ring.cells.size() >= longest) return Reach::stays;
    if (area && !area->owns(mesh, walk.cell)) return Reach::not_owned;
    ring.cells.push_back(walk.cell);
  }
}

}  // namespace

std::vector<std::size_t> EdgeRing::constrained() const {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (walls[i] != no_entity) at.push_back(i);
  return at;
}

Reach collect_ring(const Mesh<3>& mesh, const VisitArea<3>* area, CellId c, int edge, std::size_t longest, EdgeRing& ring) {
  const auto& k = mesh.cell(c);
  const auto [i, j] = edge_ends[edge];
  // Going on across the face opposite `exit` the ring runs from the vertex at `exit` to that at `entry`.
  const auto [exit, entry] = corners_without(i, j);
  ring.ends = {k.vertices[i], k.vertices[j]};
  if (!is_even(i, j, exit, entry)) std::swap(ring.ends[0], ring.ends[1]);
  ring.segment = mesh.is_subsegment(c, edge) ? mesh.constraints(c)->edge_entity[edge] : no_entity;
  ring.closed = false;
  ring.cells.assign(1, c);
  ring.vertices.clear();
  ring.walls.clear();
  if (const Reach reach = walk_ring(mesh, area, {c, entry, exit}, longest, ring); reach != Reach::ok) return reach;
  if (ring.closed) {
    // The last face is the first one: it stands in front, with the vertex at `exit`.
    std::rotate(ring.vertices.begin(), ring.vertices.end() - 1, ring.vertices.end());
    std::rotate(ring.walls.begin(), ring.walls.end() - 1, ring.walls.end());
    return Reach::ok;
  }
  EdgeRing back;
  back.cells.reserve(8);
  if (const Reach reach = walk_ring(mesh, area, {c, exit, entry}, longest - std::min(longest, ring.cells.size() - 1), back);
      reach != Reach::ok)
    return reach;
  ring.cells.insert(ring.cells.begin(), back.cells.rbegin(), back.cells.rend());
  ring.vertices.insert(ring.vertices.begin(), back.vertices.rbegin(), back.vertices.rend());
  ring.walls.insert(ring.walls.begin(), back.walls.rbegin(), back.walls.rend());
  return Reach::ok;
}

std::vector<RingSide> sides_without_edge(const Mesh<3>& mesh, const Domain<3>& domain, const EdgeRing& ring) {
  if (ring.segment != no_entity) return {};
  const std::vector<std::size_t> at = ring.constrained();
  if (at.empty()) return {{0, ring.cells.size()}};
  if (at.size() != 2 || ring.walls[at[0]] != ring.walls[at[1]]) return {};
  if (!crosses_in_facet<3>(mesh, domain, ring.walls[at[0]], ring.ends, {ring.vertices[at[0]], ring.vertices[at[1]]})) return {};
  if (!ring.closed) return {{0, ring.cells.size()}};
  return {{at[0], at[1] - at[0]}, {at[1], ring.cells.size() - (at[1] - at[0])}};
}

}  // namespace pgdr
