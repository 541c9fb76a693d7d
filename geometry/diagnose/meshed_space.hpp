// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the space about an input is meshed: what its walls enclose, but for holes (and, if asked for, what is void by
// nesting). Exact, and as the mesh itself has it: two sides of walls belong to one volume if they follow each other round a
// common ridge (3D an edge, 2D a point), or along a ray with nothing between; each connected surface needs one ray, each seed
// one. What cannot be decided, as where walls overlap, passes for not meshed. Immutable once made, any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "diagnose/first_hits.hpp"
#include "diagnose/near_pieces.hpp"
#include "space/disjoint_sets.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

template <int D>
class MeshedSpace {
 public:
  /// What walls separate.
  struct Volume {
    bool meshed = false;
    double label = 0;                                       ///< of its region seed
    double size = std::numeric_limits<double>::infinity();  ///< the bound of that
  };

  /// Points are in unit scale here and below. @throws CancelledError
  MeshedSpace(const NearPieces<D>& pieces, bool voids_by_nesting, const Bulk& bulk, const StopCheck& stop_check);

  const FirstHits<D>& hits() const { return hits_; }                      ///< of the walls
  std::span<const Volume> volumes() const { return volumes_; }            ///< the outside first
  const Volume& volume_beside(std::uint32_t wall, bool negative) const {  ///< on its positive or negative side
    return volumes_[volume_of_[2 * wall + negative]];
  }
  /// The volume that x is inside of; null on a wall, or if nothing is known.
  const Volume* volume_at(const Point<D>& x) const;
  /// Is the piece in what is meshed, or on its boundary?
  bool has(std::uint32_t piece) const;
  /// May what is between the piece and x be meshed, by the side of the piece that x is on?
  bool may_face(std::uint32_t piece, const Point<D>& x) const;
  /// Is all that is between two points of pieces in one volume that is meshed, or (3D) on one facet that bounds such a volume?
  /// With `meshed` false: in one that is not, or on one that bounds none.
  bool is_between(const Point<D>& a, const Point<D>& b, bool meshed = true) const;

 private:
  /// A wall at a ridge. `ahead`: its side that a turn round the ridge enters when it leaves the wall, counter-clockwise as seen
  /// against the direction from the ridge's lesser point to the greater.
  struct AtRidge {
    std::uint64_t ridge;
    std::uint32_t wall, apex;
    bool ahead_negative;
    friend auto operator<=>(const AtRidge&, const AtRidge&) = default;
  };
  std::uint32_t outside() const { return 2 * hits_.walls(); }
  std::vector<AtRidge> walls_at_ridges(const Bulk& bulk, const StopCheck& stop_check) const;
  Sign turn(std::uint64_t ridge, std::uint32_t from, std::uint32_t to) const;
  void turn_round(std::span<AtRidge> walls, DisjointSets& sides, DisjointSets& surfaces) const;
  /// Walls that hang together.
  struct Surface {
    std::uint32_t name;  ///< its number in the sets
    std::span<const std::uint32_t> walls;
    Box<D> box;
    double reach = -std::numeric_limits<double>::infinity();  ///< along the ray of the first attempt
  };
  std::vector<Surface> list(std::span<const std::uint32_t> by_surface, DisjointSets& surfaces) const;
  std::vector<char> join_surfaces(DisjointSets& sides, DisjointSets& surfaces, const Bulk& bulk,
                                  const StopCheck& stop_check) const;
  bool join_along_ray(const Surface& surface, int attempt, std::vector<char>& joined, DisjointSets& sides,
                      DisjointSets& surfaces) const;
  void number_volumes(DisjointSets& sides, DisjointSets& surfaces, std::span<const char> joined);
  void judge_nesting();
  void place_seeds(const StopCheck& stop_check);
  std::optional<std::uint32_t> find(const Point<D>& x) const;
  template <class Visit>
  void walls_at(const Point<D>& x, double near, const Visit& visit) const;
  bool is_in_volume(const Point<D>& a, const Point<D>& b, bool meshed) const;
  bool is_along_facet(const Point<D>& a, const Point<D>& b, bool meshed) const requires(D == 3);
  bool bounds(std::uint32_t wall) const { return volume_beside(wall, false).meshed || volume_beside(wall, true).meshed; }

  const NearPieces<D>& pieces_;
  const FirstHits<D> hits_;
  const double tolerance_;                ///< of the Domain, and at least some roundings: what is as near to a wall is on it
  std::vector<std::uint32_t> volume_of_;  ///< of sides: 2 i is the positive one of wall i, 2 i + 1 the negative; then the outside
  std::vector<Volume> volumes_;           ///< the outside first
};

extern template class MeshedSpace<2>;
extern template class MeshedSpace<3>;

}  // namespace pgdr::detail
