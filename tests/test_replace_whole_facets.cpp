// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets and segments that are put together again from their pieces: grids on the sides of a box, sheets with holes, arcs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "pgdr/whole_facets.hpp"

namespace pgdr::test_replace_whole_facets {

/// Points by their coordinates.
class Points {
 public:
  explicit Points(Plc<3>& plc) : plc_(plc) {}
  std::uint32_t operator()(double x, double y, double z) {
    const auto [at, is_new] = number_.try_emplace({x, y, z}, static_cast<std::uint32_t>(plc_.points.size()));
    if (is_new) plc_.points.push_back({{x, y, z}});
    return at->second;
  }

 private:
  Plc<3>& plc_;
  std::map<std::array<double, 3>, std::uint32_t> number_;
};

void add_triangle(Plc<3>& plc, const std::array<std::uint32_t, 3>& corners, int marker) {
  plc.facets.emplace_back().polygons = {{corners[0], corners[1], corners[2]}};
  plc.facets.back().marker = marker;
}

/// Squares of a grid, two triangles each, where there is one.
void add_grid(
    Plc<3>& plc, int n, int marker, const std::function<std::uint32_t(int, int)>& at,
    const std::function<bool(int, int)>& is_there = [](int, int) { return true; }) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (!is_there(i, j)) continue;
      add_triangle(plc, {at(i, j), at(i + 1, j), at(i + 1, j + 1)}, marker);
      add_triangle(plc, {at(i, j), at(i + 1, j + 1), at(i, j + 1)}, marker);
    }
}

/// The box [0, n] x [0, n] x [0, n], its sides as grids with the markers 1 to 6.
Plc<3> gridded_box(int n) {
  Plc<3> plc;
  Points point(plc);
  int marker = 0;
  for (const double end : {0.0, double(n)}) {
    add_grid(plc, n, ++marker, [&](int i, int j) { return point(i, j, end); });
    add_grid(plc, n, ++marker, [&](int i, int j) { return point(end, i, j); });
    add_grid(plc, n, ++marker, [&](int i, int j) { return point(j, end, i); });
  }
  return plc;
}

/// Turned about an axis that is none of the coordinates', and moved.
Plc<3> turned(Plc<3> plc) {
  const double c = std::cos(0.7), s = std::sin(0.7), d = std::cos(0.3), e = std::sin(0.3);
  for (Point3& p : plc.points) {
    const double x = c * p[0] - s * p[1], y = s * p[0] + c * p[1];
    p = {{x + 0.1, d * y - e * p[2] + 0.2, e * y + d * p[2] - 0.3}};
  }
  return plc;
}

double area(const Plc<3>& plc) {
  const Domain<3> domain(plc);
  double sum = 0;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) {
      std::array<double, 3> u, v;
      for (int k = 0; k < 3; ++k) {
        u[static_cast<std::size_t>(k)] = domain.points()[t[1]][k] - domain.points()[t[0]][k];
        v[static_cast<std::size_t>(k)] = domain.points()[t[2]][k] - domain.points()[t[0]][k];
      }
      const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
      sum += std::sqrt(x * x + y * y + z * z) / 2;
    }
  return sum;
}

std::multiset<int> markers(const Plc<3>& plc) {
  std::multiset<int> out;
  for (const auto& f : plc.facets) out.insert(f.marker);
  return out;
}

TEST(WholeFacets, SidesOfABox) {
  for (const bool turn : {false, true}) {
    const Plc<3> plc = turn ? turned(gridded_box(5)) : gridded_box(5);
    const WholeFacets<3> whole = with_whole_facets(plc);
    EXPECT_EQ(whole.plc.points.size(), 8u) << turn;
    EXPECT_EQ(markers(whole.plc), (std::multiset<int>{1, 2, 3, 4, 5, 6}));
    EXPECT_TRUE(whole.plc.segments.empty());
    for (std::size_t f = 0; f < whole.plc.facets.size(); ++f)
      EXPECT_EQ(plc.facets[whole.facet_of_input[f]].marker, whole.plc.facets[f].marker);
    EXPECT_EQ(std::ranges::count(whole.point_of_input, no_entity), std::ssize(plc.points) - 8);
    for (std::size_t p = 0; p < plc.points.size(); ++p)
      if (whole.point_of_input[p] != no_entity) {
        EXPECT_EQ(whole.plc.points[whole.point_of_input[p]], plc.points[p]);
      }
    EXPECT_NEAR(area(whole.plc), 150, 1e-11);
  }
}

TEST(WholeFacets, RequiredPointsStay) {
  const Plc<3> plc = gridded_box(4);
  std::vector<std::uint8_t> required(plc.points.size(), 0);
  const auto require = [&](const Point3& x) {
    required[static_cast<std::size_t>(std::ranges::find(plc.points, x) - plc.points.begin())] = 1;
  };
  require({{2, 2, 0}});  // inside of a side
  require({{0, 0, 1}});  // inside of an edge
  const WholeFacets<3> whole = with_whole_facets<3>(plc, required);
  EXPECT_EQ(whole.plc.points.size(), 10u);
  const Domain<3> domain(whole.plc);
  EXPECT_EQ(domain.facets().size(), 6u);
  EXPECT_EQ(domain.segments().size(), 13u);
  EXPECT_THROW(with_whole_facets<3>(plc, std::vector<std::uint8_t>(3, 1)), UsageError);
}

