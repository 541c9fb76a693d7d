// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes (2D: areas) that walls separate. Exact: two sides of walls belong to one volume if they follow each other round a
// common ridge (3D an edge, 2D a point), or along a ray with nothing between; each connected surface needs one ray. What cannot
// be decided, as where walls overlap, is not known. Immutable once made, any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "space/disjoint_sets.hpp"
#include "space/stop_check.hpp"
#include "volumes/first_hits.hpp"

namespace pgdr::detail {

/// Rays that are tried, where each goes through a rim by bad luck only.
inline constexpr int most_rays = 64;

template <int D>
class WallVolumes {
 public:
  /// The points must outlive this. @pre any two walls have corners and edges in common, or nothing. @throws CancelledError
  WallVolumes(std::span<const Point<D>> points, std::vector<Wall<D>> walls, const Bulk& bulk, const StopCheck& stop_check);

  const FirstHits<D>& hits() const { return hits_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(known_.size()); }  ///< of volumes; 0 is the outside
  /// On the positive or negative side of a wall (which corners have the sign that orient3d, orient2d say).
  std::uint32_t beside(std::uint32_t wall, bool negative) const { return volume_of_[2 * wall + negative]; }
  /// Is it known of all its walls where they are?
  bool is_known(std::uint32_t volume) const { return known_[volume] != 0; }
  /// The volume that x is inside of; none on a wall, or if nothing is known.
  std::optional<std::uint32_t> find(const Point<D>& x) const;
  /// Pairs of the volumes on both sides of the walls, where these differ.
  std::vector<std::array<std::uint32_t, 2>> neighbours() const;

 private:
  /// A wall at a ridge. `ahead`: its side that a turn round the ridge enters when it leaves the wall, counter-clockwise as seen
  /// against the direction from the ridge's lesser point to the greater.
  struct AtRidge {
    std::uint64_t ridge;
    std::uint32_t wall, apex;
    bool ahead_negative;
    friend auto operator<=>(const AtRidge&, const AtRidge&) = default;
  };
  /// Walls that hang together.
  struct Surface {
    std::uint32_t name;  ///< its number in the sets
    std::span<const std::uint32_t> walls;
    Box<D> box;
    double reach = -std::numeric_limits<double>::infinity();  ///< along the ray of the first attempt
  };
  std::uint32_t outside() const { return 2 * hits_.count(); }
  std::vector<AtRidge> walls_at_ridges(const Bulk& bulk, const StopCheck& stop_check) const;
  Sign turn(std::uint64_t ridge, std::uint32_t from, std::uint32_t to) const;
  void turn_round(std::span<AtRidge> walls, DisjointSets& sides, DisjointSets& surfaces) const;
  std::vector<Surface> list(std::span<const std::uint32_t> by_surface, DisjointSets& surfaces) const;
  std::vector<char> join_surfaces(DisjointSets& sides, DisjointSets& surfaces, const Bulk& bulk,
                                  const StopCheck& stop_check) const;
  bool join_along_ray(const Surface& surface, int attempt, std::vector<char>& joined, DisjointSets& sides,
                      DisjointSets& surfaces) const;
  void number_volumes(DisjointSets& sides, DisjointSets& surfaces, std::span<const char> joined);

  const FirstHits<D> hits_;
  std::vector<std::uint32_t> volume_of_;  ///< of sides: 2 i is the positive one of wall i, 2 i + 1 the negative; then the outside
  std::vector<char> known_;               ///< of volumes
};

extern template class WallVolumes<2>;
extern template class WallVolumes<3>;

}  // namespace pgdr::detail
