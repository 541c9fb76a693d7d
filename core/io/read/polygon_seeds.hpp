// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// 2D: what segments enclose, and which of given polygons it belongs to. Segments are split first where they meet within the
// tolerance or cross, as resolve_crossings() does it; what comes of them is a planar graph, whose faces are found by walks along
// its edges, with exact signs; of each bounded face one point inside is chosen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// A polygon by its rings: the outer one, then its holes, each without the first corner again at its end.
struct RingPolygon {
  std::vector<std::vector<Point2>> rings;
  std::uint32_t feature = 0;  ///< what it belongs to
};

struct FaceSeed {
  Point2 point;
  std::int64_t feature = -1;  ///< of the first polygon that has the point; -1: none has
};

/// One point in each bounded face that the segments of `plc` make, which has nothing else; faces so narrow that rounding leaves
/// no point in them have none. n log n, but for what lies on a line through each face.
std::vector<FaceSeed> seeds_of_faces(const Plc<2>& plc, std::span<const RingPolygon> polygons);

}  // namespace pgdr::detail
