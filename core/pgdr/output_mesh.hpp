// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The finished mesh: flat arrays, input points first. What `refine` returns, what files hold, what the checker reads.
// A plain value; any number of threads may read it. 16 bytes a tetrahedron and 24 a vertex, plus labels where a mesh
// has more than one region.
#pragma once

#include <cstdint>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/names.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Vertices, cells and constraints. Its arrays may be moved out, or seen as flat spans (flat_arrays.hpp).
template <int D>
struct OutputMesh {
  using Index = std::uint32_t;  ///< into `points`
  /// Sub-simplex of a constraint: a subsegment (2 vertices) or, in 3D, a subfacet (3 vertices), with its marker.
  template <int K>
  struct Constraint {
    std::array<Index, K> vertices;  ///< those on the hull face outwards, the others are sorted
    int marker = 0;                 ///< of its segment or facet
    EntityId entity = no_entity;    ///< its segment or facet in the Domain; no_entity: unknown, e.g. read from a file
  };

  /// The distinct input points in the order of the input, those where edges of its facets cross in one plane, then Steiner points
  /// along a Hilbert curve (in no particular order if the run was cancelled, or ended by its time limit).
  std::vector<Point<D>> points;
  /// How many of `points` are the Domain's (0: unknown, e.g. read from a file): all, unless those of no cell were dropped.
  std::size_t input_points = 0;
  /// Empty, or one a point. Of a Steiner point that of the segment or facet that it lies on.
  std::vector<int> point_markers;
  /// Of the first point, of the second, ...: equally many each, or none at all. Those of Steiner points are interpolated
  /// (point_data.hpp).
  std::vector<double> point_attributes;
  std::vector<std::array<Index, D + 1>> cells;  ///< positively oriented
  std::vector<double> regions;                  ///< empty (one region), or the attribute of each cell
  std::vector<std::uint32_t> leaves;       ///< on request: which leaf each cell's circumcentre lies in, by their Morton order
  std::vector<Constraint<2>> subsegments;  ///< each once, sorted by vertices; so are the subfacets
  std::vector<Constraint<3>> subfacets;    ///< 3D only
  Names names;                             ///< of the labels and markers of the input, where they have any
};

}  // namespace pgdr
