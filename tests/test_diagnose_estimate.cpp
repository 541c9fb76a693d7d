// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The narrowest gap, beside one that looks at all pairs; the least angle; least numbers of cells of
// shapes whose meshes are known.
#include "pgdr/estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "domain_plcs.hpp"
#include "pgdr/diagnosis.hpp"
#include "planar_plcs.hpp"
#include "space/bulk.hpp"

namespace pgdr::test_diagnose_estimate {

using test::box;
using test::triangulated;
using test::turned;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The solution of a small system of equations; empty if there is not one.
std::vector<double> solved(std::vector<std::vector<double>> a) {
  const std::size_t n = a.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t largest = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[largest][k])) largest = i;
    std::swap(a[k], a[largest]);
    if (std::fabs(a[k][k]) < 1e-13) return {};
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j <= n; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  std::vector<double> x;
  for (std::size_t k = 0; k < n; ++k) x.push_back(a[k][n] / a[k][k]);
  return x;
}

/// Least distance of two simplices, by their corners: of the flats through all subsets of these, where the nearest points of two
/// flats are inside of both.
template <int D>
double distance_by_subsets(const std::vector<Point<D>>& a, const std::vector<Point<D>>& b) {
  const auto subset = [](const std::vector<Point<D>>& s, unsigned which) {
    std::vector<Point<D>> some;
    for (std::size_t i = 0; i < s.size(); ++i)
      if (which >> i & 1) some.push_back(s[i]);
    return some;
  };
  const auto minus = [](const Point<D>& p, const Point<D>& q) {
    Point<D> d;
    for (int i = 0; i < D; ++i) d[i] = p[i] - q[i];
    return d;
  };
  const auto product = [](const Point<D>& p, const Point<D>& q) {
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += p[i] * q[i];
    return sum;
  };
  double least = infinity;
  for (unsigned i = 1; i < 1u << a.size(); ++i)
    for (unsigned j = 1; j < 1u << b.size(); ++j) {
      const auto s = subset(a, i), t = subset(b, j);
      std::vector<Point<D>> along;  // |s[0] - t[0] + sum x_k along_k| is to be least
      for (std::size_t k = 1; k < s.size(); ++k) along.push_back(minus(s[k], s[0]));
      for (std::size_t k = 1; k < t.size(); ++k) along.push_back(minus(t[0], t[k]));
      const Point<D> from = minus(s[0], t[0]);
      std::vector<std::vector<double>> equations;
      for (const auto& u : along) {
        equations.emplace_back();
        for (const auto& v : along) equations.back().push_back(product(u, v));
        equations.back().push_back(-product(u, from));
      }
      const std::vector<double> x = solved(equations);
      if (x.size() != along.size()) continue;
      double in_s = 1, in_t = 1;
      Point<D> way = from;
      bool inside = true;
      for (std::size_t k = 0; k < x.size(); ++k) {
        (k + 1 < s.size() ? in_s : in_t) -= x[k];
        inside = inside && x[k] >= 0;
        for (int c = 0; c < D; ++c) way[c] += x[k] * along[k][c];
      }
      if (inside && in_s >= 0 && in_t >= 0) least = std::min(least, std::sqrt(product(way, way)));
    }
  return least;
}

/// An entity by its points and pieces.
template <int D>
struct Entity {
  std::vector<std::uint32_t> points;
  std::vector<std::vector<Point<D>>> pieces;
};

template <int D>
std::vector<Entity<D>> entities_of(const Domain<D>& domain) {
  std::vector<Entity<D>> all;
  const auto p = domain.points();
  for (std::uint32_t v = 0; v < p.size(); ++v) all.push_back({{v}, {{p[v]}}});
  for (const DomainSegment& s : domain.segments())
    all.push_back({{s.points[0], s.points[1]}, {{p[s.points[0]], p[s.points[1]]}}});
  if constexpr (D == 3)
    for (EntityId f = 0; f < domain.facets().size(); ++f) {
      const auto points = domain.facet_points(f);
      Entity<D> facet{{points.begin(), points.end()}, {}};
      for (const auto& t : domain.triangles(f)) facet.pieces.push_back({p[t[0]], p[t[1]], p[t[2]]});
      all.push_back(facet);
    }
  return all;
}

