// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Subsegments at which the kept cells are several fans with nothing but outside and voids between them (two bodies that
// touch along an edge): no walk across faces leads from one fan to the other, yet all must be split at once. So the cells
// at these are listed, by the two vertices.
//
// Threads: an entry is read and written only by visits that own a cell with both vertices. Claims of concurrent visits are
// disjoint, so that no two of them have business with one entry, and its order is a function of the mesh's history alone;
// only the tables that hold the entries are shared, and locked.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// The cells at such subsegments: see above.
class PinchedEdges {
 public:
  /// `segments`: of each segment of the Domain, whether its subsegments are such.
  explicit PinchedEdges(std::vector<bool> segments) : segments_(std::move(segments)) {}

  bool has(EntityId segment) const { return segments_[segment]; }  ///< are its subsegments such?
  void add(VertexId a, VertexId b, CellId c);  ///< a cell with the subsegment ab
  void remove(VertexId a, VertexId b, CellId c);  ///< when it dies
  /// The cells with this subsegment, of all fans.
  std::vector<CellId> cells(VertexId a, VertexId b) const;

 private:
  struct Table {
    mutable std::mutex mutex;
    std::unordered_map<std::uint64_t, std::vector<CellId>> cells;
  };
  static std::uint64_t key(VertexId a, VertexId b);
  Table& table(std::uint64_t key) { return tables_[key * 0x9e3779b97f4a7c15u >> 58]; }
  const Table& table(std::uint64_t key) const { return const_cast<PinchedEdges*>(this)->table(key); }

  std::vector<bool> segments_;
  std::array<Table, 64> tables_;
};

}  // namespace pgdr
