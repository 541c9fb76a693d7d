// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "space/bulk.hpp"

namespace pgdr::detail {

/// Sorts v, and keeps one of equal values.
template <class T>
void make_set(std::vector<T>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

/// The same, sorted side by side.
template <class T>
void make_set(std::vector<T>& v, const Bulk& bulk) {
  if (!std::is_sorted(v.begin(), v.end())) bulk.sort(v, std::less<>());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

}  // namespace pgdr::detail
