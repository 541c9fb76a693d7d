// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/whole.hpp"

#include <algorithm>
#include <optional>

namespace pgdr::detail {
namespace {

/// The entity that face f of c is constrained by, if it is.
template <int D>
std::optional<EntityId> wall(const Mesh<D>& mesh, CellId c, int f) {
  if (!mesh.constrained(c, f)) return std::nullopt;
  return mesh.constraints(c)->face_entity[f];
}

/// The segment that edge ij of c is a piece of, if it is.
std::optional<EntityId> subsegment(const Mesh<3>& mesh, CellId c, int i, int j) {
  const auto* k = mesh.constraints(c);
  const int e = edge_of_ends[i][j];
  if (!k || !k->has_edge(e)) return std::nullopt;
  return k->edge_entity[e];
}

/// Do the two cells have the same vertices but the one opposite the face, and agree on what is constrained there?
template <int D>
bool agree(const Mesh<D>& mesh, CellId a, int f, CellId b, int g) {
  if (wall(mesh, a, f) != wall(mesh, b, g)) return false;
  const auto &u = mesh.cell(a).vertices, &v = mesh.cell(b).vertices;
  std::array<int, D + 1> there{};
  for (int i = 0; i <= D; ++i) {
    if (i == f) continue;
    there[i] = corner_of(v, u[i]);
    if (there[i] > D || there[i] == g) return false;
  }
  if constexpr (D == 3) {
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (i != f && j != f && subsegment(mesh, a, i, j) != subsegment(mesh, b, there[i], there[j])) return false;
  }
  return true;
}

template <int D>
bool cell_is_whole(const Mesh<D>& mesh, CellId c) {
  const CellRecord<D>& k = mesh.cell(c);
  if (mesh.marked(c)) return false;
  if (const auto* constraints = mesh.constraints(c); constraints && constraints->part != 0) return false;
  for (const VertexId v : k.vertices)
    if (index(v) >= mesh.vertex_bound()) return false;
  if (orient<D>(mesh.simplex(c)) != Sign::positive) return false;
  for (int f = 0; f <= D; ++f) {
    const Link link = k.links[f];
    if (!link) {
      if (link != Link::not_held() && !mesh.constrained(c, f)) return false;
      continue;
    }
    if (index(link.cell()) >= mesh.cell_bound() || !mesh.alive(link.cell())) return false;
    if (mesh.cell(link.cell()).links[link.face()] != Link(c, f)) return false;
    if (!agree(mesh, c, f, link.cell(), link.face())) return false;
  }
  return true;
}

}  // namespace

template <int D>
bool is_whole(const Mesh<D>& mesh) {
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i}) && !cell_is_whole(mesh, CellId{i})) return false;
  return true;
}

template bool is_whole<2>(const Mesh<2>&);
template bool is_whole<3>(const Mesh<3>&);

}  // namespace pgdr::detail
