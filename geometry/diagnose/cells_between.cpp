// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/cells_between.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "numbers/vectors.hpp"
#include "space/box_tree.hpp"
#include "space/chance.hpp"

namespace pgdr::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int place_count = 256;

/// A place on a piece, and the area (length) that it stands for.
template <int D>
struct Place {
  std::uint32_t piece;
  Point<D> x;
  double measure;
};

template <int D>
const Point<D>& corner(const NearPieces<D>& pieces, const Piece& piece, std::size_t i) {
  return pieces.points()[piece.corners[i]];
}

/// Its length is twice the area (2D: the length).
template <int D>
Vector<D> normal_of(const NearPieces<D>& pieces, const Piece& piece) {
  const auto u = difference(corner<D>(pieces, piece, 1), corner<D>(pieces, piece, 0));
  if constexpr (D == 3)
    return cross(u, difference(corner<D>(pieces, piece, 2), corner<D>(pieces, piece, 0)));
  else
    return {u[1], -u[0]};
}

template <int D>
double measure_of(const NearPieces<D>& pieces, const Piece& piece) {
  if (piece.count < D) return 0;
  const auto n = normal_of<D>(pieces, piece);
  return std::sqrt(dot(n, n)) / (D == 3 ? 2 : 1);
}

template <int D>
Point<D> choose_in(const NearPieces<D>& pieces, const Piece& piece, Chance& chance) {
  double u = chance(), v = D == 3 ? chance() : 0.0;
  if (u + v > 1) u = 1 - u, v = 1 - v;
  Point<D> x = on_edge(corner<D>(pieces, piece, 0), corner<D>(pieces, piece, 1), u);
  if constexpr (D == 3)
    for (int k = 0; k < D; ++k) x[k] += v * (corner<D>(pieces, piece, 2)[k] - corner<D>(pieces, piece, 0)[k]);
  return x;
}

template <int D>
std::vector<Place<D>> choose_places(const NearPieces<D>& pieces, const Bulk& bulk) {
  std::vector<double> until(pieces.pieces().size());  // area of all pieces up to this one
  bulk.each(until.size(), [&](std::size_t i) { until[i] = measure_of<D>(pieces, pieces.pieces()[i]); });
  std::partial_sum(until.begin(), until.end(), until.begin());
  std::vector<Place<D>> places;
  Chance chance;
  for (int k = 0; k < place_count && !until.empty(); ++k) {
    const auto at = std::upper_bound(until.begin(), until.end(), (k + chance()) / place_count * until.back());
    if (at == until.end()) continue;
    const auto i = static_cast<std::uint32_t>(at - until.begin());
    places.push_back({i, choose_in<D>(pieces, pieces.pieces()[i], chance), until.back() / place_count});
  }
  return places;
}

/// The area (length) of the largest subfacet where another facet is no farther than that.
template <int D>
double largest_subfacet(double radius_edge_bound, double distance) {
  constexpr double largest_triangle = 1.299038105676658;  // of those in a circle: 3/4 sqrt 3
  const double radius = std::sqrt(2.0) * radius_edge_bound * distance;
  return D == 3 ? largest_triangle * radius * radius : 2 * radius;
}

/// The distance at which that is so large.
template <int D>
double distance_of_subfacet(double radius_edge_bound, double measure) {
  const double at_one = largest_subfacet<D>(radius_edge_bound, 1);
  return D == 3 ? std::sqrt(measure / at_one) : measure / at_one;
}

/// A piece, and where it is nearest to a point.
template <int D>
struct Near {
  std::uint32_t piece = no_entity;  ///< no_entity: there is none
  double distance = infinity;
  Point<D> place;
};

/// What comes nearest to a place on a piece, of what the entity of that has no point in common with.
template <int D>
class NearestDisjoint {
 public:
  NearestDisjoint(const NearPieces<D>& pieces, const MeshedSpace<D>& space, const Bulk& bulk)
      : pieces_(pieces),
        space_(space),
        tree_(pieces.boxes(0, bulk), bulk),
        least_facet_below_(tree_.least_below(facets_of_pieces(1, bulk), bulk)),
        greatest_facet_below_(tree_.least_below(facets_of_pieces(-1, bulk), bulk)) {}

