// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Hilbert keys, and the biased randomised insertion order (Amenta, Choi, Rote 2003): rounds of doubling size drawn by a
// hash of the coordinates, each in Hilbert order. Functions of the coordinates alone, but for powers of two; pure; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/bulk.hpp"

namespace pgdr {

/// Maps a cube to keys along a Hilbert curve; 31 bits a coordinate in 2D, 21 in 3D. Points outside are clamped.
template <int D>
class HilbertCurve {
 public:
  /// The cube spans the bounding box of `points`, its side rounded up to a power of two.
  explicit HilbertCurve(std::span<const Point<D>> points);
  std::uint64_t key(const Point<D>& p) const;  ///< position along the curve
  double unit() const { return unit_; }        ///< the power of two that makes the longest side of the box from one to two

 private:
  Point<D> corner_{};
  double scale_ = 1, unit_ = 1;
};

/// Points in the order of the curve, and the round that each is drawn into: the last round has half of the points, the one before
/// a quarter, ...
struct CurveOrder {
  std::vector<std::uint32_t> points;  ///< their indices along the curve; those of one key in the order of their coordinates
  std::vector<std::uint8_t> rounds;   ///< of each, in the same order
  int round_count = 1;
};
template <int D>
CurveOrder curve_order(std::span<const Point<D>> points, const detail::Bulk& bulk);

/// A permutation of the indices of `points` in which to insert them: round by round, each along the curve.
template <int D>
std::vector<std::uint32_t> insertion_order(std::span<const Point<D>> points);

}  // namespace pgdr
