// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies on a grid of unit cubes, where it is known of each cube which bodies it is of.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

#include "allow_threads.hpp"
#include "cube_bodies.hpp"
#include "pgdr/arrangement.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/domain.hpp"
#include "space/distances.hpp"
#include "volumes/wall_volumes.hpp"

namespace pgdr {
namespace {

using test::add_square;
using test::add_surface;
using test::Body;
using test::box;
using test::Cube;
using test::surfaces;
using test::turned;

/// Of each set of bodies how many cubes it has.
using Volumes = std::map<std::vector<std::uint32_t>, double>;

/// The bodies of each cube that has any.
std::map<Cube, std::vector<std::uint32_t>> bodies_of_cubes(const std::vector<Body>& bodies) {
  std::map<Cube, std::vector<std::uint32_t>> found;
  for (std::uint32_t b = 0; b < bodies.size(); ++b)
    for (const Cube& c : bodies[b]) found[c].push_back(b);
  return found;
}

Volumes region_volumes_of(const std::vector<BodyRegion>& regions) {
  Volumes found;
  for (const BodyRegion& r : regions) found[r.bodies] += r.volume;
  return found;
}

/// The label that the seeds of an input give to each cube; 0: outside or void.
std::map<Cube, double> labels_of_cubes(const Plc<3>& plc, const std::set<Cube>& cubes, bool is_turned) {
  std::vector<Diagnostic> repairs;
  const Arrangement pieces = arrange(plc, repairs);
  const detail::WallVolumes<3> walls(pieces.points, pieces.triangles, detail::Bulk(false), detail::StopCheck({}));
  std::map<std::uint32_t, double> label_of_volume;
  for (const auto& seed : plc.regions) {
    const auto v = walls.find(seed.point);
    EXPECT_TRUE(v && *v != 0);
    EXPECT_TRUE(!v || label_of_volume.emplace(*v, seed.attribute).second) << "two seeds in one volume";
  }
  for (const auto& hole : plc.holes) {
    const auto v = walls.find(hole);
    EXPECT_TRUE(v && *v != 0);
    EXPECT_TRUE(!v || label_of_volume.emplace(*v, 0).second) << "two seeds in one volume";
  }
  EXPECT_EQ(label_of_volume.size() + 1, walls.count()) << "a volume without a seed";
  std::map<Cube, double> labels;
  for (const Cube& c : cubes) {
    Point<3> x{{c[0] + 0.5, c[1] + 0.53, c[2] + 0.47}};
    if (is_turned) x = turned(x);
    const auto v = walls.find(x);
    labels[c] = v && *v != 0 ? label_of_volume[*v] : 0;
  }
  return labels;
}

std::set<Cube> all_cubes(int n) { return box({-1, -1, -1}, {n + 1, n + 1, n + 1}); }

std::vector<Body> random_boxes(std::mt19937& chance, int n) {
  const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(chance); };
  std::vector<Body> bodies(static_cast<std::size_t>(number(2, 5)));
  for (Body& b : bodies) {
    Cube low, high;
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = number(0, n - 1);
      high[i] = number(low[i] + 1, n);
    }
    b = box(low, high);
  }
  return bodies;
}

/// How many pieces the cubes have that hang together by faces; and of each how many cubes.
std::multiset<double> connected(std::set<Cube> cubes) {
  std::multiset<double> sizes;
  while (!cubes.empty()) {
    std::vector<Cube> waiting{*cubes.begin()};
    cubes.erase(cubes.begin());
    double size = 0;
    while (!waiting.empty()) {
      const Cube c = waiting.back();
      waiting.pop_back();
      ++size;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Cube next = c;
          next[axis] += step;
          if (cubes.erase(next) > 0) waiting.push_back(next);
        }
    }
    sizes.insert(size);
  }
  return sizes;
}

void expect_near(const Volumes& found, const Volumes& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [bodies, volume] : wanted) {
    const auto at = found.find(bodies);
    ASSERT_NE(at, found.end());
    EXPECT_NEAR(at->second, volume, 1e-12 * volume);
  }
}

