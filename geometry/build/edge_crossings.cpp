// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/edge_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "numbers/double_double.hpp"
#include "numbers/vectors.hpp"
#include "space/box_tree.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"
#include "space/make_set.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

using Ends = std::array<Point3, 2>;

Ends sorted_ends(std::span<const Point3> p, std::uint64_t key) {
  const auto [a, b] = edge_of(key);
  return lex_less(p[b], p[a]) ? Ends{p[b], p[a]} : Ends{p[a], p[b]};
}

bool less(const Ends& e, const Ends& f) { return e[0] == f[0] ? lex_less(e[1], f[1]) : lex_less(e[0], f[0]); }

/// How far on the way along e the point is where f crosses it, seen along the coordinate in which most is seen of their plane.
/// Coordinates are of the size of 1.
DoubleDouble crossing_part(const Ends& e, const Ends& f) {
  const Vector<3> n = cross(difference(e[1], e[0]), difference(f[1], f[0]));
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(n[static_cast<std::size_t>(i)]) > std::fabs(n[static_cast<std::size_t>(axis)])) axis = i;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto minus = [&](const Point3& p, const Point3& q) { return std::array{difference(p[i], q[i]), difference(p[j], q[j])}; };
  const auto u = minus(e[1], e[0]), w = minus(f[1], f[0]), from = minus(f[0], e[0]);
  return (from[0] * w[1] - from[1] * w[0]) / (u[0] * w[1] - u[1] * w[0]);
}

}  // namespace

EdgeCrossings::EdgeCrossings(BuildInput<3>& in, const PlaneWidth& width,
                             std::vector<std::pair<std::uint64_t, std::uint64_t>> crossing)
    : in_(in), width_(width.of_added() / in.scale) {
  make_set(crossing);
  for (const auto& [first, second] : crossing) {
    in.stop();
    crossings_.push_back(crossing_of(first, second));
  }
}

EdgeCrossings::Crossing EdgeCrossings::crossing_of(std::uint64_t first, std::uint64_t second) const {
  const auto& p = in_.points;
  if (less(sorted_ends(p, second), sorted_ends(p, first))) std::swap(first, second);
  Ends e = sorted_ends(p, first), f = sorted_ends(p, second);
  for (Point3* q : {&e[0], &e[1], &f[0], &f[1]})
    for (double& x : q->x) x *= in_.scale;
  const DoubleDouble part = crossing_part(e, f);
  Crossing c{{}, first, second, edge_of(first), part.rounded()};
  if (lex_less(p[c.on[1]], p[c.on[0]])) std::swap(c.on[0], c.on[1]);
  for (int i = 0; i < 3; ++i) {
    const double x = (DoubleDouble(e[0][i]) + difference(e[1][i], e[0][i]) * part).rounded();
    c.at[i] = std::clamp(x, std::min(e[0][i], e[1][i]), std::max(e[0][i], e[1][i])) / in_.scale + 0.0;
  }
  return c;
}

std::vector<PointOn> EdgeCrossings::add_points(PointLists& lists, BuildReport<3>& report) {
  join_ends();
  join_near(lists, report);
  std::vector<PointOn> on_edges;
  for (const Crossing& c : crossings_)
    for (const std::uint64_t key : {c.first, c.second})
      if (c.point != edge_of(key)[0] && c.point != edge_of(key)[1]) on_edges.emplace_back(key, c.point);
  make_set(on_edges);
  pass_near(lists.points, on_edges);
  return on_edges;
}

/// Crossings near to an end of one of the edges are that: the nearest, the first by coordinates of several.
void EdgeCrossings::join_ends() {
  const auto& p = in_.points;
  for (Crossing& c : crossings_) {
    double least = width_ * width_;
    for (const std::uint64_t key : {c.first, c.second})
      for (const std::uint32_t v : edge_of(key)) {
        const double square = squared_distance(c.at, p[v]);
        if (square < least || (square == least && (c.point == no_entity || lex_less(p[v], p[c.point])))) {
          least = square;
          c.point = v;
        }
      }
  }
}

