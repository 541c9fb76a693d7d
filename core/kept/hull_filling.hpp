// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fills a hull with cells: about one of its vertices; by a search among all ways to fill it with its own vertices
// (optimize/polyhedron_filling.hpp); or about a new point inside.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "change/replacement.hpp"
#include "kept/vertex_parts.hpp"
#include "optimize/cell_quality.hpp"
#include "optimize/placement.hpp"
#include "optimize/polyhedron_filling.hpp"

namespace pgdr {

/// See above. Signs of cells are exact, and no cell has all corners on one facet, as those are flat but for rounding. One thread.
class HullFilling {
 public:
  using Cells = std::vector<Replacement<3>::Cell>;

  HullFilling(const Mesh<3>& mesh, const Domain<3>& domain);  ///< both must outlive it
  HullFilling(const HullFilling&) = delete;
  HullFilling& operator=(const HullFilling&) = delete;

  /// Appends cells of the hull's own vertices that fill it. `facets`: those that may have all corners of a cell. False: none are
  /// found.
  bool fill(const Hull& hull, std::span<const EntityId> facets, Cells& out);
  /// Do cells about a new point there fill it? `flat`: even if doubles take some of them for flat; they are positive, exactly.
  bool is_seen_from(const Hull& hull, const Point3& x, bool flat) const;
  /// A place where the worst of these cells is better, or x. @pre is_seen_from(hull, x, true)
  Point3 better_place(const Hull& hull, const Point3& x);

 private:
  void take(const Hull& hull, std::span<const EntityId> facets);
  double quality_about(const Hull& hull, VertexId apex) const;
  double quality_about(const Hull& hull, const Point3& apex) const;
  bool is_flat(const Hull::Face& face, VertexId apex) const;
  bool search(const Hull& hull, Cells& out);
  void build(const Hull& hull);

  const Mesh<3>* mesh_;
  const Domain<3>* domain_;
  const CellBounds<3> bounds_;  // none
  const CellQuality quality_;
  std::vector<VertexId> vertices_;                     // of the hull, ascending
  std::vector<std::vector<std::uint8_t>> on_facet_;    // of each facet that has four or more of these: which
  std::vector<std::vector<std::uint8_t>> on_segment_;  // of each segment that has three or more
  PolyhedronFilling search_;
  Polyhedron polyhedron_;
  Placement placement_;
  Star star_;
};

}  // namespace pgdr