void expect_fragments(const std::vector<Body>& bodies, const Plc<3>& plc, bool is_turned, int n) {
  const WithBodies made = with_bodies(plc, BodyMode::fragments);
  const auto of_cubes = bodies_of_cubes(bodies);
  Volumes wanted;
  for (const auto& [cube, its] : of_cubes) ++wanted[its];
  expect_near(region_volumes_of(made.regions), wanted);
  EXPECT_EQ(made.plc.facets.size(), plc.facets.size());
  for (const auto& [cube, label] : labels_of_cubes(made.plc, all_cubes(n), is_turned)) {
    const auto at = of_cubes.find(cube);
    const auto region = std::ranges::find(made.regions, label, &BodyRegion::label);
    ASSERT_EQ(at != of_cubes.end(), region != made.regions.end());
    if (at != of_cubes.end()) {
      EXPECT_EQ(at->second, region->bodies);
    }
  }
}

void expect_united(const std::vector<Body>& bodies, const Plc<3>& plc, bool is_turned, int n) {
  const WithBodies made = with_bodies(plc, BodyMode::united);
  std::set<Cube> solid;
  for (const Body& b : bodies) solid.insert(b.begin(), b.end());
  std::multiset<double> sizes;
  for (const BodyRegion& r : made.regions) sizes.insert(std::round(r.volume * 1e9) / 1e9);
  EXPECT_EQ(sizes, connected(solid));
  std::map<double, double> count;
  for (const auto& [cube, label] : labels_of_cubes(made.plc, all_cubes(n), is_turned)) {
    EXPECT_EQ(label != 0, solid.contains(cube));
    ++count[label];
  }
  for (const BodyRegion& r : made.regions) EXPECT_NEAR(r.volume, count[r.label], 1e-9);
}

void expect_priority(const std::vector<Body>& bodies, const Plc<3>& plc, bool is_turned, int n) {
  const WithBodies made = with_bodies(plc, BodyMode::priority);
  const auto of_cubes = bodies_of_cubes(bodies);
  Volumes wanted;
  for (const auto& [cube, its] : of_cubes) ++wanted[{its[0]}];
  expect_near(region_volumes_of(made.regions), wanted);
  for (const auto& [cube, label] : labels_of_cubes(made.plc, all_cubes(n), is_turned)) {
    const auto at = of_cubes.find(cube);
    const auto region = std::ranges::find(made.regions, label, &BodyRegion::label);
    ASSERT_EQ(at != of_cubes.end(), region != made.regions.end());
    if (at != of_cubes.end()) {
      EXPECT_EQ(at->second[0], region->bodies[0]);
    }
  }
}

void expect_disjoint(const std::vector<Body>& bodies, const Plc<3>& plc) {
  bool overlap = false;
  for (const auto& [cube, its] : bodies_of_cubes(bodies)) overlap = overlap || its.size() > 1;
  try {
    with_bodies(plc, BodyMode::disjoint);
    EXPECT_FALSE(overlap);
  } catch (const InputError& e) {
    EXPECT_TRUE(overlap);
    EXPECT_EQ(e.code(), Errc::bodies_overlap);
    EXPECT_GE(e.diagnostic().ids.size(), 2u);
  }
}

TEST(Bodies, RandomBoxes) {
  std::mt19937 chance(1);
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(k);
    const std::vector<Body> bodies = random_boxes(chance, 4);
    const bool is_turned = k % 2 == 1;
    const Plc<3> plc = is_turned ? turned(surfaces(bodies)) : surfaces(bodies);
    expect_fragments(bodies, plc, is_turned, 4);
    expect_united(bodies, plc, is_turned, 4);
    expect_priority(bodies, plc, is_turned, 4);
    expect_disjoint(bodies, plc);
  }
}

TEST(Bodies, OrderAndThreads) {
  const test::AllowThreads threads(3);
  std::mt19937 chance(2);
  for (int k = 0; k < 10; ++k) {
    std::vector<Body> bodies = random_boxes(chance, 4);
    const Plc<3> plc = surfaces(bodies);
    std::ranges::reverse(bodies);
    const Plc<3> other = surfaces(bodies);
    const auto last = static_cast<std::uint32_t>(bodies.size() - 1);
    for (const BodyMode mode : {BodyMode::united, BodyMode::fragments}) {
      const WithBodies a = with_bodies(plc, mode);
      WithBodies b = tbb::task_arena(1).execute([&] { return with_bodies(other, mode); });
      ASSERT_EQ(a.regions.size(), b.regions.size());
      for (std::size_t i = 0; i < a.regions.size(); ++i) {
        for (std::uint32_t& body : b.regions[i].bodies) body = last - body;
        std::ranges::sort(b.regions[i].bodies);
        EXPECT_EQ(a.regions[i].bodies, b.regions[i].bodies);
        EXPECT_EQ(a.regions[i].label, b.regions[i].label);
        EXPECT_EQ(a.regions[i].volume, b.regions[i].volume);
      }
      EXPECT_EQ(labels_of_cubes(a.plc, all_cubes(4), false), labels_of_cubes(b.plc, all_cubes(4), false));
      const WithBodies again = tbb::task_arena(3).execute([&] { return with_bodies(other, mode); });
      EXPECT_EQ(again.plc.points, b.plc.points);
      ASSERT_EQ(again.plc.regions.size(), b.plc.regions.size());
      for (std::size_t i = 0; i < b.plc.regions.size(); ++i) EXPECT_EQ(again.plc.regions[i].point, b.plc.regions[i].point);
    }
  }
}

