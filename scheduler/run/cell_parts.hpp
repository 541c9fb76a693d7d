// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks at every cell, in parts of many side by side, by the same executor as the visits.
#pragma once

#include <cstdint>
#include <functional>

#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

/// Threads that visits can run on.
int threads_of(const ScheduleOptions& options);

/// A part of the cells' slots: [first, last), in all but the last as many as are whole words of a SlotSet. Its number says where
/// it stands among all.
struct CellPart {
  std::uint32_t number, first, last;
};

/// So many parts there are of so many slots.
std::uint32_t count_parts(std::uint32_t cells);

/// Time that parts took: all of them, on the wall, and the one that took longest.
struct PartSeconds {
  double all = 0, longest = 0;
};

/// Calls f for each part, several at once, with the floating-point environment of a visit. Rethrows what f throws.
PartSeconds each_part(std::uint32_t cells, const ScheduleOptions& options, const std::function<void(const CellPart&)>& f);

}  // namespace pgdr::detail
