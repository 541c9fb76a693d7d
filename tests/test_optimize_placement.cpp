// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Places of vertices: the terms of the measure and their gradients, stars made by hand, and the stars of poor cells of a mesh.
#include "optimize/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "refined_models.hpp"

namespace pgdr::test_optimize_placement {

CellBounds<3> bounds_of(double ratio, double size = INFINITY, double volume = INFINITY) {
  CellBounds<3> bounds;
  bounds.radius_edge_bound = ratio;
  if (std::isfinite(size)) bounds.size = SizingField<3>(size);
  bounds.max_measure = volume;
  return bounds;
}

double det_of(const Simplex<3>& s) {
  using detail::difference;
  return detail::dot(difference<3>(s[1], s[0]), detail::cross(difference<3>(s[2], s[0]), difference<3>(s[3], s[0])));
}

double worst_of(const Star& star, const CellQuality& quality, const Point3& x) {
  double least = 1;
  for (const auto& c : star.cells) least = std::min(least, quality.of({c.base[0], c.base[1], c.base[2], x}, c.region));
  return least;
}

/// The faces of a convex body about the origin, with the vertex at `x`.
Star star_in(const Plc<3>& body, const Point3& x) {
  Star star;
  star.vertex = x;
  for (const auto& facet : body.facets) {
    const auto& f = facet.polygons[0];
    Star::Cell cell{{body.points[f[0]], body.points[f[1]], body.points[f[2]]}, 0};
    if (det_of({cell.base[0], cell.base[1], cell.base[2], Point3{{0, 0, 0}}}) < 0) std::swap(cell.base[0], cell.base[1]);
    star.cells.push_back(cell);
  }
  return star;
}

Point3 scaled(const Point3& p, double by) { return {{p[0] * by, p[1] * by, p[2] * by}}; }

Star scaled(Star star, double by) {
  for (auto& c : star.cells)
    for (Point3& p : c.base) p = scaled(p, by);
  star.vertex = scaled(star.vertex, by);
  return star;
}

TEST(CellQualityTerms, TheirLeastIsTheQualityAndTheirGradientsAreDifferences) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const CellBounds<3> bounds = bounds_of(2, 0.1, 0.01);
  const CellQuality quality(bounds, 15);
  std::vector<CellQuality::Term> terms, up, down;
  int looked_at = 0;
  for (int round = 0; round < 2000; ++round) {
    Simplex<3> s;
    for (Point3& p : s)
      for (double& x : p.x) x = coordinate(random);
    if (det_of(s) < 0) std::swap(s[0], s[1]);
    if (det_of(s) < 1e-2) continue;
    terms.clear();
    quality.append_terms(s, 0, INFINITY, terms);
    ASSERT_EQ(terms.size(), 9u);
    double least = 1;
    for (const auto& t : terms) least = std::min(least, t.value);
    EXPECT_NEAR(quality.of(s, 0), least, 1e-8 * least);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double h = 1e-7;
      Simplex<3> a = s, b = s;
      a[3][axis] += h;
      b[3][axis] -= h;
      up.clear();
      down.clear();
      quality.append_terms(a, 0, INFINITY, up);
      quality.append_terms(b, 0, INFINITY, down);
      for (std::size_t i = 0; i < terms.size(); ++i) {
        const double slope = (up[i].value - down[i].value) / (2 * h),
                     steepest = std::sqrt(detail::dot(terms[i].gradient, terms[i].gradient));
        // Where a term has a kink within the step (an angle of 90 degrees, another shortest edge) the two sides differ.
        const double left = (terms[i].value - down[i].value) / h, right = (up[i].value - terms[i].value) / h;
        if (std::fabs(left - right) > 1e-3 * (1 + steepest)) continue;
        EXPECT_NEAR(terms[i].gradient[static_cast<std::size_t>(axis)], slope, 1e-3 * (steepest + terms[i].value)) << i;
        ++looked_at;
      }
    }
  }
  EXPECT_GT(looked_at, 20000);
}