/// Of the others, those that are near to each other are one point, that of the first by coordinates; which is one that is there
/// already, or is added.
void EdgeCrossings::join_near(PointLists& lists, BuildReport<3>& report) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t k = 0; k < crossings_.size(); ++k)
    if (crossings_[k].point == no_entity) order.push_back(k);
  const auto at = [&](std::uint32_t k) { return crossings_[order[k]].at; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t k, std::uint32_t l) {
    const Crossing &c = crossings_[k], &d = crossings_[l];
    if (c.at != d.at) return lex_less(c.at, d.at);
    const auto& p = in_.points;
    const Ends first = sorted_ends(p, c.first), other = sorted_ends(p, d.first);
    return first != other ? less(first, other) : less(sorted_ends(p, c.second), sorted_ends(p, d.second));
  });
  DisjointSets groups(order.size());
  std::vector<Box<3>> boxes;
  for (std::uint32_t k = 0; k < order.size(); ++k) boxes.push_back(Box<3>::around(at(k)).widened(width_ / 2));
  BoxTree<3>(boxes).self_pairs([&](std::uint32_t k, std::uint32_t l) {
    if (squared_distance(at(k), at(l)) <= width_ * width_) groups.unite(k, l);
  });
  PointPlaces places(in_.points.size());
  for (std::uint32_t v = 0; !order.empty() && v < in_.points.size(); ++v) places.insert(hash_of(in_.points[v]), v);
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    Crossing& c = crossings_[order[k]];
    if (const std::uint32_t first = groups.find(k); first != k) {
      c.point = crossings_[order[first]].point;
      continue;
    }
    c.point = places.find(hash_of(c.at), [&](std::uint32_t v) { return in_.points[v] == c.at; });
    if (c.point == no_entity) c.point = add(c, lists, report);
  }
}

std::uint32_t EdgeCrossings::add(const Crossing& c, PointLists& lists, BuildReport<3>& report) {
  const auto v = static_cast<std::uint32_t>(lists.points.size());
  const auto number = static_cast<std::uint32_t>(lists.input_of_point.back());
  const std::size_t columns = lists.attributes.size() / v;
  lists.points.push_back(c.at);
  lists.input_of_point.push_back(std::max(number + 1, static_cast<std::uint32_t>(in_.plc.points.size())));
  if (!lists.markers.empty()) lists.markers.push_back(0);
  in_.points = lists.points;
  report.set_points(lists.points, lists.input_of_point);
  for (std::size_t k = 0; k < columns; ++k) {
    const double from = lists.attributes[c.on[0] * columns + k], to = lists.attributes[c.on[1] * columns + k];
    lists.attributes.push_back((1 - c.part) * from + c.part * to);
  }
  const std::int64_t added = report.number(lists.input_of_point.back());
  std::array<std::int64_t, 4> ends;  // of the two edges
  for (std::size_t i = 0; i < 4; ++i) ends[i] = report.point_number(edge_of(i < 2 ? c.first : c.second)[i % 2]);
  report.repairs.added_points.add(
      [&] {
        const auto edge = [&](std::size_t i) { return std::to_string(ends[i]) + " - " + std::to_string(ends[i + 1]); };
        return std::to_string(added) + " " + to_text(c.at) + " on " + edge(0) + " and " + edge(2);
      },
      {added, ends[0], ends[1], ends[2], ends[3]});
  report.repairs.added_points.diagnostic.points.push_back(c.at.x);
  return v;
}

/// Of the edges that cross others those that pass a crossing nearly.
void EdgeCrossings::pass_near(std::span<const Point3> points, std::vector<PointOn>& on_edges) const {
  std::vector<std::uint64_t> edges;
  for (const Crossing& c : crossings_) edges.insert(edges.end(), {c.first, c.second});
  make_set(edges);
  std::vector<Box<3>> boxes;
  for (const std::uint64_t key : edges) {
    auto box = Box<3>::around(points[edge_of(key)[0]]);
    box.add(points[edge_of(key)[1]]);
    boxes.push_back(box.widened(width_));
  }
  const BoxTree<3> tree(boxes);
  std::vector<std::uint32_t> made;
  for (const Crossing& c : crossings_) made.push_back(c.point);
  make_set(made);
  for (const std::uint32_t v : made)
    tree.at(points[v], [&](std::uint32_t k) {
      const auto [a, b] = edge_of(edges[k]);
      if (v != a && v != b && closest_to_edge(points[v], points[a], points[b]).square <= width_ * width_)
        on_edges.emplace_back(edges[k], v);
    });
  make_set(on_edges);
}

}  // namespace pgdr::detail
