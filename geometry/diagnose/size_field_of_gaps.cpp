// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/size_field_of_gaps.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace pgdr::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int D>
std::vector<Box<D>> boxes_of(std::span<const Point<D>> points) {
  std::vector<Box<D>> boxes;
  boxes.reserve(points.size());
  for (const Point<D>& p : points) boxes.push_back(Box<D>::around(p));
  return boxes;
}

template <int D>
std::vector<Box<D>> boxes_of_segments(const NearPieces<D>& pieces) {
  constexpr std::size_t most = 20000;  // of more than that, most are as short as what is between their ends and others
  std::vector<Box<D>> boxes;
  if (D == 2 || pieces.domain().segments().size() > most) return boxes;
  for (const DomainSegment& s : pieces.domain().segments()) {
    auto box = Box<D>::around(pieces.points()[s.points[0]]);
    box.add(pieces.points()[s.points[1]]);
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

template <int D>
SizeFieldOfGaps<D>::SizeFieldOfGaps(const Domain<D>& domain, const EstimateOptions<D>& options, const Bulk& bulk)
    : pieces_(domain, bulk),
      space_(pieces_, options.voids_by_nesting, bulk, StopCheck(options.stop)),
      tree_(pieces_.boxes(0, bulk), bulk),
      points_tree_(boxes_of<D>(pieces_.points()), bulk),
      segments_tree_(boxes_of_segments(pieces_), bulk),
      sizes_(sizes_at_points(options.narrowest, bulk)),
      least_size_below_(points_tree_.least_below(sizes_, bulk)) {
  least_facet_below_ = tree_.least_below(facets_of_pieces(1, bulk), bulk);
  greatest_facet_below_ = tree_.least_below(facets_of_pieces(-1, bulk), bulk);
}

/// Of each piece its facet, with a sign; of those that are of none a number that no facet has.
template <int D>
std::vector<double> SizeFieldOfGaps<D>::facets_of_pieces(double sign, const Bulk& bulk) const {
  std::vector<double> facets(pieces_.pieces().size());
  bulk.each(facets.size(), [&](std::size_t i) {
    const auto& piece = pieces_.pieces()[i];
    facets[i] = sign * (piece.count == 3 ? piece.facet : double{no_entity});
  });
  return facets;
}

template <int D>
std::vector<double> SizeFieldOfGaps<D>::sizes_at_points(const std::optional<Gap<D>>& narrowest, const Bulk& bulk) const {
  const auto p = pieces_.points();
  std::vector<double> square(p.size(), infinity);
  const auto known = [&](std::uint32_t v) { return std::atomic_ref(square[v]).load(std::memory_order_relaxed); };
  const auto note = [&](std::uint32_t v, double s) {  // the least one, whoever comes first
    std::atomic_ref least(square[v]);
    for (double before = known(v); s < before && !least.compare_exchange_weak(before, s, std::memory_order_relaxed);) continue;
  };
  bulk.each(pieces_.pieces().size(), [&](std::size_t number) {
    const auto& piece = pieces_.pieces()[number];
    const auto corners = piece.points();
    if (corners.size() == 1 || !space_.has(static_cast<std::uint32_t>(number))) return;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % corners.size()], c = corners[(i + 2) % corners.size()];
      note(a, squared_distance(p[a], p[b]));
      note(b, squared_distance(p[a], p[b]));
      if (corners.size() < 3) continue;
      const double height = closest_to_edge(p[a], p[b], p[c]).square;
      if (height < known(a) && pieces_.is_segment(piece, b, c)) note(a, height);
    }
  });
  if (narrowest) {
    const double gap = narrowest->distance / pieces_.unit();
    for (const EntityRef& e : narrowest->entities)
      if (e.kind == EntityKind::vertex) note(e.id, gap * gap);
  }
  for (double& s : square) s = std::sqrt(s);
  return square;
}

template <int D>
double SizeFieldOfGaps<D>::from_points(const Point<D>& x) const {
  double least = infinity;
  points_tree_.nearest(
      [&](const Box<D>& box, std::uint32_t node) { return std::sqrt(box.squared_distance_to(x)) + least_size_below_[node]; },
      [&](std::uint32_t v) { return least = std::min(least, sizes_[v] + std::sqrt(squared_distance(x, pieces_.points()[v]))); });
  return least;
}

