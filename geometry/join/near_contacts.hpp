// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The points of a Domain in the making that are near to an edge, or (3D) to the inside of a facet, that they do not belong to.
// Nothing moves where they are joined: an edge goes through its new points, and a facet through its own.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "input/edges.hpp"
#include "join/build_report.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// A point near an edge, by the key of that, and how far on the way from its first end.
struct NearPoint {
  std::uint64_t key;
  double part;
  std::uint32_t point;
  bool operator<(const NearPoint& o) const { return std::tie(key, part, point) < std::tie(o.key, o.part, o.point); }
  bool operator==(const NearPoint&) const = default;
};

class NearContacts {
 public:
  using Polygons = std::vector<std::vector<std::uint32_t>>;

  NearContacts() = default;
  /// `on_edges`: sorted; `in_facets`: pairs of an input facet and a point, sorted.
  NearContacts(std::vector<NearPoint> on_edges, std::vector<std::pair<std::uint32_t, std::uint32_t>> in_facets)
      : on_edges_(std::move(on_edges)), in_facets_(std::move(in_facets)) {}

  /// These and points near to the insides of facets, pairs as above.
  NearContacts with_points_in_facets(std::vector<std::pair<std::uint32_t, std::uint32_t>> in_facets) && {
    return {std::move(on_edges_), std::move(in_facets)};
  }

  /// Adds points near edges; true if there are any new ones among them.
  bool add(std::vector<NearPoint> on_edges);

  bool empty() const { return on_edges_.empty() && in_facets_.empty(); }
  /// All points near edges.
  std::span<const NearPoint> on_edges() const { return on_edges_; }
  /// The points near the edge, in their order from its end of smaller index.
  std::span<const NearPoint> on_edge(std::uint64_t key) const;
  /// Pairs of the input facet and a point near to its inside.
  std::span<const std::pair<std::uint32_t, std::uint32_t>> in_facet(std::uint32_t f) const;
  /// a, the points near the edge in their order, b.
  std::vector<std::uint32_t> chain(std::uint32_t a, std::uint32_t b) const;
  /// Is there anything near the inside of facet f of one polygon, by distinct points, or near its edges?
  bool touches(std::uint32_t f, std::span<const std::uint32_t> polygon) const;
  /// Is a corner of the triangle near the edge opposite, so that nothing is left of it?
  bool closes(std::span<const std::uint32_t> triangle) const;
  /// The polygons of facet f through the points near their edges; points near the inside are polygons of their own.
  Polygons joined(std::uint32_t f, Polygons polygons) const;
  /// Of all edges that go through points near them: the keys of a piece and of the edge as given, sorted.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> pieces() const;
  /// Splits the edges at the points near them.
  void split(std::vector<OwnedEdge>& edges) const;
  /// Notes all of them.
  template <int D>
  void note(BuildReport<D>& report) const;

 private:
  std::vector<NearPoint> on_edges_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> in_facets_;
};

}  // namespace pgdr::detail
