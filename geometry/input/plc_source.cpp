// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "pgdr/plc.hpp"

namespace pgdr {

PlcSource::Place PlcSource::place(SourceItem item, std::size_t i) const {
  const auto kind = static_cast<std::size_t>(item);
  const std::array lines{&point_lines, &segment_lines, &facet_lines, &hole_lines, &region_lines};
  Place place{file, i < lines[kind]->size() ? (*lines[kind])[i] : 0};
  const auto next = std::upper_bound(parts.begin(), parts.end(), i,
                                     [kind](std::size_t index, const Part& part) { return index < part.first[kind]; });
  if (next != parts.begin()) place.file = std::prev(next)->file;
  return place;
}

}  // namespace pgdr
