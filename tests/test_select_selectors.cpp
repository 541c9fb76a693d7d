// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The library's selectors on single elements: the formulas, the disks, the candidates that they ask about, their choice.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <type_traits>
#include <vector>

#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/selectors.hpp"

namespace pgdr::test_select_selectors {

template <class Dimension>
class Selectors : public testing::Test {};
template <int D>
using Dim = std::integral_constant<int, D>;
using Dimensions = testing::Types<Dim<2>, Dim<3>>;
TYPED_TEST_SUITE(Selectors, Dimensions);

/// Answers by a function of the candidate, and keeps the candidates.
template <int D>
class Scripted final : public Neighborhood<D> {
 public:
  explicit Scripted(std::function<Preview<D>(const Point<D>&)> answer) : answer_(std::move(answer)) {}
  Preview<D> count(const Point<D>& p) override {
    asked.push_back(p);
    return answer_(p);
  }
  Preview<D> measure(const Point<D>& p) override { return count(p); }
  std::vector<Point<D>> asked;

 private:
  std::function<Preview<D>(const Point<D>&)> answer_;
};

template <int D>
Preview<D> preview(int poor, int good, double cosine = 0.5) {
  return {Preview<D>::Status::possible, poor, good, cosine};
}

template <int D>
PoorElement<D> element_of(Simplex<D> corners, double bound, const DiskOptions& disk) {
  std::sort(corners.begin(), corners.end(), lex_less<D>);
  PoorElement<D> e;
  e.corners = corners;
  e.circumcenter = circumsphere<D>(corners).center;
  e.circumradius = std::sqrt(squared_distance(e.circumcenter, corners[0]));
  e.shortest_edge = std::sqrt(shortest_edge_squared<D>(corners));
  e.radius_edge_bound = bound;
  e.over_radius_edge = true;
  e.disk = selection_disk<D>(e, disk);
  return e;
}

/// Elements over the bound, of random shape: two corners near to each other.
template <int D>
std::vector<PoorElement<D>> poor_elements(double bound, const DiskOptions& disk, int n = 200) {
  std::mt19937_64 random(7);
  auto draw = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  std::vector<PoorElement<D>> all;
  while (static_cast<int>(all.size()) < n) {
    Simplex<D> s;
    for (auto& p : s)
      for (int k = 0; k < D; ++k) p[k] = draw();
    for (int k = 0; k < D; ++k) s[1][k] = s[0][k] + 0.1 * draw();
    const auto e = element_of<D>(s, bound, disk);
    if (e.circumradius > bound * e.shortest_edge && e.circumradius < 100) all.push_back(e);
  }
  return all;
}

template <int D>
double bound_of() {
  return D == 2 ? 1.5 : 2.5;
}

template <int D>
Scripted<D> unasked() {
  return Scripted<D>([](const Point<D>&) -> Preview<D> { throw std::logic_error("asked"); });
}

TYPED_TEST(Selectors, OffCentersLieOnTheAxisAtTheirDistance) {
  constexpr int D = TypeParam::value;
  const double b = bound_of<D>(), factor = D == 2 ? 1 : 0.6;
  const auto selector = off_center<D>(factor);
  auto nobody = unasked<D>();
  int nearer = 0;
  for (const auto& e : poor_elements<D>(b, {DiskType::type1})) {
    const Point<D> p = selector(e, nobody);
    if (p == e.circumcenter) {
      ++nearer;
      continue;
    }
    EXPECT_TRUE(inside(e.disk, p));
    // As far from both ends of the shortest edge, on the segment from its midpoint to the centre.
    int a = 0, c = 1;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (squared_distance(e.corners[i], e.corners[j]) < squared_distance(e.corners[a], e.corners[c])) a = i, c = j;
    Point<D> middle;
    for (int k = 0; k < D; ++k) middle[k] = (e.corners[a][k] + e.corners[c][k]) / 2;
    const double far = std::sqrt(squared_distance(p, middle)), rest = std::sqrt(squared_distance(p, e.circumcenter));
    EXPECT_NEAR(far, factor * e.shortest_edge * (b + std::sqrt(b * b - 0.25)), 1e-12 * e.circumradius);
    EXPECT_NEAR(far + rest, std::sqrt(squared_distance(middle, e.circumcenter)), 1e-10 * e.circumradius);
    if constexpr (D == 2) {  // the new triangle has exactly the ratio b
      const Simplex<2> made{e.corners[a], e.corners[c], p};
      EXPECT_NEAR(circumsphere<2>(made).squared_radius, b * b * shortest_edge_squared<2>(made), 1e-9 * e.circumradius);
    }
  }
  EXPECT_LT(nearer, 150);
}

// Where the formula leaves the disk (of type II, or with an odd factor) the point is the disk's nearest on the axis.
TYPED_TEST(Selectors, OffCentersStayInTheDisk) {
  constexpr int D = TypeParam::value;
  const double b = bound_of<D>();
  auto nobody = unasked<D>();
  for (const DiskOptions disk : {DiskOptions{DiskType::type2}, DiskOptions{DiskType::type2, 0.99}, DiskOptions{DiskType::type1}})
    for (const double factor : {0.01, 0.6, 1.0, 1e6}) {
      int moved = 0;
      for (const auto& e : poor_elements<D>(b, disk)) {
        const Point<D> p = off_center<D>(factor)(e, nobody);
        EXPECT_TRUE(p == e.circumcenter || inside(e.disk, p));
        moved += !(p == e.circumcenter);
      }
      EXPECT_EQ(moved > 0, factor < 1e6);
    }
  // No disk, no choice.
  for (const auto& e : poor_elements<D>(b, {DiskType::type2, 1})) EXPECT_EQ(off_center<D>(0.5)(e, nobody), e.circumcenter);
}

TYPED_TEST(Selectors, OptimizedTakesTheFirstOfTheLeastLosses) {
  constexpr int D = TypeParam::value;
  for (const auto& e : poor_elements<D>(bound_of<D>(), {DiskType::type1}, 20)) {
    Scripted<D> all([](const Point<D>&) { return preview<D>(1, 3); });
    const Point<D> first = optimized<D>(100)(e, all);
    ASSERT_GE(all.asked.size(), 90u);
    EXPECT_EQ(first, all.asked[0]);
    for (const auto& p : all.asked) EXPECT_TRUE(inside(e.disk, p));
    const Point<D> best = all.asked[50], impossible = all.asked[7];
    Scripted<D> one([&](const Point<D>& p) {
      if (p == impossible) return Preview<D>{Preview<D>::Status::impossible, 9, 0, 1};
      return p == best ? preview<D>(4, 3) : preview<D>(1, 3);
    });
    EXPECT_EQ(optimized<D>(100)(e, one), best);
    // A candidate in whose place an entity would be split is the last choice.
    Scripted<D> splits([&](const Point<D>& p) {
      Preview<D> answer = p == best ? preview<D>(0, 9) : preview<D>(5, 0);
      if (!(p == best)) answer.status = Preview<D>::Status::encroaches;
      return answer;
    });
    EXPECT_EQ(optimized<D>(100)(e, splits), best);
    // Nothing more is asked once there is no answer.
    Scripted<D> ends([&](const Point<D>& p) { return p == best ? Preview<D>{} : preview<D>(1, 3); });
    optimized<D>(100)(e, ends);
    EXPECT_EQ(ends.asked.size(), 51u);
  }
}

// Gamma: every candidate makes a triangle of the same ratio, just within the bound, with the shortest edge.
TEST(SelectorsPlane, CandidatesOfTheOptimizationLieOnTheArc) {
  int off = 0;
  for (const auto& e : poor_elements<2>(1.5, {DiskType::type1})) {
    Scripted<2> all([](const Point2&) { return preview<2>(1, 3); });
    optimized<2>(64)(e, all);
    int a = 0, c = 1;
    for (int i = 0; i < 3; ++i)
      for (int j = i + 1; j < 3; ++j)
        if (squared_distance(e.corners[i], e.corners[j]) < squared_distance(e.corners[a], e.corners[c])) a = i, c = j;
    const double ratio = std::sqrt(circumsphere<2>({e.corners[a], e.corners[c], all.asked[0]}).squared_radius) / e.shortest_edge;
    EXPECT_LT(ratio, 1.5);
    off += ratio > 1.49;
    double widest = 0;
    for (const auto& p : all.asked) {
      EXPECT_NEAR(std::sqrt(circumsphere<2>({e.corners[a], e.corners[c], p}).squared_radius), ratio * e.shortest_edge,
                  1e-6 * e.circumradius);
      widest = std::max(widest, squared_distance(p, all.asked[0]));
    }
    EXPECT_GT(widest, 0);
  }
  EXPECT_GT(off, 50);
}

// A thousand samples, from the centre outwards, in all directions, their distances spread evenly.
TEST(SelectorsSpace, CandidatesOfTheOptimizationFillTheBall) {
  for (const auto& e : poor_elements<3>(2.5, {DiskType::type1}, 10)) {
    Scripted<3> all([](const Point3&) { return preview<3>(1, 3); });
    optimized<3>()(e, all);
    ASSERT_EQ(all.asked.size(), 1001u);
    EXPECT_EQ(all.asked[0], e.circumcenter);
    double mean[3] = {0, 0, 0}, distance = 0;
    int octants[8] = {};
    for (const Point3& p : all.asked) {
      int octant = 0;
      for (int k = 0; k < 3; ++k) {
        mean[k] += (p[k] - e.disk.center[k]) / e.disk.radius / 1001;
        octant |= (p[k] > e.disk.center[k]) << k;
      }
      ++octants[octant];
      distance += std::sqrt(squared_distance(p, e.disk.center)) / e.disk.radius / 1001;
    }
    for (const double m : mean) EXPECT_NEAR(m, 0, 0.02);
    for (const int n : octants) EXPECT_NEAR(n, 125, 12);
    EXPECT_NEAR(distance, 0.5, 0.01);
  }
}

TYPED_TEST(Selectors, SliverAvoidingTakesTheBluntest) {
  constexpr int D = TypeParam::value;
  for (const auto& e : poor_elements<D>(bound_of<D>(), {DiskType::type1}, 20)) {
    Scripted<D> all([](const Point<D>&) { return preview<D>(1, 1); });
    EXPECT_EQ(sliver_avoiding<D>()(e, all), e.circumcenter);
    ASSERT_EQ(all.asked.size(), 21u);
    for (const auto& p : all.asked) EXPECT_TRUE(inside(e.disk, p));
    const Point<D> best = all.asked[9], splits = all.asked[4];
    Scripted<D> one([&](const Point<D>& p) {
      if (p == splits) return Preview<D>{Preview<D>::Status::encroaches, 1, 1, -1};
      return preview<D>(1, 1, p == best ? 0.25 : 0.75);
    });
    EXPECT_EQ(sliver_avoiding<D>()(e, one), best);
    Scripted<D> none([&](const Point<D>&) { return Preview<D>{Preview<D>::Status::encroaches, 1, 1, 1}; });
    EXPECT_EQ(sliver_avoiding<D>()(e, none), e.circumcenter);
    Scripted<D> ends([&](const Point<D>& p) { return p == best ? Preview<D>{} : preview<D>(1, 1); });
    sliver_avoiding<D>()(e, ends);
    EXPECT_EQ(ends.asked.size(), 10u);
  }
}

// The candidates are a function of the element, scale with it, and differ from one element to the next.
TYPED_TEST(Selectors, CandidatesScaleWithTheElement) {
  constexpr int D = TypeParam::value;
  const auto candidates = [](const PoorElement<D>& e) {
    Scripted<D> all([](const Point<D>&) { return preview<D>(1, 1); });
    sliver_avoiding<D>(8)(e, all);
    optimized<D>(8)(e, all);
    return all.asked;
  };
  const auto elements = poor_elements<D>(bound_of<D>(), {DiskType::type1}, 20);
  for (const auto& e : elements)
    for (const double factor : {0x1p-70, 0x1p55}) {
      Simplex<D> s = e.corners;
      for (auto& p : s)
        for (int k = 0; k < D; ++k) p[k] *= factor;
      const auto plain = candidates(e), big = candidates(element_of<D>(s, e.radius_edge_bound, {DiskType::type1}));
      ASSERT_EQ(plain.size(), big.size());
      for (std::size_t i = 0; i < plain.size(); ++i)
        for (int k = 0; k < D; ++k) EXPECT_EQ(big[i][k], factor * plain[i][k]);
    }
  const auto offset = [&](const PoorElement<D>& e) { return (candidates(e)[1][0] - e.circumcenter[0]) / e.disk.radius; };
  EXPECT_NE(offset(elements[0]), offset(elements[1]));
}

TYPED_TEST(Selectors, ParametersAreChecked) {
  constexpr int D = TypeParam::value;
  for (const double factor : {0.0, -1.0, double{NAN}, double{INFINITY}}) EXPECT_THROW(off_center<D>(factor), UsageError);
  for (const int n : {0, -1, 1000001}) {
    EXPECT_THROW(optimized<D>(n), UsageError);
    EXPECT_THROW(sliver_avoiding<D>(n), UsageError);
  }
}

TYPED_TEST(Selectors, HoldAnyFunctor) {
  constexpr int D = TypeParam::value;
  const PoorElement<D> e = poor_elements<D>(bound_of<D>(), {}, 1)[0];
  auto nobody = unasked<D>();
  EXPECT_FALSE(PointSelector<D>());
  EXPECT_FALSE(PointSelector<D>(nullptr));
  EXPECT_FALSE(PointSelector<D>(std::function<Point<D>(const PoorElement<D>&)>()));
  PointSelector<D> simple = [n = 0](const PoorElement<D>& x) mutable { return x.corners[n++]; };
  EXPECT_TRUE(simple);
  EXPECT_EQ(simple(e, nobody), e.corners[0]);
  EXPECT_EQ(simple(e, nobody), e.corners[1]);
  const PointSelector<D> asks = [](const PoorElement<D>& x, Neighborhood<D>& n) {
    n.count(x.circumcenter);
    return x.circumcenter;
  };
  EXPECT_THROW(asks(e, nobody), std::logic_error);
  simple = asks;
  EXPECT_THROW(simple(e, nobody), std::logic_error);
  EXPECT_FALSE(simple.is_of_several());
  EXPECT_EQ(PointSelector<D>([](const PoorElement<D>& x) { return x.corners[1]; }).all(e, nobody).size(), 1u);
  simple = nullptr;
  EXPECT_FALSE(simple);
}

TYPED_TEST(Selectors, OfSeveralPoints) {
  constexpr int D = TypeParam::value;
  const PoorElement<D> e = poor_elements<D>(bound_of<D>(), {}, 1)[0];
  auto nobody = unasked<D>();
  const auto corners = [](const PoorElement<D>& x) {
    SelectedPoints<D> points;
    for (const Point<D>& p : x.corners) points.push_back(p);
    return points;
  };
  const auto asking = [&](const PoorElement<D>& x, Neighborhood<D>&) { return corners(x); };
  const auto blocks = [&](std::span<const PoorElement<D>> x, std::span<SelectedPoints<D>> points) {
    for (std::size_t i = 0; i < x.size(); ++i) points[i] = corners(x[i]);
  };
  for (const PointSelector<D>& s :
       {PointSelector<D>(corners), PointSelector<D>(asking), PointSelector<D>::by_blocks_of_several(blocks)}) {
    EXPECT_TRUE(s);
    EXPECT_TRUE(s.is_of_several());
    EXPECT_EQ(s(e, nobody), e.corners[0]);
    const SelectedPoints<D> all = s.all(e, nobody);
    ASSERT_EQ(all.size(), static_cast<std::size_t>(D + 1));
    EXPECT_EQ(all[D], e.corners[D]);
  }
  SelectedPoints<D> points;
  EXPECT_NE(points.first(), points.first());  // NaN
  for (std::size_t i = 0; i < SelectedPoints<D>::most; ++i) points.push_back(e.corners[0]);
  EXPECT_THROW(points.push_back(e.corners[0]), std::length_error);
  EXPECT_FALSE(PointSelector<D>::by_blocks_of_several(nullptr));
}

// Uniform in the disk: the mean of the draws is near the centre, and so is half of them within the radius of half of the volume.
TYPED_TEST(Selectors, RandomPointsFillTheDisk) {
  constexpr int D = TypeParam::value;
  auto nobody = unasked<D>();
  int within = 0, all = 0;
  Point<D> mean;
  for (const PoorElement<D>& e : poor_elements<D>(bound_of<D>(), {DiskType::type1}, 20))
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      const Point<D> p = randomized<D>(seed)(e, nobody);
      ASSERT_TRUE(inside(e.disk, p));
      EXPECT_EQ(p, randomized<D>(seed)(e, nobody));
      within += squared_distance(p, e.disk.center) < std::pow(0.5, 2.0 / D) * e.disk.radius * e.disk.radius ? 1 : 0;
      for (int k = 0; k < D; ++k) mean[k] += (p[k] - e.disk.center[k]) / e.disk.radius;
      ++all;
    }
  EXPECT_EQ(all, 2000);
  EXPECT_NEAR(within / 2000.0, 0.5, 0.05);
  for (int k = 0; k < D; ++k) EXPECT_NEAR(mean[k] / 2000, 0, 0.05);
}

}  // namespace pgdr::test_select_selectors
