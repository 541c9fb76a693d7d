// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/near_search.hpp"

#include <algorithm>
#include <cmath>

#include "join/build_pieces.hpp"
#include "join/near_tests.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {
namespace {

bool have_common_end(const PlanarEdge& e, const PlanarEdge& f) {
  return e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
}

}  // namespace

template <int D>
NearSearch<D>::NearSearch(const BuildInput<D>& in, const NearContacts& own)
    : in_(in),
      width_(in.tolerance * in.scale),
      scaled_(in.points.begin(), in.points.end()),
      own_(own.on_edges().begin(), own.on_edges().end()),
      given_of_(own.pieces()) {
  for (Point<D>& p : scaled_)
    for (double& x : p.x) x *= in.scale;
}

template <int D>
bool NearSearch<D>::find_pairs(FacetTriangles& faces, std::span<const OwnedEdge> segment_edges, std::span<const FlatFacet> flat) {
  faces_ = &faces;
  pieces_ = pieces_of(in_, faces, segment_edges, flat);
  using Found = std::vector<Pair>;
  pairs_ = joined(
      look_at_pairs<Found, D>(pieces_, scaled_, width_, in_.bulk, in_.stop, [&](std::uint32_t i, std::uint32_t j, Found& found) {
        const bool meet = !have_one_facet(i, j) && contact<D>(in_.points, pieces_[i], pieces_[j]).kind != Contact::Kind::none;
        if (meet || (width_ > 0 && come_near(i, j))) found.push_back({i, j});
      }));
  closed_.clear();
  if (width_ > 0)
    closed_ = in_.bulk.template gather<std::uint32_t>(faces.triangles.size(), [&](std::size_t i, auto& found) {
      if (const auto t = static_cast<std::uint32_t>(i); is_near_corner(t, t)) found.push_back(t);
    });
  in_.stop();
  return !pairs_.empty() || !closed_.empty();
}

/// Is a corner of the one near the other, which has it not; or do edges pass each other?
template <int D>
bool NearSearch<D>::come_near(std::uint32_t i, std::uint32_t j) const {
  if (is_near_corner(i, j) || is_near_corner(j, i)) return true;
  if constexpr (D == 3) {
    if (have_one_facet(i, j) || (is_triangle(i) && is_clear_of_plane(j, i)) || (is_triangle(j) && is_clear_of_plane(i, j)))
      return false;
  }
  return have_passing_edges(i, j);
}

/// Is a corner of piece i near piece j, which has it not? Of one facet's triangles, and of a triangle with itself, edges alone
/// count.
template <int D>
bool NearSearch<D>::is_near_corner(std::uint32_t i, std::uint32_t j) const {
  const Piece &from = pieces_[i], &to = pieces_[j];
  for (std::size_t k = 0; k < from.count; ++k) {
    const std::uint32_t v = from.corners[k];
    if (to.has(v) && i != j) continue;
    const Point<D>& p = scaled_[v];
    if constexpr (D == 3)
      if (to.count == 3 && !have_one_facet(i, j)) {
        if (is_near_triangle(p, triangle(j), width_)) return true;
        continue;
      }
    if (to.count == 1 && squared_distance(p, scaled_[to.corners[0]]) <= width_ * width_) return true;
    const auto is_near = [&](const PlanarEdge& e) {
      return v != e[0] && v != e[1] && part_of_edge_near<D>(p, scaled_[e[0]], scaled_[e[1]], width_).has_value();
    };
    for (const PlanarEdge& e : edges_of(j, true))
      if (any_given(e, is_near)) return true;
  }
  return false;
}

/// Are the corners of piece i that triangle j has not all on one side of its plane, and not near that?
template <int D>
bool NearSearch<D>::is_clear_of_plane(std::uint32_t i, std::uint32_t j) const {
  bool above = true, below = true;
  if constexpr (D == 3) {
    const auto t = triangle(j);
    const auto n = cross(difference(t[1], t[0]), difference(t[2], t[0]));
    const double most = 2 * width_ * std::sqrt(dot(n, n));  // twice, for the rounding here
    for (std::size_t k = 0; k < pieces_[i].count; ++k) {
      if (pieces_[j].has(pieces_[i].corners[k])) continue;
      const double height = dot(n, difference(scaled_[pieces_[i].corners[k]], t[0]));
      above = above && height > most;
      below = below && height < -most;
    }
  }
  return above || below;
}

template <int D>
bool NearSearch<D>::have_passing_edges(std::uint32_t i, std::uint32_t j) const {
  if constexpr (D == 3)
    for (const PlanarEdge& e : edges_of(i, false))
      for (const PlanarEdge& f : edges_of(j, false))
        if (!have_common_end(e, f) && pass_within({scaled_[e[0]], scaled_[e[1]]}, {scaled_[f[0]], scaled_[f[1]]}, width_))
          return true;
  return false;
}

/// The edges of a piece, or those of them that are edges of facets and segments.
template <int D>
auto NearSearch<D>::edges_of(std::uint32_t piece, bool constrained) const -> PieceEdges {
  const auto& c = pieces_[piece].corners;
  PieceEdges edges;
  if (pieces_[piece].count == 2) edges.add(c[0], c[1]);
  if (pieces_[piece].count == 3)
    for (std::size_t k = 0; k < 3; ++k)
      if (!constrained || faces_->is_constraint(piece, k)) edges.add(c[(k + 1) % 3], c[(k + 2) % 3]);
  return edges;
}