  /// Where what is between is meshed. A large facet of many triangles is passed over where a node of the tree has no others.
  /// Behind walls there may be any number of pieces: where so many are, the place counts as one that nothing is near to.
  Near<D> from(const Place<D>& place) const {
    constexpr int most_blocked = 64;
    const Piece& own = pieces_.pieces()[place.piece];
    const double facet = own.count == 3 ? own.owner : -1.0;
    Near<D> near;
    int blocked = 0;
    tree_.nearest(
        [&](const Box<D>& box, std::uint32_t node) {
          const bool is_own = least_facet_below_[node] == facet && greatest_facet_below_[node] == -facet;
          return is_own ? infinity : std::sqrt(box.squared_distance_to(place.x));
        },
        [&](std::uint32_t i) {
          const Piece& piece = pieces_.pieces()[i];
          const auto closest = pieces_.closest(place.x, piece);
          const double distance = std::sqrt(closest.square);
          const bool is_nearer = distance < near.distance || (distance == near.distance && i < near.piece);
          const Point<D>& to = closest.points[1];
          if (blocked == most_blocked) return -infinity;
          if (!is_nearer || !space_.may_face(place.piece, to) || !space_.may_face(i, place.x) ||
              !pieces_.are_disjoint(own, piece))
            return near.distance;
          if (space_.is_between(place.x, to))
            near = {i, distance, to};
          else
            ++blocked;
          return near.distance;
        });
    return near;
  }

 private:
  /// Of each piece its facet, with a sign; of those that are of none a number that no facet has.
  std::vector<double> facets_of_pieces(double sign, const Bulk& bulk) const {
    std::vector<double> facets(pieces_.pieces().size());
    bulk.each(facets.size(), [&](std::size_t i) {
      const Piece& piece = pieces_.pieces()[i];
      facets[i] = sign * (piece.count == 3 ? piece.owner : double{no_entity});
    });
    return facets;
  }

  const NearPieces<D>& pieces_;
  const MeshedSpace<D>& space_;
  const BoxTree<D> tree_;
  const std::vector<double> least_facet_below_, greatest_facet_below_;  ///< the latter with its sign changed
};

template <int D>
class CellsBetween {
 public:
  CellsBetween(const NearPieces<D>& pieces, const MeshedSpace<D>& space, double radius_edge_bound, const Bulk& bulk)
      : pieces_(pieces), space_(space), nearest_(pieces, space, bulk), bound_(radius_edge_bound), bulk_(bulk) {}

  void add_to(CellEstimate<D>& estimate) {
    const std::vector<Place<D>> places = choose_places(pieces_, bulk_);
    std::vector<std::optional<Found>> found(places.size());
    bulk_.parts(places.size(), [&](std::size_t k) { found[k] = look_at(places[k]); });
    for (const std::optional<Found>& f : found) {
      if (!f) continue;
      Between& between = between_[f->pair];
      between.cells += f->cells;
      if (f->gap.distance < between.gap.distance) between.gap = f->gap;
    }
    for (const auto& [pair, between] : between_) {
      estimate.at_least += between.cells;
      if (between.cells > most_) estimate.most_due_to = between.gap;
      most_ = std::max(most_, between.cells);
    }
  }

 private:
  struct Between {
    double cells = 0;
    Gap<D> gap{infinity, {}, {}};
  };
  struct Found {
    std::pair<EntityId, EntityId> pair;
    double cells;
    Gap<D> gap;
  };

  std::optional<Found> look_at(const Place<D>& place) const {
    const Piece& piece = pieces_.pieces()[place.piece];
    const Point<D>& x = place.x;
    const Near<D> near = nearest_.from(place);
    if (near.piece == no_entity || pieces_.pieces()[near.piece].count < D || !(near.distance > 0)) return std::nullopt;
    const Piece& other = pieces_.pieces()[near.piece];
    const auto n = normal_of(pieces_, piece), m = normal_of(pieces_, other), way = difference(x, near.place);
    const double nn = dot(n, n), mm = dot(m, m), nm = dot(n, m), above = std::fabs(dot(way, m));
    if (!(mm > 0) || !(above >= (1 - 0x1p-20) * near.distance * std::sqrt(mm)) || nm == 0)
      return std::nullopt;  // its rim is nearest
    if (!space_.is_between(x, near.place)) return std::nullopt;
    const double cosine = std::min(1.0, std::fabs(nm) / std::sqrt(nn * mm)), tangent = std::sqrt(1 - cosine * cosine) / cosine;
    const double radius = std::sqrt(2.0) * bound_ * near.distance, farther = near.distance + 2 * radius * tangent;
    const EntityRef a = piece.entity(), b = other.entity();
    return Found{std::minmax(a.id, b.id), place.measure * cosine / largest_subfacet<D>(bound_, farther),
                 gap_between(a, b, x, near)};
  }

