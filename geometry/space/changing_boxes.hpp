// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes that change, and which of them meet a box: a binary tree without pointers as in box_tree.hpp, whose leaves are lists. A
// change adjusts its leaf and the way up; after many of them the tree is built anew. Which boxes are found depends on the boxes
// alone, in which order does not. Any number of threads may search it while none changes it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "space/box.hpp"

namespace pgdr::detail {

class ChangingBoxes {
 public:
  explicit ChangingBoxes(std::vector<Box<3>> boxes) : boxes_(std::move(boxes)) { build(); }

  /// Box i becomes this one; empty: it is taken out.
  void change(std::uint32_t i, const Box<3>& box) {
    boxes_[i] = box;
    adjust(leaf_of_[i]);
    count_change();
  }
  /// Adds a box that is about where box `near` is. Its number is the next one.
  void add(const Box<3>& box, std::uint32_t near) {
    boxes_.push_back(box);
    leaf_of_.push_back(leaf_of_[near]);
    items_[leaf_of_[near] - leaves_].push_back(static_cast<std::uint32_t>(boxes_.size() - 1));
    adjust(leaf_of_[near]);
    count_change();
  }
  /// Box i, which was taken out, is there again, about where box `near` is.
  void put_back(std::uint32_t i, const Box<3>& box, std::uint32_t near) {
    take_off_list(i);
    boxes_[i] = box;
    leaf_of_[i] = leaf_of_[near];
    items_[leaf_of_[i] - leaves_].push_back(i);
    adjust(leaf_of_[i]);
    count_change();
  }
  /// Takes the last box away, with its number.
  void remove_last() {
    const auto last = static_cast<std::uint32_t>(boxes_.size() - 1);
    take_off_list(last);
    adjust(leaf_of_[last]);
    boxes_.pop_back();
    leaf_of_.pop_back();
    count_change();
  }
  const Box<3>& operator[](std::uint32_t i) const { return boxes_[i]; }
  /// Calls visit(i) once for every box that meets this one (borders count).
  template <class Visit>
  void meeting(const Box<3>& box, const Visit& visit) const {
    std::vector<std::uint32_t> stack{1};
    while (!stack.empty()) {
      const std::uint32_t node = stack.back();
      stack.pop_back();
      if (!nodes_[node].meets(box)) continue;
      if (node < leaves_) {
        stack.push_back(2 * node);
        stack.push_back(2 * node + 1);
        continue;
      }
      for (const std::uint32_t i : items_[node - leaves_])
        if (boxes_[i].meets(box)) visit(i);
    }
  }

 private:
  static constexpr std::size_t usual_items = 8;     // of a leaf
  static constexpr std::size_t least_changes = 64;  // before the tree is built anew

  void build() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
      if (boxes_[i].low[0] <= boxes_[i].high[0]) all.push_back(i);
    leaves_ = 1;
    while (leaves_ * usual_items < all.size()) leaves_ *= 2;
    nodes_.assign(2 * std::size_t{leaves_}, Box<3>::empty());
    items_.assign(leaves_, {});
    leaf_of_.assign(boxes_.size(), leaves_);
    fill(1, all, 0, all.size());
    changes_ = 0;
  }
  /// Halves by the median along the longest side of the box.
  void fill(std::uint32_t node, std::vector<std::uint32_t>& all, std::size_t begin, std::size_t end) {
    Box<3> box = Box<3>::empty();
    for (std::size_t k = begin; k < end; ++k) box.add(boxes_[all[k]]);
    nodes_[node] = box;
    if (node >= leaves_) {
      auto& items = items_[node - leaves_];
      for (std::size_t k = begin; k < end; ++k) {
        items.push_back(all[k]);
        leaf_of_[all[k]] = node;
      }
      return;
    }
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&all](std::size_t k) { return all.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t i, std::uint32_t j) {
      return boxes_[i].low[axis] + boxes_[i].high[axis] < boxes_[j].low[axis] + boxes_[j].high[axis];
    });
    fill(2 * node, all, begin, middle);
    fill(2 * node + 1, all, middle, end);
  }
  void adjust(std::uint32_t leaf) {
    Box<3> box = Box<3>::empty();
    for (const std::uint32_t i : items_[leaf - leaves_]) box.add(boxes_[i]);
    nodes_[leaf] = box;
    for (std::uint32_t node = leaf / 2; node > 0; node /= 2) {
      nodes_[node] = nodes_[2 * node];
      nodes_[node].add(nodes_[2 * node + 1]);
    }
  }
  /// What is empty may be on no list.
  void take_off_list(std::uint32_t i) {
    auto& items = items_[leaf_of_[i] - leaves_];
    items.erase(std::remove(items.begin(), items.end(), i), items.end());
  }
  void count_change() {
    if (++changes_ > least_changes + boxes_.size() / 4) build();
  }

  std::vector<Box<3>> boxes_;
  std::vector<Box<3>> nodes_;                      // 2 * leaves_, the first unused
  std::vector<std::vector<std::uint32_t>> items_;  // of each leaf
  std::vector<std::uint32_t> leaf_of_;             // of each box
  std::uint32_t leaves_ = 1;
  std::size_t changes_ = 0;
};

}  // namespace pgdr::detail
