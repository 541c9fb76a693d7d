// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "numbers/finite.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// Are coordinates finite, and indices those of points? Else a Domain refuses it, with words.
template <int D>
bool is_usable(const Plc<D>& plc) {
  const auto is_point = [&](std::uint32_t v) { return v < plc.points.size(); };
  if (!std::ranges::all_of(plc.points, is_finite<D>)) return false;
  for (const auto& s : plc.segments)
    if (!std::ranges::all_of(s.points, is_point)) return false;
  for (const auto& facet : plc.facets)
    for (const auto& polygon : facet.polygons)
      if (!std::ranges::all_of(polygon, is_point)) return false;
  return true;
}

}  // namespace pgdr::detail
