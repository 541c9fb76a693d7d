// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops over all cells, in parts that run side by side.
#pragma once

#include <cstdint>
#include <functional>

#include "space/pieces.hpp"

namespace pgdr::detail {

/// A part of the cells' slots: [first, last), whole words of a SlotSet in all but the last. Parts are numbered in the order of
/// the slots, from 0.
struct CellPart {
  std::uint32_t number, first, last;
};

/// The number of parts of so many slots.
std::uint32_t count_parts(std::uint32_t cells);

/// Calls f for each part, several at once. Rethrows what f throws.
void each_part(std::uint32_t cells, const Pieces& pieces, const std::function<void(const CellPart&)>& f);

}  // namespace pgdr::detail
