// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "volumes/wall_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/turn_round.hpp"

namespace pgdr::detail {
namespace {

std::uint64_t ridge_of(std::uint32_t a, std::uint32_t b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

}  // namespace

template <int D>
WallVolumes<D>::WallVolumes(std::span<const Point<D>> points, std::vector<Wall<D>> walls, const Bulk& bulk,
                            const StopCheck& stop_check)
    : hits_(points, std::move(walls), bulk) {
  stop_check();
  DisjointSets sides(2 * std::size_t{hits_.count()} + 1), surfaces(hits_.count());
  std::vector<AtRidge> ridges = walls_at_ridges(bulk, stop_check);
  for (std::size_t i = 0, j = 0; i < ridges.size(); i = j) {
    for (j = i + 1; j < ridges.size() && ridges[j].ridge == ridges[i].ridge;) ++j;
    turn_round(std::span(ridges).subspan(i, j - i), sides, surfaces);
  }
  const std::vector<char> joined = join_surfaces(sides, surfaces, bulk, stop_check);
  number_volumes(sides, surfaces, joined);
}

template <int D>
auto WallVolumes<D>::walls_at_ridges(const Bulk& bulk, const StopCheck& stop_check) const -> std::vector<AtRidge> {
  std::vector<AtRidge> ridges(std::size_t{D} * hits_.count());
  bulk.each(hits_.count(), [&](std::size_t i) {
    const auto wall = static_cast<std::uint32_t>(i);
    const auto& s = hits_.walls()[i];
    for (std::size_t k = 0; k < D; ++k) {
      if constexpr (D == 2) {
        ridges[D * i + k] = {s[k], wall, s[1 - k], k == 1};
      } else {
        const std::uint32_t a = s[(k + 1) % 3], b = s[(k + 2) % 3];
        ridges[D * i + k] = {ridge_of(a, b), wall, s[k], a > b};
      }
    }
  });
  stop_check.sort(bulk, ridges);
  return ridges;
}

template <int D>
Sign WallVolumes<D>::turn(std::uint64_t ridge, std::uint32_t from, std::uint32_t to) const {
  const auto p = hits_.points();
  if constexpr (D == 2)
    return orient2d(p[ridge], p[from], p[to]);
  else
    return orient3d(p[ridge >> 32], p[ridge & 0xffffffffu], p[from], p[to]);
}

template <int D>
void WallVolumes<D>::turn_round(std::span<AtRidge> walls, DisjointSets& sides, DisjointSets& surfaces) const {
  sort_round(walls, [&, ridge = walls[0].ridge](std::uint32_t v, std::uint32_t w) { return turn(ridge, v, w); });
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const AtRidge &here = walls[i], &next = walls[(i + 1) % walls.size()];
    sides.unite(2 * here.wall + here.ahead_negative, 2 * next.wall + !next.ahead_negative);
    surfaces.unite(here.wall, next.wall);
  }
}

template <int D>
auto WallVolumes<D>::list(std::span<const std::uint32_t> by_surface, DisjointSets& surfaces) const -> std::vector<Surface> {
  const auto first_ray = hits_.ray(Point<D>{}, 0);
  const auto way = difference(first_ray.to, first_ray.from);
  std::vector<Surface> found;
  for (std::size_t i = 0; i < by_surface.size(); ++i) {
    const std::uint32_t name = surfaces.find(by_surface[i]);
    if (found.empty() || found.back().name != name) found.push_back({name, by_surface.subspan(i, 0), Box<D>::empty()});
    Surface& s = found.back();
    s.walls = std::span(s.walls.data(), s.walls.size() + 1);
    for (const Point<D>& x : hits_.corners(by_surface[i])) {
      s.box.add(x);
      s.reach = std::max(s.reach, dot(difference(x, first_ray.from), way));
    }
  }
  return found;
}

// A ray from a surface to beyond all walls tells in which volume the surface is: it leaves the surface for good, and goes on to
// others, of which each in turn is left for good, till it meets the volume's own wall, or the outside. Once it has left its own
// surface, it may end where it meets one of which that is known. Surfaces that are farther along come first, so that the next one
// is mostly known.
template <int D>
std::vector<char> WallVolumes<D>::join_surfaces(DisjointSets& sides, DisjointSets& surfaces, const Bulk& bulk,
                                                const StopCheck& stop_check) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> named(hits_.count());
  for (std::uint32_t i = 0; i < named.size(); ++i) named[i] = {surfaces.find(i), i};
  stop_check.sort(bulk, named);
  std::vector<std::uint32_t> by_surface(named.size());
  std::ranges::transform(named, by_surface.begin(), [](const auto& n) { return n.second; });
  std::vector<Surface> all = list(by_surface, surfaces);
  std::stable_sort(all.begin(), all.end(), [](const Surface& a, const Surface& b) { return a.reach > b.reach; });
  std::vector<char> joined(by_surface.size());  // by the name of the surface
  for (const Surface& s : all) {
    stop_check();
    for (int k = 0; k < most_rays && joined[s.name] == 0; ++k)
      if (join_along_ray(s, k, joined, sides, surfaces)) break;
  }
  return joined;
}

