// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the third step of a Domain (3D): which facets become one. Two that meet at an edge of just these two, with
// equal markers, on different sides of it in their projection, are one if they are exactly coplanar; or if all points of
// both lie in one plane up to the tolerance. A planar face of triangles that was turned, or printed with so many
// digits, is planar no more; every edge between its triangles would be a segment, at small angles with its neighbours
// wherever the triangles are long and thin.
//
// A pair of triangles does not say whether they are coplanar so far: the plane of a thin one may be any. So planes grow,
// from the largest triangle on: the plane is fitted to what it has (the sum of the normals, through the centre of area),
// and takes what has all its points within the tolerance of it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "input/steps/build_input.hpp"
#include "input/steps/edge_uses.hpp"
#include "input/steps/facet_triangles.hpp"
#include "input/steps/joints.hpp"
#include "input/triangle_shapes.hpp"

namespace pgdr::detail {

class CoplanarGroups {
 public:
  /// Groups the facets of `faces`; the first one of a group gets its axis, and whether it is planar.
  CoplanarGroups(const BuildInput<3>& in, FacetTriangles& faces, const EdgeUses& uses);

  /// Of each facet the first one of its group.
  const std::vector<std::uint32_t>& roots() const { return root_; }
  /// By position in the uses of edges, at the first use of each edge: does it lie inside a group, so that it is no segment?
  std::vector<bool> find_soft_edges() const;

 private:
  void find_joints();
  void grow_plane(std::uint32_t seed);
  std::pair<std::uint32_t, double> largest_triangle(std::uint32_t f) const;

  enum class State : std::uint8_t { ungrouped, exactly, nearly };

  const BuildInput<3>& in_;
  TriangleShapes shapes_;
  FacetTriangles& faces_;
  const EdgeUses& uses_;
  Joints joints_;
  std::vector<std::uint32_t> at_begin_, at_;  // joints between different facets, of each facet: positions in uses_
  std::vector<State> state_;                  // of each facet: in the plane of its group exactly, or nearly
  std::vector<std::uint32_t> root_;
};

}  // namespace pgdr::detail