TEST(CellQualityTerms, OfShare) {
  const CellBounds<3> bounds = bounds_of(2);
  const CellQuality quality(bounds, 15);
  const Simplex<3> s{Point3{{0, 0, 0}}, Point3{{1, 0, 0}}, Point3{{0, 1, 0}}, Point3{{0.3, 0.3, 0.1}}};
  std::vector<CellQuality::Term> all, some;
  quality.append_terms(s, 0, INFINITY, all);
  quality.append_terms(s, 0, 1.5, some);
  double least = INFINITY;
  for (const auto& t : all) least = std::min(least, t.value);
  std::size_t expected = 0;
  for (const auto& t : all) expected += t.value <= 1.5 * least ? 1 : 0;
  EXPECT_EQ(some.size(), expected);
  EXPECT_LT(expected, all.size());
  EXPECT_GT(expected, 0u);
  some.clear();
  quality.append_terms({s[1], s[0], s[2], s[3]}, 0, INFINITY, some);
  EXPECT_TRUE(some.empty()) << "turned over";
}

/// The best place is the centre, where all cells are alike, whatever is measured. The bounds are such that the quality there is
/// not cut off at 1.
TEST(Placement, InAnIcosahedronIsItsCentre) {
  for (const CellBounds<3>& bounds : {bounds_of(0.3), bounds_of(2, 0.4), bounds_of(2, INFINITY, 0.05)}) {
    const CellQuality quality(bounds, 59);
    const double best = worst_of(star_in(test::icosphere(0), {}), quality, {});
    ASSERT_LT(best, 0.9);
    for (const Point3 x : {Point3{{0.5, 0.2, -0.1}}, Point3{{-0.3, 0.55, 0.2}}, Point3{{0.05, 0, 0}}}) {
      const Star star = star_in(test::icosphere(0), x);
      ASSERT_EQ(star.cells.size(), 20u);
      Placement placement;
      const auto place = placement.find(star, quality);
      ASSERT_TRUE(place);
      EXPECT_LT(std::sqrt(squared_distance<3>(*place, {})), 0.01);
      EXPECT_GT(placement.least_quality(), 0.99 * best);
      EXPECT_EQ(placement.least_quality(), worst_of(star, quality, *place));
    }
  }
}

TEST(Placement, EndsWhereAllAreWithinTheBounds) {
  const CellBounds<3> bounds = bounds_of(2);
  const CellQuality quality(bounds, 20);
  Placement placement;
  EXPECT_FALSE(placement.find(star_in(test::icosphere(0), {{0.1, 0.1, 0}}), quality)) << "nothing to do";
  const auto place = placement.find(star_in(test::icosphere(0), {{0.6, 0.2, -0.1}}), quality);
  ASSERT_TRUE(place);
  EXPECT_EQ(placement.least_quality(), 1);
  EXPECT_GT(squared_distance<3>(*place, {}), 0.01) << "no farther than need be";
}

/// There it is as good as the best of many places.
TEST(Placement, StaysInItsPlaneOrOnItsLine) {
  const CellBounds<3> bounds = bounds_of(0.3);
  const CellQuality quality(bounds, 59);
  Star star = star_in(test::icosphere(0), {{0.4, 0.2, 0.25}});
  double best_in_plane = 0, best_on_line = 0;
  constexpr int steps = 100;
  for (int i = -steps; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    best_on_line = std::max(best_on_line, worst_of(star, quality, {{x, 0.2, 0.25}}));
    for (int j = -steps; j <= steps; ++j)
      best_in_plane = std::max(best_in_plane, worst_of(star, quality, {{x, static_cast<double>(j) / steps, 0.25}}));
  }
  ASSERT_GT(best_in_plane, best_on_line);
  Placement placement;
  star.freedom = 2;
  star.axis = {0, 0, 1};
  auto place = placement.find(star, quality);
  ASSERT_TRUE(place);
  EXPECT_EQ((*place)[2], 0.25);
  EXPECT_GT(placement.least_quality(), 0.995 * best_in_plane);
  star.freedom = 1;
  star.axis = {1, 0, 0};
  place = placement.find(star, quality);
  ASSERT_TRUE(place);
  EXPECT_EQ((*place)[1], 0.2);
  EXPECT_EQ((*place)[2], 0.25);
  EXPECT_GT(placement.least_quality(), 0.995 * best_on_line);
}

