// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Rows of large arrays that move between ranks: part r of P of an array is [n r / P, n (r + 1) / P).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pgdr/mesh_piece.hpp"
#include "transport/collectives.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

/// Rank q gets the q-th list of each. @returns the lists that this rank gets, by rank
template <class T>
std::vector<std::vector<T>> exchange_lists(Collectives& ranks, std::vector<std::vector<T>> to_each) {
  std::vector<Bytes> messages;
  for (std::vector<T>& list : to_each) {
    MessageWriter message;
    message.reserve(sizeof(std::uint64_t) + list.size() * sizeof(T));
    message.put(std::span<const T>(std::exchange(list, {})));
    messages.push_back(message.take());
  }
  std::vector<std::vector<T>> lists;
  for (const Bytes& bytes : ranks.exchange(std::move(messages))) {
    MessageReader message(bytes);
    lists.push_back(message.get_all<T>());
    message.require_end();
  }
  return lists;
}

/// As exchange_lists, one list after the other.
template <class T>
std::vector<T> exchange_joined(Collectives& ranks, std::vector<std::vector<T>> to_each) {
  std::vector<T> all;
  for (const std::vector<T>& list : exchange_lists(ranks, std::move(to_each))) all.insert(all.end(), list.begin(), list.end());
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

/// Rows [first, first + rows.size()) of `all`, of which the ranks together have each once, in the order of the ranks.
/// @returns this rank's part
template <class T>
std::vector<T> share_rows(Collectives& ranks, const std::vector<T>& rows, std::uint64_t first, std::uint64_t all) {
  std::vector<std::vector<T>> to_each(static_cast<std::size_t>(ranks.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    to_each[static_cast<std::size_t>(part_of_row(first + i, all, ranks.size()))].push_back(rows[i]);
  return exchange_joined(ranks, std::move(to_each));
}

}  // namespace pgdr::detail