/// Is the test true of an edge, which may be given as it is, or of one that is given and of which it is a piece?
template <int D>
template <class Test>
bool NearSearch<D>::any_given(const PlanarEdge& edge, const Test& test) const {
  if (test(edge)) return true;
  if (given_of_.empty()) return false;
  const std::uint64_t key = edge_key(edge[0], edge[1]);
  for (auto at = std::ranges::lower_bound(given_of_, std::pair{key, std::uint64_t{0}}); at != given_of_.end() && at->first == key;
       ++at)
    if (test(edge_of(at->second))) return true;
  return false;
}

template <int D>
std::array<Point<D>, 3> NearSearch<D>::triangle(std::uint32_t piece) const {
  const auto& c = pieces_[piece].corners;
  return {{scaled_[c[0]], scaled_[c[1]], scaled_[c[2]]}};
}

template <int D>
NearContacts NearSearch<D>::contacts() const {
  std::vector<NearPoint> found = own_;
  for (const std::uint32_t t : closed_) add_points_on_edges(t, t, found);
  for (const auto& [i, j] : pairs_) {
    add_points_on_edges(i, j, found);
    add_points_on_edges(j, i, found);
  }
  make_set(found);
  NearContacts on_edges(std::move(found), {});
  if constexpr (D == 3) {
    PointsInFacets in_facets = points_in_facets(on_edges);
    return std::move(on_edges).with_points_in_facets(std::move(in_facets));
  }
  return on_edges;
}

/// The corners of piece i that are near edges of piece j.
template <int D>
void NearSearch<D>::add_points_on_edges(std::uint32_t i, std::uint32_t j, std::vector<NearPoint>& found) const {
  const auto add = [&](const PlanarEdge& e) {
    const std::uint64_t key = edge_key(e[0], e[1]);
    const auto [first, second] = edge_of(key);
    for (std::size_t k = 0; k < pieces_[i].count; ++k) {
      const std::uint32_t v = pieces_[i].corners[k];
      if (v == first || v == second) continue;
      if (const auto part = part_of_edge_near<D>(scaled_[v], scaled_[first], scaled_[second], width_))
        found.push_back({key, *part, v});
    }
    return false;  // go on
  };
  for (const PlanarEdge& e : edges_of(j, true)) any_given(e, add);
}

/// Pairs of an input facet and a point near to its inside that is neither a point of it nor on an edge of it.
template <int D>
auto NearSearch<D>::points_in_facets(const NearContacts& on_edges) const -> PointsInFacets {
  PointsInFacets near;
  const auto look = [&](std::uint32_t i, std::uint32_t j) {
    if (!is_triangle(j)) return;
    const std::uint32_t f = faces_->facets[faces_->facet_of[j]].input;
    if constexpr (D == 3)
      for (std::size_t k = 0; k < pieces_[i].count; ++k)
        if (const std::uint32_t v = pieces_[i].corners[k];
            !pieces_[j].has(v) && is_near_triangle(scaled_[v], triangle(j), width_))
          near.emplace_back(f, v);
  };
  for (const auto& [i, j] : pairs_) {
    if (have_one_facet(i, j)) continue;
    look(i, j);
    look(j, i);
  }
  make_set(near);
  if (near.empty()) return near;
  PointsInFacets known;  // points of these facets, and on their edges
  for (const TriangulatedFacet& facet : faces_->facets) {
    const auto at = std::ranges::lower_bound(near, std::pair{facet.input, 0u});
    if (at == near.end() || at->first != facet.input) continue;
    for (std::uint32_t t = facet.first; t < facet.first + facet.count; ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        known.emplace_back(facet.input, faces_->triangles[t][i]);
        if (!faces_->is_constraint(t, i)) continue;
        const auto [a, b] = edge_of(faces_->key_of_edge(t, i));
        any_given({a, b}, [&](const PlanarEdge& e) {
          for (const NearPoint& p : on_edges.on_edge(edge_key(e[0], e[1]))) known.emplace_back(facet.input, p.point);
          return false;  // go on
        });
      }
  }
  make_set(known);
  std::erase_if(near, [&](const auto& pair) { return std::ranges::binary_search(known, pair); });
  return near;
}

template <int D>
std::vector<std::array<PlanarEdge, 2>> NearSearch<D>::passing_edges() const {
  std::vector<std::array<PlanarEdge, 2>> passing;
  if constexpr (D == 3) {
    std::vector<std::array<std::uint64_t, 2>> found;
    for (const auto& [i, j] : pairs_)
      for (const PlanarEdge& e : edges_of(i, true))
        for (const PlanarEdge& f : edges_of(j, true)) {
          if (have_common_end(e, f) || !pass_within({scaled_[e[0]], scaled_[e[1]]}, {scaled_[f[0]], scaled_[f[1]]}, width_))
            continue;
          const std::uint64_t first = edge_key(e[0], e[1]), second = edge_key(f[0], f[1]);
          found.push_back({std::min(first, second), std::max(first, second)});
        }
    make_set(found);
    const auto& p = in_.points;
    for (const auto& [first, second] : found) {
      const PlanarEdge e = edge_of(first), f = edge_of(second);
      if (orient3d(p[e[0]], p[e[1]], p[f[0]], p[f[1]]) != Sign::zero) passing.push_back({e, f});
    }
  }
  return passing;
}

template class NearSearch<2>;
template class NearSearch<3>;

}  // namespace pgdr::detail
