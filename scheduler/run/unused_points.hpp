// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a result says of points of the input that no cell has.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::detail {

/// Lists and warns. @param unused  points of the Domain, ascending
template <int D>
void note_unused_points(const Domain<D>& domain, const std::vector<std::uint32_t>& unused, RefineResult<D>& result) {
  constexpr std::size_t most_named = 5;
  result.unused_points = unused;
  const std::size_t count = result.unused_points.size();
  if (count == 0) return;
  Diagnostic d{Errc::unreferenced_point, {}, {}, 0, {}, {}};
  std::string names;
  for (const std::uint32_t p : result.unused_points) {
    const std::uint32_t input = domain.input_of_point()[p];
    if (input == no_entity) continue;
    d.ids.push_back(std::int64_t{input} + domain.first_index());
    if (d.ids.size() <= most_named) names.append(names.empty() ? "" : ", ").append(std::to_string(d.ids.back()));
  }
  if (d.ids.size() > most_named) names += ", ...";
  d.message = std::to_string(count) + (count == 1 ? " point is in no cell, as it lies" : " points are in no cell, as they lie") +
              " outside or in a void" + (names.empty() ? "" : ": " + names);
  result.warnings.push_back(std::move(d));
}

}  // namespace pgdr::detail
