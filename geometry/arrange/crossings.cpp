// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/crossings.hpp"

#include <algorithm>

#include "input/edges.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {
namespace {

/// What makes a point: itself; or an edge and a triangle, or another edge, that it goes through, by ascending corners.
using HitKey = std::array<std::uint32_t, 5>;

HitKey key_of_point(std::uint32_t v) { return {v, no_entity, no_entity, no_entity, no_entity}; }
bool is_point(const HitKey& key) { return key[1] == no_entity; }

HitKey key_of_crossing(const Contact::Crossing& c) {
  std::array<std::uint32_t, 2> e = c.edge;
  std::array<std::uint32_t, 3> through = c.through;
  std::ranges::sort(e);
  std::ranges::sort(through);
  if (through[2] == no_entity && std::array{through[0], through[1]} < e) {
    std::swap(e[0], through[0]);
    std::swap(e[1], through[1]);
  }
  return {e[0], e[1], through[0], through[1], through[2]};
}

struct FoundCrossings {
  struct Cut {
    std::uint32_t triangle;
    std::array<HitKey, 2> ends;
  };
  std::vector<Cut> cuts;
  std::vector<std::pair<std::uint64_t, HitKey>> on_edges;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  bool overlap = false;
};

class CrossingSearch {
 public:
  CrossingSearch(const Domain<3>& domain, std::span<const Piece> pieces, const Bulk& bulk, const StopCheck& stop)
      : domain_(domain), pieces_(pieces), points_(domain.points()), bulk_(bulk), stop_(stop) {
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      for (const TriangleOrigin& o : domain.triangle_origins(f)) origins_.push_back(o);
  }

  Crossings run() {
    auto parts = look_at_pairs<FoundCrossings, 3>(
        pieces_, points_, 0, bulk_, stop_,
        [this](std::uint32_t i, std::uint32_t j, FoundCrossings& found) { look_at(i, j, found); });
    const auto cuts = joined(parts, &FoundCrossings::cuts);
    const auto on_edges = joined(parts, &FoundCrossings::on_edges);
    Crossings out;
    out.pairs = joined(parts, &FoundCrossings::pairs);
    make_set(out.pairs);
    for (const FoundCrossings& part : parts) out.overlap = out.overlap || part.overlap;
    for (const auto& cut : cuts)
      for (const HitKey& key : cut.ends) keys_.push_back(key);
    for (const auto& [edge, key] : on_edges) keys_.push_back(key);
    std::erase_if(keys_, is_point);
    make_set(keys_, bulk_);
    for (const auto& cut : cuts) out.cuts.push_back({cut.triangle, {number(cut.ends[0]), number(cut.ends[1])}});
    for (const auto& [edge, key] : on_edges) out.on_edges.emplace_back(edge, number(key));
    for (Crossings::Cut& cut : out.cuts) std::ranges::sort(cut.ends);
    make_set(out.cuts);
    make_set(out.on_edges);
    make_points(out);
    return out;
  }

 private:
  bool is_triangle(std::uint32_t i) const { return pieces_[i].count == 3; }

  void look_at(std::uint32_t i, std::uint32_t j, FoundCrossings& found) const {
    bool same_plane = false;
    if (is_triangle(i) && is_triangle(j)) {
      if (origins_[i].facet == origins_[j].facet && !origins_[i].mixed) return;  // of one planar triangulation
      same_plane = pieces_[i].owner == pieces_[j].owner && domain_.facets()[pieces_[i].owner].planar;
    }
    const Contact c = contact<3>(points_, pieces_[i], pieces_[j], same_plane);
    if (c.kind == Contact::Kind::none) return;
    found.pairs.push_back({i, j});
    if (c.kind == Contact::Kind::overlap) {
      found.overlap = true;
      return;
    }
    note(i, j, c, found);
  }

  void note(std::uint32_t i, std::uint32_t j, const Contact& c, FoundCrossings& found) const {
    std::vector<HitKey> hull;
    for (const std::uint32_t v : pieces_[i].points())
      if (pieces_[j].has(v)) hull.push_back(key_of_point(v));
    for (const Contact::Corner& corner : c.corners) {
      hull.push_back(key_of_point(corner.point));
      if (corner.edge[0] != no_entity) found.on_edges.emplace_back(edge_key(corner.edge[0], corner.edge[1]), hull.back());
    }
    for (const Contact::Crossing& x : c.crossings) {
      hull.push_back(key_of_crossing(x));
      found.on_edges.emplace_back(edge_key(x.edge[0], x.edge[1]), hull.back());
      if (x.through[2] == no_entity) found.on_edges.emplace_back(edge_key(x.through[0], x.through[1]), hull.back());
    }
    for (const std::uint32_t t : {i, j}) {
      if (!is_triangle(t)) continue;
      if (hull.size() == 1) found.cuts.push_back({t, {hull[0], hull[0]}});
      for (std::size_t k = 1; k < hull.size(); ++k) found.cuts.push_back({t, {hull[0], hull[k]}});
    }
  }

  std::uint32_t number(const HitKey& key) const {
    if (is_point(key)) return key[0];
    return static_cast<std::uint32_t>(points_.size() +
                                      static_cast<std::size_t>(std::ranges::lower_bound(keys_, key) - keys_.begin()));
  }

  void make_points(Crossings& out) const {
    out.points.resize(keys_.size());
    constexpr std::size_t block = 256;
    bulk_.parts((keys_.size() + block - 1) / block, [&](std::size_t part) {
      for (std::size_t k = part * block; k < std::min(keys_.size(), (part + 1) * block); ++k) {
        const auto& [a, b, c, d, e] = keys_[k];
        const auto& p = points_;
        out.points[k].exact = e == no_entity
                                  ? meeting_of_lines(ExactPoint(p[a]), ExactPoint(p[b]), ExactPoint(p[c]), ExactPoint(p[d]))
                                  : line_through_plane(p[a], p[b], p[c], p[d], p[e]);
        out.points[k].at = rounded(out.points[k].exact);
      }
    });
    stop_();
  }

  const Domain<3>& domain_;
  std::span<const Piece> pieces_;
  std::span<const Point3> points_;
  const Bulk& bulk_;
  const StopCheck& stop_;
  std::vector<TriangleOrigin> origins_;  // of each triangle
  std::vector<HitKey> keys_;             // of new points, sorted
};

}  // namespace

Crossings find_crossings(const Domain<3>& domain, std::span<const Piece> pieces, const Bulk& bulk, const StopCheck& stop) {
  return CrossingSearch(domain, pieces, bulk, stop).run();
}

}  // namespace pgdr::detail
