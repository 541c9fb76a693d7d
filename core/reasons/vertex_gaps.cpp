// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/vertex_gaps.hpp"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include "numbers/corners.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {
namespace {

constexpr std::size_t most_cells_round = 256;  // a point are looked at for its entities

/// Calls f(cell, the vertex's number in it) at cells round the vertex, from c on, across its faces there that `crosses` lets
/// through, until it says true. Has it?
template <class Crosses, class F>
bool any_cell_round(const Mesh<3>& mesh, CellId c, VertexId v, Crosses crosses, F f) {
  std::vector<CellId> cells{c};
  std::unordered_set<std::uint32_t> known{index(c)};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int corner = corner_of(mesh.cell(cells[i]).vertices, v);
    if (f(cells[i], corner)) return true;
    for (int face = 0; face < 4; ++face) {
      const Link link = mesh.cell(cells[i]).links[face];
      if (face == corner || !link || cells.size() >= most_cells_round || !crosses(cells[i], face)) continue;
      if (known.insert(index(link.cell())).second) cells.push_back(link.cell());
    }
  }
  return false;
}

}  // namespace

const std::optional<Point3>& VertexGaps::gap(EntityId point, EntityRef a, EntityRef b) {
  const auto [at, fresh] = gaps_.try_emplace({point, a.kind, a.id, b.kind, b.id});
  if (fresh) at->second = middle_of_gap(*domain_, point, a, b, bounds_, meshed_);
  return at->second;
}

/// Does another corner of the cell lie on the entity?
bool VertexGaps::touches(CellId c, int corner, EntityRef e) const {
  for (int i = 0; i < 4; ++i)
    if (i != corner && lies_on<3>(*domain_, mesh_->vertex(mesh_->cell(c).vertices[i]).home, e)) return true;
  return false;
}

/// Is the cell in the gap: does a way round the point lead from it to the gap's middle, across neither of the two?
bool VertexGaps::reaches(CellId c, VertexId v, const Pair& pair, const Point3& middle) const {
  const auto crosses = [&](CellId k, int face) {
    const bool wall = mesh_->constrained(k, face);
    return !wall || std::find(pair.begin(), pair.end(), mesh_->entity_of_face(k, face)) == pair.end();
  };
  return any_cell_round(*mesh_, c, v, crosses,
                        [&](CellId k, int corner) { return has_direction(mesh_->simplex(k), corner, middle); });
}

std::optional<VertexGaps::Pair> VertexGaps::at_corner(CellId c, int corner) {
  const VertexId v = mesh_->cell(c).vertices[corner];
  const EntityId point = mesh_->vertex(v).home.id();
  std::vector<EntityRef> round;
  std::optional<Pair> found;
  const auto add = [&](EntityRef e) {
    if (found || std::find(round.begin(), round.end(), e) != round.end()) return;
    for (const EntityRef& other : round) {
      if (!touches(c, corner, e) && !touches(c, corner, other)) continue;
      const auto& middle = gap(point, other, e);
      if (!middle || !reaches(c, v, {other, e}, *middle)) continue;
      found = Pair{other, e};
      return;
    }
    round.push_back(e);
  };
  const auto anywhere = [](CellId, int) { return true; };
  any_cell_round(*mesh_, c, v, anywhere, [&](CellId k, int at) {
    const auto* constraints = mesh_->constraints(k);
    for (int i = 0; constraints && i < 4; ++i) {
      if (i == at) continue;
      if (constraints->has_face(i)) add(mesh_->entity_of_face(k, i));
      if (const int edge = edge_of_ends[at][i]; constraints->has_edge(edge))
        add({EntityKind::segment, constraints->edge_entity[edge]});
    }
    return found.has_value();
  });
  return found;
}

std::optional<VertexGaps::Pair> VertexGaps::of_cell(CellId c) {
  for (int i = 0; i < 4; ++i) {
    if (mesh_->vertex(mesh_->cell(c).vertices[i]).home.kind() != EntityKind::vertex) continue;
    if (!is_thin_at(mesh_->simplex(c), i, bounds_)) continue;
    if (const auto pair = at_corner(c, i)) return pair;
  }
  return {};
}

}  // namespace pgdr
