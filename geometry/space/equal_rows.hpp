// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The rows of a sorted list that have a key. (std::ranges::equal_range says it, too, but Clang 14 does not take the header of
// GCC 12.)
#pragma once

#include <algorithm>
#include <functional>
#include <span>

namespace pgdr::detail {

/// @pre the rows are sorted by key_of(row)
template <class Row, class Key, class KeyOf>
std::span<const Row> equal_rows(std::span<const Row> rows, const Key& key, KeyOf key_of) {
  const auto first = std::lower_bound(rows.begin(), rows.end(), key,
                                      [&](const Row& row, const Key& k) { return std::invoke(key_of, row) < k; });
  const auto last = std::upper_bound(first, rows.end(), key,
                                     [&](const Key& k, const Row& row) { return k < std::invoke(key_of, row); });
  return rows.subspan(static_cast<std::size_t>(first - rows.begin()), static_cast<std::size_t>(last - first));
}

}  // namespace pgdr::detail
