// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes that walls separate (segments in 2D, triangles in 3D): those of a Domain, or of a mesh with what else was given,
// found from these alone and exactly. Two sides of walls belong to one volume if they follow each
// other round a common ridge (a point in 2D, an edge in 3D), or along a line that crosses both with nothing between;
// such lines are cast once per connected component, and once per seed. Immutable once made.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "numbers/signed_measure.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/region_mode.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

/// A maximal part of an entity that no segment divides: a segment in 2D; in 3D triangles of one facet.
struct Patch {
  EntityId entity = no_entity;
  std::uint32_t first = 0, count = 0;     ///< of the simplices
  std::array<std::uint32_t, 2> volume{};  ///< on the positive side of its simplices, and on the negative
};

/// A patch has triangles along this segment. `reversed`: they run along it from its second point to its first.
struct Bound {
  EntityId segment = no_entity;
  bool reversed = false;
  std::uint32_t patch = 0;
  friend auto operator<=>(const Bound&, const Bound&) = default;
};

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
  std::vector<EntityId> entities;                      ///< of each simplex, what it is a part of
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< lesser coordinates first; 2D: of each simplex
  /// The segments are pieces of those of the input, whose lesser ends alone are known: those of the pieces.
  bool segments_are_pieces = false;
  std::vector<Point<D>> holes;
  std::vector<RegionSeed<D>> regions;
};

template <int D>
class InputVolumes {
 public:
  explicit InputVolumes(const Domain<D>& domain, RegionMode mode = RegionMode::seeds);
  InputVolumes(VolumeWalls<D> walls, RegionMode mode);

  /// Null if it was made of other walls.
  const Domain<D>* made_of() const { return domain_; }
  const Domain<D>& domain() const { return *domain_; }
  std::span<const Point<D>> holes() const { return walls_.holes; }
  std::span<const RegionSeed<D>> regions() const { return walls_.regions; }
  /// Points of the walls, grouped by patch; in 3D all of a facet run the same way in its projection.
  std::span<const std::array<std::uint32_t, D>> simplices() const { return walls_.simplices; }
  std::array<Point<D>, D> simplex(std::uint32_t i) const;
  std::span<const Patch> patches() const { return patches_; }
  /// Volume 0 is the outside.
  std::span<const Volume> volumes() const { return volumes_; }
  /// 3D: bounds of all patches along a segment in one direction.
  std::span<const Bound> bounds(EntityId segment, bool reversed) const;
  /// All bounds, sorted.
  std::span<const Bound> bounds() const { return bounds_; }
  /// The volume at p; empty if p is on a wall.
  std::optional<std::uint32_t> locate(const Point<D>& p) const;
  /// The volume of each region seed; empty if it is on a wall.
  std::span<const std::optional<std::uint32_t>> region_volumes() const { return region_volumes_; }

  /// Whether the entity must be in the mesh: it touches a kept volume. A loose one is located, which takes a
  /// line: ask only for what is not in the mesh.
  bool wants_patch(std::uint32_t patch) const;
  bool wants_segment(EntityId segment) const;
  bool wants_point(std::uint32_t point) const;

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
  std::uint32_t side_volume(std::uint32_t simplex, bool negative) const;
  bool keeps(const Point<D>& p) const;

  const Domain<D>* domain_ = nullptr;
  VolumeWalls<D> walls_;
  double span_ = 0;                         ///< longer than the bounding box of the input
  std::optional<detail::BoxTree<D>> tree_;  ///< of the simplices
  std::vector<std::uint32_t> patch_of_;
  std::vector<Patch> patches_;
  std::vector<Bound> bounds_;
  std::vector<Volume> volumes_;
  std::vector<std::optional<std::uint32_t>> region_volumes_;
  enum class Wanted : std::uint8_t { unknown, no, yes };
  std::vector<Wanted> wants_segment_, wants_point_;  ///< unknown: at no wall
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
