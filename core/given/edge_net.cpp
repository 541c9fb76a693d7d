// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/edge_net.hpp"

#include <algorithm>

#include "numbers/vectors.hpp"
#include "pgdr/error.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {

using detail::Box;
using detail::BoxTree;
using detail::PlanarEdge;

void EdgeNet::add(const PlanarEdge& edge, double reach, bool whole) {
  const auto [at, fresh] = number_.try_emplace(edge, static_cast<std::uint32_t>(edges_.size()));
  if (fresh) edges_.push_back({edge, reach, whole, {}, {}});
  Edge& e = edges_[at->second];
  e.reach = std::max(e.reach, reach);
  e.whole |= whole;
}

// A crossing is taken for good, and its two pieces have a common point from then on. So rounds end, unless rounding makes new
// ones.
void EdgeNet::cut() {
  constexpr int rounds = 32;  // of crossings by rounding at earlier crossings: seen were two
  for (int round = 0; round < rounds; ++round) {
    make_chains();
    if (!cross_pieces()) return note_whole_edges();
  }
  throw InputError({Errc::entities_intersect, "Facets outside of the mesh cross without end.", {}, 0, {}, {}});
}

void EdgeNet::make_chains() {
  std::vector<std::uint32_t> used;
  for (const auto& [x, v] : crossings_) used.push_back(v);
  for (const Edge& e : edges_) used.insert(used.end(), e.ends.begin(), e.ends.end());
  detail::make_set(used);
  std::vector<Box<3>> boxes;
  boxes.reserve(used.size());
  for (const std::uint32_t v : used) boxes.push_back(Box<3>::around(points_[v]));
  const BoxTree<3> tree(boxes);
  for (Edge& e : edges_) {
    const Point3 &a = points_[e.ends[0]], &b = points_[e.ends[1]];
    const auto d = detail::difference(b, a);
    const double length = detail::dot(d, d);
    std::vector<std::pair<double, std::uint32_t>> along{{0, e.ends[0]}, {length, e.ends[1]}};
    const auto take = [&](std::uint32_t v) {
      if (const auto t = place_on(e, v)) along.push_back({*t, v});
    };
    for (const std::uint32_t v : e.forced) take(v);
    auto box = Box<3>::around(a);
    box.add(b);
    tree.meeting(box.widened(e.reach), [&](std::uint32_t i) {
      if (detail::closest_to_edge(points_[used[i]], a, b).square <= e.reach * e.reach) take(used[i]);
    });
    detail::make_set(along);
    e.chain.clear();
    for (const auto& [t, v] : along) e.chain.push_back(v);
  }
}

void EdgeNet::note_whole_edges() {
  whole_of_.clear();
  for (const Edge& e : edges_)
    for (std::size_t k = 1; e.whole && k < e.chain.size(); ++k) whole_of_[sorted_edge(e.chain[k - 1], e.chain[k])] = e.ends;
}

bool EdgeNet::cross_pieces() {
  struct Piece {
    PlanarEdge ends;
    std::uint32_t edge;
  };
  std::vector<Piece> pieces;
  std::vector<Box<3>> boxes;
  for (std::uint32_t i = 0; i < edges_.size(); ++i)
    for (std::size_t k = 1; k < edges_[i].chain.size(); ++k) {
      const PlanarEdge ends{edges_[i].chain[k - 1], edges_[i].chain[k]};
      pieces.push_back({ends, i});
      auto box = Box<3>::around(points_[ends[0]]);
      box.add(points_[ends[1]]);
      boxes.push_back(box.widened(edges_[i].reach));
    }
  const BoxTree<3> tree(boxes);
  bool found = false;
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    if (edges_[pieces[p].edge].whole) continue;
    tree.meeting(boxes[p], [&](std::uint32_t q) {
      Edge& other = edges_[pieces[q].edge];
      if (other.whole || q < p) found |= cross(pieces[p].ends, edges_[pieces[p].edge], pieces[q].ends, other);
    });
  }
  return found;
}

