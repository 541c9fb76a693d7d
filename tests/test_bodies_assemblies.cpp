// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies that cross: random boxes, prisms and spheres, resolved and told by winding numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "pgdr/bodies.hpp"
#include "pgdr/diagnosis.hpp"
#include "structure_plcs.hpp"

namespace pgdr {
namespace {

using Volumes = std::map<std::vector<std::uint32_t>, double>;

double number(std::mt19937& chance, double low, double high) {
  return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(chance);
}

struct Box {
  Point3 low, high;
};

Box random_box(std::mt19937& chance) {
  Box b;
  for (int i = 0; i < 3; ++i) {
    b.low[i] = number(chance, 0, 0.7);
    b.high[i] = b.low[i] + number(chance, 0.1, 0.6);
  }
  return b;
}

void append_body(Plc<3>& plc, const Plc<3>& body) {
  const std::uint32_t number = plc.facet_bodies.empty() ? 0 : plc.facet_bodies.back() + 1;
  test::append(plc, body, 1, {});
  plc.facet_bodies.resize(plc.facets.size(), number);
}

Plc<3> prism(std::mt19937& chance) {
  const auto n = static_cast<std::uint32_t>(number(chance, 3, 9));
  const Point3 at{{number(chance, 0, 1), number(chance, 0, 1), number(chance, 0, 1)}};
  const double radius = number(chance, 0.1, 0.4), height = number(chance, 0.1, 0.8), lean = number(chance, -0.3, 0.3);
  Plc<3> plc;
  for (const int top : {0, 1})
    for (std::uint32_t k = 0; k < n; ++k) {
      const double angle = 2 * 3.14159265358979323846 * k / n;
      plc.points.push_back(
          {{at[0] + radius * std::cos(angle) + lean * top, at[1] + radius * std::sin(angle), at[2] + height * top}});
    }
  std::vector<std::uint32_t> below, above;
  for (std::uint32_t k = 0; k < n; ++k) {
    below.push_back(n - 1 - k);
    above.push_back(n + k);
    // Its sides lean: two triangles each.
    const std::uint32_t l = (k + 1) % n;
    plc.facets.push_back({{{k, l, n + l}}, {}, 0});
    plc.facets.push_back({{{k, n + l, n + k}}, {}, 0});
  }
  plc.facets.push_back({{below}, {}, 0});
  plc.facets.push_back({{above}, {}, 0});
  return plc;
}

Plc<3> sphere(std::mt19937& chance) {
  Plc<3> plc;
  test::append(plc, test::icosphere(1), number(chance, 0.1, 0.5),
               {{number(chance, 0, 1), number(chance, 0, 1), number(chance, 0, 1)}});
  return plc;
}

WithBodies resolved(const Plc<3>& plc, BodyMode mode) {
  BodyOptions options;
  options.resolve_crossings = true;
  WithBodies made = with_bodies(plc, mode, options);
  EXPECT_NO_THROW(require_no_errors(Domain<3>(made.plc)));
  return made;
}

Volumes volumes_of(const std::vector<BodyRegion>& regions) {
  Volumes found;
  for (const BodyRegion& r : regions) found[r.bodies] += r.volume;
  return found;
}

/// Of boxes, by the grid of all their coordinates.
Volumes exact_volumes(const std::vector<Box>& boxes) {
  std::array<std::vector<double>, 3> cuts;
  for (const Box& b : boxes)
    for (int i = 0; i < 3; ++i) {
      cuts[static_cast<std::size_t>(i)].push_back(b.low[i]);
      cuts[static_cast<std::size_t>(i)].push_back(b.high[i]);
    }
  for (auto& c : cuts) std::ranges::sort(c);
  Volumes found;
  for (std::size_t x = 1; x < cuts[0].size(); ++x)
    for (std::size_t y = 1; y < cuts[1].size(); ++y)
      for (std::size_t z = 1; z < cuts[2].size(); ++z) {
        std::vector<std::uint32_t> its;
        for (std::uint32_t b = 0; b < boxes.size(); ++b)
          if (boxes[b].low[0] <= cuts[0][x - 1] && cuts[0][x] <= boxes[b].high[0] && boxes[b].low[1] <= cuts[1][y - 1] &&
              cuts[1][y] <= boxes[b].high[1] && boxes[b].low[2] <= cuts[2][z - 1] && cuts[2][z] <= boxes[b].high[2])
            its.push_back(b);
        if (!its.empty())
          found[its] += (cuts[0][x] - cuts[0][x - 1]) * (cuts[1][y] - cuts[1][y - 1]) * (cuts[2][z] - cuts[2][z - 1]);
      }
  return found;
}

TEST(Assemblies, BoxesAgreeWithTheirGrid) {
  std::mt19937 chance(3);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(k);
    std::vector<Box> boxes(2 + static_cast<std::size_t>(k % 4));
    Plc<3> plc;
    for (Box& b : boxes) {
      b = random_box(chance);
      append_body(plc, test::boxes({{b.low, b.high}}));
    }
    const Volumes wanted = exact_volumes(boxes), found = volumes_of(resolved(plc, BodyMode::fragments).regions);
    ASSERT_EQ(found.size(), wanted.size());
    for (const auto& [bodies, volume] : wanted) {
      ASSERT_TRUE(found.contains(bodies));
      EXPECT_NEAR(found.at(bodies), volume, 1e-12);
    }
    double sum = 0, united = 0;
    for (const auto& [bodies, volume] : wanted) sum += volume;
    for (const BodyRegion& r : resolved(plc, BodyMode::united).regions) united += r.volume;
    EXPECT_NEAR(united, sum, 1e-12);
  }
}

double sum_with(const Volumes& volumes, const std::vector<std::uint32_t>& bodies) {
  double sum = 0;
  for (const auto& [its, volume] : volumes)
    if (std::ranges::includes(its, bodies)) sum += volume;
  return sum;
}

/// Only these bodies of an assembly.
Plc<3> part_of(const std::vector<Plc<3>>& bodies, const std::vector<std::uint32_t>& which) {
  Plc<3> plc;
  for (const std::uint32_t b : which) append_body(plc, bodies[b]);
  return plc;
}

// What all have in common is known of two, by themselves, and of each alone, without anything that crosses.
TEST(Assemblies, AllAgreeWithPairs) {
  std::mt19937 chance(4);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(k);
    std::vector<Plc<3>> bodies(2 + static_cast<std::size_t>(k % 3));
    for (auto& b : bodies) {
      const double kind = number(chance, 0, 3);
      const Box box = random_box(chance);
      b = kind < 1 ? test::boxes({{box.low, box.high}}) : kind < 2 ? prism(chance) : sphere(chance);
    }
    std::vector<std::uint32_t> all;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) all.push_back(b);
    const Volumes found = volumes_of(resolved(part_of(bodies, all), BodyMode::fragments).regions);
    double united = 0, fragments = 0, priority = 0;
    for (const BodyRegion& r : resolved(part_of(bodies, all), BodyMode::united).regions) united += r.volume;
    for (const BodyRegion& r : resolved(part_of(bodies, all), BodyMode::priority).regions) priority += r.volume;
    for (const auto& [its, volume] : found) fragments += volume;
    EXPECT_NEAR(united, fragments, 1e-12);
    EXPECT_NEAR(priority, fragments, 1e-12);
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
      EXPECT_NEAR(sum_with(found, {a}), with_bodies(bodies[a], BodyMode::united).regions.at(0).volume, 1e-12);
      for (std::uint32_t b = a + 1; b < bodies.size(); ++b)
        EXPECT_NEAR(sum_with(found, {a, b}),
                    sum_with(volumes_of(resolved(part_of(bodies, {a, b}), BodyMode::fragments).regions), {0, 1}), 1e-12);
    }
  }
}

}  // namespace
}  // namespace pgdr