template <int D>
double narrowest_of_all_pairs(const Domain<D>& domain) {
  const auto entities = entities_of(domain);
  double least = infinity;
  for (std::size_t i = 0; i < entities.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto shared = [&](std::uint32_t v) { return std::ranges::count(entities[j].points, v) > 0; };
      if (std::ranges::any_of(entities[i].points, shared)) continue;
      for (const auto& a : entities[i].pieces)
        for (const auto& b : entities[j].pieces) least = std::min(least, distance_by_subsets<D>(a, b));
    }
  return least;
}

/// The distance is that of the two entities named, and the points are on them.
template <int D>
void expect_consistent(const Domain<D>& domain, const Gap<D>& gap) {
  EXPECT_NEAR(std::sqrt(squared_distance(gap.points[0], gap.points[1])), gap.distance, 1e-12 * (1 + gap.distance));
  const auto entities = entities_of(domain);
  std::array<std::size_t, 2> at{};
  for (std::size_t i = 0; i < 2; ++i) {
    at[i] = gap.entities[i].id;
    if (gap.entities[i].kind != EntityKind::vertex) at[i] += domain.points().size();
    if (gap.entities[i].kind == EntityKind::facet) at[i] += domain.segments().size();
  }
  double least = infinity;
  for (const auto& a : entities[at[0]].pieces)
    for (const auto& b : entities[at[1]].pieces) least = std::min(least, distance_by_subsets<D>(a, b));
  EXPECT_NEAR(least, gap.distance, 1e-9 * gap.distance);
}

/// A box with another one on its top face, `apart` from it.
Plc<3> two_boxes(double apart) {
  Plc<3> plc = box();
  const auto n = static_cast<std::uint32_t>(plc.points.size());
  const Plc<3> other = box();
  for (const Point3& p : other.points) plc.points.push_back({p[0] / 2 + 0.5, p[1] / 2 + 0.25, p[2] / 3 + 3 + apart});
  for (auto facet : other.facets) {
    for (std::uint32_t& v : facet.polygons[0]) v += n;
    plc.facets.push_back(facet);
  }
  return plc;
}

template <int D>
CellEstimate<D> estimate(const Plc<D>& plc) {
  return estimate_cells(Domain<D>(plc));
}

TEST(NarrowestGap, OfABoxIsBetweenOppositeFaces) {
  for (const double scale : {1.0, 0x1p-400, 0x1p300}) {
    Plc<3> plc = box();
    for (Point3& p : plc.points)
      for (double& x : p.x) x *= scale;
    const auto gap = narrowest_gap(Domain<3>(plc));
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->distance, scale);
    EXPECT_EQ(gap->entities[0].kind, EntityKind::facet);
    EXPECT_EQ(gap->entities[1].kind, EntityKind::facet);
  }
}

TEST(NarrowestGap, OfTwoBoxesIsBetweenThem) {
  for (const double apart : {1e-3, 1e-6, 1e-9})
    for (const Plc<3>& plc : {two_boxes(apart), triangulated(two_boxes(apart)), turned(two_boxes(apart))}) {
      const Domain<3> domain(plc);
      for (const GapsIn in : {GapsIn::all_space, GapsIn::not_meshed}) {
        const auto gap = narrowest_gap(domain, {.in = in});
        ASSERT_TRUE(gap);
        EXPECT_NEAR(gap->distance, apart, 1e-14);
        EXPECT_EQ(gap->entities[0].kind, EntityKind::facet);
        EXPECT_EQ(gap->entities[1].kind, EntityKind::facet);
      }
    }
}

/// What is between two things counts where it is meshed. A box within a box, by a thin gap all around.
Plc<3> nested_boxes(double apart) {
  Plc<3> plc = box();
  const Plc<3> inner = box();
  for (const Point3& p : inner.points)
    plc.points.push_back({p[0] > 1 ? 2 - apart : apart, p[1] > 0.5 ? 1 - apart : apart, p[2] > 1 ? 3 - apart : apart});
  for (auto facet : inner.facets) {
    for (std::uint32_t& v : facet.polygons[0]) v += 8;
    plc.facets.push_back(facet);
  }
  return plc;
}

