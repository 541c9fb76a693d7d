// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts into which its segments divide a facet of a Domain. A part is told by the segments about it and the sides on which it
// has them, so that no point is located. Near-linear; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "pgdr/domain.hpp"

namespace pgdr::detail {

/// Which of some edges is which, by their ends.
class EdgeNumbers {
 public:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t number) { edges_.emplace_back(edge_of(a, b), number); }
  void index();
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const;  ///< no_entity: it is none of them

 private:
  using Edge = std::array<std::uint32_t, 2>;
  static Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
  std::vector<std::pair<Edge, std::uint32_t>> edges_;
};

class DomainParts {
 public:
  /// One side of a segment, in a facet that has it. The left one is that on the left of the way from its first point to its
  /// second, where the facet is seen along its axis.
  struct Side {
    EntityId facet, segment;
    bool left;
    auto operator<=>(const Side&) const = default;
  };

  explicit DomainParts(const Domain<3>& domain);

  std::size_t triangles() const { return part_of_.size(); }  ///< of all facets
  /// Of a triangle, counted among those of all facets; a part goes by its first one.
  std::uint32_t of(std::uint32_t triangle) const { return part_of_[triangle]; }
  /// The part on a side of a segment; no_entity if none is, or the facet is a single triangle.
  std::uint32_t at(const Side& side) const;

 private:
  struct PartAtSide {
    Side side;
    std::uint32_t part;
    auto operator<=>(const PartAtSide&) const = default;
  };

  std::vector<std::uint32_t> part_of_;
  std::vector<PartAtSide> at_sides_;  // sorted
};

/// Has the way from a to b, two points of the segment, its direction? By the axis along which the segment is longest.
bool runs_along(const Domain<3>& domain, EntityId segment, const Point3& a, const Point3& b);

}  // namespace pgdr::detail
