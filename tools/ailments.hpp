// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What an input in space suffers from: which closed bodies overlap, where edges touch, how wide its seams gape.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// Closed surfaces that run through each other.
struct OverlappingBodies {
  std::uint64_t count = 0;
  std::uint64_t crossings = 0;  ///< pairs of their facets
  std::string first;            ///< of these
};
/// If nothing else is wrong.
std::optional<OverlappingBodies> overlapping_bodies(const Plc<3>& plc, const Diagnosis<3>& diagnosis,
                                                    const std::stop_token& stop);

/// Where edges cross, and no more: facets that meet in a single point, and edges that Domain refuses as they pass each other
/// within the tolerance, within which places are one.
std::vector<std::array<double, 3>> places_where_edges_cross(const Diagnosis<3>& all, double tolerance);

/// Facets that meet, in a few words: whether they cross, or touch at points alone.
std::string words_of_meetings(const Diagnosis<3>& diagnosis);

/// Of the points of open boundaries, how far each is from the nearest other one; ascending. None if there are too many.
template <int D>
std::vector<double> gaps_of_open_boundaries(const Plc<D>& plc, const std::stop_token& stop);

}  // namespace pgdr::tool
