// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Distances shown by heights over a plane, against samples that look at every triangle.
#include "replace/height_proof.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "model_plcs.hpp"
#include "pgdr/surface.hpp"
#include "replace/complex.hpp"
#include "space/distances.hpp"
#include "surface_distances.hpp"

namespace pgdr::test_replace_height_proof {

using Triangle = std::array<Point3, 3>;
using detail::closest_to_triangle;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  std::size_t index(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }
  Point3 on(const Triangle& t) {
    double u = number(0, 1), v = number(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = u * t[0][i] + v * t[1][i] + (1 - u - v) * t[2][i];
    return p;
  }

 private:
  std::mt19937_64 engine_;
};

/// The height of a triangle over a point of the plane z = 0; none if that is not below it.
std::optional<double> height_over(const Triangle& t, double x, double y) {
  const auto area = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
  const double all = area(t[1][0] - t[0][0], t[1][1] - t[0][1], t[2][0] - t[0][0], t[2][1] - t[0][1]);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
    const double weight = area(a[0] - x, a[1] - y, b[0] - x, b[1] - y) / all;
    if (!(weight > 0)) return {};
    sum += weight * t[i][2];
  }
  return sum;
}

TEST(Overlay, HeightsDifferMostAtItsCorners) {
  Random random(1);
  const detail::Projection plane({{0, 0, 0}}, {0, 0, 1}, 1, 0.5);
  ASSERT_TRUE(plane.is_one());
  int met = 0;
  for (int k = 0; k < 2000; ++k) {
    // On a small grid, so that corners and edges coincide; heights are anything.
    const auto triangle = [&](int n) {
      Triangle t;
      for (Point3& p : t) p = {{double(random.index(n)) / n, double(random.index(n)) / n, random.number(-0.3, 0.3)}};
      return t;
    };
    const int n = k % 2 == 0 ? 4 : 1000;
    const Triangle a = triangle(n), b = triangle(n);
    const auto first = plane.raised(a), second = plane.raised(b);
    if (first.way == 0 || second.way == 0) continue;
    const detail::Overlay o = overlay(first, second), other = overlay(second, first);
    EXPECT_EQ(o.is_any, other.is_any);
    EXPECT_EQ(o.edges_of_first, other.edges_of_second);
    double most = 0;
    bool any = false;
    for (int s = 0; s < 300; ++s) {
      const Point3 p = random.on(s % 2 == 0 ? a : b);
      const auto h = height_over(a, p[0], p[1]), g = height_over(b, p[0], p[1]);
      if (!h || !g) continue;
      any = true;
      most = std::max(most, std::fabs(*h - *g));
    }
    EXPECT_TRUE(!any || o.is_any);
    if (!o.is_any || !o.is_clear) continue;
    ++met;
    const double unit = plane.most_apart() / 0.5;
    EXPECT_GE(o.apart, most * unit * 0.999);
    EXPECT_NEAR(o.apart, other.apart, 1e-9);
    // It is so far apart somewhere: at a point of the first one that is over the second one, but for rounding.
    Point3 where;
    for (std::size_t c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i) where[i] += o.where[c] * a[c][i];
    EXPECT_LE(
        closest_to_triangle({{where[0], where[1], 0}}, {{b[0][0], b[0][1], 0}}, {{b[1][0], b[1][1], 0}}, {{b[2][0], b[2][1], 0}})
            .square,
        1e-18);
  }
  EXPECT_GT(met, 500);
}

/// A rough hill over a grid, and below one of its sides a wall, which has no area in the projection.
Plc<3> hill(Random& random, int n, double height, double roughness) {
  Plc<3> plc;
  const auto number = [n](int i, int j) { return static_cast<test::Index>(j * (n + 1) + i); };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = double(i) / n, y = double(j) / n;
      plc.points.push_back({{x, y, height * std::sin(3 * x) * std::cos(2 * y) + random.number(-roughness, roughness)}});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      test::add_polygon(plc, {number(i, j), number(i + 1, j), number(i + 1, j + 1)}, 1);
      test::add_polygon(plc, {number(i, j), number(i + 1, j + 1), number(i, j + 1)}, 1);
    }
  const auto foot = static_cast<test::Index>(plc.points.size());
  for (int i = 0; i <= n; ++i) plc.points.push_back({{double(i) / n, 0, -1}});
  for (int i = 0; i < n; ++i) {
    const auto below = static_cast<test::Index>(foot + i);
    test::add_polygon(plc, {number(i, 0), below, number(i + 1, 0)}, 1);
    test::add_polygon(plc, {number(i + 1, 0), below, below + 1}, 1);
  }
  return plc;
}

detail::ChangingSurface surface_of(const Plc<3>& plc, double e) {
  const Domain<3> domain(plc);
  detail::LoosePieces loose;
  std::uint64_t creases = 0;
  SurfaceOptions options;
  options.tolerance = e;
  auto complex = detail::make_complex(plc, domain, e, options, loose, creases);
  return {std::move(complex), std::move(loose), {}};
}

double distance_to(const Point3& p, const std::vector<Triangle>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : all) least = std::min(least, closest_to_triangle(p, t[0], t[1], t[2]).square);
  return std::sqrt(least);
}

