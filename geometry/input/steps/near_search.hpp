// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what is near to what it does not belong to (3D), where the caller wants points within a distance merged: points near
// edges and facets, and edges that run along facets. Looks at the triangles of all facets as they are.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "input/steps/build_input.hpp"
#include "input/steps/explicit_segments.hpp"
#include "input/steps/facet_triangulator.hpp"

#include "input/steps/near_contacts.hpp"
#include "input/triangle_shapes.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

class NearSearch {
 public:
  explicit NearSearch(const BuildInput<3>& in);

  /// Within which, times BuildInput::scale; 0: nothing is near.
  double width() const { return width_; }

  /// Points near edges and the inside of facets.
  NearContacts find(const TriangulatedFacets& facets, const ExplicitSegments<3>& segments) const;
  /// Calls visit(a, b, t) for edges of facets and segments, and triangles whose boxes, larger by the width, meet.
  void edges_and_triangles(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                           const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)>& visit) const;
  /// Calls visit(e, f) for edges, of no common point and not in one plane, that pass each other within the width.
  void passing_edges(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                     const std::function<void(const PlanarEdge&, const PlanarEdge&)>& visit) const;
  /// Is the part of ab that is seen inside of the triangle, along its normal, within the width of its plane?
  bool runs_near(std::uint32_t a, std::uint32_t b, const PlanarTriangle& t) const;
  /// Do the corners opposite a joint's edge lie within the width of the planes of each other's triangles?
  bool is_nearly_flat(const std::array<Point3, 4>& corners_of_joint) const;

 private:
  template <std::size_t N>
  Box<3> box(const std::array<std::uint32_t, N>& corners) const;
  template <std::size_t N>
  BoxTree<3> widened_boxes(std::span<const std::array<std::uint32_t, N>> simplices) const;
  std::array<Point3, 3> scaled(const PlanarTriangle& t) const;
  std::vector<NearPoint> points_near_edges(const TriangulatedFacets& facets, const ExplicitSegments<3>& segments) const;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> points_near_facets(const FacetTriangles& faces,
                                                                          std::vector<std::vector<std::uint32_t>> points) const;

  const BuildInput<3>& in_;
  TriangleShapes shapes_;
  double width_;
};

}  // namespace pgdr::detail
