// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the subdivision of what meets inside of a common plane (plane_subdivider.hpp), once no edges cross there: a cluster
// of facets becomes one planar triangulation with all their edges, and each of its triangles goes to the first of the layers that
// cover it, or, where their markers differ, to the smallest: to the patch on a wall, and not to the wall. A layer is what hangs
// together over edges that are no segments: one facet of the input, or several of one plane with equal markers, whose first one
// gets the triangles of all.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "build/facet_areas.hpp"
#include "build/plane_edges.hpp"
#include "build/plane_meetings.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/facet_triangles.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

class PlaneClusters {
 public:
  /// `plane_of`: of each facet the name of its cluster. `areas`: if any facets overlap.
  PlaneClusters(const BuildInput<3>& in, const PlaneWidth& width, FacetTriangles& faces, const PlaneEdges& edges,
                std::span<const std::uint32_t> plane_of, FacetAreas* areas, BuildReport<3>& report);

  /// Triangulates these facets (sorted), with `edges` (keys, distinct) that run inside of them and are no soft ones. False if
  /// there is no such triangulation; then they stay as they are.
  bool triangulate(std::span<const std::uint32_t> facets, std::span<const std::uint64_t> edges);
  /// Puts what was made in the place of what was there. Facets of which nothing is left are dropped.
  void write();

 private:
  /// An edge that bounds a layer, or is drawn in it; the layer is on its left.
  struct Rim {
    std::uint32_t a, b, layer;
  };
  struct Made {
    std::uint32_t facet;
    PlanarTriangle triangle;
    std::uint8_t mask;
    std::vector<std::uint32_t> inputs;  ///< all facets of the input that cover it, sorted
    bool operator<(const Made& o) const { return facet < o.facet; }
  };

  bool look_along_axis();
  std::uint32_t place(std::uint32_t f) const;
  std::uint32_t other_in_cluster(std::uint32_t t, std::size_t edge) const;
  void find_layers();
  void find_rims();
  bool build(std::span<const std::uint64_t> edges);
  bool cover();
  bool flood(std::uint32_t layer, std::span<const Rim> rims);
  std::uint32_t beyond(const PlanarTriangle& t, std::size_t edge) const;
  std::uint32_t left_of(std::uint32_t a, std::uint32_t b) const;
  std::span<const std::pair<std::uint32_t, std::uint32_t>> layers_at(std::uint32_t cell) const;
  std::vector<std::vector<std::uint32_t>> inputs_of_layers() const;
  int marker(std::uint32_t layer) const;
  std::uint32_t owner(std::uint32_t cell) const;
  void measure_layers();
  void take_cells();
  void find_outlines();
  void turn_facets();
  void note_markers();
  void drop_empty_facets();

  const BuildInput<3>& in_;
  const PlaneWidth& width_;
  FacetTriangles& faces_;
  const PlaneEdges& edges_;
  std::span<const std::uint32_t> plane_of_;
  FacetAreas* areas_;
  BuildReport<3>& report_;
  // Of all clusters.
  std::vector<Made> made_;
  std::vector<bool> replaced_;                                   // of each facet: are its triangles made anew?
  std::vector<std::uint32_t> kept_by_;                           // of a facet that has none: the one that has them
  std::vector<std::uint32_t> lost_;                              // facets all of whose triangles others cover
  std::vector<std::uint64_t> given_up_;                          // edges between facets of a layer
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hidden_;  // facets of the input with another marker than those over them
  // Of one.
  std::span<const std::uint32_t> facets_;
  int axis_ = 2;
  std::vector<std::uint32_t> layer_of_;       // by place in the cluster
  std::vector<std::uint32_t> first_of_;       // of each layer its first facet; ascending
  std::vector<FacetArea> area_of_;            // of each layer
  std::vector<std::uint64_t> inside_layers_;  // edges given up here
  std::vector<Rim> rims_;                     // layer by layer
  std::vector<std::uint64_t> hard_;           // edges of the triangulation that stay, sorted
  PlanarTriangulation planar_;
  std::vector<PlanarTriangle> cells_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sides_;   // an edge, first end in the upper half, and the cell on its left
  std::vector<std::uint32_t> seen_by_;                           // of each cell the last layer that covers it
  std::vector<std::pair<std::uint32_t, std::uint32_t>> covers_;  // cell, layer that covers it; sorted
};

}  // namespace pgdr::detail