TEST(NarrowestGap, IsInWhatIsMeshed) {
  constexpr double apart = 1e-6;
  for (const bool is_turned : {false, true}) {
    const auto gap_of = [&](const Plc<3>& plc, const GapOptions& options = {}) {
      const auto gap = narrowest_gap(Domain<3>(is_turned ? turned(plc) : plc), options);
      return gap ? gap->distance : infinity;
    };
    Plc<3> plc = two_boxes(apart);
    EXPECT_NEAR(gap_of(plc), 0.5, 1e-12);  // the outside is between them
    for (std::size_t v = 0; v < 8; ++v) plc.points[8 + v] = plc.points[v], plc.points[8 + v][2] += 3 + apart;
    EXPECT_NEAR(gap_of(plc, {.in = GapsIn::not_meshed}), apart, 1e-12);  // with sides in one plane
    plc = nested_boxes(apart);
    EXPECT_NEAR(gap_of(plc), apart, 1e-12);
    EXPECT_EQ(gap_of(plc, {.in = GapsIn::not_meshed}), infinity);
    EXPECT_NEAR(gap_of(plc, {.voids_by_nesting = true}), apart, 1e-12);  // the shell is solid, its inside void
    if (is_turned) continue;
    plc.holes = {{1, 0.5, apart / 2}};
    EXPECT_NEAR(gap_of(plc), 1 - 2 * apart, 1e-9);  // the inner box alone
    EXPECT_NEAR(gap_of(plc, {.in = GapsIn::not_meshed}), apart, 1e-12);
    EXPECT_NEAR(gap_of(plc, {.in = GapsIn::not_meshed, .within = 2 * apart}), apart, 1e-12);
    EXPECT_EQ(gap_of(plc, {.in = GapsIn::not_meshed, .within = apart / 2}), infinity);
    plc.holes = {{1, 0.5, 1.5}};
    EXPECT_NEAR(gap_of(plc), apart, 1e-12);
  }
}

/// Walls that bound nothing are in the way of a gap, but are no border of what is meshed.
TEST(NarrowestGap, OfASheetInABoxIsMeshed) {
  for (const bool is_inside : {true, false}) {
    Plc<3> plc = box();
    const double z = is_inside ? 3 - 1e-6 : 3 + 1e-6;
    for (const auto& [x, y] : {std::pair{0.5, 0.25}, {1.5, 0.25}, {1.5, 0.75}, {0.5, 0.75}}) plc.points.push_back({x, y, z});
    plc.facets.push_back({{{8, 9, 10, 11}}, {}, 0});
    for (const Plc<3>& p : {plc, turned(plc)}) {
      const auto gap = narrowest_gap(Domain<3>(p));
      ASSERT_TRUE(gap);
      EXPECT_NEAR(gap->distance, is_inside ? 1e-6 : 1, 1e-9);
    }
  }
}

/// Two squares, and between them a slit that is closed at both ends.
TEST(NarrowestGap, IsInWhatIsMeshedIn2D) {
  constexpr double apart = 1e-7;
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{1 + apart, 0}}, {{2, 0}}, {{2, 1}}, {{1 + apart, 1}}};
  plc.segments = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 3}, 0}, {{3, 0}, 0}, {{4, 5}, 0}, {{5, 6}, 0}, {{6, 7}, 0}, {{7, 4}, 0}};
  EXPECT_NEAR(narrowest_gap(Domain<2>(plc))->distance, 1 - apart, 1e-12);
  EXPECT_NEAR(narrowest_gap(Domain<2>(plc), {.in = GapsIn::not_meshed})->distance, apart, 1e-12);
  plc.segments.push_back({{1, 4}, 0});
  plc.segments.push_back({{2, 7}, 0});
  EXPECT_NEAR(narrowest_gap(Domain<2>(plc))->distance, apart, 1e-12);
  EXPECT_GT(estimate(plc).at_least, 1e5);
  plc.holes = {{{1 + apart / 2, 0.5}}};
  EXPECT_NEAR(narrowest_gap(Domain<2>(plc))->distance, 1 - apart, 1e-12);  // nor are its ends: they have the outside beyond
  EXPECT_LT(estimate(plc).at_least, 100);
}

