// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pinched edges: subsegments at which the kept cells are several fans, with outside and voids between them, as where two bodies
// touch along an edge. No walk across faces leads from one fan to the other, yet all fans must be split at once. So the cells at
// pinched edges are listed, by the two vertices.
//
// Threads: the list of an edge is read and written only by visits that own a cell with both vertices. Claims of concurrent visits
// are disjoint, so that no two of them use one list, and its order depends on the history of the mesh alone. The tables that hold
// the lists are shared, and locked.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// The cells at pinched edges.
class PinchedEdges {
 public:
  /// `segments`: of each segment of the Domain, whether subsegments of it are pinched.
  explicit PinchedEdges(std::vector<bool> segments) : segments_(std::move(segments)) {}

  bool has(EntityId segment) const { return segments_[segment]; }  ///< are subsegments of it pinched?
  void add(VertexId a, VertexId b, CellId c);                      ///< lists a cell with the subsegment ab
  void remove(VertexId a, VertexId b, CellId c);                   ///< takes a cell that dies off the list
  /// The cells with this subsegment, of all fans.
  std::vector<CellId> cells(VertexId a, VertexId b) const;
  /// Renames all vertices v to to(v), and all cells c to to(c). One thread.
  template <class To>
  void rename(const To& to) {
    std::array<std::unordered_map<std::uint64_t, std::vector<CellId>>, tables> before;
    for (std::size_t i = 0; i < tables; ++i) before[i].swap(tables_[i].cells);
    for (auto& cells_of : before)
      for (auto& [k, cells] : cells_of) {
        for (CellId& c : cells) c = to(c);
        const std::uint64_t renamed = key(to(VertexId{static_cast<std::uint32_t>(k >> 32)}),
                                          to(VertexId{static_cast<std::uint32_t>(k)}));
        table(renamed).cells[renamed] = std::move(cells);
      }
  }

 private:
  static constexpr std::size_t tables = 64;

  struct Table {
    mutable std::mutex mutex;
    std::unordered_map<std::uint64_t, std::vector<CellId>> cells;
  };
  static std::uint64_t key(VertexId a, VertexId b);
  Table& table(std::uint64_t key) { return tables_[key * 0x9e3779b97f4a7c15u >> 58]; }
  const Table& table(std::uint64_t key) const { return const_cast<PinchedEdges*>(this)->table(key); }

  std::vector<bool> segments_;
  std::array<Table, tables> tables_;
};

}  // namespace pgdr