/// Points that it returns are ones that onto_entity returned, and measured there.
TEST(Placement, IsBroughtOntoItsEntity) {
  const CellBounds<3> bounds = bounds_of(2);
  const CellQuality quality(bounds, 59);
  Star star = star_in(test::icosphere(0), {{0.4, 0.2, 0.25}});
  star.freedom = 2;
  star.axis = {0, 0, 1};
  constexpr double grid = 1.0 / 64;
  star.onto_entity = [](const Point3& p) {
    return Point3{{std::floor(p[0] / grid) * grid, std::floor(p[1] / grid) * grid, 0.25}};
  };
  Placement placement;
  const auto place = placement.find(star, quality);
  ASSERT_TRUE(place);
  EXPECT_EQ(star.onto_entity(*place), *place);
  EXPECT_EQ(placement.least_quality(), worst_of(star, quality, *place));
  star.onto_entity = [&star](const Point3&) { return star.vertex; };
  EXPECT_FALSE(placement.find(star, quality)) << "no way to go";
}

/// The vertex begins in the plane of a face, or beyond it: cells are flat or turned over, and are not when it ends.
TEST(Placement, GetsCellsOffZero) {
  const CellBounds<3> bounds = bounds_of(2);
  const CellQuality quality(bounds, 15);
  const Plc<3> body = test::icosphere(0);
  const auto& f = body.facets[3].polygons[0];
  Point3 centre;
  for (int i = 0; i < 3; ++i) centre[i] = (body.points[f[0]][i] + body.points[f[1]][i] + body.points[f[2]][i]) / 3;
  for (const double by : {1.0, 1.0001, 1.5}) {
    const Star star = star_in(body, scaled(centre, by));
    ASSERT_LT(worst_of(star, quality, star.vertex), 1e-9);
    Placement placement;
    const auto place = placement.find(star, quality);
    ASSERT_TRUE(place);
    EXPECT_EQ(worst_of(star, quality, *place), 1);
  }
}

/// Two cells over the two sides of one triangle: whatever is done, one of them is turned over.
TEST(Placement, ThereIsNoneInAStarWithoutInside) {
  const CellBounds<3> bounds = bounds_of(2);
  const CellQuality quality(bounds, 15);
  const Point3 a{{0, 0, 0}}, b{{1, 0, 0}}, c{{0, 1, 0}};
  Star star;
  star.cells = {{{a, b, c}, 0}, {{b, a, c}, 0}};
  for (const double z : {0.0, 1e-20, 0.3}) {
    star.vertex = {{0.2, 0.2, z}};
    EXPECT_FALSE(Placement().find(star, quality));
  }
  star.cells.clear();
  EXPECT_FALSE(Placement().find(star, quality)) << "no cells at all";
  star.cells = {{{a, b, b}, 0}};
  EXPECT_FALSE(Placement().find(star, quality)) << "no base";
}

TEST(Placement, ScalesByPowersOfTwo) {
  const CellBounds<3> bounds = bounds_of(2, 3, 0.4);
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> coordinate(-0.7, 0.7);
  int found = 0;
  for (int round = 0; round < 50; ++round) {
    Star star = star_in(test::icosphere(round % 2), {{coordinate(random), coordinate(random), coordinate(random)}});
    star.freedom = 1 + round % 3;
    star.axis = {0.6, 0, 0.8};
    Placement placement;
    const auto place = placement.find(star, CellQuality(bounds, 40));
    const double least = placement.least_quality();
    found += place ? 1 : 0;
    for (const int exponent : {20, -30, -100}) {
      const double by = std::ldexp(1.0, exponent);
      const CellBounds<3> scaled_bounds = bounds_of(2, 3 * by, 0.4 * by * by * by);
      const auto of_scaled = placement.find(scaled(star, by), CellQuality(scaled_bounds, 40));
      ASSERT_EQ(place.has_value(), of_scaled.has_value());
      if (!place) continue;
      EXPECT_EQ(scaled(*place, by), *of_scaled);
      EXPECT_EQ(placement.least_quality(), least);
    }
  }
  EXPECT_GT(found, 25);
}

