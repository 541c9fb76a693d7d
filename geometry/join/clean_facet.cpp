// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/clean_facet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "join/near_tests.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

std::vector<std::uint32_t> vertices_of(const CleanFacet::Loops& loops) {
  std::vector<std::uint32_t> vertices;
  for (const auto& loop : loops) vertices.insert(vertices.end(), loop.begin(), loop.end());
  make_set(vertices);
  return vertices;
}

std::vector<PlanarEdge> edges_of(const CleanFacet::Loops& loops) {
  std::vector<PlanarEdge> edges;
  for (const auto& loop : loops) {
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < (n > 2 ? n : n == 2 ? 1 : 0); ++k) {
      const auto [a, b] = std::minmax(loop[k], loop[(k + 1) % n]);
      edges.push_back({a, b});
    }
  }
  make_set(edges);
  return edges;
}

}  // namespace

CleanFacet clean_facet(const BuildInput<3>& in, std::uint32_t f, const NearContacts& near, BuildReport<3>& report) {
  CleanFacet facet;
  for (const auto& polygon : in.plc.facets[f].polygons) {
    auto& loop = facet.given.emplace_back();
    const auto drop = [&](std::uint32_t i, std::uint32_t j) {
      const std::int64_t number = report.number(f), first = report.number(i), second = report.number(j);
      report.repairs.dropped_edges.add(
          [&] { return std::to_string(first) + " - " + std::to_string(second) + " of facet " + std::to_string(number); },
          {number, first, second});
    };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t v = in.point_of_input[polygon[k]];
      if (!loop.empty() && loop.back() == v)
        drop(polygon[k - 1], polygon[k]);
      else
        loop.push_back(v);
    }
    while (loop.size() > 1 && polygon.size() > 2 && loop.front() == loop.back()) {
      drop(polygon.back(), polygon.front());
      loop.pop_back();
    }
  }
  facet.join(f, near);
  return facet;
}

void CleanFacet::join(std::uint32_t f, const NearContacts& near) {
  loops = near.joined(f, given);
  vertices = vertices_of(loops);
  edges = edges_of(loops);
}

std::vector<NearPoint> CleanFacet::points_near_own_edges(const BuildInput<3>& in) const {
  const double width = in.tolerance * in.scale;
  const auto scaled = [&](std::uint32_t v) {
    Point3 p = in.points[v];
    for (double& x : p.x) x *= in.scale;
    return p;
  };
  const std::vector<PlanarEdge> own = edges_of(given);
  std::vector<Box<3>> boxes;
  for (const auto& [a, b] : own) {
    auto box = Box<3>::around(scaled(a));
    box.add(scaled(b));
    boxes.push_back(box.widened(width));
  }
  const BoxTree<3> tree(boxes);
  std::vector<NearPoint> near;
  for (const std::uint32_t v : vertices_of(given))
    tree.at(scaled(v), [&](std::uint32_t k) {
      const auto [a, b] = own[k];
      if (v == a || v == b) return;
      if (const auto part = part_of_edge_near<3>(scaled(v), scaled(a), scaled(b), width))
        near.push_back({edge_key(a, b), *part, v});
    });
  return near;
}

bool CleanFacet::split_at_own_points(std::span<const Point3> p, BuildReport<3>& report) {
  std::vector<std::uint32_t> by_place = vertices;
  const auto before = [&](std::uint32_t v, std::uint32_t w) { return lex_less(p[v], p[w]); };
  std::sort(by_place.begin(), by_place.end(), before);
  const auto inside_of = [&](std::uint32_t a, std::uint32_t b) {  // from a to b
    const auto [low, high] = before(a, b) ? std::pair{a, b} : std::pair{b, a};
    std::vector<std::uint32_t> out;
    for (auto v = std::upper_bound(by_place.begin(), by_place.end(), low, before); *v != high; ++v)
      if (collinear<3>(p[low], p[high], p[*v])) out.push_back(*v);
    if (low != a) std::reverse(out.begin(), out.end());
    return out;
  };
  std::vector<PlanarEdge> finer_edges;
  for (const auto& [a, b] : edges) {
    std::uint32_t last = a;
    for (const std::uint32_t v : inside_of(a, b)) {
      report.note_on_edge(v, a, b);
      finer_edges.push_back({std::min(last, v), std::max(last, v)});
      last = v;
    }
    finer_edges.push_back({std::min(last, b), std::max(last, b)});
  }
  make_set(finer_edges);
  if (finer_edges == edges) return false;
  edges = std::move(finer_edges);
  for (auto& loop : loops) {
    if (loop.size() < 3) continue;
    std::vector<std::uint32_t> finer;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      finer.push_back(loop[k]);
      const auto inside = inside_of(loop[k], loop[(k + 1) % loop.size()]);
      finer.insert(finer.end(), inside.begin(), inside.end());
    }
    loop = std::move(finer);
  }
  return true;
}

std::array<double, 3> CleanFacet::normal(const TriangleShapes& shapes) const {
  std::array<double, 3> best{};
  double best_size = -1;
  for (std::vector<std::uint32_t> loop : loops) {
    if (loop.size() < 3) continue;
    // From its least point on, by the lesser one beside it: sums are rounded, and decide what an order may not.
    const auto less = [&](std::uint32_t v, std::uint32_t w) { return lex_less(shapes.scaled(v), shapes.scaled(w)); };
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), less), loop.end());
    const bool is_turned = less(loop.back(), loop[1]);
    if (is_turned) std::reverse(loop.begin() + 1, loop.end());
    std::array<double, 3> sum{};
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {  // from a point of it: no cancellation far from the origin
      const auto n = shapes.normal({loop[0], loop[k], loop[k + 1]});
      for (std::size_t i = 0; i < 3; ++i) sum[i] += is_turned ? -n[i] : n[i];
    }
    const double size = std::fabs(sum[0]) + std::fabs(sum[1]) + std::fabs(sum[2]);
    if (size > best_size) {
      best = sum;
      best_size = size;
    }
  }
  return best;
}

double CleanFacet::extent(std::span<const Point3> points) const {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const auto before = [&](std::uint32_t v, std::uint32_t w) { return points[v][i] < points[w][i]; };
    const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), before);
    longest = std::max(longest, points[*high][i] - points[*low][i]);
  }
  return longest;
}

}  // namespace pgdr::detail
