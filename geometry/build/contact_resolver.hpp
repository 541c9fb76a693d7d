// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The fourth step of a Domain: points that lie exactly inside an edge split it, and with it the triangles that have it;
// points inside a triangle become its corners. Each triangle is triangulated anew by itself, in its own plane, so that
// no point of any facet moves, also where a facet is not planar. What meets is found as the diagnosis finds it.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/facet_triangles.hpp"
#include "space/contact.hpp"

namespace pgdr::detail {

/// Two pieces that meet where they should not.
struct FoundContact {
  std::uint32_t first, second;
  Contact what;
};

/// Points inside edges: exactly, or but for the rounding of points that were added.
template <int D>
class PointsOnEdges {
 public:
  PointsOnEdges() = default;
  /// `found`: sorted, distinct.
  PointsOnEdges(std::span<const Point<D>> points, std::vector<PointOn> found) : points_(points), found_(std::move(found)) {}

  bool empty() const { return found_.empty(); }
  /// a, the points inside the edge in their order, b.
  std::vector<std::uint32_t> chain(std::uint32_t a, std::uint32_t b) const;
  /// Splits the edges there.
  void split(std::vector<OwnedEdge>& edges, BuildReport<D>& report) const;

 private:
  std::span<const Point<D>> points_;
  std::vector<PointOn> found_;
};

template <int D>
class ContactResolver {
 public:
  /// `segment_edges`: the explicit segments, or what they are split into.
  ContactResolver(const BuildInput<D>& in, FacetTriangles& faces, std::vector<OwnedEdge>& segment_edges, BuildReport<D>& report)
      : in_(in), faces_(faces), segment_edges_(segment_edges), report_(report) {}

  /// Finds what meets as things are; true if anything does. The facets of triangles are indexed then.
  bool find();
  /// Splits edges and triangles at the points that were found on them.
  void split_at_points();

 private:
  const BuildInput<D>& in_;
  FacetTriangles& faces_;
  std::vector<OwnedEdge>& segment_edges_;
  BuildReport<D>& report_;
  std::vector<Piece> pieces_;
  std::vector<FoundContact> contacts_;
};

}  // namespace pgdr::detail
