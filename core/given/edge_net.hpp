// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Straight edges in space, in pieces that meet at common points alone: an edge is cut at each end of another one that it passes,
// and where it crosses another one. What meets is within a reach: the points are rounded. A point that was found for a crossing
// is one of the net from then on, the same for all edges, so that whatever is made of the pieces of one edge fits what is made of
// those of another.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::checking {

class EdgeNet {
 public:
  /// Points of crossings are appended to `points`, which is to outlive the net.
  explicit EdgeNet(std::vector<Point3>& points) : points_(points) {}

  /// @param edge by its lesser end. @param whole it is known to cross no other one that is: two edges of a mesh.
  void add(const detail::PlanarEdge& edge, double reach, bool whole);
  /// @throws InputError entities_intersect, if crossings do not end.
  void cut();
  /// What pieces do in a projection that they must not: the edges are to be cut there, too, next time.
  /// @return whether anything can be done about it
  bool take_apart(const detail::PlanarResult& problem);

  /// The points of an edge, from its lesser end to the other. @pre it was added
  std::span<const std::uint32_t> chain(const detail::PlanarEdge& edge) const { return edges_[number_.at(edge)].chain; }
  /// Of a piece of an edge that was added as `whole`: that edge; none.
  const detail::PlanarEdge* whole_edge(const detail::PlanarEdge& piece) const;

 private:
  struct Edge {
    detail::PlanarEdge ends;
    double reach;
    bool whole;
    std::vector<std::uint32_t> forced, chain;
  };
  void make_chains();
  bool cross_pieces();
  bool cross(const detail::PlanarEdge& p, Edge& of_p, const detail::PlanarEdge& q, Edge& of_q);
  bool meet(const Point3& x, double reach, const detail::PlanarEdge& p, Edge& of_p, const detail::PlanarEdge& q, Edge& of_q);
  std::uint32_t crossing_at(const Point3& x, double reach);
  std::optional<double> place_on(const Edge& e, std::uint32_t v) const;
  bool put(Edge& e, std::uint32_t v);
  void note_whole_edges();

  std::vector<Point3>& points_;
  std::vector<Edge> edges_;
  std::map<detail::PlanarEdge, std::uint32_t> number_;
  std::map<detail::PlanarEdge, detail::PlanarEdge> whole_of_;
  std::multimap<double, std::uint32_t> crossings_;  // points that were added, by x
};

/// The lesser end first.
inline detail::PlanarEdge sorted_edge(std::uint32_t a, std::uint32_t b) {
  return a < b ? detail::PlanarEdge{a, b} : detail::PlanarEdge{b, a};
}

}  // namespace pgdr::checking
