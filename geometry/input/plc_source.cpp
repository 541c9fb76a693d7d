// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "pgdr/plc.hpp"

namespace pgdr {

PlcSource::Place PlcSource::place(SourceItem item, std::size_t i) const {
  const auto kind = static_cast<std::size_t>(item);
  const std::array lines{&point_lines, &segment_lines, &facet_lines, &hole_lines, &region_lines};
  const std::uint32_t line = i < lines[kind]->size() ? (*lines[kind])[i] : 0;
  const auto next = std::upper_bound(parts.begin(), parts.end(), line,
                                     [](std::uint32_t wanted, const Part& part) { return wanted < part.first_line; });
  if (next == parts.begin()) return {file, line};
  return {std::prev(next)->file, line - std::prev(next)->first_line};
}

}  // namespace pgdr
