// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The narrowest gap of a Domain. The least distance of two planar polygons that do not meet is that of a corner of one from the
// other, or of an edge of one from an edge of the other. So it is looked for between points and segments, points and facets,
// and segments, of pieces whose boxes come as near to each other as the nearest two entities within one piece are: not many more
// than meet. What is between is looked at where two are nearer than all before.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "diagnose/meshed_space.hpp"
#include "diagnose/near_pieces.hpp"
#include "input/entities.hpp"
#include "pgdr/estimate.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"
#include "space/stop_check.hpp"

namespace pgdr {
namespace {

using detail::ClosestPoints;
using detail::NearPieces;
using detail::Piece;

/// How many pairs of pieces one of a thousand parts of the search looks at. Surfaces have some six a piece in all; those of long
/// thin triangles side by side may have all that there are.
constexpr std::uint64_t most_pairs(std::size_t pieces) { return (1 << 16) + pieces / 8; }

/// Two things that are near: points, segments by their ends, facets by a triangle.
struct NearPair {
  enum Kind : std::uint32_t { points, point_and_edge, point_and_facet, edges };
  double square = std::numeric_limits<double>::infinity();
  Kind kind = points;
  std::array<std::uint32_t, 4> at{};  ///< points (a, b), (p, a, b), (p, piece), (a, b, c, d)
  friend auto operator<=>(const NearPair&, const NearPair&) = default;
};

template <int D>
class GapSearch {
 public:
  GapSearch(const Domain<D>& domain, const GapOptions& options)
      : bulk_(true, options.stop),
        stop_check_(options.stop),
        pieces_(domain, bulk_),
        p_(pieces_.points()),
        boxes_(pieces_.boxes(0, bulk_)),
        in_(options.in) {
    const double within = options.within / pieces_.unit();
    none_.square = std::nextafter(within * within, std::numeric_limits<double>::infinity());
    if (in_ != GapsIn::all_space) space_.emplace(pieces_, options.voids_by_nesting, bulk_, stop_check_);
  }

  std::optional<Gap<D>> run() {
    NearPair least = least_inside();
    stop_check_();
    look_between(least);
    if (!(least < none_)) return std::nullopt;
    return in_words_of_entities(least);
  }

 private:
  struct Part {
    NearPair least;
    std::uint64_t pairs = 0;
    bool begun = false;
  };

