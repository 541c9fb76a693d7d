// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where triangles and segments of a Domain meet although they have nothing in common there, exactly: what the diagnosis refuses,
// as points on edges and as edges through triangles. For .cpp files of this room alone.
//
// Two triangles that are not of one plane meet in a point or in an edge, whose ends are among the hits of contact() and the
// common corners: the hull of these is all that they have in common (space/contact.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arrange/exact_point.hpp"
#include "pgdr/domain.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// A new point, where an edge goes through another edge or a triangle.
struct CrossingPoint {
  ExactPoint exact;
  Point3 at;  ///< the doubles next to it
};

/// Points go by number: those of the Domain by theirs, new ones counted on behind these.
struct Crossings {
  /// An edge, or with equal ends a point, that a triangle gets.
  struct Cut {
    std::uint32_t triangle;
    std::array<std::uint32_t, 2> ends;
    friend auto operator<=>(const Cut&, const Cut&) = default;
  };
  std::vector<CrossingPoint> points;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> on_edges;  ///< key of an edge, point inside of it; sorted
  std::vector<Cut> cuts;                                          ///< sorted
  std::vector<std::array<std::uint32_t, 2>> pairs;                ///< of pieces that meet, sorted
  bool overlap = false;                                           ///< some of them with an area of one plane
};

/// `pieces`: those of the Domain. In parallel.
Crossings find_crossings(const Domain<3>& domain, std::span<const Piece> pieces, const Bulk& bulk, const StopCheck& stop);

}  // namespace pgdr::detail
