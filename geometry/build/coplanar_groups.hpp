// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the third step of a Domain (3D): which facets become one. Two that meet at an edge of just these two, with
// equal markers, on different sides of it in their projection, are of one plane if they are so exactly, or if all their points
// lie within the tolerance of one plane: that of the sum of their normals, through their centre of area. The groups are the
// connected components of this, so that no order of facets decides. A group that as a whole is not within the tolerance of one
// plane is ambiguous, as a finely triangulated round surface is: what is exactly of one plane is one facet there, and nothing
// else.
//
// A planar face of triangles that was turned is planar no more; every edge between its triangles would be a segment, at small
// angles with its neighbours wherever the triangles are long and thin.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "build/fitted_plane.hpp"
#include "build/joints.hpp"
#include "input/triangle_shapes.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/edge_uses.hpp"
#include "join/facet_triangles.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {

class CoplanarGroups {
 public:
  /// Groups the facets of `faces`; the first one of a group gets its axis, and whether it is planar.
  /// @throws InputError ambiguous for a tolerance that was given
  CoplanarGroups(const BuildInput<3>& in, FacetTriangles& faces, const EdgeUses& uses, BuildReport<3>& report);

  /// Of each facet the first one of its group.
  const std::vector<std::uint32_t>& roots() const { return root_; }
  /// By position in the uses of edges, at the first use of each edge: does it lie inside a group, so that it is no segment?
  std::vector<bool> find_soft_edges() const;

 private:
  using Pair = std::array<std::uint32_t, 2>;  // of facets
  struct Farthest {
    std::uint32_t point = no_entity;
    double distance = -1;
  };

  void fit_planes();
  void unite_pairs();
  bool have_one_plane(const Pair& pair) const;
  void settle(std::span<const std::uint32_t> group);
  void take(std::span<const std::uint32_t> group, const FittedPlane& plane, bool exactly);
  void leave_exact(std::span<const std::uint32_t> group, const Farthest& farthest);
  Farthest farthest_off(const FittedPlane& plane, std::uint32_t f) const;

  const BuildInput<3>& in_;
  TriangleShapes shapes_;
  FacetTriangles& faces_;
  const EdgeUses& uses_;
  BuildReport<3>& report_;
  Joints joints_;
  double width_;                     // the tolerance, times BuildInput::scale
  std::vector<FittedPlane> planes_;  // of each facet
  DisjointSets exactly_, nearly_;    // facets of one plane
  std::vector<std::uint32_t> root_;
};

}  // namespace pgdr::detail
