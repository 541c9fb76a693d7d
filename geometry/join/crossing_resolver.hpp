// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the segments of a planar straight line graph cross no more.
//
// Points within the tolerance T are one, an edge goes through the points that it passes within T, and edges that cross then get a
// common point: one that is there within 2 T, as far as points may move, or else a new one, the intersection rounded once. (So a
// point within T of an edge between new points always cuts it into shorter ones, and a Domain finds nothing more that meets.)
// Where 2 T is less than the rounding of a crossing, that takes its place: what is nearer than that to it cannot be told from it.
//
// Why this ends. An edge is only ever split into edges that are shorter than it is, measured by the same sums of squares in
// doubles. New points keep their distance from all others, so that there is room for finitely many, and there are finitely many
// edges between these. Serial.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "input/edges.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// The points near to places, by cells of a grid.
class PointsInReach {
 public:
  /// @param reach of nearest(), > 0
  explicit PointsInReach(double reach) : reach_(reach) {}
  void add(const Point2& p, std::uint32_t v) { cells_[cell_of(p)].push_back({p, v}); }
  /// The nearest point within the reach, of equals the lexicographically least; no_entity if there is none.
  std::uint32_t nearest(const Point2& p) const;

 private:
  using Cell = std::array<double, 2>;
  struct Entry {
    Point2 point;
    std::uint32_t v;
  };
  Cell cell_of(const Point2& p) const;

  double reach_;
  std::map<Cell, std::vector<Entry>> cells_;
};

/// The rounds.
class CrossingResolver {
 public:
  /// @pre coordinates are finite, and indices in range
  explicit CrossingResolver(const Plc<2>& plc);

  /// Splits edges at points that they pass within the tolerance, or else, if there are none, edges that cross. True if it did.
  bool split_once();

  const std::vector<Point2>& points() const { return points_; }
  /// The pieces of each segment in their order, segment by segment; those of no length too.
  const std::vector<OwnedEdge>& edges() const { return edges_; }
  /// Points, and edges, or pieces of such, that passed within the tolerance.
  const std::vector<PointOn>& touching() const { return touching_; }
  /// Of the new points, in their order: the ends of the edge that each was made on. These may be new points before it.
  const std::vector<std::array<std::uint32_t, 2>>& origins() const { return origins_; }
  /// Pairs of segments that crossed, by their indices.
  const std::set<std::pair<std::uint32_t, std::uint32_t>>& pairs() const { return pairs_; }

 private:
  /// Two edges that cross, the lexicographically lesser first, and where.
  struct Crossing {
    Point2 place;
    std::array<PlanarEdge, 2> edges;
  };

  std::vector<std::uint32_t> places_of_points() const;
  const Point2& scaled(std::uint32_t v) const { return scaled_[v]; }
  std::uint32_t add_point(const Point2& p);
  std::vector<std::uint64_t> edge_keys() const;
  void find_near(const std::vector<std::uint64_t>& keys);
  std::vector<Crossing> find_crossings(const std::vector<std::uint64_t>& keys);
  PlanarEdge directed(PlanarEdge e) const;
  void split_at(const Crossing& crossing);
  std::uint32_t point_at(const Crossing& crossing);
  void note_pairs(const std::vector<Crossing>& crossings);
  void replace_edges();
  std::vector<std::uint32_t> chain_of(std::uint32_t a, std::uint32_t b) const;

  double scale_ = 1;      ///< brings coordinates to the size of 1
  double tolerance_ = 0;  ///< scaled
  double reach_ = 0;      ///< scaled: of crossings
  std::vector<Point2> points_, scaled_;
  std::vector<std::uint32_t> distinct_;  ///< of the points one a place, in their order
  PointsInReach grid_{1};
  std::vector<OwnedEdge> edges_;
  std::vector<std::array<std::uint32_t, 2>> origins_;
  std::vector<PointOn> touching_;
  std::vector<PointOn> inside_;  ///< of this round
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace pgdr::detail
