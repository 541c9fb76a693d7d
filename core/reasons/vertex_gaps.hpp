// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells at a point of the input in a gap too thin for the bounds: between two facets or segments that share that point alone
// (docs/small-angles.md has the proof that some cell there is over a bound). Reads the whole mesh, while nothing else is running.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <tuple>

#include "input/sharp_angles.hpp"
#include "mesh/mesh.hpp"

namespace pgdr {

/// Finds the two entities. It remembers the gaps of the input that it has measured: each thread has its own.
class VertexGaps {
 public:
  using Pair = std::array<EntityRef, 2>;

  /// What it is given must outlive it.
  VertexGaps(const Mesh<3>& mesh, const Domain<3>& domain, const AngleBounds& bounds, CountedTriangles meshed)
      : mesh_(&mesh), domain_(&domain), bounds_(bounds), meshed_(meshed) {}

  /// For a cell that is thin at a corner on such a point, and has another corner on one of the two.
  std::optional<Pair> of_cell(CellId c);

 private:
  std::optional<Pair> at_corner(CellId c, int corner);
  bool touches(CellId c, int corner, EntityRef e) const;
  bool reaches(CellId c, VertexId v, const Pair& pair, const Point3& middle) const;
  const std::optional<Point3>& gap(EntityId point, EntityRef a, EntityRef b);

  const Mesh<3>* mesh_;
  const Domain<3>* domain_;
  AngleBounds bounds_;
  CountedTriangles meshed_;
  /// Of a point, and the kinds and numbers of two entities: middle_of_gap.
  std::map<std::tuple<EntityId, EntityKind, EntityId, EntityKind, EntityId>, std::optional<Point3>> gaps_;
};

}  // namespace pgdr
