// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces: maximal sets of subfacets connected across edges that are no subsegments, all turned the same way. A piece
// belongs to one patch of the input; which one, its bounding chains tell.
#pragma once

#include <cstdint>
#include <vector>

#include "check/conformity.hpp"

namespace pgdr::checking {

/// An edge of a piece that is a subsegment of a known segment.
struct PieceBound {
  EntityId segment = no_entity;
  bool reversed = false;  ///< the (turned) subfacet runs along it against the segment's direction
  std::uint32_t subfacet = 0;
};

struct Piece {
  std::vector<std::uint32_t> subfacets;
  std::vector<PieceBound> bounds;
};

struct Pieces {
  std::vector<Piece> list;
  std::vector<std::uint8_t> turned;  ///< of each subfacet: its vertices run against its piece's sense
};

/// Edges inside a piece that are not used exactly twice, and pieces that cannot be oriented, are findings.
Pieces collect_pieces(const ConformityTask<3>& task, const Conformity<3>& conformity);

}  // namespace pgdr::checking
