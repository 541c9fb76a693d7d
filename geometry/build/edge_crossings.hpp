// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The points where edges cross inside of a plane that both lie in (3D): computed on one of the two, which their coordinates tell,
// and rounded once. One that is within the tolerance, or its own rounding, of an end of the edges is that end; such as are within
// it of each other are one; and edges that pass it as near go through it. Nothing depends on the order of edges.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "build/plane_meetings.hpp"
#include "input/edges.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"

namespace pgdr::detail {

/// The lists of a Domain by its points, to which points are added behind those of the input.
struct PointLists {
  std::vector<Point3>& points;
  std::vector<std::uint32_t>& input_of_point;  ///< of an added one: counted on behind the points of the input
  std::vector<int>& markers;
  std::vector<double>& attributes;  ///< of an added one: linear along its edge
};

class EdgeCrossings {
 public:
  /// `crossing`: pairs of edges, by their keys, whose insides cross.
  EdgeCrossings(BuildInput<3>& in, const PlaneWidth& width, std::vector<std::pair<std::uint64_t, std::uint64_t>> crossing);

  /// Adds the points, to which `in` and `report` look from then on, and says which edges go through which points from now on:
  /// sorted, distinct.
  std::vector<PointOn> add_points(PointLists& lists, BuildReport<3>& report);

 private:
  /// Where two edges cross. `on`: the ends of the one it is computed on; `part`: how far on the way between them.
  struct Crossing {
    Point3 at;
    std::uint64_t first, second;
    PlanarEdge on;
    double part;
    std::uint32_t point = no_entity;  ///< which it is
  };

  Crossing crossing_of(std::uint64_t first, std::uint64_t second) const;
  void join_ends();
  void join_near(PointLists& lists, BuildReport<3>& report);
  std::uint32_t add(const Crossing& c, PointLists& lists, BuildReport<3>& report);
  void pass_near(std::span<const Point3> points, std::vector<PointOn>& on_edges) const;

  BuildInput<3>& in_;
  double width_;  // in units of the coordinates
  std::vector<Crossing> crossings_;
};

}  // namespace pgdr::detail
