// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The certificate of another surface: meshes of one surface against another one, made by hand.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <functional>
#include <random>

#include "allow_threads.hpp"
#include "pgdr/check.hpp"
#include "pgdr/facet_places.hpp"
#include "pgdr/refine.hpp"
#include "structure_plcs.hpp"

namespace test_nearness_pairs {

using namespace pgdr;
using Kind = CheckFinding::Kind;
constexpr double e = 0.1;  // the distance

OutputMesh<3> mesh_of(const Plc<3>& plc, RegionMode regions = RegionMode::automatic) {
  RefineOptions<3> options;
  options.regions = regions;
  options.refine = false;
  return refine<3>(plc, options).mesh;
}

CheckReport certify(const Plc<3>& given, const OutputMesh<3>& mesh, double distance = e,
                    RegionMode regions = RegionMode::automatic, double feature_angle = 40) {
  CheckOptions<3> options;
  options.feature_angle = feature_angle;
  options.input = &given;
  options.regions = regions;
  options.surface_tolerance = distance;
  return check(mesh, options);
}

std::string findings(const CheckReport& report) {
  std::string text;
  for (const CheckFinding& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + '\n';
  return text;
}

/// As they are, and turned and shifted.
void expect_passes(const Plc<3>& given, const Plc<3>& other, double distance = e, double feature_angle = 40) {
  const auto report = certify(given, mesh_of(other), distance, RegionMode::automatic, feature_angle);
  EXPECT_EQ(report.exit_code(), 0) << findings(report);
  const auto turned = certify(test::turned(given), mesh_of(test::turned(other)), distance, RegionMode::automatic, feature_angle);
  EXPECT_EQ(turned.exit_code(), 0) << findings(turned);
}

void expect_finds(Kind kind, const Plc<3>& given, const Plc<3>& other, double distance = e) {
  const auto report = certify(given, mesh_of(other), distance);
  EXPECT_GT(report.count(kind), 0u) << findings(report);
  EXPECT_EQ(report.exit_code(), 6);
  EXPECT_GT(certify(test::turned(given), mesh_of(test::turned(other)), distance).count(kind), 0u);
}

TEST(NearPairs, TheGivenSurfaceIsNearItself) {
  const auto structures = test::all_structures();
  EXPECT_GT(structures.size(), 20u);
  for (const auto& s : structures)
    for (const bool is_turned : {false, true}) {
      if (is_turned && !s.turns) continue;
      const Plc<3> plc = is_turned ? test::turned(s.plc) : s.plc;
      for (const RegionMode mode : {RegionMode::seeds, RegionMode::automatic}) {
        const OutputMesh<3> mesh = mesh_of(plc, mode);
        for (const double distance : {1e-9, 1e-3, 0.2}) {
          const auto report = certify(plc, mesh, distance, mode);
          EXPECT_EQ(report.finding_count, 0u) << s.name << (is_turned ? ", turned" : "") << ", " << distance << '\n'
                                              << findings(report);
        }
      }
    }
}

TEST(NearPairs, RefinedToo) {
  for (const Plc<3>& plc :
       {test::icosphere(2), test::plate_with_hole(), test::two_region_cube(), test::cube_with_marked_facet()}) {
    const Plc<3> turned = test::turned(plc);
    const auto result = refine<3>(turned, {});
    CheckOptions<3> options;
    options.input = &turned;
    options.surface_tolerance = 1e-6;
    options.radius_edge_bound = RefineOptions<3>{}.radius_edge_bound;
    options.largest_cosine = result.optimization.claimed_cosine;
    auto reasons = result.reasons;
    name_facets_by_places(turned, reasons);
    options.reasons = &reasons;
    const auto report = check(result.mesh, options);
    EXPECT_LE(report.exit_code(), 1) << findings(report);
  }
}

/// A cube of side 2; the middle of its top is lower by h.
Plc<3> dented(double h) {
  Plc<3> plc;
  test::add_box(plc, {{0, 0, 0}}, {{2, 2, 2}});
  for (auto& facet : plc.facets) facet.marker = 1;
  const auto top = plc.facets.back().polygons[0];
  plc.facets.pop_back();
  const test::Index middle = test::add_point(plc, {{1, 1, 2 - h}});
  for (std::size_t k = 0; k < 4; ++k) test::add_polygon(plc, {top[k], top[(k + 1) % 4], middle}, 1);
  return plc;
}

TEST(NearPairs, Dents) {
  const Plc<3> flat = dented(0);
  expect_passes(flat, dented(0.9 * e));
  expect_passes(dented(0.9 * e), flat);
  expect_passes(flat, dented(-0.9 * e));
  expect_finds(Kind::off_surface, flat, dented(1.1 * e));
  expect_finds(Kind::surface_not_covered, dented(1.1 * e), flat);
  expect_finds(Kind::off_surface, flat, dented(-1.1 * e));
}

/// A blade on the cube, narrow and as high as h.
Plc<3> with_blade(double h, double width) {
  Plc<3> plc = test::prism({{{0, 0}}, {{2, 0}}, {{2, 2}}, {{1 + width, 2}}, {{1, 2 + h}}, {{1 - width, 2}}, {{0, 2}}}, 2);
  for (auto& facet : plc.facets) facet.marker = 1;
  return plc;
}

TEST(NearPairs, Blades) {
  const Plc<3> without = with_blade(0, 0.01);
  expect_passes(with_blade(0.9 * e, 0.0001), without, e, 180);
  EXPECT_EQ(certify(test::turned(with_blade(0.9 * e, 0.0001)), mesh_of(test::turned(without))).exit_code(),
            6);                                                                 // its ridge is a crease
  expect_finds(Kind::surface_not_covered, with_blade(2 * e, 0.0001), without);  // all of the mesh is near what was given
  EXPECT_EQ(certify(with_blade(2 * e, 0.0001), mesh_of(without)).count(Kind::off_surface), 0u);
  expect_finds(Kind::off_surface, without, with_blade(2 * e, 0.01));
}

/// The top of a box has two markers, which meet at x.
Plc<3> coloured(double x) {
  Plc<3> plc;
  test::add_box(plc, {{0, 0, 0}}, {{2, 2, 2}});
  for (auto& facet : plc.facets) facet.marker = 1;
  plc.facets.pop_back();
  const auto a = test::add_point(plc, {{x, 0, 2}}), b = test::add_point(plc, {{x, 2, 2}});
  plc.facets[2].polygons[0] = {0, 1, 5, a, 4};
  plc.facets[3].polygons[0] = {2, 6, b, 7, 3};
  test::add_polygon(plc, {4, a, b, 6}, 1);
  test::add_polygon(plc, {a, 5, 7, b}, 2);
  return plc;
}

TEST(NearPairs, BordersOfMarkers) {
  expect_passes(coloured(1), coloured(1 + 0.9 * e));
  expect_finds(Kind::wrong_marker, coloured(1), coloured(1 + 1.1 * e));
  expect_finds(Kind::surface_not_covered, coloured(1), coloured(1 + 1.1 * e));
  expect_finds(Kind::wrong_marker, coloured(1), coloured(1 - 1.1 * e));
  Plc<3> other = coloured(1);
  other.facets.back().marker = 3;
  expect_finds(Kind::wrong_marker, coloured(1), other);
}

/// A sphere, those of its triangles coloured whose centres are above a height.
Plc<3> coloured_sphere(int levels, double z) {
  Plc<3> plc = test::icosphere(levels);
  for (auto& facet : plc.facets) {
    double sum = 0;
    for (const test::Index p : facet.polygons[0]) sum += plc.points[p][2] / 3;
    facet.marker = sum > z ? 2 : 1;
  }
  return plc;
}

TEST(NearPairs, Spheres) {
  const Plc<3> coarse = coloured_sphere(2, 0.3), fine = coloured_sphere(3, 0.3);
  EXPECT_EQ(certify(coarse, mesh_of(fine), 0.2).exit_code(), 0) << findings(certify(coarse, mesh_of(fine), 0.2));
  EXPECT_EQ(certify(fine, mesh_of(coarse), 0.2).exit_code(), 0) << findings(certify(fine, mesh_of(coarse), 0.2));
  // The border is farther away than the surfaces are: both are within 0.04 of the sphere.
  EXPECT_EQ(certify(test::icosphere(3), mesh_of(test::icosphere(2)), 0.04).exit_code(), 0);
  EXPECT_EQ(certify(fine, mesh_of(coloured_sphere(3, -0.3)), 0.2).exit_code(), 6);
}

Plc<3> big_box() { return test::boxes({{{{0, 0, 0}}, {{3, 3, 3}}}}); }

TEST(NearPairs, Components) {
  Plc<3> given = big_box();
  test::add_box(given, {{1, 1, 3 + 0.2 * e}}, {{1 + 0.3 * e, 1 + 0.3 * e, 3 + 0.5 * e}});
  for (auto& facet : given.facets) facet.marker = 0;
  Plc<3> without = big_box();
  for (auto& facet : without.facets) facet.marker = 0;
  expect_finds(Kind::other_topology, given, without);
  expect_finds(Kind::other_topology, without, given);
  EXPECT_EQ(certify(given, mesh_of(without)).undecided_volumes, 1u);
  EXPECT_EQ(certify(without, mesh_of(given)).undecided_volumes, 1u);
}

/// A plate with a hole of half a width s through it.
Plc<3> drilled(double s, bool has_hole = true) {
  Plc<3> plc;
  test::add_box(plc, {{0, 0, 0}}, {{4, 4, 1}});
  if (has_hole) {
    test::add_box(plc, {{2 - s, 2 - s, 0}}, {{2 + s, 2 + s, 1}});
    plc.facets.resize(10);  // without the low and the high one
    for (const std::size_t k : {0, 1}) {
      const test::Index base = k == 0 ? 8 : 12;
      plc.facets[4 + k].polygons.push_back({base, base + 1, base + 3, base + 2});
      plc.facets[4 + k].holes = {{{2, 2, static_cast<double>(k)}}};
    }
  }
  for (auto& facet : plc.facets) facet.marker = 0;
  return plc;
}

TEST(NearPairs, Handles) {
  expect_finds(Kind::other_topology, drilled(0.5, false), drilled(e / 4), 3 * e);  // the bore is within 3 e of nothing else
  expect_passes(drilled(0.5), drilled(0.5 + 0.6 * e));
  // A bore through a plate that is thinner than the distance: all is near, and one has a handle more.
  const auto thin = [](bool has_hole) {
    Plc<3> plc = drilled(e / 4, has_hole);
    test::for_each_point(plc, [](Point3& p) { p[2] *= e; });
    return plc;
  };
  const auto report = certify(thin(true), mesh_of(thin(false)));
  EXPECT_EQ(report.count(Kind::other_topology), 1u) << findings(report);
  EXPECT_EQ(report.count(Kind::off_surface), 0u) << findings(report);
}

/// A box in two halves, with the wall between them at x.
Plc<3> halves(double x, int marker = 7) {
  Plc<3> plc = test::boxes({{{{0, 0, 0}}, {{x, 3, 3}}}, {{{x, 0, 0}}, {{4, 3, 3}}}});
  plc.facets[6 + 0].polygons.clear();
  plc.facets.erase(plc.facets.begin() + 6);
  for (auto& facet : plc.facets) facet.marker = 0;
  plc.facets[1].marker = marker;
  plc.regions = {{{{0.5, 1.5, 1.5}}, 10, 0}, {{{3.5, 1.5, 1.5}}, 20, 0}};
  return plc;
}

TEST(NearPairs, Walls) {
  expect_passes(halves(2), halves(2 + 0.9 * e));
  expect_finds(Kind::off_surface, halves(2), halves(2 + 1.1 * e));
  expect_finds(Kind::wrong_marker, halves(2), halves(2, 8));
  Plc<3> whole = halves(2);
  whole.facets.erase(whole.facets.begin() + 1);
  whole.regions.pop_back();
  expect_finds(Kind::surface_not_covered, halves(2), whole);
  OutputMesh<3> swapped = mesh_of(halves(2));
  for (double& label : swapped.regions) label = 30 - label;
  EXPECT_GT(certify(halves(2), swapped).count(Kind::wrong_region), 0u);
  Plc<3> other = halves(2);
  std::swap(other.regions[0].point, other.regions[1].point);
  EXPECT_GT(certify(halves(2), mesh_of(other)).count(Kind::wrong_region), 0u);
}

TEST(NearPairs, VoidsAreNotFilled) {
  const Plc<3> given = test::boxes({{{{0, 0, 0}}, {{5, 5, 5}}}, {{{2, 2, 2}}, {{3, 3, 3}}}});
  EXPECT_EQ(certify(given, mesh_of(given)).exit_code(), 0);
  const auto filled = certify(given, mesh_of(given, RegionMode::seeds));
  EXPECT_EQ(filled.exit_code(), 6);
  EXPECT_GT(filled.count(Kind::wrong_volume) + filled.count(Kind::hole_filled), 0u) << findings(filled);
}

TEST(NearPairs, Segments) {
  Plc<3> given = big_box(), near = big_box(), far = big_box();
  test::add_segment(given, {{1, 1, 1}}, {{2, 1, 1}}, 5);
  test::add_segment(near, {{1, 1, 1}}, {{1.5, 1.05, 1}}, 5);
  test::add_segment(near, {{1.5, 1.05, 1}}, {{2, 1, 1}}, 5);
  test::add_segment(far, {{1, 1, 1}}, {{1.5, 1.15, 1}}, 5);
  test::add_segment(far, {{1.5, 1.15, 1}}, {{2, 1, 1}}, 5);
  expect_passes(given, near);
  expect_finds(Kind::off_surface, given, far);
  expect_finds(Kind::surface_not_covered, given, far);
  expect_finds(Kind::surface_not_covered, given, big_box());
  expect_finds(Kind::missing_input_point, given, big_box());
  near.segments[0].marker = near.segments[1].marker = 6;
  expect_finds(Kind::off_surface, given, near);
  test::add_segment(given, {{5, 5, 5}}, {{6, 5, 5}}, 5);  // outside
  near.segments[0].marker = near.segments[1].marker = 5;
  EXPECT_EQ(certify(given, mesh_of(near)).exit_code(), 0) << findings(certify(given, mesh_of(near)));
}

// A ridge of half the distance on a roof, which is as near to a flat one.
TEST(NearPairs, Creases) {
  const auto roof = [](double h) {
    Plc<3> plc = test::prism({{{0, 0}}, {{4, 0}}, {{4, 4}}, {{2 + 0.6 * e, 4}}, {{2, 4 + h}}, {{2 - 0.6 * e, 4}}, {{0, 4}}}, 4);
    for (auto& facet : plc.facets) facet.marker = 0;
    return plc;
  };
  Plc<3> flat = test::prism({{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}}, 4);
  for (auto& facet : flat.facets) facet.marker = 0;
  expect_passes(roof(0.5 * e), roof(0.6 * e));
  expect_finds(Kind::surface_not_covered, roof(0.5 * e), flat);
  expect_passes(roof(0.15 * e), flat);  // normals differ by 28 degrees
  expect_passes(roof(0.5 * e), flat, e, 100);
}

/// The kinds of findings of each way to spoil a mesh.
TEST(NearPairs, Mutations) {
  const Plc<3> given = halves(2);
  const OutputMesh<3> good = mesh_of(given);
  ASSERT_EQ(certify(given, good).exit_code(), 0) << findings(certify(given, good));
  OutputMesh<3> mesh = good;
  for (auto& s : mesh.subfacets) s.marker = s.marker == 7 ? 0 : s.marker;
  EXPECT_GT(certify(given, mesh).count(Kind::wrong_marker), 0u);
  mesh = good;
  mesh.points[0][0] -= 2 * e;  // a corner of the box
  EXPECT_GT(certify(given, mesh).count(Kind::off_surface), 0u);
  mesh = good;
  std::erase_if(mesh.subfacets, [](const auto& s) { return s.marker == 7; });
  EXPECT_GT(certify(given, mesh).count(Kind::surface_not_covered), 0u);
  mesh = good;
  std::size_t left = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.regions[c] == 10) {
      mesh.cells[left] = mesh.cells[c];
      mesh.regions[left++] = 10;
    }
  mesh.cells.resize(left);
  mesh.regions.resize(left);
  EXPECT_EQ(certify(given, mesh).exit_code(), 6);
}

// A void that is thinner than the distance may have become a body beside it: nothing says which of them it is.
TEST(NearPairs, ThinVolumesAreCounted) {
  const auto with_cube = [](double z) {
    Plc<3> plc = test::boxes({{{{0, 0, 0}}, {{3, 3, 3}}}, {{{1, 1, z}}, {{1 + e / 4, 1 + e / 4, z + e / 4}}}});
    for (auto& facet : plc.facets) facet.marker = 0;
    return plc;
  };
  const auto report = certify(with_cube(3 - e / 2), mesh_of(with_cube(3 + e / 4)));
  EXPECT_EQ(report.finding_count, 0u) << findings(report);
  EXPECT_EQ(report.undecided_volumes, 1u);
  EXPECT_EQ(certify(with_cube(3 - e / 2), mesh_of(with_cube(3 + e / 4)), e / 10).exit_code(), 6);
}

/// A plate whose top is lower by h from one place on. Two facets are its bottom, and end on an edge of others.
Plc<3> plate_with_step(double h) {
  constexpr int squares = 8;
  constexpr double length = 11.5;
  std::vector<Point3> outline{{{0, 0, -1}}, {{length, 0, -1}}};  // of a side, from its lower end on
  Plc<3> plc;
  const auto add_across = [&](const Point3& p, const Point3& q) {
    test::add_facet(plc, {p, q, {{q[0], 1, q[2]}}, {{p[0], 1, p[2]}}});
  };
  std::vector<Point3> top{{{0, 0, 0}}, {{1.5, 0, 0}}};
  for (int k = 1; k <= squares; ++k) top.push_back({{1.5 + k, 0, 0}});
  top.push_back({{1.5 + squares, 0, -h}});
  for (int k = squares + 1; 1.5 + k <= length; ++k) top.push_back({{1.5 + k, 0, -h}});
  for (std::size_t k = 1; k < top.size(); ++k) add_across(top[k - 1], top[k]);
  add_across({{0, 0, -1}}, {{5, 0, -1}});
  add_across({{5, 0, -1}}, {{length, 0, -1}});
  add_across({{0, 0, -1}}, {{0, 0, 0}});
  add_across({{length, 0, -1}}, {{length, 0, -h}});
  outline.insert(outline.end(), top.rbegin(), top.rend());
  test::add_facet(plc, outline);
  for (Point3& p : outline) p[1] = 1;
  test::add_facet(plc, outline);
  return plc;
}

// The top is some triangles long, so that what lies a few tolerances below its far end may be in one plane with the first of
// them. The certificate took the riser for a part of that plane, in which it is seen as a line: "What is left over of facets
// makes no complex". (A printer's platform had such steps, of a third of a micrometre.)
TEST(NearPairs, StepsOfSomeTolerances) {
  for (const double h : {1.5e-3, 2e-3, 3e-3, 5e-3, 9e-3, 12e-3, 20e-3}) {
    Plc<3> given = plate_with_step(h);
    given.tolerance = 1e-3;
    given.is_coarse = true;
    const auto report = certify(given, mesh_of(given));
    EXPECT_EQ(report.exit_code(), 0) << h << ": " << findings(report);
  }
}

/// Of four corners below and four above, each side as two triangles, along a diagonal that chance says.
template <class Random>
void add_block(Plc<3>& plc, const std::array<Point2, 4>& outline, double low, double high, Random& random) {
  constexpr std::array<std::array<std::size_t, 4>, 6> sides{
      {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  for (const auto& side : sides) {
    std::array<Point3, 4> c;
    const std::size_t first = random() % 2;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t i = side[(first + k) % 4];
      c[k] = {{outline[i % 4][0], outline[i % 4][1], i < 4 ? low : high}};
    }
    test::add_facet(plc, {c[0], c[1], c[2]});
    test::add_facet(plc, {c[0], c[2], c[3]});
  }
}

// Clips on the side of a plate, whose long triangles cross its diagonals at small angles: where, was told less exactly than what
// meets meets, "What is left over of facets makes no complex". And a triangle that meets the side with a sharp corner had a line
// in common with it, as long as both are within the tolerance of each other: the volumes were wrong.
TEST(NearPairs, ClipsOnASide) {
  std::mt19937 random(7);
  const auto between = [&](double a, double b) {
    return std::round((a + (b - a) * static_cast<double>(random()) / 0x1p32) * 1000) / 1000;
  };
  for (int n = 0; n < 40; ++n) {
    constexpr double side = 11.425;
    Plc<3> given;
    add_block(given, {{{{-12.35, -1}}, {{12.35, -1}}, {{12.35, side}}, {{-12.35, side}}}}, -0.46, -0.06, random);
    for (double x = -12; x < 6; x += 6.5) {
      const double from = between(x, x + 2), to = between(from + 1, from + 4), slant = random() % 2 ? between(-0.1, 0.1) : 0;
      const double beyond = side + std::array{0.01, 0.035, 0.1, 0.3, 1.0}[random() % 5];
      add_block(given, {{{{from, side}}, {{to, side}}, {{to + slant, beyond}}, {{from + slant, beyond}}}},
                random() % 3 ? -0.46 : -0.4, std::array{-0.06, -0.184, -0.3}[random() % 3], random);
    }
    const auto report = certify(given, mesh_of(given), 1e-6);
    EXPECT_EQ(report.exit_code(), 0) << n << ": " << findings(report);
  }
}

TEST(NearPairs, ThreadsChangeNothing) {
  const Plc<3> given = test::icosphere(3), other = coloured_sphere(2, 2);
  const OutputMesh<3> mesh = mesh_of(other);
  std::vector<std::string> said;
  const test::AllowThreads allowed(8);
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { said.push_back(findings(certify(given, mesh, 0.01))); });
  }
  EXPECT_NE(said[0], "");
  EXPECT_EQ(said[1], said[0]);
  EXPECT_EQ(said[2], said[0]);
}

// Random surfaces about a sphere: never within where a point of one is farther from the other than the distance.
TEST(NearPairs, RandomSpheres) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  int passed = 0;
  for (int k = 0; k < 40; ++k) {
    const Plc<3> given = test::icosphere(2);
    Plc<3> other = given;
    for (Point3& p : other.points) {
      const double r = 1 + 0.05 * unit(random);
      for (double& x : p.x) x *= r;
    }
    double most = 0;  // of corners, radially: the true distance is no more, and nearly that
    for (std::size_t p = 0; p < given.points.size(); ++p)
      most = std::max(most, std::sqrt(squared_distance(given.points[p], other.points[p])));
    const OutputMesh<3> mesh = mesh_of(other);
    EXPECT_EQ(certify(given, mesh, 1.001 * most).exit_code(), 0) << findings(certify(given, mesh, 1.001 * most));
    const auto at_half = certify(given, mesh, 0.5 * most);
    EXPECT_EQ(at_half.exit_code(), 6);
    passed += at_half.count(Kind::off_surface) > 0;
  }
  EXPECT_EQ(passed, 40);
}

}  // namespace test_nearness_pairs
