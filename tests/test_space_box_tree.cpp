// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The box tree against all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/distances.hpp"

namespace pgdr::detail::test_space_box_tree {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <int D>
std::vector<Box<D>> random_boxes(std::mt19937_64& random, std::size_t n, double size, bool on_grid) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Box<D>> boxes;
  for (std::size_t k = 0; k < n; ++k) {
    Point<D> p, q;
    for (int i = 0; i < D; ++i) {
      p[i] = on_grid ? static_cast<double>(random() % 5) : uniform(random);
      q[i] = p[i] + (on_grid ? static_cast<double>(random() % 2) : size * uniform(random));
    }
    boxes.push_back(Box<D>::around(q));
    boxes.back().add(p);
  }
  return boxes;
}

template <int D>
void compare(const std::vector<Box<D>>& a, const std::vector<Box<D>>& b) {
  Pairs self, expected_self, both, expected_both;
  const BoxTree<D> tree(a);
  tree.self_pairs([&](std::uint32_t i, std::uint32_t j) {
    EXPECT_LT(i, j);
    self.emplace_back(i, j);
  });
  for (std::uint32_t j = 0; j < b.size(); ++j) tree.meeting(b[j], [&](std::uint32_t i) { both.emplace_back(i, j); });
  for (std::uint32_t i = 0; i < a.size(); ++i) {
    for (std::uint32_t j = i + 1; j < a.size(); ++j)
      if (a[i].meets(a[j])) expected_self.emplace_back(i, j);
    for (std::uint32_t j = 0; j < b.size(); ++j)
      if (a[i].meets(b[j])) expected_both.emplace_back(i, j);
  }
  std::sort(self.begin(), self.end());
  std::sort(both.begin(), both.end());
  EXPECT_EQ(self, expected_self);
  EXPECT_EQ(both, expected_both);
}

// The nearest box, and the least sum of distance and weight, of points in the middle of other boxes.
template <int D>
void compare_nearest(const std::vector<Box<D>>& a, const std::vector<Box<D>>& b, TreeCut cut, std::mt19937_64& random) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> weights(a.size());
  for (double& w : weights) w = std::uniform_real_distribution<double>(0, 0.3)(random);
  const BoxTree<D> tree(a, cut);
  const std::vector<double> least = tree.least_below(weights, Bulk(false));
  for (const Box<D>& box : b) {
    const Point<D>& x = box.low;
    double expected = infinity, expected_weighted = infinity, nearest = infinity, weighted = infinity;
    for (std::size_t i = 0; i < a.size(); ++i) {
      expected = std::min(expected, a[i].squared_distance_to(x));
      expected_weighted = std::min(expected_weighted, weights[i] + a[i].squared_distance_to(x));
    }
    tree.nearest([&](const Box<D>& node, std::uint32_t) { return node.squared_distance_to(x); },
                 [&](std::uint32_t i) { return nearest = std::min(nearest, a[i].squared_distance_to(x)); });
    tree.nearest([&](const Box<D>& node, std::uint32_t k) { return least[k] + node.squared_distance_to(x); },
                 [&](std::uint32_t i) { return weighted = std::min(weighted, weights[i] + a[i].squared_distance_to(x)); });
    EXPECT_EQ(nearest, expected);
    EXPECT_EQ(weighted, expected_weighted);
  }
}

template <int D>
void compare_many() {
  std::mt19937_64 random(1);
  for (const std::size_t n : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 33u, 500u})
    for (const bool on_grid : {false, true})
      for (const double size : {0.05, 0.5}) {
        const auto a = random_boxes<D>(random, n, size, on_grid), b = random_boxes<D>(random, n / 2 + 3, size, on_grid);
        compare<D>(a, b);
        for (const TreeCut cut : {TreeCut::along_curve, TreeCut::at_medians}) compare_nearest<D>(a, b, cut, random);
      }
}

TEST(BoxTree, AllPairs2) { compare_many<2>(); }
TEST(BoxTree, AllPairs3) { compare_many<3>(); }

