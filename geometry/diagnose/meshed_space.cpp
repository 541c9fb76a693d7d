// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/meshed_space.hpp"

#include <algorithm>
#include <cmath>

#include "space/nesting.hpp"

namespace pgdr::detail {
namespace {

/// In unit scale, where coordinates are up to 2: rounding's own, 8 ulps, where the Domain has none.
constexpr double least_tolerance = 0x1p-48;

/// Those of the pieces that are walls come first.
template <int D>
std::vector<Wall<D>> walls_of(const NearPieces<D>& pieces) {
  std::vector<Wall<D>> walls;
  for (const Piece& p : pieces.pieces()) {
    if (p.count != D) break;
    Wall<D>& wall = walls.emplace_back();
    std::copy_n(p.corners.begin(), D, wall.begin());
  }
  return walls;
}

}  // namespace

template <int D>
MeshedSpace<D>::MeshedSpace(const NearPieces<D>& pieces, bool voids_by_nesting, const Bulk& bulk, const StopCheck& stop_check)
    : pieces_(pieces),
      walls_(pieces.points(), walls_of(pieces), bulk, stop_check),
      tolerance_(std::max(pieces.domain().tolerance() / pieces.unit(), least_tolerance)),
      volumes_(walls_.count()) {
  const std::vector<bool> solid = voids_by_nesting ? solid_by_nesting(walls_.count(), walls_.neighbours())
                                                   : std::vector<bool>(volumes_.size(), true);
  for (std::uint32_t v = 1; v < volumes_.size(); ++v) volumes_[v].meshed = walls_.is_known(v) && solid[v];
  place_seeds(stop_check);
}

template <int D>
void MeshedSpace<D>::place_seeds(const StopCheck& stop_check) {
  const auto volume_of = [&](Point<D> x) {
    stop_check();
    for (double& c : x.x) c /= pieces_.unit();
    return walls_.find(x);
  };
  for (const RegionSeed<D>& seed : pieces_.domain().regions())
    if (const auto v = volume_of(seed.point); v && *v != 0) {
      volumes_[*v].meshed = true;
      volumes_[*v].label = seed.attribute;
      if (seed.size > 0) volumes_[*v].size = seed.size;
    }
  for (const Point<D>& hole : pieces_.domain().holes())
    if (const auto v = volume_of(hole)) volumes_[*v].meshed = false;
}

template <int D>
auto MeshedSpace<D>::volume_at(const Point<D>& x) const -> const Volume* {
  const auto v = walls_.find(x);
  return v ? &volumes_[*v] : nullptr;
}

template <int D>
bool MeshedSpace<D>::has(std::uint32_t piece) const {
  if (piece < hits().count()) return bounds(piece);
  const auto corners = pieces_.pieces()[piece].points();
  const auto p = pieces_.points();
  const Volume* const about = volume_at(on_edge(p[corners.front()], p[corners.back()], 0.5));
  return about && about->meshed;
}

template <int D>
bool MeshedSpace<D>::may_face(std::uint32_t piece, const Point<D>& x) const {
  if (piece >= hits().count()) return true;
  const Sign side = hits().side(piece, x);
  return side == Sign::zero ? bounds(piece) : volume_beside(piece, side == Sign::negative).meshed;
}

template <int D>
bool MeshedSpace<D>::is_between(const Point<D>& a, const Point<D>& b, bool meshed) const {
  if (is_in_volume(a, b, meshed)) return true;
  if constexpr (D == 3)
    return is_along_facet(a, b, meshed);
  else
    return false;
}

// Both ends lie on walls, and are rounded; and so is the middle, which would be on either side of a wall that it is on.
template <int D>
bool MeshedSpace<D>::is_in_volume(const Point<D>& a, const Point<D>& b, bool meshed) const {
  constexpr double most = 0.125;
  const double length = std::sqrt(squared_distance(a, b)), rim = length * most > tolerance_ ? tolerance_ / length : most;
  const typename FirstHits<D>::Ray way{on_edge(a, b, rim), on_edge(a, b, 1 - rim)};
  if (hits().first(way).kind != FirstHits<D>::Kind::none) return false;
  const Point<D> middle = on_edge(a, b, 0.5);
  bool on_wall = false;
  walls_at(middle, std::min(tolerance_, length / 4), [&](std::uint32_t) { on_wall = true; });
  const Volume* const here = on_wall ? nullptr : volume_at(middle);
  return here && here->meshed == meshed;
}

template <int D>
template <class Visit>
void MeshedSpace<D>::walls_at(const Point<D>& x, double near, const Visit& visit) const {
  hits().tree().meeting(Box<D>::around(x).widened(near), [&](std::uint32_t i) {
    if (pieces_.closest(x, pieces_.pieces()[i]).square <= near * near) visit(i);
  });
}

template <int D>
bool MeshedSpace<D>::is_along_facet(const Point<D>& a, const Point<D>& b, bool meshed) const requires(D == 3) {
  const auto is_of = [&](EntityId facet, const Point<D>& x) {
    bool found = false;
    walls_at(x, tolerance_, [&](std::uint32_t i) { found = found || pieces_.pieces()[i].owner == facet; });
    return found;
  };
  bool along = false;
  walls_at(on_edge(a, b, 0.5), tolerance_, [&](std::uint32_t i) {
    const EntityId facet = pieces_.pieces()[i].owner;
    along = along || (bounds(i) == meshed && is_of(facet, a) && is_of(facet, b));
  });
  return along;
}

template class MeshedSpace<2>;
template class MeshedSpace<3>;

}  // namespace pgdr::detail