/// A sheet of 6 x 6 squares without those of a list, and a triangle of another plane, since an input of one plane is none.
Plc<3> sheet(const std::set<std::pair<int, int>>& missing) {
  Plc<3> plc;
  Points point(plc);
  add_grid(
      plc, 6, 3, [&](int i, int j) { return point(i, j, 1); },
      [&](int i, int j) {
        return !missing.contains({i, j});
      });
  add_triangle(plc, {point(20, 0, 0), point(21, 0, 0), point(20, 0, 4)}, 4);
  return plc;
}

TEST(WholeFacets, HolesAndHolesThatTouch) {
  struct Example {
    std::set<std::pair<int, int>> missing;
    std::size_t points, polygons;
  };
  const Example examples[] = {{{}, 4, 1},
                              {{{2, 2}}, 8, 2},
                              {{{2, 2}, {3, 3}}, 11, 3},          // two holes with a corner in common
                              {{{0, 2}}, 8, 1},                   // a notch
                              {{{0, 2}, {1, 3}}, 11, 2},          // a notch, and a hole that touches it
                              {{{2, 2}, {2, 3}, {3, 2}}, 10, 2},  // an L
                              {{{1, 1}, {2, 2}, {3, 3}, {4, 4}}, 17, 5}};
  for (const Example& e : examples)
    for (const bool turn : {false, true}) {
      const Plc<3> plc = turn ? turned(sheet(e.missing)) : sheet(e.missing);
      const WholeFacets<3> whole = with_whole_facets(plc);
      EXPECT_EQ(whole.plc.points.size(), e.points + 3) << e.missing.size() << turn;
      ASSERT_EQ(whole.plc.facets.size(), 2u) << e.missing.size() << turn;
      EXPECT_EQ(whole.plc.facets[0].polygons.size(), e.polygons);
      EXPECT_EQ(whole.plc.facets[0].holes.size(), e.polygons - 1);
      EXPECT_NEAR(area(whole.plc), 38 - static_cast<double>(e.missing.size()), 1e-11);
    }
}

TEST(WholeFacets, SegmentsInPlanesStayAndThoseAtEdgesAreGivenAnyway) {
  Plc<3> plc = gridded_box(4);
  const auto number = [&](const Point3& x) {
    return static_cast<std::uint32_t>(std::ranges::find(plc.points, x) - plc.points.begin());
  };
  for (int i = 0; i < 4; ++i) {
    plc.segments.push_back({{number({{double(i), 2, 0}}), number({{i + 1.0, 2, 0}})}, 0});  // through a side
    plc.segments.push_back({{number({{double(i), 0, 0}}), number({{i + 1.0, 0, 0}})}, 0});  // along an edge
    plc.segments.push_back({{number({{double(i), 4, 0}}), number({{i + 1.0, 4, 0}})}, i < 2 ? 7 : 8});
  }
  const WholeFacets<3> whole = with_whole_facets(plc);
  std::multiset<int> found;
  for (const auto& s : whole.plc.segments) found.insert(s.marker);
  EXPECT_EQ(found, (std::multiset<int>{0, 7, 8}));
  EXPECT_EQ(whole.plc.points.size(), 11u);  // the ends of the line through a side, and where markers change
  EXPECT_NEAR(area(whole.plc), 96, 1e-12);
}

TEST(WholeFacets, LinesAndArcsOfAPlane) {
  Plc<2> plc;
  constexpr std::uint32_t n = 3000;  // so fine that three points in succession are within the tolerance of a line, but for a few
  for (std::uint32_t i = 0; i <= n; ++i) {
    const double a = 1e-4 * i / n;
    plc.points.push_back({{std::cos(a), std::sin(a)}});
    if (i > 0) plc.segments.push_back({{i - 1, i}, 5});
  }
  const double far = 3;
  plc.points.push_back({{far, 0}});
  plc.segments.push_back({{n, n + 1}, 5});
  plc.segments.push_back({{n + 1, 0}, 5});
  const WholeFacets<2> whole = with_whole_facets(plc);
  EXPECT_GT(whole.plc.points.size(), 4u);  // the arc is 1.25e-9 high: no line, and not one of its points is free to go

  Plc<2> square;
  for (int i = 0; i < 40; ++i) {
    const double t = i % 10 * 0.1;
    const std::array<std::array<double, 2>, 4> sides{{{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}}};
    const auto& [x, y] = sides[static_cast<std::size_t>(i / 10)];
    square.points.push_back({{x * std::cos(0.4) - y * std::sin(0.4), x * std::sin(0.4) + y * std::cos(0.4)}});
    square.segments.push_back({{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>((i + 1) % 40)}, 1 + i / 10});
  }
  const WholeFacets<2> joined = with_whole_facets(square);
  EXPECT_EQ(joined.plc.points.size(), 4u);
  ASSERT_EQ(joined.plc.segments.size(), 4u);
  for (std::size_t s = 0; s < 4; ++s)
    EXPECT_NEAR(squared_distance(joined.plc.points[joined.plc.segments[s].points[0]],
                                 joined.plc.points[joined.plc.segments[s].points[1]]),
                1, 1e-12);
}

TEST(WholeFacets, RoundSurfacesAreLeft) {
  Plc<3> plc;
  constexpr int n = 48;
  for (int i = 0; i < n; ++i)
    for (const double z : {0.0, 1.0}) plc.points.push_back({{std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), z}});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    add_triangle(plc, {a, b, b + 1}, 1);
    add_triangle(plc, {a, b + 1, a + 1}, 1);
  }
  const WholeFacets<3> whole = with_whole_facets(plc);
  EXPECT_EQ(whole.plc.points.size(), plc.points.size());
  EXPECT_EQ(whole.plc.facets.size(), std::size_t{n});  // its quadrilaterals
}

}  // namespace pgdr::test_replace_whole_facets