TEST(NarrowestGap, IsThatOfAllPairsIn3D) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  int valid = 0;
  for (int round = 0; round < 16; ++round) {
    Plc<3> plc = round % 2 == 0 ? triangulated(two_boxes(0.5)) : two_boxes(0.5);
    if (round % 2 == 0)
      for (Point3& p : plc.points)
        for (double& x : p.x) x += shift(random) / (1 + round % 3);
    plc.points.push_back({1 + shift(random), 0.5 + shift(random), 1});  // of nothing
    plc.points.push_back({1 + shift(random), 0.5 + shift(random), 2});
    plc.points.push_back({1 + shift(random), 0.5 + shift(random), 2.5});
    const auto n = static_cast<std::uint32_t>(plc.points.size());
    plc.segments.push_back({{n - 2, n - 1}, 0});
    const Domain<3> domain(turned(plc, 0.1 * round));
    if (diagnose(domain).error_count() > 0) continue;
    ++valid;
    const auto gap = narrowest_gap(domain, {.in = GapsIn::all_space});
    ASSERT_TRUE(gap);
    const double expected = narrowest_of_all_pairs(domain);
    EXPECT_NEAR(gap->distance, expected, 1e-9 * expected) << round;
    expect_consistent(domain, *gap);
  }
  EXPECT_GE(valid, 8);
}

TEST(NarrowestGap, IsThatOfAllPairsIn2D) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Domain<2> domain(test::random_graph(20, 15, 0, seed));
    const auto gap = narrowest_gap(domain, {.in = GapsIn::all_space});
    ASSERT_TRUE(gap);
    const double expected = narrowest_of_all_pairs(domain);
    EXPECT_NEAR(gap->distance, expected, 1e-9 * expected) << seed;
    expect_consistent(domain, *gap);
  }
}

TEST(NarrowestGap, OfPointsAlone) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{3, 4}}, {{100, 0}}};
  EXPECT_EQ(narrowest_gap(Domain<2>(plc), {.in = GapsIn::all_space})->distance, 5);
  EXPECT_FALSE(narrowest_gap(Domain<2>(plc)));  // nothing is meshed
  plc.segments.push_back({{0, 1}, 0});
  EXPECT_EQ(narrowest_gap(Domain<2>(plc), {.in = GapsIn::all_space})->distance, 5);  // its ends are points without a common point
}

TEST(NarrowestGap, IsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(narrowest_gap(Domain<3>(box()), {.stop = stop.get_token()}), CancelledError);
  EXPECT_THROW(least_angle(Domain<3>(box()), stop.get_token()), CancelledError);
  EXPECT_THROW(estimate_cells<3>(Domain<3>(box()), {.measure = {}, .stop = stop.get_token()}), CancelledError);
}

/// Two facets that meet at an edge along the y axis at that angle, in radians, and what closes the wedge between them.
Plc<3> wedge(double angle) {
  Plc<3> plc;
  const double s = std::tan(angle);
  for (const double y : {0.0, 1.0})
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, s}}) plc.points.push_back({x, y, z});
  plc.facets = {
      {{{0, 1, 2}}, {}, 0}, {{{3, 4, 5}}, {}, 0}, {{{0, 1, 4, 3}}, {}, 0}, {{{0, 2, 5, 3}}, {}, 0}, {{{1, 2, 5, 4}}, {}, 0}};
  return plc;
}

TEST(LeastAngle, OfAWedgeIsThatOfItsFacets) {
  for (const double degrees : {30.0, 1.0, 1e-3, 6e-6}) {
    const Domain<3> domain(wedge(degrees * std::acos(-1) / 180));
    const auto angle = least_angle(domain);
    ASSERT_TRUE(angle);
    EXPECT_NEAR(angle->degrees, degrees, 1e-6 * degrees);
  }
  EXPECT_NEAR(least_angle(Domain<3>(turned(box())))->degrees, 90, 1e-9);
}

TEST(LeastAngle, OfSegmentsInThePlane) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1e-3}}};
  plc.segments = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 0}, 0}};
  const auto angle = least_angle(Domain<2>(plc));
  ASSERT_TRUE(angle);
  EXPECT_NEAR(angle->degrees, 0.0573, 1e-4);
  EXPECT_EQ(angle->point, (Point2{{0, 0}}));
}

