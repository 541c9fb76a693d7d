// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/cell_parts.hpp"

#include <algorithm>

#include "mesh/slot_set.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t cells_a_part = 1 << 13;  // of which the least look takes some 50 microseconds
static_assert(cells_a_part % SlotSet::slots_a_word == 0);

}  // namespace

std::uint32_t count_parts(std::uint32_t cells) { return cells / cells_a_part + 1; }

void each_part(std::uint32_t cells, const Pieces& pieces, const std::function<void(const CellPart&)>& f) {
  pieces.run(count_parts(cells), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    f({v, v * cells_a_part, std::min(cells, (v + 1) * cells_a_part)});
  });
}

}  // namespace pgdr::detail
