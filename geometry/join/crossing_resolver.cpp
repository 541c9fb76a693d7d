// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/crossing_resolver.hpp"

#include <algorithm>
#include <cmath>

#include "join/passing_points.hpp"
#include "join/point_groups.hpp"
#include "numbers/double_double.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/contact.hpp"
#include "space/make_set.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

DoubleDouble exact_cross(const DoubleDoubles<2>& a, const DoubleDoubles<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Where the lines ab and cd meet, rounded once. @pre the insides of the segments cross; the points are of the size of 1
Point2 intersection(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto u = exact_difference(b, a), w = exact_difference(d, c);
  const DoubleDouble t = exact_cross(exact_difference(c, a), w) / exact_cross(u, w);
  Point2 x;
  for (int i = 0; i < 2; ++i) x[i] = (DoubleDouble(a[i]) + u[static_cast<std::size_t>(i)] * t).rounded();
  return x;
}

}  // namespace

/// Cells are as wide as the reach; their numbers are whole, or so large that the reach is less than an ulp of the coordinate.
auto PointsInReach::cell_of(const Point2& p) const -> Cell { return {std::floor(p[0] / reach_), std::floor(p[1] / reach_)}; }

std::uint32_t PointsInReach::nearest(const Point2& p) const {
  const Cell at = cell_of(p);
  const Entry* best = nullptr;
  double least = reach_ * reach_;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const auto cell = cells_.find({at[0] + i, at[1] + j});
      if (cell == cells_.end()) continue;
      for (const Entry& e : cell->second) {
        const double d = squared_distance(p, e.point);
        if (d > least || (best && d == least && !lex_less(e.point, best->point))) continue;
        least = d;
        best = &e;
      }
    }
  return best ? best->v : no_entity;
}

CrossingResolver::CrossingResolver(const Plc<2>& plc) : points_(plc.points) {
  for (Point2& p : points_)
    for (double& x : p.x) x += 0.0;  // no negative zeros
  const auto [scale, largest] = scale_of<2>(points_);
  scale_ = scale;
  tolerance_ = tolerance_of(plc) * scale;
  reach_ = std::max(2 * tolerance_, rounding::of_point * largest);  // `largest` is scaled
  scaled_ = points_;
  for (Point2& p : scaled_)
    for (double& x : p.x) x *= scale;
  const auto place = places_of_points();
  if (reach_ > 0) grid_ = PointsInReach(reach_);
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    if (place[v] != v) continue;
    distinct_.push_back(v);
    grid_.add(scaled_[v], v);
  }
  for (std::uint32_t s = 0; s < plc.segments.size(); ++s) {
    const auto [a, b] = plc.segments[s].points;
    edges_.push_back({{place[a], place[b]}, s});
  }
}

/// Of each point the one that stands for all at its place, or within the tolerance of it.
std::vector<std::uint32_t> CrossingResolver::places_of_points() const {
  PointPlaces places(points_.size());
  std::vector<std::uint32_t> first(points_.size()), distinct;
  std::vector<Point2> at;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const std::size_t hash = hash_of(points_[i]);
    const std::uint32_t known = places.find(hash, [&](std::uint32_t v) { return points_[v] == points_[i]; });
    first[i] = known == no_entity ? i : known;
    if (known != no_entity) continue;
    places.insert(hash, i);
    distinct.push_back(i);
    at.push_back(scaled_[i]);
  }
  if (!(tolerance_ > 0)) return first;
  const PointGroups groups = group_points<2>(at, tolerance_, StopCheck({}));
  std::vector<std::uint32_t> stands_for(points_.size());
  for (std::uint32_t k = 0; k < distinct.size(); ++k) stands_for[distinct[k]] = distinct[groups.place_of[groups.group_of[k]]];
  for (std::uint32_t& v : first) v = stands_for[v];
  return first;
}

bool CrossingResolver::split_once() {
  inside_.clear();
  const auto keys = edge_keys();
  find_near(keys);
  if (!inside_.empty()) {
    touching_.insert(touching_.end(), inside_.begin(), inside_.end());
  } else {
    const auto crossings = find_crossings(keys);
    for (const Crossing& crossing : crossings) split_at(crossing);
    note_pairs(crossings);
    make_set(inside_);
  }
  if (inside_.empty()) return false;
  replace_edges();
  return true;
}

/// The edges of some length, as they are now.
std::vector<std::uint64_t> CrossingResolver::edge_keys() const {
  std::vector<std::uint64_t> keys;
  for (const OwnedEdge& e : edges_)
    if (e.edge[0] != e.edge[1]) keys.push_back(edge_key(e.edge[0], e.edge[1]));
  make_set(keys);
  return keys;
}

/// Points that edges pass within the tolerance.
void CrossingResolver::find_near(const std::vector<std::uint64_t>& keys) {
  std::vector<Box<2>> boxes;
  for (const std::uint64_t key : keys) {
    const auto [a, b] = edge_of(key);
    auto box = Box<2>::around(scaled(a));
    box.add(scaled(b));
    boxes.push_back(box.widened(tolerance_));
  }
  for (const std::uint32_t v : distinct_) boxes.push_back(Box<2>::around(scaled(v)));
  const auto edges = static_cast<std::uint32_t>(keys.size());
  BoxTree<2>(boxes).self_pairs([&](std::uint32_t i, std::uint32_t j) {
    if (i >= edges || j < edges) return;
    const auto [a, b] = edge_of(keys[i]);
    const std::uint32_t v = distinct_[j - edges];
    if (v != a && v != b && passes_within(scaled(a), scaled(b), scaled(v), tolerance_)) inside_.emplace_back(keys[i], v);
  });
  make_set(inside_);
}

