// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The mesh against the input as given, both ways: what of the mesh lies on nothing that was given, and what was given and is not
// in the mesh. Not all of the latter is a fault: what lies outside, or in a hole, is not meshed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "given/given_input.hpp"
#include "given/links.hpp"

namespace pgdr::checking {

template <int D>
struct GivenTask {
  const OutputMesh<D>& mesh;
  const GivenInput<D>& input;
  Findings& findings;
  const std::vector<std::uint8_t>* required = nullptr;  ///< of each given point: it has to be a vertex; null: all have to
  bool requires_point(std::uint32_t p) const { return required == nullptr || (*required)[p] != 0; }
};

/// A part of something given that the mesh does not have: a point, a piece of a segment, a convex piece of a triangle.
template <int D>
struct Leftover {
  EntityKind kind;
  std::uint32_t id;  ///< of Plc::points, GivenInput::segments, GivenInput::triangles
  std::vector<Point<D>> corners;
};

/// A wall on a given triangle (2D: segment): its centre is, or has that one's on it.
struct OnGiven {
  std::uint32_t given, wall;
  bool turned;  ///< their positive sides are opposite ones
};

template <int D>
struct GivenMatch {
  std::vector<std::uint32_t> vertex_of_point;  ///< of each given point: the nearest vertex within twice the tolerance; none
  std::vector<double> moved;                   ///< and how far it is
  std::vector<Leftover<D>> leftovers;
  std::vector<OnGiven> on_given;  ///< by the former
  std::vector<double> reach;      ///< of each given triangle (2D: segment): how far the mesh may be from it
};

/// Each given point has a vertex in its place, or within twice the tolerance where another given point is as near to it.
/// Markers of points. A vertex that is in no cell is a given point, or one of GivenCrossings.
template <int D>
void match_given_points(const GivenTask<D>& task, std::span<const std::uint32_t> sorted, GivenMatch<D>& out);

/// Each subsegment lies on given segments of its marker (3D: of marker 0, or on edges of facets), and each given segment is a
/// chain of subsegments.
template <int D>
void match_given_segments(const GivenTask<D>& task, GivenMatch<D>& out);

/// Each subfacet lies on given facets of its marker, and each given facet is covered by subfacets.
void match_given_facets(const GivenTask<3>& task, GivenMatch<3>& out);

/// Where subfacets meet that are not two of one facet, there is a subsegment: two of one facet have one marker, and may be within
/// reach of one plane.
void check_creases(const GivenTask<3>& task, const GivenMatch<3>& match);

/// What was given and is not in the mesh, though it lies in or on cells, is a finding.
template <int D>
void check_leftovers(const GivenTask<D>& task, const GivenMatch<D>& match);

}  // namespace pgdr::checking
