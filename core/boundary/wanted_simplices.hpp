// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of edges or triangles that a mesh is to contain, looked up cell by cell. They are sorted, and each vertex knows those
// that it is the first of, which are few at most vertices.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/ids.hpp"
#include "pgdr/types.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// Edges (K = 2) or triangles (K = 3), each with something to know of it. Threads: several may call each_of() and of() at once.
template <std::size_t K, class T>
class WantedSimplices {
 public:
  struct Item {
    std::array<VertexId, K> vertices;  // sorted
    T what;
  };

  static Item item(std::array<VertexId, K> vertices, const T& what) {
    std::sort(vertices.begin(), vertices.end());
    return {vertices, what};
  }
  /// Puts these in the place of what was there.
  void set(std::vector<Item>&& items, std::uint32_t vertex_bound, const Bulk& bulk) {
    clear(bulk);
    items_ = std::move(items);
    bulk.sort(items_, [](const Item& a, const Item& b) { return a.vertices < b.vertices; });
    if (range_.size() < vertex_bound) range_.resize(vertex_bound);
    bulk.each(items_.size(), [this](std::size_t i) {
      const std::uint32_t v = first(i);
      if (i == 0 || first(i - 1) != v) range_[v][0] = static_cast<std::uint32_t>(i);
      if (i + 1 == items_.size() || first(i + 1) != v) range_[v][1] = static_cast<std::uint32_t>(i + 1);
    });
  }
  void clear(const Bulk& bulk) {
    bulk.each(items_.size(), [this](std::size_t i) {
      if (i == 0 || first(i - 1) != first(i)) range_[first(i)] = {0, 0};
    });
    items_.clear();
  }
  const std::vector<Item>& items() const { return items_; }
  /// Are any two the same?
  bool has_equal(const Bulk& bulk) const {
    std::atomic<bool> any = false;
    bulk.each(items_.size(), [&](std::size_t i) {
      if (i > 0 && items_[i].vertices == items_[i - 1].vertices) any.store(true, std::memory_order_relaxed);
    });
    return any;
  }

  /// Calls f(item) for all whose vertices are among these, which are sorted.
  template <std::size_t N, class F>
  void each_of(const std::array<VertexId, N>& among, const F& f) const {
    for (std::size_t a = 0; a + K <= N && index(among[a]) < range_.size(); ++a) {
      const auto [begin, end] = range_[index(among[a])];
      if (end - begin <= few) {
        for (std::uint32_t i = begin; i < end; ++i)
          if (has_others(among, a + 1, items_[i].vertices)) f(items_[i]);
        continue;
      }
      for (std::size_t b = a + 1; b < N; ++b) {
        if constexpr (K == 2) {
          each_equal({among[a], among[b]}, f);
        } else {
          for (std::size_t c = b + 1; c < N; ++c) each_equal({among[a], among[b], among[c]}, f);
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t few = 16;  // to be looked at one after the other

  /// Are the vertices but the first among these from number `from` on? Without branches, which nobody could foretell.
  template <std::size_t N>
  static bool has_others(const std::array<VertexId, N>& among, std::size_t from, const std::array<VertexId, K>& vertices) {
    std::uint32_t found = 0;
    for (std::size_t k = 1; k < K; ++k)
      for (std::size_t b = from; b < N; ++b) found += among[b] == vertices[k] ? 1u : 0u;
    return found == K - 1;
  }
  std::uint32_t first(std::size_t i) const { return index(items_[i].vertices[0]); }
  template <class F>
  void each_equal(const std::array<VertexId, K>& vertices, const F& f) const {
    const auto [begin, end] = range_[index(vertices[0])];
    const auto of_first = std::span(items_).subspan(begin, end - begin);
    const auto less = [](const Item& item, const auto& v) { return item.vertices < v; };
    for (auto at = std::lower_bound(of_first.begin(), of_first.end(), vertices, less);
         at != of_first.end() && at->vertices == vertices; ++at)
      f(*at);
  }

  std::vector<Item> items_;
  std::vector<std::array<std::uint32_t, 2>> range_;  ///< of each vertex: the items that it is the first of; {0, 0}: none
};

}  // namespace pgdr::detail