Plc<3> slab(double thickness) {
  Plc<3> plc = box();
  for (Point3& p : plc.points) p = {p[0] / 2, p[1], p[2] / 3 * thickness};
  return plc;
}

/// Of squares of side 1, by their thickness: the tetrahedra that `pgdr mesh` makes with its default bounds.
TEST(Estimate, OfSlabs) {
  for (const auto& [thickness, cells] : {std::pair{1.0, 6.0}, {0.1, 211.0}, {0.05, 1245.0}, {0.02, 7710.0}})
    for (const Plc<3>& plc : {slab(thickness), turned(slab(thickness)), triangulated(slab(thickness))}) {
      const CellEstimate<3> e = estimate(plc);
      EXPECT_GE(e.cells, 3) << thickness;  // 12 triangles, four a cell
      EXPECT_LE(e.cells, cells) << thickness;
      EXPECT_LE(e.at_least, e.cells) << thickness;
      EXPECT_TRUE(thickness >= 0.1 || e.at_least > cells / 50) << thickness;
    }
}

/// Layers as thin as those of printed circuits: what takes days to count.
TEST(Estimate, OfVeryThinSlabs) {
  for (const double thickness : {1e-3, 1e-5, 1e-7})
    for (const double angle : {0.0, 0.1, 0.7, 1.3}) {
      const double expected = 3.1 / (thickness * thickness);  // as of those that are not so thin
      const CellEstimate<3> e = estimate(angle > 0 ? turned(slab(thickness), angle) : slab(thickness));
      EXPECT_LT(e.at_least, expected);
      EXPECT_GT(e.at_least, expected / 50);
      EXPECT_EQ(e.cells, e.at_least);
      ASSERT_TRUE(e.most_due_to);
      EXPECT_NEAR(e.most_due_to->distance, thickness, 1e-9 * thickness + 1e-15);
    }
}

/// A cube with a small cube in its middle, each of whose 12 triangles has two sides, or one where it is taken out: then there are
/// some 70 tetrahedra more for each halving of that.
TEST(Estimate, OfASmallVoid) {
  for (const auto& [side, cells] : {std::pair{0.1, 196.0}, {0.01, 528.0}, {0.001, 761.0}, {0.0001, 973.0}}) {
    Plc<3> plc = slab(1);
    for (const Point3& p : slab(1).points)
      plc.points.push_back({0.5 + side * (p[0] - 0.5), 0.5 + side * (p[1] - 0.5), 0.5 + side * (p[2] - 0.5)});
    for (auto facet : slab(1).facets) {
      for (std::uint32_t& v : facet.polygons[0]) v += 8;
      plc.facets.push_back(facet);
    }
    EXPECT_EQ(std::max(estimate(plc).at_least, 9.0), estimate(plc).cells) << side;
    plc.holes = {{0.5, 0.5, 0.5}};
    EXPECT_EQ(std::max(estimate(plc).at_least, 6.0), estimate(plc).cells) << side;
    EXPECT_LE(estimate(plc).cells, cells) << side;
  }
}

TEST(Estimate, OfRectangles) {
  for (const auto& [height, cells] : {std::pair{0.1, 8.0}, {0.01, 128.0}, {0.001, 1024.0}}) {
    Plc<2> plc;
    plc.points = {{{0, 0}}, {{1, 0}}, {{1, height}}, {{0, height}}};
    for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
    const CellEstimate<2> e = estimate(plc);
    EXPECT_GT(e.cells, cells / 30) << height;
    EXPECT_LE(e.cells, cells) << height;
    EXPECT_LE(e.at_least, e.cells) << height;
  }
}

TEST(Estimate, CountsSizes) {
  const Domain<3> domain{slab(1)};
  for (const double volume : {1e-3, 1e-6, 1e-9}) {
    EstimateOptions<3> options;
    options.measure = [&](const Point3&, double) { return volume; };
    const CellEstimate<3> e = estimate_cells(domain, options);
    EXPECT_NEAR(e.cells * volume, 1, 1e-9);
    EXPECT_LE(e.at_least, 6);  // sizes do not count
    options.measure = [&](const Point3& p, double) { return p[0] < 0.125 ? volume : infinity; };
    EXPECT_NEAR(estimate_cells(domain, options).cells * volume, 0.125, 0.02);
    options.measure = [&](const Point3& p, double) { return volume / p[0]; };  // the integral of x is 1/2
    EXPECT_NEAR(estimate_cells(domain, options).cells * volume, 0.5, 0.02);
  }
}

