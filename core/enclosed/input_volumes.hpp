// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes that walls separate (segments in 2D, triangles in 3D), those of a mesh with what else was given, found from these
// alone and exactly. Two sides of walls belong to one volume if they follow each other round a common ridge (a point in 2D, an
// edge in 3D), or along a line that crosses both with nothing between; such lines are cast once per connected component, and once
// per seed. Immutable once made.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "numbers/signed_measure.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/region_mode.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

struct Volume {
  bool kept = true;                                       ///< to be meshed: neither outside nor a hole, and not void by nesting
  std::vector<std::uint32_t> seeds;                       ///< region seeds in it
  double size = std::numeric_limits<double>::infinity();  ///< measure bound of its cells
  double measure = 0, measure_error = 0;
  /// Its label if it is numbered (numbers_volumes): between these (equal but for volumes with the same segments).
  std::optional<std::array<double, 2>> numbered;
};

/// What separates volumes: simplices that meet at common corners alone; and the seeds.
template <int D>
struct VolumeWalls {
  std::vector<Point<D>> points;
  std::vector<std::array<std::uint32_t, D>> simplices;
  /// 3D: pieces of the segments of the input, lesser coordinates first: the lesser ends of segments are among theirs. 2D: each
  /// simplex is one.
  std::vector<std::array<std::uint32_t, 2>> segments;
  std::vector<Point<D>> holes;
  std::vector<RegionSeed<D>> regions;
};

template <int D>
class InputVolumes {
 public:
  InputVolumes(VolumeWalls<D> walls, RegionMode mode);

  std::span<const Point<D>> holes() const { return walls_.holes; }
  std::span<const RegionSeed<D>> regions() const { return walls_.regions; }
  std::size_t wall_count() const { return sides_.size(); }
  std::array<Point<D>, D> simplex(std::uint32_t i) const;
  /// On the positive side of a wall, and on its negative.
  const std::array<std::uint32_t, 2>& volumes_of(std::uint32_t wall) const { return sides_[wall]; }
  /// Volume 0 is the outside.
  std::span<const Volume> volumes() const { return volumes_; }
  /// The volume at p; empty if p is on a wall.
  std::optional<std::uint32_t> locate(const Point<D>& p) const;
  /// The volume of each region seed; empty if it is on a wall.
  std::span<const std::optional<std::uint32_t>> region_volumes() const { return region_volumes_; }
  /// Whether the wall must be in the mesh: it touches a volume that is to be meshed.
  bool wants(std::uint32_t wall) const { return volumes_[sides_[wall][0]].kept || volumes_[sides_[wall][1]].kept; }

 private:
  template <int>
  friend class InputBuilder;
  /// Simplices crossed by the open segment from q to p, in order; empty optional if not in general position.
  std::optional<std::vector<std::uint32_t>> crossings(const Point<D>& q, const Point<D>& p) const;
  Point<D> far_from(const Point<D>& p, std::uint64_t attempt) const;
  /// Those next to p among these, in order, the last one at least. So that place after place does not take a look at all walls.
  std::optional<std::vector<std::uint32_t>> last_crossings(const Point<D>& q, const Point<D>& p) const;
  std::optional<std::vector<std::uint32_t>> in_order(const Point<D>& q, const Point<D>& p,
                                                     const std::vector<std::uint32_t>& hits) const;
  void plant_simplices();
  void nest();    ///< RegionMode::automatic: which are kept
  void number();  ///< labels of those without a seed (numbers_volumes)

  VolumeWalls<D> walls_;
  double span_ = 0;                         ///< longer than the bounding box of the input
  std::optional<detail::BoxTree<D>> tree_;  ///< of the simplices
  std::vector<std::array<std::uint32_t, 2>> sides_;
  std::vector<std::array<std::uint32_t, 2>> at_segments_;  ///< 3D: a segment, and a wall with it
  std::vector<Volume> volumes_;
  std::vector<std::optional<std::uint32_t>> region_volumes_;
};

using detail::signed_measure;

/// A sum with the running error added back (Neumaier), for volumes of millions of cells.
class CompensatedSum {
 public:
  void add(double x);
  double value() const { return sum_ + rest_; }
  double error() const { return 0x1p-51 * absolute_; }  ///< of the summation

 private:
  double sum_ = 0, rest_ = 0, absolute_ = 0;
};

}  // namespace pgdr::checking
