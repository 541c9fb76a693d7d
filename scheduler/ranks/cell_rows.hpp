// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells of a mesh of which each rank has a part, sorted by the numbers of their vertices over all ranks: each goes to the
// rank in whose part of the numbers its first vertex is, and is sorted there. It is written into the message from where it lay in
// the mesh, which shrinks meanwhile, and read from the message into its place, so that no rank needs more memory than for the
// mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "compact/canonical.hpp"
#include "compact/stripped_cells.hpp"
#include "ranks/exchange.hpp"
#include "ranks/vertex_numbering.hpp"

namespace pgdr::detail {

/// A cell by the numbers of its vertices, in canonical order. N: an unsigned type that has all numbers.
template <int D, class N>
struct CellRow {
  std::array<N, D + 1> vertices;
  std::uint32_t label;  ///< the number of its region
};

/// See above.
template <int D, class N>
class CellRows {
 public:
  using Row = CellRow<D, N>;

  /// `points`: of the whole mesh.
  CellRows(Collectives& ranks, const Bulk& bulk, Number points)
      : ranks_(ranks), bulk_(bulk), points_(points), own_(points, ranks) {}

  /// Of all cells of all ranks those with their first vertex in this rank's part of the points, sorted. `numbers`: of the
  /// vertices. The cells of this rank are gone afterwards. @throws ResourceError internal: a message is none; std::bad_alloc
  std::vector<Row> sorted(StrippedCells<D>& cells, Mesh<D>& mesh, const std::vector<Number>& numbers) {
    std::vector<Bytes> arrived = ranks_.exchange(pack(cells, mesh, numbers));
    std::vector<Row> rows = in_buckets(arrived);
    bulk_.each(static_cast<std::size_t>(own_.count), [&](std::size_t v) {
      std::sort(rows.begin() + begin_[v], rows.begin() + begin_[v + 1],
                [](const Row& a, const Row& b) { return a.vertices < b.vertices; });
    });
    return rows;
  }

 private:
  std::size_t rank_of(Number first) const { return static_cast<std::size_t>(part_of_row(first, points_, ranks_.size())); }

  /// The cells for each rank. Each block of the mesh is given back once its cells are written.
  std::vector<Bytes> pack(StrippedCells<D>& cells, Mesh<D>& mesh, const std::vector<Number>& numbers) const {
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(ranks_.size()), 0);
    for (std::size_t block = 0; block < cells.block_count(); ++block)
      for (const auto& cell : cells.block(block)) {
        Number first = numbers[cell[0]];
        for (const std::uint32_t v : cell) first = std::min(first, numbers[v]);
        ++counts[rank_of(first)];
      }
    std::vector<MessageWriter> messages(counts.size());
    for (std::size_t q = 0; q < messages.size(); ++q) {
      messages[q].reserve(sizeof(std::uint64_t) + counts[q] * sizeof(Row));
      messages[q].put(counts[q]);
    }
    for (std::size_t block = 0; block < cells.block_count(); ++block) {
      const auto regions = cells.regions(block);
      std::size_t i = 0;
      for (const auto& cell : cells.block(block)) {
        Row row{{}, regions.empty() ? 0u : regions[i++]};
        for (std::size_t j = 0; j <= D; ++j) row.vertices[j] = static_cast<N>(numbers[cell[j]]);
        row.vertices = canonical(row.vertices);
        messages[rank_of(row.vertices[0])].put(row);
      }
      cells.discard(mesh, block);
    }
    std::vector<Bytes> bytes;
    for (MessageWriter& message : messages) bytes.push_back(message.take());
    return bytes;
  }

  /// The cells in the messages by their first vertices: those of vertex v of this rank's part begin at begin_[v].
  std::vector<Row> in_buckets(std::vector<Bytes>& messages) {
    begin_.assign(static_cast<std::size_t>(own_.count) + 2, 0);
    std::uint32_t all = 0;
    for (const Bytes& bytes : messages) each_row(bytes, [&](const Row& row) { ++begin_[place_of(row) + 2], ++all; });
    for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    std::vector<Row> rows(all);
    for (Bytes& bytes : messages) {
      each_row(bytes, [&](const Row& row) { rows[begin_[place_of(row) + 1]++] = row; });
      Bytes().swap(bytes);
    }
    begin_.pop_back();
    return rows;
  }
  template <class F>
  static void each_row(const Bytes& bytes, F f) {
    MessageReader message(bytes);
    for (std::size_t left = message.get_count(sizeof(Row)); left > 0; --left) f(message.get<Row>());
    message.require_end();
  }
  std::size_t place_of(const Row& row) const {
    const Number place = row.vertices[0] - own_.first;
    if (place >= own_.count) fail_message("a message of another rank has a cell for a third one");
    return static_cast<std::size_t>(place);
  }

  Collectives& ranks_;
  const Bulk& bulk_;
  const Number points_;
  const RowRange own_;  // this rank's part of the points
  std::vector<std::uint32_t> begin_;
};

}  // namespace pgdr::detail