/// A plate so thin that no place of a grid is in it, oblique in a box that is larger than it.
TEST(Estimate, CountsSizesInWhatIsThin) {
  EstimateOptions<3> options;
  options.radius_edge_bound = infinity;
  options.measure = [&](const Point3&, double) { return 1e-12; };
  EXPECT_NEAR(estimate_cells<3>(Domain<3>(turned(slab(1e-7), 0.5)), options).cells * 1e-5, 1, 1e-6);
}

/// Two boxes with a face in common, and a size for one of them.
TEST(Estimate, CountsSizesOfRegions) {
  Plc<3> plc = box();
  for (const double y : {0.0, 1.0})
    for (const double x : {0.0, 2.0}) plc.points.push_back({x, y, 1});
  plc.facets.push_back({{{8, 9, 11, 10}}, {}, 0});  // cuts off a third
  plc.regions = {{{{1, 0.5, 0.5}}, 7, 1e-5}, {{{1, 0.5, 2}}, 8, 0}};
  EXPECT_NEAR(estimate(plc).cells * 1e-5, 2, 1e-9);
  const Domain<3> domain(plc);
  EstimateOptions<3> options;
  options.measure = [](const Point3&, double label) { return label == 8 ? 1e-6 : infinity; };
  EXPECT_NEAR(estimate_cells(domain, options).cells * 1e-6, 4 + 0.1 * 2, 1e-9);
}

/// Outside of the input there are no cells.
TEST(Estimate, LeavesOutWhatIsOutside) {
  Plc<3> plc;  // a regular tetrahedron in every other corner of the cube: a third of it
  plc.points = {{{0, 0, 0}}, {{1, 1, 0}}, {{1, 0, 1}}, {{0, 1, 1}}};
  plc.facets = {{{{0, 1, 2}}, {}, 0}, {{{0, 1, 3}}, {}, 0}, {{{0, 2, 3}}, {}, 0}, {{{1, 2, 3}}, {}, 0}};
  EstimateOptions<3> options;
  options.measure = [](const Point3&, double) { return 1e-7; };
  EXPECT_NEAR(estimate_cells<3>(Domain<3>(plc), options).cells * 1e-7, 1.0 / 3, 1e-9);
}

/// One after the other, the last first.
class LastFirst final : public detail::Pieces {
 public:
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    for (std::size_t i = count; i-- > 0;) piece(i);
  }
  bool is_parallel() const override { return false; }
};

// Whoever runs the pieces, and in whatever order.
TEST(Estimate, DoesNotDependOnTheOrderOfPieces) {
  const Plc<3> plc = turned(two_boxes(0.01));
  EstimateOptions<3> options;
  options.measure = [](const Point3& x, double) { return 1e-4 * (1 + x[0] * x[0]); };
  const Domain<3> domain(plc);
  const auto gap = narrowest_gap(domain);
  const auto angle = least_angle(domain);
  const CellEstimate<3> expected = estimate_cells(domain, options);
  const LastFirst pieces;
  const detail::PiecesHere here(pieces);
  const Domain<3> again(plc);
  EXPECT_EQ(again.facets().size(), domain.facets().size());
  EXPECT_EQ(narrowest_gap(again)->points, gap->points);
  EXPECT_EQ(least_angle(again)->entities, angle->entities);
  EXPECT_EQ(estimate_cells(again, options).cells, expected.cells);
  EXPECT_EQ(estimate_cells(again, options).at_least, expected.at_least);
}

TEST(Estimate, IsTheSameAgain) {
  const Plc<3> plc = turned(two_boxes(0.01));
  EXPECT_EQ(estimate(plc).cells, estimate(plc).cells);
  Plc<3> scaled = plc;
  for (Point3& p : scaled.points)
    for (double& x : p.x) x *= 0x1p-200;
  EXPECT_EQ(estimate(plc).cells, estimate(scaled).cells);
}

}  // namespace pgdr::test_diagnose_estimate
