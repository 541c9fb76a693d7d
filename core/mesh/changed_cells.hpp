// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells of a mesh that were made or deleted since somebody looked, each once, in the order of their first change.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mesh/ids.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

class ChangedCells {
 public:
  void add(std::span<const CellId> cells) {
    for (const CellId c : cells) {
      if (index(c) >= is_in_.size()) is_in_.resize(std::max<std::size_t>(index(c) + 1, is_in_.size() * 3 / 2));
      if (is_in_[index(c)]) continue;
      is_in_[index(c)] = true;
      list_.push_back(c);
    }
  }
  bool contains(CellId c) const { return index(c) < is_in_.size() && is_in_[index(c)]; }
  const std::vector<CellId>& list() const { return list_; }
  void clear() {
    for (const CellId c : list_) is_in_[index(c)] = false;
    list_.clear();
  }

 private:
  std::vector<bool> is_in_;
  std::vector<CellId> list_;
};

}  // namespace pgdr::detail