  NearPair least_inside() const {
    constexpr std::size_t block = 4096;
    const std::size_t count = pieces_.pieces().size();
    std::vector<NearPair> found((count + block - 1) / block, none_);
    bulk_.parts(found.size(), [&](std::size_t k) {
      for (std::size_t i = k * block; i < std::min(count, (k + 1) * block); ++i)
        note_inside(static_cast<std::uint32_t>(i), found[k]);
    });
    return found.empty() ? none_ : *std::min_element(found.begin(), found.end());
  }
  /// Of one piece: its corners, and each from the edge opposite to it.
  void note_inside(std::uint32_t piece, NearPair& least) const {
    const auto corners = pieces_.pieces()[piece].points();
    const auto counts = [&] { return !space_ || space_->has(piece) == (in_ == GapsIn::meshed); };
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) note_points(corners[i], corners[j], least, counts);
      if (corners.size() == 3) note_edge(corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3], least, counts);
    }
  }

  /// The pairs of pieces that come near enough. Without one to begin with, as of single points, any may be the nearest.
  void look_between(NearPair& least) const {
    const bool any = least.square < std::numeric_limits<double>::infinity();
    double width = 0;
    if (any)
      width = std::sqrt(least.square) / 2 * (1 + 0x1p-40);
    else
      width = detail::Box<D>::of(p_).longest_side();
    const detail::BoxTree<D> tree(pieces_.boxes(width, bulk_), bulk_);
    const std::uint64_t most = most_pairs(pieces_.pieces().size());
    stop_check_();
    const auto parts = tree.template self_pairs_in_parts<Part>(bulk_, [&](std::uint32_t i, std::uint32_t j, Part& part) {
      if (!part.begun) part = {least, 0, true};
      if (++part.pairs % 4096 == 0) stop_check_();
      if (part.pairs <= most) note_pair(i, j, part.least);
    });
    stop_check_();
    for (const Part& part : parts)
      if (part.begun) least = std::min(least, part.least);
  }

  void note_pair(std::uint32_t i, std::uint32_t j, NearPair& least) const {
    const Piece &a = pieces_.pieces()[i], &b = pieces_.pieces()[j];
    if (!may_be_near(boxes_[i].low, boxes_[i].high, boxes_[j].low, boxes_[j].high, least.square)) return;
    for (const std::uint32_t v : a.points())
      if (!b.has(v)) note_point(v, j, least);
    for (const std::uint32_t v : b.points())
      if (!a.has(v)) note_point(v, i, least);
    if (D == 3 && !(a.count == 3 && b.count == 3 && a.owner == b.owner)) note_edges(a, b, least);
  }

  /// A point and a piece that does not have it.
  void note_point(std::uint32_t v, std::uint32_t i, NearPair& least) const {
    const Piece& piece = pieces_.pieces()[i];
    if (boxes_[i].squared_distance_to(p_[v]) > least.square) return;
    const auto [a, b, c] = piece.corners;
    if (piece.count == 1) return note_points(v, a, least, counts(v, a));
    if (piece.count == 2) return note_edge(v, a, b, least, counts(v, a, b));
    const auto closest = pieces_.closest(p_[v], piece);
    if (closest.square > least.square) return;
    if (!pieces_.owner_has(piece, v))
      return note({closest.square, NearPair::point_and_facet, {v, i, 0, 0}}, least, counts(closest));
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = piece.corners[k], q = piece.corners[(k + 1) % 3];
      note_points(v, p, least, counts(v, p));
      note_edge(v, p, q, least, counts(v, p, q));
    }
  }

  // Whether what is between is where gaps count is asked last.
  template <class Counts>
  void note_points(std::uint32_t v, std::uint32_t w, NearPair& least, const Counts& counts) const {
    note({squared_distance(p_[v], p_[w]), NearPair::points, {std::min(v, w), std::max(v, w), 0, 0}}, least, counts);
  }
  template <class Counts>
  void note_edge(std::uint32_t v, std::uint32_t a, std::uint32_t b, NearPair& least, const Counts& counts) const {
    const double square = detail::closest_to_edge(p_[v], p_[a], p_[b]).square;
    if (square <= least.square && pieces_.is_segment(a, b))
      note({square, NearPair::point_and_edge, {v, std::min(a, b), std::max(a, b), 0}}, least, counts);
  }
  auto counts(const ClosestPoints<D>& closest) const {
    return [this, closest] { return !space_ || space_->is_between(closest.points[0], closest.points[1], in_ == GapsIn::meshed); };
  }
  auto counts(std::uint32_t v, std::uint32_t w) const { return counts(detail::closest_to_point(p_[v], p_[w])); }
  auto counts(std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
    return counts(detail::closest_to_edge(p_[v], p_[a], p_[b]));
  }

  void note_edges(const Piece& a, const Piece& b, NearPair& least) const {
    for_edges(a, [&](std::uint32_t p, std::uint32_t q) {
      if (b.has(p) || b.has(q)) return;  // then the end is no farther from the edge
      for_edges(b, [&](std::uint32_t r, std::uint32_t s) {
        if (a.has(r) || a.has(s) || !may_be_near(p_[p], p_[q], p_[r], p_[s], least.square)) return;
        const auto closest = detail::closest_of_edges(p_[p], p_[q], p_[r], p_[s]);
        if (closest.square > least.square || !pieces_.is_segment(p, q) || !pieces_.is_segment(r, s)) return;
        const auto first = std::minmax(p, q), second = std::minmax(r, s);
        std::array<std::uint32_t, 4> at{first.first, first.second, second.first, second.second};
        if (second < first) at = {second.first, second.second, first.first, first.second};
        note({closest.square, NearPair::edges, at}, least, counts(closest));
      });
    });
  }
  /// Are the boxes around two edges as near as that?
  static bool may_be_near(const Point<D>& p, const Point<D>& q, const Point<D>& r, const Point<D>& s, double square) {
    double sum = 0;
    for (int i = 0; i < D; ++i) {
      const double off = std::max(
          {std::min(r[i], s[i]) - std::max(p[i], q[i]), std::min(p[i], q[i]) - std::max(r[i], s[i]), 0.0});
      sum += off * off;
    }
    return sum <= square;
  }
  template <class Visit>
  static void for_edges(const Piece& piece, const Visit& visit) {
    if (piece.count == 2) visit(piece.corners[0], piece.corners[1]);
    if (piece.count == 3)
      for (int k = 0; k < 3; ++k) visit(piece.corners[k], piece.corners[(k + 1) % 3]);
  }
  template <class Counts>
  static void note(const NearPair& found, NearPair& least, const Counts& counts) {
    if (found < least && counts()) least = found;
  }

  /// Of the entities that have the nearest points, those of the largest dimension that have no point in common: as no two
  /// entities are nearer than this pair, none that it is part of is farther.
  Gap<D> in_words_of_entities(const NearPair& pair) const {
    const auto [first, second, closest] = described(pair);
    Gap<D> gap;
    gap.distance = std::sqrt(closest.square) * pieces_.unit();
    for (std::size_t i = 0; i < 2; ++i)
      for (int k = 0; k < D; ++k) gap.points[i][k] = closest.points[i][k] * pieces_.unit();
    gap.entities = {first, second};
    int most = -1;
    const auto others = owners(second);
    for (const EntityRef a : owners(first))
      for (const EntityRef b : others) {
        const int dimensions = static_cast<int>(a.kind) + static_cast<int>(b.kind);
        if (dimensions <= most || entities_touch<D>(pieces_.domain(), a, b)) continue;
        most = dimensions;
        gap.entities = {a, b};
      }
    return gap;
  }

  struct Described {
    EntityRef first, second;
    ClosestPoints<D> closest;
  };
  Described described(const NearPair& pair) const {
    const auto& [a, b, c, d] = pair.at;
    const auto vertex = [](std::uint32_t v) { return EntityRef{EntityKind::vertex, v}; };
    switch (pair.kind) {
      case NearPair::points: return {vertex(a), vertex(b), detail::closest_to_point(p_[a], p_[b])};
      case NearPair::point_and_edge: return {vertex(a), segment(b, c), detail::closest_to_edge(p_[a], p_[b], p_[c])};
      case NearPair::edges: return {segment(a, b), segment(c, d), detail::closest_of_edges(p_[a], p_[b], p_[c], p_[d])};
      case NearPair::point_and_facet: break;
    }
    const Piece& piece = pieces_.pieces()[b];
    return {vertex(a), piece.entity(), pieces_.closest(p_[a], piece)};
  }
  EntityRef segment(std::uint32_t a, std::uint32_t b) const {
    const EntityId s = detail::segment_between(pieces_.domain(), a, b);
    return s == no_entity ? EntityRef{EntityKind::vertex, a} : EntityRef{EntityKind::segment, s};
  }

  /// The entity, and those that it is part of, the first few; the largest dimension comes first.
  std::vector<EntityRef> owners(EntityRef e) const {
    constexpr std::size_t few = 64;
    const Domain<D>& domain = pieces_.domain();
    std::vector<EntityRef> all;
    const std::array<std::uint32_t, 2> ends = e.kind == EntityKind::segment ? domain.segments()[e.id].points
                                                                            : std::array{e.id, e.id};
    if constexpr (D == 3)
      for (EntityId f = 0; f < domain.facets().size() && e.kind != EntityKind::facet && all.size() < few; ++f) {
        const auto points = domain.facet_points(f);
        const bool has = e.kind == EntityKind::vertex ? std::binary_search(points.begin(), points.end(), e.id)
                                                      : std::ranges::binary_search(domain.facets_of_segment(e.id), f);
        if (has) all.push_back({EntityKind::facet, f});
      }
    if (e.kind == EntityKind::vertex)
      for (EntityId s = 0; s < domain.segments().size() && all.size() < 2 * few; ++s)
        if (std::ranges::count(domain.segments()[s].points, ends[0]) > 0) all.push_back({EntityKind::segment, s});
    all.push_back(e);
    return all;
  }

  const detail::Bulk bulk_;
  const detail::StopCheck stop_check_;
  const NearPieces<D> pieces_;
  const std::span<const Point<D>> p_;
  const std::vector<detail::Box<D>> boxes_;
  const GapsIn in_;
  NearPair none_;                                ///< what is found must be nearer
  std::optional<detail::MeshedSpace<D>> space_;  ///< none: all space counts
};

}  // namespace

template <int D>
std::optional<Gap<D>> narrowest_gap(const Domain<D>& domain, const GapOptions& options) {
  return GapSearch<D>(domain, options).run();
}

template PGDR_API std::optional<Gap<2>> narrowest_gap<2>(const Domain<2>&, const GapOptions&);
template PGDR_API std::optional<Gap<3>> narrowest_gap<3>(const Domain<3>&, const GapOptions&);

}  // namespace pgdr
