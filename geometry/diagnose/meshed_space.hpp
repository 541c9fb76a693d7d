// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the space about an input is meshed: what its walls enclose, but for holes (and, if asked for, what is void by
// nesting). Exact, and as the mesh itself has it (volumes/wall_volumes.hpp); each seed needs one ray. What cannot be decided, as
// where walls overlap, passes for not meshed. Immutable once made, any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "diagnose/near_pieces.hpp"
#include "space/stop_check.hpp"
#include "volumes/wall_volumes.hpp"

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

  const WallVolumes<D>& walls() const { return walls_; }
  const FirstHits<D>& hits() const { return walls_.hits(); }              ///< of the walls
  std::span<const Volume> volumes() const { return volumes_; }            ///< the outside first
  const Volume& volume_beside(std::uint32_t wall, bool negative) const {  ///< on its positive or negative side
    return volumes_[walls_.beside(wall, negative)];
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
  void place_seeds(const StopCheck& stop_check);
  template <class Visit>
  void walls_at(const Point<D>& x, double near, const Visit& visit) const;
  bool is_in_volume(const Point<D>& a, const Point<D>& b, bool meshed) const;
  bool is_along_facet(const Point<D>& a, const Point<D>& b, bool meshed) const requires(D == 3);
  bool bounds(std::uint32_t wall) const { return volume_beside(wall, false).meshed || volume_beside(wall, true).meshed; }

  const NearPieces<D>& pieces_;
  const WallVolumes<D> walls_;
  const double tolerance_;       ///< of the Domain, and at least some roundings: what is as near to a wall is on it
  std::vector<Volume> volumes_;  ///< the outside first
};

extern template class MeshedSpace<2>;
extern template class MeshedSpace<3>;

}  // namespace pgdr::detail