/// Without numbers of bodies: they are told by edges.
Plc<3> in_one_file(Plc<3> plc) {
  plc.facet_bodies.clear();
  return plc;
}

TEST(Bodies, ShellInShell) {
  Plc<3> plc;
  add_surface(plc, box({0, 0, 0}, {5, 5, 5}), 0);
  add_surface(plc, box({1, 1, 1}, {3, 3, 3}), 1);
  const WithBodies both = with_bodies(plc, BodyMode::united);
  ASSERT_EQ(both.regions.size(), 1u);
  EXPECT_EQ(both.regions[0].volume, 125);
  EXPECT_EQ(both.plc.facets.size(), 300u) << "the inner one is gone";
  EXPECT_EQ(both.plc.points.size(), 600u) << "and its points";
  EXPECT_EQ(region_volumes_of(with_bodies(plc, BodyMode::fragments).regions), (Volumes{{{0}, 117}, {{0, 1}, 8}}));
  EXPECT_EQ(region_volumes_of(with_bodies(in_one_file(plc), BodyMode::fragments).regions), (Volumes{{{0}, 117}, {{0, 1}, 8}}));
}

TEST(Bodies, CavityIsOfWhatItIsIn) {
  Plc<3> plc;
  add_surface(plc, box({1, 1, 1}, {3, 3, 3}), 0, false);
  add_surface(plc, box({0, 0, 0}, {5, 5, 5}), 0);
  add_surface(plc, box({-1, -1, -1}, {6, 6, 6}), 0);
  for (const BodyMode mode : {BodyMode::fragments, BodyMode::priority}) {
    const WithBodies made = with_bodies(in_one_file(plc), mode);
    EXPECT_EQ(made.body_names.size(), 2u);
    const Volumes wanted = mode == BodyMode::priority ? Volumes{{{0}, 117}, {{1}, 343 - 117}}
                                                      : Volumes{{{0, 1}, 117}, {{1}, 343 - 117}};
    EXPECT_EQ(region_volumes_of(made.regions), wanted) << "the shell of the cavity comes first, so that its body is 0";
  }
  const WithBodies united = with_bodies(in_one_file(plc), BodyMode::united);
  ASSERT_EQ(united.regions.size(), 1u);
  EXPECT_EQ(united.regions[0].volume, 343) << "w is 1 in the cavity, by the outer shell";
}

TEST(Bodies, InsideOut) {
  Plc<3> plc;
  add_surface(plc, box({0, 0, 0}, {4, 4, 4}), 0, false);
  add_surface(plc, box({1, 1, 1}, {2, 2, 2}), 0, true);
  const WithBodies made = with_bodies(in_one_file(plc), BodyMode::united);
  ASSERT_EQ(made.regions.size(), 1u);
  EXPECT_EQ(made.regions[0].volume, 63);
  EXPECT_EQ(made.plc.holes.size(), 1u);
  EXPECT_EQ(region_volumes_of(with_bodies(in_one_file(plc), BodyMode::fragments).regions), (Volumes{{{0}, 63}}));
}

TEST(Bodies, RepeatedFacetsCount) {
  Plc<3> plc;
  add_surface(plc, box({0, 0, 0}, {2, 2, 2}), 0);
  add_surface(plc, box({0, 0, 0}, {2, 2, 2}), 0);
  add_surface(plc, box({1, 0, 0}, {3, 2, 2}), 1, false);
  // The second one is reversed as a whole, or it would take away from the first.
  EXPECT_EQ(region_volumes_of(with_bodies(plc, BodyMode::fragments).regions), (Volumes{{{0}, 4}, {{0, 1}, 4}, {{1}, 4}}));
  // In one file it does: twice, less once.
  for (auto& body : plc.facet_bodies) body = 0;
  const WithBodies made = with_bodies(plc, BodyMode::united);
  ASSERT_EQ(made.regions.size(), 1u);
  EXPECT_EQ(made.regions[0].volume, 8);
}