/// All that cross, in an order that is that of the coordinates alone.
auto CrossingResolver::find_crossings(const std::vector<std::uint64_t>& keys) -> std::vector<Crossing> {
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const std::uint64_t key : keys) corners.push_back({edge_of(key)[0], edge_of(key)[1], no_entity});
  std::vector<Crossing> found;
  BoxTree<2>(corners, points_).self_pairs([&](std::uint32_t i, std::uint32_t j) {
    if (contact<2>(points_, {corners[i], 2, 0}, {corners[j], 2, 0}).kind != Contact::Kind::cross) return;
    PlanarEdge e = directed(edge_of(keys[i])), f = directed(edge_of(keys[j]));
    if (std::pair(points_[f[0]].x, points_[f[1]].x) < std::pair(points_[e[0]].x, points_[e[1]].x)) std::swap(e, f);
    found.push_back({intersection(scaled(e[0]), scaled(e[1]), scaled(f[0]), scaled(f[1])), {e, f}});
  });
  std::sort(found.begin(), found.end(), [&](const Crossing& a, const Crossing& b) {
    const auto rank = [&](const Crossing& c) {
      return std::array{c.place.x, points_[c.edges[0][0]].x, points_[c.edges[0][1]].x, points_[c.edges[1][0]].x,
                        points_[c.edges[1][1]].x};
    };
    return rank(a) < rank(b);
  });
  return found;
}

/// The lexicographically lesser end first.
PlanarEdge CrossingResolver::directed(PlanarEdge e) const {
  if (lex_less(points_[e[1]], points_[e[0]])) std::swap(e[0], e[1]);
  return e;
}

void CrossingResolver::split_at(const Crossing& crossing) {
  const std::uint32_t v = point_at(crossing);
  for (const PlanarEdge& e : crossing.edges)
    if (v != e[0] && v != e[1] && splits_into_shorter(scaled(e[0]), scaled(e[1]), scaled(v)))
      inside_.emplace_back(edge_key(e[0], e[1]), v);
}

/// The nearest end of the two edges within reach, else the nearest point within reach, else a new one.
std::uint32_t CrossingResolver::point_at(const Crossing& crossing) {
  std::uint32_t best = no_entity;
  double least = reach_ * reach_;
  for (const PlanarEdge& e : crossing.edges)
    for (const std::uint32_t v : e)
      if (const double d = squared_distance(crossing.place, scaled(v));
          d < least || (d == least && (best == no_entity || lex_less(scaled(v), scaled(best))))) {
        least = d;
        best = v;
      }
  if (best == no_entity) best = grid_.nearest(crossing.place);
  if (best != no_entity) return best;
  const auto v = static_cast<std::uint32_t>(points_.size());
  scaled_.push_back(crossing.place);
  points_.push_back(crossing.place);
  for (double& x : points_.back().x) x = x / scale_ + 0.0;
  grid_.add(crossing.place, v);
  distinct_.push_back(v);
  origins_.push_back(crossing.edges[0]);
  return v;
}

/// Which segments the edges that cross are pieces of.
void CrossingResolver::note_pairs(const std::vector<Crossing>& crossings) {
  std::multimap<std::uint64_t, std::uint32_t> owners;
  for (const OwnedEdge& e : edges_) owners.emplace(edge_key(e.edge[0], e.edge[1]), e.owner);
  for (const Crossing& c : crossings) {
    const std::uint64_t first = edge_key(c.edges[0][0], c.edges[0][1]), second = edge_key(c.edges[1][0], c.edges[1][1]);
    for (auto [i, last] = owners.equal_range(first); i != last; ++i)
      for (auto [j, end] = owners.equal_range(second); j != end; ++j)
        pairs_.emplace(std::min(i->second, j->second), std::max(i->second, j->second));
  }
}

void CrossingResolver::replace_edges() {
  std::vector<OwnedEdge> pieces;
  for (const OwnedEdge& e : edges_) {
    const auto chain = chain_of(e.edge[0], e.edge[1]);
    for (std::size_t k = 1; k < chain.size(); ++k) pieces.push_back({{chain[k - 1], chain[k]}, e.owner});
  }
  edges_ = std::move(pieces);
}

/// a, the points inside the edge in their order along it, b. Where two of them, on both sides of the edge, are farther apart than
/// it is long, the one nearest to its middle alone.
std::vector<std::uint32_t> CrossingResolver::chain_of(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> inside;
  const std::uint64_t key = edge_key(a, b);
  for (auto i = std::lower_bound(inside_.begin(), inside_.end(), PointOn{key, 0}); i != inside_.end() && i->first == key; ++i)
    inside.push_back(i->second);
  const auto chain = chain_along(scaled_, {a, b}, inside);
  const double length2 = squared_distance(scaled(a), scaled(b));
  for (std::size_t k = 1; k < chain.size() && chain.size() > 3; ++k)
    if (!(squared_distance(scaled(chain[k - 1]), scaled(chain[k])) < length2)) {
      const auto longer_piece = [&](std::uint32_t v) {
        return std::max(squared_distance(scaled(a), scaled(v)), squared_distance(scaled(b), scaled(v)));
      };
      const auto less = [&](std::uint32_t v, std::uint32_t w) { return longer_piece(v) < longer_piece(w); };
      return {a, *std::min_element(chain.begin() + 1, chain.end() - 1, less), b};
    }
  return chain;
}

}  // namespace pgdr::detail
