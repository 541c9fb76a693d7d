// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of edges or triangles that a mesh is to contain, looked up by their vertices while all cells are passed over once.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Edges (K = 2) or triangles (K = 3), each with an entity. add() all, then sort() or index_by_first(), then find().
template <std::size_t K>
class WantedSimplices {
 public:
  struct Item {
    std::array<VertexId, K> vertices;  // sorted
    EntityId entity;
  };

  void add(std::array<VertexId, K> vertices, EntityId entity) {
    std::sort(vertices.begin(), vertices.end());
    items_.push_back({vertices, entity});
  }
  /// Makes find() a binary search among all.
  void sort() {
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) { return a.vertices < b.vertices; });
  }
  /// Makes find() a binary search among those with the same first vertex; takes time for every vertex of the mesh.
  void index_by_first(std::uint32_t vertex_bound) {
    sort();
    begin_.assign(vertex_bound + 1, 0);
    for (const Item& item : items_) ++begin_[pgdr::index(item.vertices[0]) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  }
  Item* find(std::array<VertexId, K> vertices) {
    std::sort(vertices.begin(), vertices.end());
    auto begin = items_.begin(), end = items_.end();
    if (!begin_.empty()) {
      const std::uint32_t first = pgdr::index(vertices[0]);
      if (first + 1 >= begin_.size()) return nullptr;
      end = begin + begin_[first + 1];
      begin += begin_[first];
    }
    const auto at = std::lower_bound(begin, end, vertices, [](const Item& item, const auto& v) { return item.vertices < v; });
    return at != end && at->vertices == vertices ? &*at : nullptr;
  }
  std::vector<Item>& items() { return items_; }
  void clear() {
    items_.clear();
    begin_.clear();
  }

 private:
  std::vector<Item> items_;
  std::vector<std::uint32_t> begin_;
};

}  // namespace pgdr::detail
