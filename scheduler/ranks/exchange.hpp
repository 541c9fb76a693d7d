// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Rows of large arrays that move between ranks: part r of P of an array is [n r / P, n (r + 1) / P).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pgdr/mesh_piece.hpp"
#include "transport/collectives.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

/// Rank q gets the q-th list of each. That of the rank itself, which may be the largest, is moved.
/// @returns the lists that this rank gets, by rank
template <class T>
std::vector<std::vector<T>> exchange_lists(Collectives& ranks, std::vector<std::vector<T>> to_each) {
  const auto self = static_cast<std::size_t>(ranks.rank());
  std::vector<T> own = std::move(to_each[self]);
  std::vector<Bytes> messages(to_each.size());
  for (std::size_t q = 0; q < to_each.size(); ++q) {
    if (q == self) continue;
    MessageWriter message;
    message.reserve(sizeof(std::uint64_t) + to_each[q].size() * sizeof(T));
    message.put(std::span<const T>(std::vector<T>(std::move(to_each[q]))));
    messages[q] = message.take();
  }
  std::vector<Bytes> arrived = ranks.exchange(std::move(messages));
  std::vector<std::vector<T>> lists(arrived.size());
  for (std::size_t q = 0; q < arrived.size(); ++q) {
    if (q == self) continue;
    const Bytes bytes = std::move(arrived[q]);  // freed once it has been read
    MessageReader message(bytes);
    lists[q] = message.get_all<T>();
    message.require_end();
  }
  lists[self] = std::move(own);
  return lists;
}

/// As exchange_lists, one list after the other.
template <class T>
std::vector<T> exchange_joined(Collectives& ranks, std::vector<std::vector<T>> to_each) {
  std::vector<std::vector<T>> lists = exchange_lists(ranks, std::move(to_each));
  std::size_t count = 0, largest = 0;
  for (std::size_t q = 0; q < lists.size(); ++q) {
    count += lists[q].size();
    if (lists[q].size() > lists[largest].size()) largest = q;
  }
  // The others are put around the largest, where it has the room.
  std::vector<T> all = std::move(lists[largest]);
  const std::size_t before = [&] {
    std::size_t sum = 0;
    for (std::size_t q = 0; q < largest; ++q) sum += lists[q].size();
    return sum;
  }();
  all.reserve(count);
  all.insert(all.begin(), before, T{});
  auto at = all.begin();
  for (std::size_t q = 0; q < largest; ++q) at = std::copy(lists[q].begin(), lists[q].end(), at);
  for (std::size_t q = largest + 1; q < lists.size(); ++q) all.insert(all.end(), lists[q].begin(), lists[q].end());
  return all;
}

/// The part that a row is in. @pre row < rows
inline int part_of_row(std::uint64_t row, std::uint64_t rows, int parts) {
  return static_cast<int>(((row + 1) * static_cast<std::uint64_t>(parts) - 1) / rows);
}

/// The rows of one part of the ranks' parts.
struct RowRange {
  std::uint64_t first, count;
  RowRange(std::uint64_t rows, const Collectives& ranks)
      : first(first_row_of_part(rows, static_cast<std::uint64_t>(ranks.rank()), static_cast<std::uint64_t>(ranks.size()))),
        count(first_row_of_part(rows, static_cast<std::uint64_t>(ranks.rank()) + 1, static_cast<std::uint64_t>(ranks.size())) -
              first) {}
};

/// Rows [first, first + rows.size()) of `all`, of which the ranks together have each once, in the order of the ranks. Only what
/// another rank gets is copied.
/// @returns this rank's part
template <class T>
std::vector<T> share_rows(Collectives& ranks, std::vector<T> rows, std::uint64_t first, std::uint64_t all) {
  const auto size = static_cast<std::uint64_t>(ranks.size()), self = static_cast<std::uint64_t>(ranks.rank());
  const auto place = [&](std::uint64_t rank) {  // in `rows`, of the first row of its part
    const std::uint64_t row = std::clamp(first_row_of_part(all, rank, size), first, first + rows.size());
    return rows.begin() + static_cast<std::ptrdiff_t>(row - first);
  };
  std::vector<std::vector<T>> to_each(ranks.size());
  for (std::uint64_t q = 0; q < size; ++q)
    if (q != self) to_each[q].assign(place(q), place(q + 1));
  rows.erase(place(self + 1), rows.end());
  rows.erase(rows.begin(), place(self));
  to_each[self] = std::move(rows);
  return exchange_joined(ranks, std::move(to_each));
}

}  // namespace pgdr::detail