TEST(Bodies, TouchingBodiesOfOppositeFaces) {
  Plc<3> plc = surfaces({box({0, 0, 0}, {2, 2, 2}), box({2, 0, 0}, {4, 2, 2})});
  EXPECT_EQ(region_volumes_of(with_bodies(plc, BodyMode::fragments).regions), (Volumes{{{0}, 8}, {{1}, 8}}));
  const WithBodies united = with_bodies(plc, BodyMode::united);
  ASSERT_EQ(united.regions.size(), 1u);
  EXPECT_EQ(united.regions[0].bodies, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(united.plc.facets.size(), 80u);
}

TEST(Bodies, FacetsTurnedOver) {
  Plc<3> plc = in_one_file(surfaces({box({0, 0, 0}, {3, 3, 3})}));
  for (const std::size_t f : {3u, 17u, 18u, 40u}) std::swap(plc.facets[f].polygons[0][1], plc.facets[f].polygons[0][2]);
  const WithBodies made = with_bodies(plc, BodyMode::fragments);
  EXPECT_EQ(region_volumes_of(made.regions), (Volumes{{{0}, 27}}));
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_EQ(made.warnings[0].code, Errc::inconsistent_orientation);
  EXPECT_EQ(made.warnings[0].ids, (std::vector<std::int64_t>{3, 17, 18, 40}));
}

TEST(Bodies, CornersOnEdgesOfOthers) {
  // The top is one square, whose edges have the corners of the sides' squares on them.
  Plc<3> plc;
  for (const Cube& c : box({0, 0, 0}, {2, 2, 2})) {
    if (c[0] == 0) add_square(plc, c, 0, false, 0), add_square(plc, {2, c[1], c[2]}, 0, true, 0);
    if (c[1] == 0) add_square(plc, c, 1, false, 0), add_square(plc, {c[0], 2, c[2]}, 1, true, 0);
    if (c[2] == 0) add_square(plc, c, 2, false, 0);
  }
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (const auto& [x, y] : {std::pair{0., 0.}, {2., 0.}, {2., 2.}, {0., 2.}}) plc.points.push_back({{x, y, 2}});
  plc.facets.push_back({{{first, first + 1, first + 2, first + 3}}, {}, 0});
  add_surface(plc, box({5, 0, 0}, {6, 1, 1}), 0);
  const WithBodies made = with_bodies(in_one_file(plc), BodyMode::fragments);
  EXPECT_EQ(region_volumes_of(made.regions), (Volumes{{{0}, 8}, {{1}, 1}}));
  EXPECT_TRUE(made.warnings.empty());
}

/// Leaves out all squares that lie in a plane.
Plc<3> without_plane(Plc<3> plc, int axis, double level) {
  Plc<3> left = plc;
  left.facets.clear();
  left.facet_bodies.clear();
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    const auto is_there = [&](std::uint32_t v) { return plc.points[v][axis] == level; };
    if (std::ranges::all_of(plc.facets[f].polygons[0], is_there)) continue;
    left.facets.push_back(plc.facets[f]);
    left.facet_bodies.push_back(plc.facet_bodies[f]);
  }
  return left;
}

TEST(Bodies, OpenBoxOnAPlate) {
  // A box without its lower side stands on a plate, which closes it.
  Plc<3> open = without_plane(surfaces({box({1, 1, 1}, {4, 4, 4})}), 2, 1);
  add_surface(open, box({0, 0, 0}, {5, 5, 1}), 1);
  const WithBodies made = with_bodies(open, BodyMode::fragments);
  EXPECT_EQ(region_volumes_of(made.regions), (Volumes{{{0}, 27}, {{1}, 25}}));
  EXPECT_TRUE(made.warnings.empty()) << made.warnings[0].message;
  EXPECT_EQ(region_volumes_of(with_bodies(open, BodyMode::united).regions), (Volumes{{{0, 1}, 52}}));
}

