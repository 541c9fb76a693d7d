// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Triangles of a Domain cut along all that meets them: each by itself, exactly, then rounded once. What is the same point in two
// triangles is so by its doubles, since these are a function of the exact point alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arrange/crossings.hpp"

namespace pgdr::detail {

/// Where a new point gets its attributes: from an edge (third corner no_entity), or a triangle.
using PointSource = std::array<std::uint32_t, 3>;

struct CutTriangles {
  std::vector<std::uint32_t> cut;                    ///< the triangles, ascending
  std::vector<std::uint32_t> begin;                  ///< of each its first piece, one more than triangles
  std::vector<std::array<std::uint32_t, 3>> pieces;  ///< none of them degenerate; oriented as their triangle, but for rounding
  std::vector<Point3> added;                         ///< new points, behind those of the Domain, in lexicographic order
  std::vector<PointSource> sources;                  ///< of each
  std::vector<std::pair<std::uint64_t, std::uint32_t>> on_edges;  ///< key of an edge, point inside of it; sorted
  double farthest = 0;                                            ///< that a point was rounded by

  bool empty() const { return cut.empty() && on_edges.empty(); }
};

/// `pieces`: those of the Domain. In parallel; the same for any number of threads.
CutTriangles cut_triangles(const Domain<3>& domain, std::span<const Piece> pieces, const Crossings& crossings, const Bulk& bulk,
                           const StopCheck& stop);

}  // namespace pgdr::detail