/// What passes within the reaches of both is a crossing; near an end of one of them that end is the point.
bool EdgeNet::cross(const PlanarEdge& p, Edge& of_p, const PlanarEdge& q, Edge& of_q) {
  for (const std::uint32_t v : p)
    if (v == q[0] || v == q[1]) return false;
  const auto closest = detail::closest_of_edges(points_[p[0]], points_[p[1]], points_[q[0]], points_[q[1]]);
  const double reach = of_p.reach + of_q.reach;
  if (closest.square > reach * reach) return false;
  return meet(closest.points[of_q.whole ? 1 : 0], reach, p, of_p, q, of_q);
}

bool EdgeNet::meet(const Point3& x, double reach, const PlanarEdge& p, Edge& of_p, const PlanarEdge& q, Edge& of_q) {
  bool near_end = false, changed = false;
  for (const PlanarEdge& ends : {q, p})
    for (const std::uint32_t v : ends)
      if (squared_distance(points_[v], x) <= reach * reach) {
        near_end = true;
        changed |= put(of_p, v);
        changed |= put(of_q, v);
      }
  if (near_end) return changed;
  const std::uint32_t v = crossing_at(x, reach);
  put(of_p, v);
  put(of_q, v);
  return true;
}

/// Several pairs of edges may cross at one place.
std::uint32_t EdgeNet::crossing_at(const Point3& x, double reach) {
  for (auto at = crossings_.lower_bound(x[0] - reach); at != crossings_.end() && at->first <= x[0] + reach; ++at)
    if (squared_distance(points_[at->second], x) <= reach * reach) return at->second;
  const auto v = static_cast<std::uint32_t>(points_.size());
  points_.push_back(x);
  crossings_.insert({x[0], v});
  return v;
}

std::optional<double> EdgeNet::place_on(const Edge& e, std::uint32_t v) const {
  const Point3& a = points_[e.ends[0]];
  const auto d = detail::difference(points_[e.ends[1]], a);
  const double t = detail::dot(detail::difference(points_[v], a), d);
  if (v == e.ends[0] || v == e.ends[1] || !(t > 0 && t < detail::dot(d, d))) return {};
  return t;
}

bool EdgeNet::put(Edge& e, std::uint32_t v) {
  if (std::ranges::find(e.chain, v) != e.chain.end() || std::ranges::find(e.forced, v) != e.forced.end()) return false;
  if (!place_on(e, v)) return false;
  e.forced.push_back(v);
  return true;
}

bool EdgeNet::take_apart(const detail::PlanarResult& problem) {
  const auto owners = [&](const PlanarEdge& piece) {
    std::vector<Edge*> out;
    for (Edge& e : edges_)
      for (std::size_t k = 1; k < e.chain.size(); ++k)
        if (sorted_edge(e.chain[k - 1], e.chain[k]) == sorted_edge(piece[0], piece[1])) out.push_back(&e);
    return out;
  };
  bool changed = false;
  if (problem.status == detail::PlanarStatus::point_on_edge)
    for (Edge* e : owners(problem.edge)) changed |= put(*e, problem.other[0]);
  if (problem.status == detail::PlanarStatus::edges_cross) {
    const auto closest = detail::closest_of_edges(points_[problem.edge[0]], points_[problem.edge[1]], points_[problem.other[0]],
                                                  points_[problem.other[1]]);
    for (Edge* p : owners(problem.edge))
      for (Edge* q : owners(problem.other))
        if (!changed) changed = meet(closest.points[q->whole ? 1 : 0], p->reach + q->reach, problem.edge, *p, problem.other, *q);
  }
  return changed;
}

const PlanarEdge* EdgeNet::whole_edge(const PlanarEdge& piece) const {
  const auto at = whole_of_.find(piece);
  return at == whole_of_.end() ? nullptr : &at->second;
}

}  // namespace pgdr::checking
