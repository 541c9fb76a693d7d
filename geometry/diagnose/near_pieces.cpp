// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/near_pieces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace pgdr::detail {
namespace {

/// The points times a power of two, so that no square over- or underflows; `unit`: the length that becomes 1.
template <int D>
std::vector<Point<D>> scaled(std::span<const Point<D>> given, double& unit) {
  double largest = 0;
  for (const Point<D>& p : given)
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  std::vector<Point<D>> points(given.begin(), given.end());
  if (!(largest > 0)) return points;
  const int exponent = std::ilogb(largest);
  unit = std::ldexp(1.0, exponent);
  for (Point<D>& p : points)
    for (double& x : p.x) x = std::ldexp(x, -exponent);
  return points;
}

}  // namespace

template <int D>
NearPieces<D>::NearPieces(const Domain<D>& domain, const Bulk& bulk)
    : domain_(&domain), points_(scaled<D>(domain.points(), unit_)) {
  const auto append = [this](const std::vector<Piece>& more) { pieces_.insert(pieces_.end(), more.begin(), more.end()); };
  pieces_ = bulk.gather<Piece>(domain.facets().size(), [&](std::size_t i, std::vector<Piece>& found) {
    const auto f = static_cast<EntityId>(i);
    for (const auto& t : domain.triangles(f)) found.push_back({t, 3, f, no_entity});
  });
  append(bulk.gather<Piece>(domain.segments().size(), [&](std::size_t i, std::vector<Piece>& found) {
    const auto s = static_cast<EntityId>(i);
    const auto& [a, b] = domain.segments()[s].points;
    if (D == 2 || domain.facets_of_segment(s).empty()) found.push_back({{a, b, no_entity}, 2, no_entity, s});
  }));
  std::vector<char> used(points_.size());
  bulk.each(pieces_.size(), [&](std::size_t i) {
    for (const std::uint32_t v : pieces_[i].points()) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
  });
  append(bulk.gather<Piece>(used.size(), [&](std::size_t v, std::vector<Piece>& found) {
    if (used[v] == 0) found.push_back({{static_cast<std::uint32_t>(v), no_entity, no_entity}, 1, no_entity, no_entity});
  }));
}

template <int D>
std::vector<Box<D>> NearPieces<D>::boxes(double width, const Bulk& bulk) const {
  std::vector<Box<D>> all(pieces_.size());
  bulk.each(all.size(), [&](std::size_t i) {
    auto box = Box<D>::empty();
    for (const std::uint32_t v : pieces_[i].points()) box.add(points_[v]);
    all[i] = box.widened(width);
  });
  return all;
}

// A Domain has its segments in the order of their points.
template <int D>
bool NearPieces<D>::is_segment(std::uint32_t a, std::uint32_t b) const {
  const auto segments = domain_->segments();
  const auto key = [](std::uint32_t p, std::uint32_t q) { return std::pair(std::min(p, q), std::max(p, q)); };
  const auto wanted = key(a, b);
  const auto at = std::partition_point(segments.begin(), segments.end(),
                                       [&](const DomainSegment& s) { return key(s.points[0], s.points[1]) < wanted; });
  return at != segments.end() && key(at->points[0], at->points[1]) == wanted;
}

template <int D>
bool NearPieces<D>::owner_has(const Piece& piece, std::uint32_t v) const {
  if (piece.has(v)) return true;
  if (piece.count < 3 || domain_->facets()[piece.facet].triangle_count == 1) return false;
  const auto points = domain_->facet_points(piece.facet);
  return std::binary_search(points.begin(), points.end(), v);
}

template <int D>
bool NearPieces<D>::are_disjoint(const Piece& a, const Piece& b) const {
  for (const std::uint32_t v : a.points())
    if (b.has(v)) return false;
  if constexpr (D == 3)
    if (a.count == 3 && b.count == 3) return a.facet != b.facet && !domain_->facets_touch(a.facet, b.facet);
  const Piece &small = a.count == 3 ? b : a, &large = a.count == 3 ? a : b;
  return std::ranges::none_of(small.points(), [&](std::uint32_t v) { return owner_has(large, v); });
}

template <int D>
ClosestPoints<D> NearPieces<D>::closest(const Point<D>& x, const Piece& piece) const {
  const auto& [a, b, c] = piece.corners;
  if constexpr (D == 3)
    if (piece.count == 3) return closest_to_triangle(x, points_[a], points_[b], points_[c]);
  return piece.count == 2 ? closest_to_edge(x, points_[a], points_[b]) : closest_to_point(x, points_[a]);
}

template class NearPieces<2>;
template class NearPieces<3>;

}  // namespace pgdr::detail
