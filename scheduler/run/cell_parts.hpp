// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops over all cells, in parts that the executor of the visits runs side by side.
#pragma once

#include <cstdint>
#include <functional>

#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

/// The number of threads that visits can run on.
int threads_of(const ScheduleOptions& options);

/// A part of the cells' slots: [first, last), whole words of a SlotSet in all but the last. Parts are numbered in the order of
/// the slots, from 0.
struct CellPart {
  std::uint32_t number, first, last;
};

/// The number of parts of so many slots.
std::uint32_t count_parts(std::uint32_t cells);

/// The seconds that parts took: all of them, on the wall, and the one that took longest.
struct PartSeconds {
  double all = 0, longest = 0;
};

/// Calls f for each part, several at once, with the floating-point environment of a visit. Rethrows what f throws.
PartSeconds each_part(std::uint32_t cells, const ScheduleOptions& options, const std::function<void(const CellPart&)>& f);

}  // namespace pgdr::detail