  Gap<D> gap_between(EntityRef a, EntityRef b, const Point<D>& x, const Near<D>& near) const {
    Gap<D> gap{near.distance * pieces_.unit(), {a, b}, {}};
    for (int k = 0; k < D; ++k) {
      gap.points[0][k] = x[k] * pieces_.unit();
      gap.points[1][k] = near.place[k] * pieces_.unit();
    }
    return gap;
  }

  const NearPieces<D>& pieces_;
  const MeshedSpace<D>& space_;
  const NearestDisjoint<D> nearest_;
  const double bound_;
  const Bulk& bulk_;
  std::map<std::pair<EntityId, EntityId>, Between> between_;  // by their entities
  double most_ = 0;
};

/// The places in the order of their first coordinates.
template <int D>
class PlacesAlongAxis {
 public:
  explicit PlacesAlongAxis(std::vector<Place<D>> places) : places_(std::move(places)) {
    std::ranges::sort(places_, {}, first_of);
  }
  /// Is there one in the box for which it is true?
  template <class IsFound>
  bool any_in(const Box<D>& box, const IsFound& is_found) const {
    auto place = std::ranges::lower_bound(places_, box.low[0], {}, first_of);
    for (; place != places_.end() && place->x[0] <= box.high[0]; ++place)
      if (box.meets(Box<D>::around(place->x)) && is_found(*place)) return true;
    return false;
  }

 private:
  static double first_of(const Place<D>& place) { return place.x[0]; }
  std::vector<Place<D>> places_;
};

/// Is a piece within this width of a place, without a point in common with what that is on?
template <int D>
bool is_any_near(const NearPieces<D>& pieces, const PlacesAlongAxis<D>& places, double width, const Bulk& bulk) {
  std::atomic<bool> is_any = false;
  bulk.each(pieces.pieces().size(), [&](std::size_t i) {
    const Piece& piece = pieces.pieces()[i];
    auto box = Box<D>::empty();
    for (const std::uint32_t v : piece.points()) box.add(pieces.points()[v]);
    const auto is_near = [&](const Place<D>& place) {
      return pieces.closest(place.x, piece).square <= width * width && pieces.are_disjoint(pieces.pieces()[place.piece], piece);
    };
    if (places.any_in(box.widened(width), is_near)) is_any = true;
  });
  return is_any;
}

}  // namespace

template <int D>
void add_cells_between(const NearPieces<D>& pieces, const MeshedSpace<D>& space, double radius_edge_bound, const Bulk& bulk,
                       CellEstimate<D>& estimate) {
  if (radius_edge_bound < infinity) CellsBetween<D>(pieces, space, radius_edge_bound, bulk).add_to(estimate);
}

template <int D>
bool may_take_more_cells_between(const NearPieces<D>& pieces, double radius_edge_bound, double cells, const Bulk& bulk) {
  if (!(radius_edge_bound < infinity)) return false;
  std::vector<Place<D>> places = choose_places(pieces, bulk);
  if (places.empty()) return false;
  constexpr double above_rounding = 1 + 0x1p-40;
  const double width = above_rounding * distance_of_subfacet<D>(radius_edge_bound, place_count * places[0].measure / cells);
  return is_any_near(pieces, PlacesAlongAxis<D>(std::move(places)), width, bulk);
}

#define PGDR_INSTANTIATE(D)                                                                                               \
  template void add_cells_between<D>(const NearPieces<D>&, const MeshedSpace<D>&, double, const Bulk&, CellEstimate<D>&); \
  template bool may_take_more_cells_between<D>(const NearPieces<D>&, double, double, const Bulk&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
