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
std::vector<Piece> pieces_of(const Domain<D>& domain, const Bulk& bulk) {
  std::vector<Piece> pieces = bulk.gather<Piece>(domain.facets().size(), [&](std::size_t i, std::vector<Piece>& found) {
    const auto f = static_cast<EntityId>(i);
    const auto axis = static_cast<std::uint8_t>(domain.facets()[f].axis);
    for (const auto& t : domain.triangles(f)) found.push_back({t, 3, axis, f});
  });
  const auto append = [&](const std::vector<Piece>& more) { pieces.insert(pieces.end(), more.begin(), more.end()); };
  append(bulk.gather<Piece>(domain.segments().size(), [&](std::size_t i, std::vector<Piece>& found) {
    const auto s = static_cast<EntityId>(i);
    const auto& [a, b] = domain.segments()[s].points;
    if (domain.facets_of_segment(s).empty()) found.push_back({{a, b, no_entity}, 2, 0, s});
  }));
  std::vector<char> used(domain.points().size());
  bulk.each(pieces.size(), [&](std::size_t i) {
    for (const std::uint32_t v : pieces[i].points()) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
  });
  append(bulk.gather<Piece>(used.size(), [&](std::size_t v, std::vector<Piece>& found) {
    if (used[v] == 0) found.push_back({{static_cast<std::uint32_t>(v), no_entity, no_entity}, 1, 0});
  }));
  return pieces;
}

template <int D>
NearPieces<D>::NearPieces(const Domain<D>& domain, const Bulk& bulk)
    : domain_(&domain), points_(scaled<D>(domain.points(), unit_)), pieces_(pieces_of(domain, bulk)) {}

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
EntityId segment_between(const Domain<D>& domain, std::uint32_t a, std::uint32_t b) {
  const auto segments = domain.segments();
  using Ends = std::pair<std::uint32_t, std::uint32_t>;
  const auto ends = [](const DomainSegment& s) -> Ends { return std::minmax(s.points[0], s.points[1]); };
  const Ends wanted = std::minmax(a, b);
  const auto at = std::partition_point(segments.begin(), segments.end(),
                                       [&](const DomainSegment& s) { return ends(s) < wanted; });
  return at != segments.end() && ends(*at) == wanted ? static_cast<EntityId>(at - segments.begin()) : no_entity;
}

template <int D>
bool NearPieces<D>::owner_has(const Piece& piece, std::uint32_t v) const {
  if (piece.has(v)) return true;
  if (piece.count < 3 || domain_->facets()[piece.owner].triangle_count == 1) return false;
  const auto points = domain_->facet_points(piece.owner);
  return std::binary_search(points.begin(), points.end(), v);
}

template <int D>
bool NearPieces<D>::are_disjoint(const Piece& a, const Piece& b) const {
  for (const std::uint32_t v : a.points())
    if (b.has(v)) return false;
  if constexpr (D == 3)
    if (a.count == 3 && b.count == 3) return a.owner != b.owner && !domain_->facets_touch(a.owner, b.owner);
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

template std::vector<Piece> pieces_of(const Domain<2>&, const Bulk&);
template std::vector<Piece> pieces_of(const Domain<3>&, const Bulk&);
template EntityId segment_between(const Domain<2>&, std::uint32_t, std::uint32_t);
template EntityId segment_between(const Domain<3>&, std::uint32_t, std::uint32_t);
template class NearPieces<2>;
template class NearPieces<3>;

}  // namespace pgdr::detail