// Simplices that meet without a common corner are all there; a fan of many has few pairs, and so have two such fans.
TEST(BoxTree, Simplices) {
  std::mt19937_64 random(3);
  for (const std::uint32_t n : {1u, 10u, 100u, 1000u}) {
    std::vector<Point3> points;
    const auto coordinate = [&] { return static_cast<double>(random() % 9); };
    for (std::uint32_t k = 0; k < n + 3; ++k) points.push_back({coordinate(), coordinate(), 0.125 * coordinate()});
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (std::uint32_t k = 0; k < n; ++k) {
      const auto a = static_cast<std::uint32_t>(random() % 3), b = static_cast<std::uint32_t>(3 + random() % n);
      corners.push_back({a, b == k + 3 ? no_corner : k + 3, b});
      if (corners.back()[1] == no_corner) std::swap(corners.back()[1], corners.back()[2]);
    }
    Pairs found, expected;
    BoxTree<3>(corners, points).self_pairs([&](std::uint32_t i, std::uint32_t j) { found.emplace_back(i, j); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    const auto meet = [&](std::uint32_t i, std::uint32_t j) {
      std::array<Piece, 2> pieces;
      for (std::size_t side = 0; side < 2; ++side) {
        Piece& piece = pieces[side];
        piece.corners = corners[side == 0 ? i : j];
        const auto at = [&](std::size_t k) { return points[piece.corners[k]]; };
        piece.count = piece.corners[2] == no_corner ? 2 : 3;
        if (at(0) == at(1)) return false;
        if (piece.count == 2) continue;
        if (at(1) == at(2) || at(0) == at(2) || collinear<3>(at(0), at(1), at(2))) return false;
        while (orient_projected(at(0), at(1), at(2), piece.axis) == Sign::zero) ++piece.axis;
        if (orient_projected(at(0), at(1), at(2), piece.axis) == Sign::negative) std::swap(piece.corners[1], piece.corners[2]);
      }
      for (const std::uint32_t v : pieces[0].corners)
        for (const std::uint32_t w : pieces[1].corners)
          if (v != no_corner && w != no_corner && points[v] == points[w]) return true;
      return contact<3>(points, pieces[0], pieces[1]).kind != Contact::Kind::none;
    };
    const auto share = [&](std::uint32_t i, std::uint32_t j) {
      return std::any_of(corners[i].begin(), corners[i].end(), [&](std::uint32_t v) {
        return v != no_corner && std::find(corners[j].begin(), corners[j].end(), v) != corners[j].end();
      });
    };
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = i + 1; j < n; ++j)
        if (!share(i, j) && meet(i, j)) {
          EXPECT_TRUE(std::binary_search(found.begin(), found.end(), std::pair{i, j}));
        }
  }
  const std::uint32_t n = 20000;  // a disc
  std::vector<Point3> points{{0, 0, 0}};
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t k = 0; k < n; ++k) {
    points.push_back({std::cos(2 * std::acos(-1) * k / n), std::sin(2 * std::acos(-1) * k / n), 0});
    corners.push_back({0, 1 + k, 1 + (k + 1) % n});
  }
  std::size_t pairs = 0;
  BoxTree<3>(corners, points).self_pairs([&](std::uint32_t, std::uint32_t) { ++pairs; });
  EXPECT_GE(pairs, n);
  EXPECT_LT(pairs, 40 * n);
  points.push_back({0, 0, 1});  // the cone on it
  for (std::uint32_t k = 0; k < n; ++k) corners.push_back({n + 1, 1 + k, 1 + (k + 1) % n});
  pairs = 0;
  BoxTree<3>(corners, points).self_pairs([&](std::uint32_t, std::uint32_t) { ++pairs; });
  EXPECT_LT(pairs, 120 * n);
}

// Triangles of fans, no two of which need meet: those with a corner that is near enough to the other are found.
TEST(BoxTree, SimplicesThatAreNear) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::uint32_t fans = 10, n = 1000;
  const double within = 0.03;
  std::vector<Point3> points;
  for (std::uint32_t k = 0; k < fans; k += 2) {  // the hubs of each two are near, too
    points.push_back({uniform(random), uniform(random), uniform(random)});
    points.push_back({points[k][0] + 0.6 * within, points[k][1], points[k][2] - 0.6 * within});
  }
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t apex = k % fans;
    Point3 p = points[apex], q;  // slender ones, whose boxes hardly hold more
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] += 0.4 * uniform(random) - 0.2;
      q[i] = p[i] + 0.01 * uniform(random);
    }
    points.insert(points.end(), {p, q});
    corners.push_back({apex, fans + 2 * k, fans + 2 * k + 1});
  }
  Pairs found;
  BoxTree<3>(corners, points, within).self_pairs([&](std::uint32_t i, std::uint32_t j) { found.emplace_back(i, j); });
  std::sort(found.begin(), found.end());
  std::size_t near = 0, apart = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = i + 1; j < n; ++j) {
      if (corners[i][0] == corners[j][0]) continue;
      const auto is_near = [&](std::uint32_t s, std::uint32_t t) {
        const auto& c = corners[t];
        return std::ranges::any_of(corners[s], [&](std::uint32_t v) {
          return closest_to_simplex<3>(points[v], {points[c[0]], points[c[1]], points[c[2]]}).square <= within * within;
        });
      };
      if (is_near(i, j) || is_near(j, i)) {
        ++near;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), std::pair{i, j})) << i << ' ' << j;
      } else {
        ++apart;
      }
    }
  EXPECT_GT(near, 100u);
  EXPECT_LT(found.size(), near + apart);  // and so are not all
}

TEST(BoxTree, OneOverlapsAll) {
  std::mt19937_64 random(2);
  auto boxes = random_boxes<3>(random, 300, 0.01, false);
  boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  boxes.push_back({{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}});
  boxes.push_back({{1e-320, 0, 0}, {1e-320, 0, 0}});
  compare<3>(boxes, boxes);
}

}  // namespace pgdr::detail::test_space_box_tree
