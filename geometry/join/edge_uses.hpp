// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Every use of an edge by the pieces of a Domain in the making: by triangles, by polygons, by segments of the input.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "join/facet_triangles.hpp"
#include "space/bulk.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// One use of an edge.
struct EdgeUse {
  /// A rim is a constraint of its facet, a diagonal lies inside it; an outline is that of a facet, inside of another one that
  /// overlaps it.
  enum class Kind : std::uint8_t { diagonal, rim, polygon, explicit_segment, outline };
  std::uint64_t key;       ///< of the edge, see edge_key
  std::uint32_t owner;     ///< triangulated facet, or for explicit_segment its number among the ExplicitSegments
  std::uint32_t triangle;  ///< diagonal and rim only
  Kind kind;
  bool is_triangle() const { return kind == Kind::diagonal || kind == Kind::rim; }
};

/// The uses of all edges, those of an edge one after the other.
class EdgeUses {
 public:
  EdgeUses(const FacetTriangles& triangles, std::span<const OwnedEdge> segment_edges, const Bulk& bulk, const StopCheck& stop);

  std::size_t size() const { return uses_.size(); }
  const EdgeUse& operator[](std::size_t k) const { return uses_[k]; }
  std::span<const EdgeUse> all() const { return uses_; }
  /// The uses of one edge, the first of which stands at `begin`.
  std::span<const EdgeUse> from(std::size_t begin) const;
  /// The uses of the edge with this key. @pre it has any
  std::span<const EdgeUse> of(std::uint64_t key) const {
    return from(static_cast<std::size_t>(std::ranges::lower_bound(uses_, key, {}, &EdgeUse::key) - uses_.begin()));
  }
  /// Calls visit(begin, uses) for each edge.
  template <class Visit>
  void each_edge(const Visit& visit) const {
    for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
      const auto uses = from(begin);
      end = begin + uses.size();
      visit(begin, uses);
    }
  }
  /// What find(begin, uses, out) appends to `out` for each edge, in their order, by bulk loops.
  template <class T, class Find>
  std::vector<T> gather(const Bulk& bulk, const Find& find) const {
    return bulk.gather<T>(uses_.size(), [&](std::size_t k, std::vector<T>& out) {
      if (k == 0 || uses_[k - 1].key != uses_[k].key) find(k, from(k), out);
    });
  }

 private:
  std::vector<EdgeUse> uses_;
};

}  // namespace pgdr::detail