/// The vertices of a mesh with the cells at them and what they lie on.
class Stars {
 public:
  explicit Stars(const OutputMesh<3>& mesh)
      : mesh_(mesh), at_(mesh.points.size()), facets_(mesh.points.size()), segments_(mesh.points.size()) {
    for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
      for (const auto v : mesh.cells[c]) at_[v].push_back(c);
    for (std::uint32_t i = 0; i < mesh.subfacets.size(); ++i)
      for (const auto v : mesh.subfacets[i].vertices) facets_[v].emplace(mesh.subfacets[i].entity, i);
    for (std::uint32_t i = 0; i < mesh.subsegments.size(); ++i)
      for (const auto v : mesh.subsegments[i].vertices) segments_[v].emplace(mesh.subsegments[i].entity, i);
  }
  Simplex<3> simplex(std::size_t c) const {
    Simplex<3> s;
    for (std::size_t i = 0; i < 4; ++i) s[i] = mesh_.points[mesh_.cells[c][i]];
    return s;
  }
  /// None of a vertex that cannot move.
  std::optional<Star> of(std::uint32_t v) const {
    Star star;
    star.vertex = mesh_.points[v];
    star.freedom = v < mesh_.input_points ? 0 : !segments_[v].empty() ? 1 : !facets_[v].empty() ? 2 : 3;
    if (star.freedom == 0) return std::nullopt;
    using detail::difference;
    if (star.freedom == 1) {
      const auto& ends = mesh_.subsegments[segments_[v].begin()->second].vertices;
      star.axis = difference<3>(mesh_.points[ends[1]], mesh_.points[ends[0]]);
    } else if (star.freedom == 2) {
      const auto& t = mesh_.subfacets[facets_[v].begin()->second].vertices;
      star.axis = detail::cross(difference<3>(mesh_.points[t[1]], mesh_.points[t[0]]),
                                difference<3>(mesh_.points[t[2]], mesh_.points[t[0]]));
    }
    const double length = std::sqrt(detail::dot(star.axis, star.axis));
    for (double& x : star.axis) x = star.freedom == 3 ? 0 : x / length;
    for (const std::uint32_t c : at_[v]) {
      const int k = corner_of(mesh_.cells[c], v);
      const auto& f = face_corners<3>[static_cast<std::size_t>(k)];
      const Simplex<3> s = simplex(c);
      star.cells.push_back({{s[f[0]], s[f[1]], s[f[2]]}, 0});
    }
    return star;
  }

 private:
  const OutputMesh<3>& mesh_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<std::map<EntityId, std::uint32_t>> facets_, segments_;
};

/// On the stars of the poor cells of a cube: never worse, mostly better, for an effort of a few times the star. For the figures
/// see the properties in the XML output.
TEST(Placement, OfPoorCellsOfACube) {
  RefineOptions<3> options;
  options.size = 0.08;
  options.min_dihedral = 0;  // poor cells are wanted
  const auto result = refine<3>(Domain<3>(test::cube()), options);
  const Stars stars(result.mesh);
  const CellBounds<3> bounds = bounds_of(2, 0.08);
  const CellQuality quality(bounds, 15);
  std::set<std::uint32_t> vertices;
  for (std::size_t c = 0; c < result.mesh.cells.size(); ++c)
    if (quality.of(stars.simplex(c), 0) < 1) vertices.insert(result.mesh.cells[c].begin(), result.mesh.cells[c].end());
  int calls = 0, better = 0, done = 0;
  std::uint64_t evaluated = 0, cells = 0;
  Placement placement;
  for (const std::uint32_t v : vertices) {
    const auto star = stars.of(v);
    if (!star) continue;
    const double before = worst_of(*star, quality, star->vertex);
    const std::uint64_t from = quality.evaluated();
    const auto place = placement.find(*star, quality);
    evaluated += quality.evaluated() - from;
    cells += star->cells.size();
    ++calls;
    if (!place) continue;
    ++better;
    done += placement.least_quality() == 1 ? 1 : 0;
    EXPECT_GT(placement.least_quality(), before);
    EXPECT_EQ(placement.least_quality(), worst_of(*star, quality, *place));
    for (const auto& c : star->cells) EXPECT_EQ(orient<3>({c.base[0], c.base[1], c.base[2], *place}), Sign::positive);
    const auto gone = detail::difference<3>(*place, star->vertex);
    const double along = detail::dot(gone, star->axis), length2 = detail::dot(gone, gone);
    const double expected = star->freedom == 2 ? 0 : star->freedom == 1 ? length2 : along * along;
    EXPECT_NEAR(along * along, expected, 1e-12);
  }
  ASSERT_GT(calls, 200);
  EXPECT_GT(better, 0.9 * calls);
  EXPECT_GT(done, calls / 2);
  EXPECT_LT(static_cast<double>(evaluated), 7.0 * static_cast<double>(cells));
  RecordProperty("calls", calls);
  RecordProperty("better", better);
  RecordProperty("done", done);
  RecordProperty("evaluated", static_cast<int>(evaluated));
  RecordProperty("cells", static_cast<int>(cells));
}

}  // namespace pgdr::test_optimize_placement