/// Puts vertices into neighbours, as far as is shown; what is shown holds of samples.
void contract_some(std::uint64_t seed, bool is_flat, double e, std::array<int, 4>& counts) {
  Random random(seed);
  const Plc<3> plc = hill(random, 10, is_flat ? 0 : 0.3, is_flat ? 0 : 0.02);
  detail::ChangingSurface s = surface_of(plc, e);
  std::vector<Triangle> given;
  for (const auto& t : s.given.triangles()) given.push_back(t.corners);
  for (int trial = 0; trial < 150; ++trial) {
    const auto u = static_cast<std::uint32_t>(random.index(s.complex.points.size()));
    if (s.complex.faces_at[u].empty()) continue;
    const auto near = s.complex.neighbours(u);
    const std::uint32_t v = near[random.index(near.size())];
    if (!detail::is_contractible(s.complex, u, v)) continue;
    const auto change = detail::contraction(s.complex, u, v, s.complex.at(v));
    if (!change) continue;
    detail::Box<3> box = detail::Box<3>::empty();
    for (const std::uint32_t f : change->gone) box.add(detail::Box<3>::of(s.complex.triangle(f)).widened(e));
    std::vector<detail::NearGiven> close;
    s.given.triangles_meeting(box.widened(1), [&](std::uint32_t g, const detail::Box<3>& b) { close.push_back({g, b}); });
    detail::HeightProof proof(s, *change, e, close, box);
    std::vector<Triangle> after;
    for (std::uint32_t f = 0; f < s.complex.faces.size(); ++f)
      if (s.complex.faces[f].alive && !change->is_gone(f)) after.push_back(s.complex.triangle(f));
    bool are_shown = true;
    for (std::size_t k = 0; k < change->come.size(); ++k) {
      const Triangle t = triangle_after(s.complex, *change, change->come[k]);
      after.push_back(t);
      const bool is_shown = proof.shows_face(k);
      are_shown = are_shown && is_shown;
      ++counts[is_shown];
      if (!is_shown) continue;
      for (int i = 0; i < 20; ++i) EXPECT_LE(distance_to(random.on(t), given), e);
    }
    for (std::size_t place = 0; place < close.size(); ++place) {
      bool is_asked = false;
      for (std::size_t k = 0; k < change->gone.size(); ++k) is_asked = is_asked || proof.may_be_near(k, place);
      const Triangle& t = given[close[place].number];
      std::vector<Triangle> gone;
      for (const std::uint32_t f : change->gone) gone.push_back(s.complex.triangle(f));
      const bool is_shown = is_asked && proof.shows_given(place);
      are_shown = are_shown && (is_shown || !is_asked);
      counts[2 + is_shown] += is_asked;
      for (int i = 0; i < 20; ++i) {
        const Point3 p = random.on(t);
        EXPECT_TRUE(is_asked || distance_to(p, gone) > e);
        EXPECT_TRUE(!is_shown || !box.meets(detail::Box<3>::around(p)) || distance_to(p, after) <= e);
      }
    }
    if (!are_shown) continue;
    for (const std::uint32_t f : change->gone) {
      s.complex.remove_face(f);
      s.boxes.change(f, detail::Box<3>::empty());
    }
    for (std::size_t k = 0; k < change->come.size(); ++k) {
      const std::uint32_t f = s.complex.add_face(change->come[k]);
      s.boxes.add(detail::Box<3>::of(s.complex.triangle(f)), change->from[k]);
    }
  }
}

TEST(HeightProof, YesIsAProof) {
  std::array<int, 4> counts{};
  for (std::uint64_t seed = 0; seed < 8; ++seed) contract_some(seed, seed > 5, seed % 2 == 0 ? 0.03 : 0.08, counts);
  for (const int count : counts) EXPECT_GT(count, 100);  // both answers come
}

/// A ball of meridians, all of whose faces at a pole may go with one change: more than are looked at over a plane.
TEST(HeightProof, PolesOfManyFaces) {
  constexpr int meridians = 70, rings = 8;
  Plc<3> plc;
  plc.points = {{{0, 0, 1}}, {{0, 0, -1}}};
  for (int j = 1; j < rings; ++j)
    for (int i = 0; i < meridians; ++i) {
      const double polar = j * std::numbers::pi / rings, along = 2 * i * std::numbers::pi / meridians;
      plc.points.push_back({{std::sin(polar) * std::cos(along), std::sin(polar) * std::sin(along), std::cos(polar)}});
    }
  const auto number = [](int j, int i) { return static_cast<test::Index>(2 + (j - 1) * meridians + i % meridians); };
  for (int i = 0; i < meridians; ++i) {
    test::add_polygon(plc, {0, number(1, i), number(1, i + 1)});
    test::add_polygon(plc, {1, number(rings - 1, i + 1), number(rings - 1, i)});
    for (int j = 1; j + 1 < rings; ++j) {
      test::add_polygon(plc, {number(j, i), number(j + 1, i), number(j + 1, i + 1)});
      test::add_polygon(plc, {number(j, i), number(j + 1, i + 1), number(j, i + 1)});
    }
  }
  SurfaceOptions options;
  options.tolerance = 0.05;
  const ReplacedSurface out = replace_surface(plc, options);
  EXPECT_LT(out.report.triangles[1], plc.facets.size() / 5);
  EXPECT_EQ(out.report.sharp_triangles[1], 0u);
  EXPECT_LE(test::sampled_distance(out.plc, plc, 2), options.tolerance);
  EXPECT_LE(test::sampled_distance(plc, out.plc, 2), options.tolerance);
}

}  // namespace pgdr::test_replace_height_proof