template <int D>
auto SizeFieldOfGaps<D>::nearest(const Point<D>& x, double most) const -> Near {
  Near near;
  tree_.nearest([&](const Box<D>& box, std::uint32_t) { return std::sqrt(box.squared_distance_to(x)); },
                [&](std::uint32_t i) {
                  const auto closest = pieces_.closest(x, pieces_.pieces()[i]);
                  const double distance = std::sqrt(closest.square);
                  if (distance < std::min(most, near.distance) || (distance == near.distance && i < near.piece))
                    near = {i, distance, closest.points[1]};
                  return std::min(most, near.distance);
                });
  return near;
}

template <int D>
auto SizeFieldOfGaps<D>::nearest_segment(const Point<D>& x, double most) const -> Near requires(D == 3) {
  const auto segments = pieces_.domain().segments();
  Near near;
  segments_tree_.nearest([&](const Box<D>& box, std::uint32_t) { return std::sqrt(box.squared_distance_to(x)); },
                         [&](std::uint32_t s) {
                           const auto& [a, b] = segments[s].points;
                           const auto closest = closest_to_edge(x, pieces_.points()[a], pieces_.points()[b]);
                           const double distance = std::sqrt(closest.square);
                           if (distance < std::min(most, near.distance) || (distance == near.distance && s < near.piece))
                             near = {s, distance, closest.points[1]};
                           return std::min(most, near.distance);
                         });
  return near;
}

// A large facet of many triangles is passed over where a node has no others. Behind walls there may be any number of pieces:
// where so many are, the place counts as one that nothing is near to.
constexpr int most_blocked = 64;

template <int D>
template <class MayFace>
auto SizeFieldOfGaps<D>::nearest_disjoint(const Point<D>& x, const typename NearPieces<D>::Piece& own, double most,
                                          const MayFace& may_face) const -> Near {
  const double facet = own.count == 3 ? own.facet : -1.0;
  Near near;
  int blocked = 0;
  tree_.nearest(
      [&](const Box<D>& box, std::uint32_t node) {
        const bool is_own = least_facet_below_[node] == facet && greatest_facet_below_[node] == -facet;
        return is_own ? infinity : std::sqrt(box.squared_distance_to(x));
      },
      [&](std::uint32_t i) {
        const auto& piece = pieces_.pieces()[i];
        const double limit = std::min(most, near.distance);
        const auto closest = pieces_.closest(x, piece);
        if (!(closest.square <= limit * limit)) return limit;
        const double distance = std::sqrt(closest.square);
        const bool is_nearer = distance < limit || (distance == near.distance && i < near.piece);
        const Point<D>& to = closest.points[1];
        if (blocked == most_blocked) return -infinity;
        if (!is_nearer || !may_face(to) || !space_.may_face(i, x) || !pieces_.are_disjoint(own, piece)) return limit;
        if (space_.is_between(x, to))
          near = {i, distance, to};
        else
          ++blocked;
        return std::min(most, near.distance);
      });
  return near;
}

template <int D>
auto SizeFieldOfGaps<D>::nearest_disjoint(const Point<D>& x, std::uint32_t from, double most) const -> Near {
  return nearest_disjoint(x, pieces_.pieces()[from], most, [&](const Point<D>& to) { return space_.may_face(from, to); });
}

template <int D>
auto SizeFieldOfGaps<D>::look(const Point<D>& x) const -> Look {
  Look found{from_points(x), {}, {}};
  const auto note = [&](const Near& here, const Near& there, Narrow& narrow) {
    if (there.piece == no_entity) return;
    narrow = {here.distance, there.distance, here.place};
    found.h = std::min(found.h, narrow.size());
  };
  if (const Near here = nearest(x, found.h); here.piece != no_entity)
    note(here, nearest_disjoint(here.place, here.piece, found.h - here.distance), found.nearest);
  if constexpr (D == 3)
    if (const Near here = nearest_segment(x, found.h); here.piece != no_entity) {
      const auto& [a, b] = pieces_.domain().segments()[here.piece].points;
      const auto may_face = [&](const Point<D>& to) { return space_.may_face_from_segment(here.piece, to); };
      note(here, nearest_disjoint(here.place, {{a, b, no_entity}, 2, no_entity, here.piece}, found.h - here.distance, may_face),
           found.on_segment);
    }
  return found;
}

template class SizeFieldOfGaps<2>;
template class SizeFieldOfGaps<3>;

}  // namespace pgdr::detail
