// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/pinched_edges.hpp"

#include <algorithm>
#include <cassert>

namespace pgdr {

std::uint64_t PinchedEdges::key(VertexId a, VertexId b) {
  return std::uint64_t{std::min(index(a), index(b))} << 32 | std::max(index(a), index(b));
}

void PinchedEdges::add(VertexId a, VertexId b, CellId c) {
  const std::uint64_t k = key(a, b);
  Table& t = table(k);
  const std::lock_guard lock(t.mutex);
  t.cells[k].push_back(c);
}

void PinchedEdges::remove(VertexId a, VertexId b, CellId c) {
  const std::uint64_t k = key(a, b);
  Table& t = table(k);
  const std::lock_guard lock(t.mutex);
  const auto entry = t.cells.find(k);
  assert(entry != t.cells.end());
  std::erase(entry->second, c);
  if (entry->second.empty()) t.cells.erase(entry);
}

std::vector<CellId> PinchedEdges::cells(VertexId a, VertexId b) const {
  const std::uint64_t k = key(a, b);
  const Table& t = table(k);
  const std::lock_guard lock(t.mutex);
  const auto entry = t.cells.find(k);
  return entry == t.cells.end() ? std::vector<CellId>{} : entry->second;
}

}  // namespace pgdr