TEST(Bodies, UnsureOfAnOpenBody) {
  // A square divides a box. Beside its middle it goes 0.3 times round.
  Plc<3> plc = surfaces({box({0, 0, 0}, {6, 6, 4})});
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (const auto& [x, y] : {std::pair{0., 0.}, {6., 0.}, {6., 6.}, {0., 6.}}) plc.points.push_back({{x, y, 2}});
  plc.facets.push_back({{{first, first + 1, first + 2, first + 3}}, {}, 0});
  plc.facet_bodies.push_back(1);
  const WithBodies made = with_bodies(plc, BodyMode::fragments);
  double volume = 0;
  for (const BodyRegion& r : made.regions) volume += r.volume;
  EXPECT_EQ(volume, 144);
  ASSERT_FALSE(made.warnings.empty());
  EXPECT_EQ(made.warnings[0].code, Errc::unsure_volume);
  EXPECT_EQ(made.warnings[0].ids, (std::vector<std::int64_t>{1}));
}

TEST(Bodies, SheetThatDividesNothing) {
  Plc<3> plc = surfaces({box({0, 0, 0}, {6, 6, 4})});
  for (int x = 1; x < 5; ++x)
    for (int y = 1; y < 5; ++y) add_square(plc, {x, y, 2}, 2, true, 1, 7);
  const WithBodies made = with_bodies(plc, BodyMode::fragments);
  EXPECT_EQ(region_volumes_of(made.regions), (Volumes{{{0}, 144}}));
  EXPECT_TRUE(made.warnings.empty());
  EXPECT_EQ(made.plc.facets.size(), plc.facets.size()) << "the sheet is in the mesh";
  EXPECT_EQ(with_bodies(plc, BodyMode::united).plc.facets.size(), plc.facets.size() - 32);
}

/// Seven squares that hang together as a Moebius strip does.
void add_moebius_strip(Plc<3>& plc, std::uint32_t body) {
  const std::vector<std::pair<Cube, int>> squares{{{0, 0, 0}, 2}, {{1, 0, 0}, 2}, {{1, 1, 0}, 2}, {{1, 1, 0}, 0},
                                                  {{0, 1, 1}, 2}, {{0, 1, 0}, 0}, {{0, 0, 0}, 0}};
  for (const auto& [low, axis] : squares) add_square(plc, low, axis, true, body);
}

TEST(Bodies, MoebiusStrip) {
  Plc<3> plc = surfaces({box({-2, -2, -2}, {4, 4, 4})});
  add_moebius_strip(plc, 1);
  EXPECT_EQ(region_volumes_of(with_bodies(plc, BodyMode::fragments).regions), (Volumes{{{0}, 216}})) << "it separates nothing";
  // Among cubes it does.
  std::vector<Body> cubes;
  for (const Cube& c : box({-1, -1, -1}, {3, 3, 3})) cubes.push_back({c});
  plc = surfaces(cubes);
  add_moebius_strip(plc, static_cast<std::uint32_t>(cubes.size()));
  plc.body_names.assign(cubes.size() + 1, "cube");
  plc.body_names.back() = "strip";
  try {
    with_bodies(plc, BodyMode::fragments);
    ADD_FAILURE() << "taken";
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::not_orientable);
    EXPECT_NE(std::string(e.what()).find("strip"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("--regions all"), std::string::npos) << e.what();
  }
}

TEST(Bodies, VolumeWithoutPointsOfDoubles) {
  // A box stands on another one. Both have a corner in the middle of the square between them, but not at quite the same height.
  Plc<3> plc = without_plane(surfaces({box({1, 1, 1}, {2, 2, 2}), box({1, 1, 2}, {2, 2, 3})}), 2, 2);
  for (const std::uint32_t body : {0u, 1u}) {
    const auto first = static_cast<std::uint32_t>(plc.points.size());
    for (const auto& [x, y] : {std::pair{1., 1.}, {2., 1.}, {2., 2.}, {1., 2.}}) plc.points.push_back({{x, y, 2}});
    plc.points.push_back({{1.5, 1.5, body == 1 ? std::nextafter(2, 3) : 2}});
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % 4;
      plc.facets.push_back({{{body == 1 ? b : a, body == 1 ? a : b, first + 4}}, {}, 0});
      plc.facet_bodies.push_back(body);
    }
  }
  plc.tolerance = 0;
  for (const BodyMode mode : {BodyMode::united, BodyMode::fragments}) {
    const WithBodies made = with_bodies(plc, mode);
    double volume = 0;
    for (const BodyRegion& r : made.regions) volume += r.volume;
    EXPECT_NEAR(volume, 2, 1e-12);
    EXPECT_EQ(made.plc.regions.size(), mode == BodyMode::united ? 1u : 2u);
    EXPECT_TRUE(made.plc.holes.empty());
    ASSERT_EQ(made.warnings.size(), 1u);
    EXPECT_EQ(made.warnings[0].code, Errc::ambiguous);
    EXPECT_NO_THROW(Domain<3>{made.plc});
  }
}

