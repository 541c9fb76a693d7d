// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Periodic sides of an input that hang together by pairs: the same places on each, and the same pieces of lines between them.
// One thread.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"
#include "run/near_points.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

/// What an input has of its periodic sides.
template <int D>
struct SideInput {
  struct Line {
    std::array<std::uint32_t, 2> points;
    int marker;
  };
  struct Wall {
    std::array<std::uint32_t, D> points;
    int marker;
  };
  std::vector<Point<D>> points;
  std::vector<std::int64_t> numbers;                ///< what messages call them
  std::vector<Line> lines;                          ///< straight, of a side each: its segments (3D: of its facets)
  std::vector<Wall> walls;                          ///< 2D: the lines; 3D: triangles of its facets
  std::map<int, std::vector<std::uint32_t>> given;  ///< points on the side with this marker, ascending
  double reach = 0;                                 ///< within which things meet
};

using SideMarkers = std::set<int>;
/// The ends of the segments with these markers, and the points that lie on them.
SideInput<2> side_input(const Plc<2>& plc, const SideMarkers& markers);
/// The segments and points of the facets with these markers. Walls are in the order of Domain::triangles, facet by facet.
SideInput<3> side_input(const Domain<3>& domain, const SideMarkers& markers);

/// How far along an edge a point is that lies on it, or is an end, within so much.
template <int D>
std::optional<double> part_near(const Point<D>& p, const Point<D>& a, const Point<D>& b, double width);
template <int D>
Box<D> box_of_edge(const Point<D>& a, const Point<D>& b, double width);
[[noreturn]] void refuse_sides(const std::string& what, const std::vector<std::int64_t>& ids = {},
                               const std::vector<std::array<double, 3>>& points = {});

template <int D>
class SideChain {
 public:
  using Piece = std::array<std::uint32_t, 2>;  // places, the smaller first
  struct Side {
    int marker = 0;
    std::uint32_t parent = 0;           // where its places come from; of the first: itself
    Motion<D> motion{};                 // from the parent, or to it
    bool is_image = true;               // the former
    std::vector<std::uint32_t> at{};    // of each place, its point
    std::vector<std::uint32_t> wall{};  // of the input, on which it lies; no_entity: it was not looked for
    std::set<std::uint32_t> has{};      // the points
  };

  /// Gives the pairs that have none their motions, and finds the places.
  /// @param input  must outlive this
  /// @param points  those of the input at first, which has the same numbers; others are added, for all chains
  /// @throws UsageError: the sides do not match within the tolerance, or pairs contradict each other
  SideChain(const SideInput<D>& input, NearPoints<D>& points, std::vector<PeriodicSides<D>>& pairs);

  /// Takes what other chains have added on its sides. @returns whether there was anything
  bool take_points();
  /// The pieces of lines between neighbouring places. In 3D what one side has alone the others get.
  void find_pieces();

  bool has(int marker) const { return side_of_.contains(marker); }
  const std::vector<Side>& sides() const { return sides_; }
  const std::vector<std::uint32_t>& order() const { return order_; }  ///< of sides: parents first
  const Side& first() const { return sides_[order_[0]]; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  void set_pieces(std::vector<Piece> pieces) { pieces_ = std::move(pieces); }
  const Point<D>& point(const Side& side, std::uint32_t place) const { return points_[side.at[place]]; }

  /// Where a point of the first side would be on another.
  Point<D> carried(std::uint32_t side, const Point<D>& on_first) const;
  /// A place that lies on lines, on all sides; where there is a point within the tolerance, that is it.
  std::uint32_t add_place(const Point<D>& on_first, std::uint32_t origin = no_entity, int marker = 0);
  /// The place of a point of a side.
  std::uint32_t add_place_of(std::uint32_t side, std::uint32_t point);
  /// A place inside of a facet, with points of its own.
  std::uint32_t add_inner_place(const Point<D>& on_first);
  /// The first wall of the input that it lies on, or no_entity.
  std::uint32_t wall_at(int marker, const Point<D>& p) const;
  bool is_on(const Side& side, const Point<D>& p) const { return wall_at(side.marker, p) != no_entity; }

 private:
  void make_sides(const std::vector<PeriodicSides<D>>& pairs);
  void find_motions(std::vector<PeriodicSides<D>>& pairs) const;
  void order_sides(const std::vector<PeriodicSides<D>>& pairs);
  void find_places();
  void require_consistent(const std::vector<PeriodicSides<D>>& pairs) const;
  std::set<Piece> pieces_on(const Side& side) const;
  void require_like(const std::set<Piece>& pieces, const Side& side) const;
  Point<D> from_parent(const Side& side, const Point<D>& p) const;
  Point<D> on_first(std::uint32_t side, Point<D> p) const;
  std::vector<std::int64_t> numbers(std::initializer_list<std::uint32_t> points) const;
  [[noreturn]] void refuse_place(const Point<D>& p, int there, std::uint32_t origin, int marker) const;

  const SideInput<D>& input_;
  NearPoints<D>& points_;
  NearPoints<D> places_;  // where they are on the first side
  BoxTree<D> walls_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> order_;
  std::map<int, std::uint32_t> side_of_;
  std::vector<Piece> pieces_;
  std::uint32_t seen_;  // so many of the points
};

/// The markers of all sides.
template <int D>
SideMarkers markers_of(std::span<const PeriodicSides<D>> sides) {
  SideMarkers markers;
  for (const auto& pair : sides) markers.insert({pair.from, pair.to});
  return markers;
}

/// Chains of the pairs that hang together by common markers, with all places of each other.
/// @returns the pairs, chain by chain, each with its motion
template <int D>
std::vector<PeriodicSides<D>> make_chains(const SideInput<D>& input, NearPoints<D>& points,
                                          std::span<const PeriodicSides<D>> sides, std::vector<SideChain<D>>& chains);

/// Where a mesh cuts a piece: parts of it, between 0 and 1, ascending.
using Cuts = std::vector<double>;
/// Of each piece of each chain the cuts of all meshes that have any.
using PieceCuts = std::vector<std::vector<std::vector<Cuts>>>;

/// How far p, which lies on it within rounding, is along an edge: simple fractions exactly, so that what is in the middle stays
/// so.
template <int D>
double place_of_cut(const Point<D>& p, const Point<D>& a, const Point<D>& b);

/// Cuts pieces where meshes have cut them. Pieces of several chains that have an edge in common, and those that have one in
/// common with these, are cut alike.
/// @returns whether there was anything to cut
template <int D>
bool cut_pieces(std::vector<SideChain<D>>& chains, const PieceCuts& cuts);

}  // namespace pgdr::detail
