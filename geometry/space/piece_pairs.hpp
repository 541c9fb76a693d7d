// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pairs of pieces that may meet, or come within a distance of each other.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "space/box_tree.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// Calls visit(i, j, part), i < j, for all pairs of pieces that come within this distance of each other, but for some that meet
/// in, or are near, a common corner alone (BoxTree); and for others. In parts, several of which may be looked through at once.
/// @returns these, in an order that does not depend on the threads. @throws CancelledError
template <class Part, int D, class Visit>
std::vector<Part> look_at_pairs(std::span<const Piece> pieces, std::span<const Point<D>> points, double within, const Bulk& bulk,
                                const StopCheck& stop_check, const Visit& visit) {
  std::vector<std::array<std::uint32_t, 3>> corners(pieces.size());
  bulk.each(corners.size(), [&](std::size_t i) { corners[i] = pieces[i].corners; });
  const BoxTree<D> tree(corners, points, within, bulk);
  stop_check();
  auto parts = tree.template self_pairs_in_parts<Part>(bulk, [&](std::uint32_t i, std::uint32_t j, Part& part) {
    stop_check();
    visit(i, j, part);
  });
  stop_check();
  return parts;
}

/// The lists of all parts, one after the other; `list`: of a part.
template <class Part, class List>
std::vector<List> joined(std::vector<Part>& parts, std::vector<List> Part::*list) {
  std::vector<List> all;
  for (Part& part : parts) std::move((part.*list).begin(), (part.*list).end(), std::back_inserter(all));
  return all;
}
template <class Item>
std::vector<Item> joined(std::vector<std::vector<Item>>&& parts) {
  std::vector<Item> all;
  for (std::vector<Item>& part : parts) std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

}  // namespace pgdr::detail