TEST(Bodies, SegmentsAreCutWithThem) {
  Plc<3> plc = surfaces({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})});
  const auto end = static_cast<std::uint32_t>(plc.points.size());
  plc.points.insert(plc.points.end(), {{{0.5, 0.5, 0.25}}, {{2.75, 2.75, 2.5}}});
  plc.segments = {{{end, end + 1}, 77}};
  BodyOptions options;
  options.resolve_crossings = true;
  const WithBodies made = with_bodies(plc, BodyMode::fragments, options);
  EXPECT_GT(made.plc.segments.size(), 2u) << "it goes into the second box, and out of the first";
  for (const auto& s : made.plc.segments) EXPECT_EQ(s.marker, 77);
  EXPECT_EQ(diagnose(made.plc).error_count(), 0u);
}

TEST(Bodies, AttributesOfNewPointsAreInterpolated) {
  Plc<3> plc = turned(surfaces({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})}));
  const auto value = [](const Point3& p) { return 3 * p[0] - p[1] + 2 * p[2] + 5; };  // linear, so that it is known everywhere
  for (const Point3& p : plc.points) plc.point_attributes.insert(plc.point_attributes.end(), {value(p), 7});
  BodyOptions options;
  options.resolve_crossings = true;
  for (const BodyMode mode : {BodyMode::united, BodyMode::fragments}) {
    const Plc<3> made = with_bodies(plc, mode, options).plc;
    ASSERT_EQ(made.point_attributes.size(), 2 * made.points.size());
    for (std::size_t i = 0; i < made.points.size(); ++i) {
      EXPECT_NEAR(made.point_attributes[2 * i], value(made.points[i]), 1e-12);
      EXPECT_NEAR(made.point_attributes[2 * i + 1], 7, 1e-12);
    }
  }
}

TEST(Bodies, SeedsWin) {
  Plc<3> plc = surfaces({box({0, 0, 0}, {2, 2, 2}), box({1, 0, 0}, {3, 2, 2}), box({5, 0, 0}, {6, 1, 1})});
  plc.regions = {{{{1.5, 0.9, 0.9}}, 1, 0.01}};
  WithBodies made = with_bodies(plc, BodyMode::fragments);
  ASSERT_EQ(made.regions.size(), 4u);
  EXPECT_EQ(made.regions[0].label, 1);
  EXPECT_EQ(made.regions[0].bodies, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(made.regions[1].label, 2) << "1 is taken";
  EXPECT_EQ(made.plc.regions[0].size, 0.01);
  plc.regions.clear();
  plc.holes = {{{5.5, 0.4, 0.6}}};
  made = with_bodies(plc, BodyMode::united);
  EXPECT_EQ(region_volumes_of(made.regions), (Volumes{{{0, 1}, 12}}));
  EXPECT_EQ(made.plc.holes.size(), 1u);
}

// Seeds lay as deep as the triangle beside them is wide, so that another surface within E was refused for spheres of small ones.
TEST(Bodies, SeedsAreDeepInWhatTheyMean) {
  for (const bool is_turned : {false, true}) {
    const Plc<3> grid = surfaces({box({0, 0, 0}, {10, 8, 6})});
    const WithBodies made = with_bodies(is_turned ? turned(grid) : grid, BodyMode::united, {});
    ASSERT_EQ(made.plc.regions.size(), 1u);
    for (const auto& facet : made.plc.facets) {
      const auto corner = [&](std::size_t i) { return made.plc.points[facet.polygons[0][i]]; };
      EXPECT_GE(detail::closest_to_triangle(made.plc.regions[0].point, corner(0), corner(1), corner(2)).square, 4);
    }
  }
}

TEST(Bodies, FacetsThatCrossAreRefused) {
  Plc<3> plc;
  plc.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0.2, 0.2, -1}}, {{0.2, 0.2, 1}}, {{3, 3, 0}}};
  plc.facets = {{{{0, 1, 2}}, {}, 0}, {{{3, 4, 5}}, {}, 0}};
  EXPECT_THROW(with_bodies(plc, BodyMode::united), DiagnosedError);
}

}  // namespace
}  // namespace pgdr