/// Through another wall of the surface at each attempt. False if the ray is of no use.
template <int D>
bool WallVolumes<D>::join_along_ray(const Surface& surface, int attempt, std::vector<char>& joined, DisjointSets& sides,
                                    DisjointSets& surfaces) const {
  constexpr std::size_t stride = 7919;  // a prime
  const std::uint32_t through = surface.walls[static_cast<std::size_t>(attempt) * stride % surface.walls.size()];
  Point<D> begin{};
  for (const Point<D>& x : hits_.corners(through))
    for (int i = 0; i < D; ++i) begin[i] += x[i] / D;
  auto ray = hits_.ray(begin, attempt);
  for (int i = 0; i < D; ++i) ray.from[i] -= 0x1p-24 * (ray.to[i] - begin[i]);  // before the wall, whose middle is rounded
  if (!hits_.crosses(ray, through)) return false;
  std::vector<std::uint32_t> passed;
  std::uint32_t open = no_entity;  // the side on which the ray has left the last wall
  for (auto hit = hits_.first(ray);; hit = hits_.first(ray, hit.wall)) {
    if (hit.kind == FirstHits<D>::Kind::on_wall || hit.kind == FirstHits<D>::Kind::degenerate) return false;
    const bool ends = hit.kind == FirstHits<D>::Kind::none;
    if (open != no_entity) sides.unite(open, ends ? outside() : 2 * hit.wall + hit.from_negative);
    if (ends) break;
    passed.push_back(surfaces.find(hit.wall));
    open = 2 * hit.wall + !hit.from_negative;
    if (joined[passed.back()] != 0 && hits_.is_beyond(ray, surface.box, hit.wall)) {
      passed = {surface.name};  // the others may be met once more
      break;
    }
  }
  for (const std::uint32_t s : passed) joined[s] = 1;
  return true;
}

template <int D>
void WallVolumes<D>::number_volumes(DisjointSets& sides, DisjointSets& surfaces, std::span<const char> joined) {
  std::vector<std::uint32_t> number(std::size_t{outside()} + 1, no_entity);
  std::uint32_t count = 0;
  number[sides.find(outside())] = count++;
  volume_of_.resize(number.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    std::uint32_t& mine = number[sides.find(i)];
    if (mine == no_entity) mine = count++;
    volume_of_[i] = mine;
  }
  known_.assign(count, 1);
  for (std::uint32_t i = 0; i < outside(); ++i)
    if (joined[surfaces.find(i / 2)] == 0) known_[volume_of_[i]] = 0;
  known_[0] = 1;
}

template <int D>
std::vector<std::array<std::uint32_t, 2>> WallVolumes<D>::neighbours() const {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t i = 0; i < outside(); i += 2)
    if (volume_of_[i] != volume_of_[i + 1]) pairs.push_back({volume_of_[i], volume_of_[i + 1]});
  return pairs;
}

template <int D>
std::optional<std::uint32_t> WallVolumes<D>::find(const Point<D>& x) const {
  using Kind = typename FirstHits<D>::Kind;
  for (int k = 0; k < most_rays; ++k) {
    const auto hit = hits_.first(hits_.ray(x, k));
    if (hit.kind == Kind::on_wall) return std::nullopt;
    if (hit.kind == Kind::none) return 0;
    if (hit.kind == Kind::hit) return beside(hit.wall, hit.from_negative);
  }
  return std::nullopt;
}

template class WallVolumes<2>;
template class WallVolumes<3>;

}  // namespace pgdr::detail
