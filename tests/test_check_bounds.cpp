// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's bounds and reasons, the two counts of faces that are not Delaunay, and what may lie outside the mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dimensions.hpp"
#include "given_names.hpp"
#include "mesh_mutations.hpp"
#include "pgdr/check.hpp"
#include "test_check_models.hpp"

namespace test_check_bounds {

using namespace pgdr;
using namespace pgdr::test;
using Kind = CheckFinding::Kind;
using Code = PoorReason::Code;

/// The segment between two input points of a model.
GivenEntity between(const Model<2>& model, std::uint32_t a, std::uint32_t b) {
  return named_segment<2>(model.plc.points[a], model.plc.points[b]);
}

/// Of the needles, at their first points.
const double needle_angle = std::atan2(0.34375, 0.9375) * 180 / std::numbers::pi;

template <int D>
CheckReport run(const Model<D>& model, CheckOptions<D> options, const std::vector<PoorReason>& reasons) {
  options.input = &model.plc;
  options.delaunay = true;
  options.reasons = &reasons;
  return check(model.mesh, options);
}

/// Two triangles far from each other, each with an angle of about 20 degrees at its first point (0 and 3).
Model<2> two_needles() {
  Model<2> m;
  for (const double x : {0.0, 100.0}) m.plc.points.insert(m.plc.points.end(), {{{x, 0}}, {{x + 1, 0}}, {{x + 0.9375, 0.34375}}});
  for (const std::uint32_t i : {0u, 3u}) {
    m.plc.segments.push_back({{i, i + 1}, 0});
    m.plc.segments.push_back({{i + 1, i + 2}, 0});
    m.plc.segments.push_back({{i, i + 2}, 0});
    m.mesh.cells.push_back({i, i + 1, i + 2});
    for (const auto& s : {std::array{i, i + 1}, std::array{i + 1, i + 2}, std::array{i, i + 2}})
      m.mesh.subsegments.push_back({s, 0});
  }
  m.mesh.points = m.plc.points;
  m.mesh.input_points = 6;
  return m;
}

TEST(CheckBounds, SmallAnglesMustHold) {
  const Model<2> m = two_needles();
  const GivenEntity a = between(m, 0, 1), b = between(m, 0, 2);
  const GivenEntity c = between(m, 3, 4), d = between(m, 3, 5), opposite = between(m, 4, 5);
  CheckOptions<2> options;
  options.radius_edge_bound = 1.41422;
  const auto with = [&](std::vector<PoorReason> reasons) { return run(m, options, reasons); };
  const auto none = with({});
  EXPECT_EQ(none.exit_code(), 6);
  EXPECT_EQ(none.over_radius_edge, 2u);
  EXPECT_EQ(none.count(Kind::over_radius_edge), 2u);

  const PoorReason first{0, Code::small_angle, {a, b}, needle_angle};
  const auto good = with({first, {1, Code::small_angle, {c, d}, needle_angle}});
  EXPECT_EQ(good.exit_code(), 1);
  EXPECT_EQ(good.explained, 2u);

  const std::vector<std::pair<const char*, PoorReason>> false_claims = {
      {"an angle of 80 degrees", {1, Code::small_angle, {c, opposite}, needle_angle}},
      {"an angle that is not theirs", {1, Code::small_angle, {c, d}, needle_angle + 1e-9}},
      {"one that is, elsewhere", {1, Code::small_angle, {c, d}, 59}},
      {"segments that do not touch", {1, Code::small_angle, {c, a}, needle_angle}},
      {"a small angle far away", {1, Code::small_angle, {a, b}, needle_angle}},
      {"one segment twice", {1, Code::small_angle, {c, c}, needle_angle}},
      {"no such segment", {1, Code::small_angle, {c, named_segment<2>(m.plc.points[3], {{107, 7}})}, needle_angle}},
      {"no entity", {1, Code::small_angle, {GivenEntity{}, c}, needle_angle}},
      {"rounding, for half of the cells", {1, Code::rounding, {}, 0}},
      {"a bound above the proved one", {1, Code::beyond_theory, {}, 0}},
  };
  for (const auto& [what, reason] : false_claims) {
    const auto report = with({first, reason});
    EXPECT_EQ(report.exit_code(), 6) << what;
    EXPECT_GT(report.count(Kind::bad_reason), 0u) << what;
  }
  EXPECT_EQ(with({first, {7, Code::rounding, {}, 0}}).count(Kind::bad_reason), 1u) << "no such cell";
  EXPECT_EQ(with({first, {0, Code::rounding, {}, 0}}).count(Kind::over_radius_edge), 1u) << "a reason for another cell";
  // Any of several reasons will do.
  EXPECT_EQ(with({first, {1, Code::beyond_theory, {}, 0}, {1, Code::small_angle, {d, c}, needle_angle}}).exit_code(), 1);
}

/// A triangle 100 long, 20 below it a needle of length 1. The long side of the first is in so many pieces, each the base of a
/// cell.
Model<2> needle_below(std::uint32_t pieces) {
  Model<2> m;
  m.plc.points = {{{0, 0}}, {{128, 0}}, {{128, 48}}, {{32, -20}}, {{33, -20}}, {{32.9375, -19.65625}}};
  for (const auto& s :
       {std::array{0u, 1u}, std::array{1u, 2u}, std::array{0u, 2u}, std::array{3u, 4u}, std::array{4u, 5u}, std::array{3u, 5u}})
    m.plc.segments.push_back({s, 0});
  m.mesh.points = m.plc.points;
  m.mesh.input_points = 6;
  for (std::uint32_t i = 1, last = 0; i <= pieces; ++i) {
    const std::uint32_t next = i == pieces ? 1 : 5 + i;
    if (i < pieces) m.mesh.points.push_back({{128.0 * i / pieces, 0}});
    m.mesh.cells.push_back({last, next, 2});
    m.mesh.subsegments.push_back({{last, next}, 0});
    last = next;
  }
  m.mesh.cells.push_back({3, 4, 5});
  for (std::size_t i = 1; i < m.plc.segments.size(); ++i) m.mesh.subsegments.push_back({m.plc.segments[i].points, 0});
  return m;
}

// A map with crossings resolved: a triangle had no reason, since the segment that could not be split for it was 2.6 circumradii
// away.
TEST(CheckBounds, SegmentsStopWhatMeetsTheirPiecesDisks) {
  CheckOptions<2> options;
  options.radius_edge_bound = 1.41422;
  for (const std::uint32_t pieces : {1u, 2u, 4u, 8u, 16u}) {
    const Model<2> m = needle_below(pieces);
    const GivenEntity base = between(m, 0, 1), slope = between(m, 0, 2);
    const double angle = std::atan2(48, 128) * 180 / std::numbers::pi;
    std::vector<PoorReason> reasons;
    for (std::uint32_t c = 0; c <= pieces; ++c) reasons.push_back({c, Code::small_angle, {base, slope}, angle});
    const auto report = run(m, options, reasons);
    const bool meets = pieces <= 2;  // disks of radius 64, 32, 16 and so on, 20 away
    EXPECT_EQ(report.exit_code(), meets ? 1 : 6) << pieces;
    EXPECT_EQ(report.count(Kind::bad_reason), meets ? 0u : 1u) << pieces;
    reasons.back().entities = {slope, base};  // farther, but in one piece
    EXPECT_EQ(run(m, options, reasons).count(Kind::bad_reason), 0u) << pieces;
    reasons.back().entities = {base, between(m, 1, 2)};
    EXPECT_EQ(run(m, options, reasons).count(Kind::bad_reason), 1u) << pieces << ", a right angle";
  }
}

TEST(CheckBounds, BeyondTheoryBelowTheProvedBound) {
  CheckOptions<2> options;
  options.radius_edge_bound = 1.2;
  const auto report = run(two_needles(), options, {{0, Code::beyond_theory, {}, 0}, {1, Code::beyond_theory, {}, 0}});
  EXPECT_EQ(report.exit_code(), 1);
}

TEST(CheckBounds, ReasonsNeedTheInput) {
  const Model<2> m = two_needles();
  CheckOptions<2> options;
  options.radius_edge_bound = 1.41422;
  const std::vector<PoorReason> reasons{{0, Code::small_angle, {between(m, 0, 1), between(m, 0, 2)}, needle_angle}};
  options.reasons = &reasons;
  const auto report = check(m.mesh, options);
  EXPECT_EQ(report.count(Kind::bad_reason), 1u);
  EXPECT_EQ(report.count(Kind::over_radius_edge), 1u);
}

TEST(CheckBounds, AnglesInSpace) {
  // In the block all angles are right. In the slanted one the facets through a corner meet at 60 or 120 degrees.
  CheckOptions<3> options;
  options.radius_edge_bound = 0.5;  // below what any tetrahedron has
  const auto claim = [&](const Model<3>& m, EntityRef a, EntityRef b) {
    const Domain<3> domain(m.plc);
    const double angle = entity_angle(domain, a, b);
    const auto report = run(m, options, {{0, Code::small_angle, {named(domain, a), named(domain, b)}, angle}});
    return report.explained == 1;
  };
  const auto segment = [](EntityId s) { return EntityRef{EntityKind::segment, s}; };
  const auto facet = [](EntityId f) { return EntityRef{EntityKind::facet, f}; };
  const auto straight_block = solid_block<3>("block", 2, straight<3>());
  const auto slanted_block = solid_block<3>("block", 2, slanted<3>());
  int straight_small = 0, slanted_facets = 0, slanted_mixed = 0;
  for (EntityId a = 0; a < 12; ++a)
    for (EntityId b = 0; b < 12; ++b) {
      straight_small += claim(straight_block, segment(a), segment(b));
      if (a < 6 && b < 6) straight_small += claim(straight_block, facet(a), facet(b));
      if (b < 6) straight_small += claim(straight_block, segment(a), facet(b));
      if (a < 6 && b < 6) slanted_facets += claim(slanted_block, facet(a), facet(b));
      if (b < 6) slanted_mixed += claim(slanted_block, segment(a), facet(b));
    }
  EXPECT_EQ(straight_small, 0);
  EXPECT_GT(slanted_facets, 0);
  EXPECT_LE(slanted_facets, 12);  // half of the 12 pairs with a common edge, both ways
  EXPECT_GT(slanted_mixed, 0);
}

/// A block of two prisms whose top, of two facets, is plane but for half of the tolerance; its first edge is 20 tolerances long.
Model<3> block_with_an_uneven_top() {
  Model<3> m;
  m.plc.points = {{{0, 0, 1}},       {{0.02, 0, 1}},    {{5, 5, 1.0005}}, {{0, 5, 1}},
                  {{0.2, -0.02, 0}}, {{0.3, -0.02, 0}}, {{5, 5, 0}},      {{0.2, 5, 0}}};
  m.mesh.cells = {{0, 2, 1, 4}, {1, 2, 5, 4}, {2, 6, 5, 4}, {0, 3, 2, 4}, {2, 3, 6, 4}, {3, 7, 6, 4}};
  const std::vector<std::array<std::uint32_t, 3>> walls{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {0, 1, 4}, {1, 4, 5},
                                                        {1, 2, 5}, {2, 5, 6}, {2, 3, 6}, {3, 6, 7}, {0, 3, 4}, {3, 4, 7}};
  for (const auto& w : walls) {
    m.plc.facets.push_back({{{w[0], w[1], w[2]}}, {}, 0});
    m.mesh.subfacets.push_back({w, 0});
  }
  m.plc.tolerance = 0.001;
  m.mesh.points = m.plc.points;
  m.mesh.input_points = 8;
  return m;
}

// wam2.stl of a robot's arm, without the optimiser: of a facet in one plane but for the tolerance no short edge was known, so
// that a true angle with one was none.
TEST(CheckBounds, CornersOfGivenTrianglesAreKnown) {
  const Model<3> m = block_with_an_uneven_top();
  CheckOptions<3> options;
  options.radius_edge_bound = 0.5;
  options.tolerance = m.plc.tolerance;
  const GivenEntity edge = named_segment<3>(m.plc.points[0], m.plc.points[4]);
  const double angle = std::acos(0.2 / std::sqrt(0.2 * 0.2 + 0.02 * 0.02 + 1)) * 180 / std::numbers::pi;
  const auto explained = [&](std::uint32_t facet, double stated) {
    const auto report = run(m, options, {{0, Code::small_angle, {named_facet(facet), edge}, stated}});
    EXPECT_EQ(report.count(Kind::over_radius_edge), 5u);
    return report.explained == 1;
  };
  EXPECT_TRUE(explained(0, angle));
  EXPECT_FALSE(explained(0, angle - 1));
  EXPECT_FALSE(explained(4, angle)) << "a facet that has the edge";
}

TEST(CheckBounds, Sizes) {
  auto m = two_regions<3>(straight<3>());  // cells of volume 1/6, circumradius sqrt(3)/2
  CheckOptions<3> options;
  const auto over = [&] { return run(m, options, {}).over_size; };
  const std::uint64_t cells = m.mesh.cells.size();
  options.size = std::sqrt(0.75);
  const bool rounded_down = std::sqrt(0.75) * std::sqrt(0.75) < 0.75;
  EXPECT_EQ(over(), rounded_down ? cells : 0u) << "the bound is met or missed by all alike";
  options.size = 0.8660;
  EXPECT_EQ(over(), cells);
  options.size = [](const Point3& p) { return p[0] < 2 ? 0.8660 : 0.8661; };
  EXPECT_EQ(over(), cells / 2);
  options.size = {};
  options.max_measure = 0.16;
  EXPECT_EQ(over(), cells);
  options.max_measure = 0.17;
  EXPECT_EQ(over(), 0u);
  m.plc.regions[1].size = 0.16;
  EXPECT_EQ(over(), cells / 2) << "the bound of one region";
  EXPECT_EQ(run(m, options, {}).exit_code(), 6);
  options.size = [](const Point3&) { return std::nan(""); };
  EXPECT_THROW(run(m, options, {}), UsageError);
}

TEST(CheckBounds, AreasInThePlane) {
  const auto m = two_regions<2>(straight<2>());
  CheckOptions<2> options;
  options.size = 0.5;
  EXPECT_EQ(run(m, options, {}).over_size, 0u);
  options.size = 0.49;
  EXPECT_EQ(run(m, options, {}).over_size, m.mesh.cells.size());
}

/// A strip of squares, turned so that Steiner points on its long sides are rounded.
Model<2> turned_strip(const Lattice<2>& size, long shift) {
  const AffineMap<2> map{{1000 + 37 * shift, 500 - shift}, {{{20, 15}, {-15, 20}}}};
  const Lattice<2> low{};
  PlcMaker<2> maker(map);
  maker.box(low, size);
  Block<2> block{size, map};
  block.marker = [=](int axis, const auto& corners) { return box_marker<2>(low, size, axis, corners); };
  return {"turned_strip", maker.plc, BlockMesher<2>(block).run(maker.lattice)};
}

TEST(CheckDelaunay, RoundingIsCountedWhereSlantedPointsMayMove) {
  std::uint64_t rounding = 0, strict = 0;
  for (long shift = 0; shift < 10; ++shift) {
    const auto m = turned_strip({31, 1}, shift);  // no point in the volume
    const auto report = run(m, {}, {});
    EXPECT_EQ(report.exit_code(), 0);
    rounding += report.not_delaunay_rounding;
    CheckOptions<2> exact;
    exact.conformity_ulps = 0;
    const auto without = run(m, exact, {});
    EXPECT_EQ(without.not_delaunay_rounding, 0u) << "without ulps nothing may move";
    strict += without.count(Kind::not_delaunay);
  }
  EXPECT_GT(rounding, 0u);
  EXPECT_EQ(strict, rounding);
}

TEST(CheckDelaunay, VolumePointsAreNobodysRounding) {
  std::uint64_t real = 0;
  for (long shift = 0; shift < 10; ++shift) {
    const auto report = run(turned_strip({9, 9}, shift), {}, {});
    real += report.count(Kind::not_delaunay);
    EXPECT_EQ(report.finding_count, report.count(Kind::not_delaunay));
  }
  EXPECT_GT(real, 0u);
}

TEST(CheckDelaunay, RefusedOnlyBesideANamedEntity) {
  auto m = two_needles();
  // A square beside the needles, with its wrong diagonal after a push: points 6 to 9.
  m.plc.points.insert(m.plc.points.end(), {{{0, 5}}, {{1, 5}}, {{1.25, 6.5}}, {{0, 6}}});
  m.mesh.points = m.plc.points;
  m.mesh.cells.push_back({6, 7, 8});
  m.mesh.cells.push_back({6, 8, 9});
  for (const auto& s : {std::array{6u, 7u}, std::array{7u, 8u}, std::array{8u, 9u}, std::array{6u, 9u}}) {
    m.plc.segments.push_back({s, 0});
    m.mesh.subsegments.push_back({s, 0});
  }
  m.mesh.input_points = 10;
  EXPECT_EQ(run(m, {}, {}).count(Kind::not_delaunay), 1u);
  const auto said = run(m, {.not_delaunay_left = 1}, {});  // as hellbot_hidra_plus.obj, without the optimiser, has 31
  EXPECT_EQ(said.not_delaunay_unexplained, 1u);
  EXPECT_EQ(said.exit_code(), 1);
  const PoorReason elsewhere{0, Code::small_angle, {between(m, 0, 1), between(m, 0, 2)}, needle_angle};
  EXPECT_EQ(run(m, {}, {elsewhere}).count(Kind::not_delaunay), 1u);
  const PoorReason no_angle{2, Code::small_angle, {between(m, 6, 7), between(m, 7, 8)}, needle_angle};
  EXPECT_EQ(run(m, {}, {no_angle}).count(Kind::not_delaunay), 1u) << "an entity named with a false angle";
  // With a needle at the square's corner the same face is one beside a refused entity.
  m.plc.points.push_back({{-1, 4.875}});
  m.plc.points.push_back({{-1, 5.125}});
  m.mesh.points = m.plc.points;
  m.mesh.input_points = 12;
  m.mesh.cells.push_back({6, 11, 10});
  for (const auto& s : {std::array{6u, 10u}, std::array{6u, 11u}, std::array{10u, 11u}}) {
    m.plc.segments.push_back({s, 0});
    m.mesh.subsegments.push_back({s, 0});
  }
  const PoorReason beside{
      4, Code::small_angle, {between(m, 6, 10), between(m, 6, 11)}, 2 * std::atan2(0.125, 1) * 180 / std::numbers::pi};
  const auto report = run(m, {}, {beside});
  EXPECT_EQ(report.not_delaunay_refused, 1u);
  EXPECT_EQ(report.not_delaunay_unexplained, 0u);
  EXPECT_EQ(report.exit_code(), 0) << "as the mesher's: the bounds decide";
}

template <class Tag>
class CheckOutside : public testing::Test {};
TYPED_TEST_SUITE(CheckOutside, test::Dimensions);

TYPED_TEST(CheckOutside, FilledHolesAreFound) {
  constexpr int D = TypeParam::value;
  for (const auto& map : {straight<D>(), slanted<D>()}) {
    const auto report = run(cavity<D>(map, true), {}, {});
    EXPECT_EQ(report.exit_code(), 6);
    EXPECT_GE(report.count(Kind::hole_filled), 2u) << "by its walls and by its seed";
  }
}

TYPED_TEST(CheckOutside, MissingEntitiesOutsideAreFine) {
  constexpr int D = TypeParam::value;
  auto m = cavity<D>(straight<D>());
  const auto add_point = [&](double x) {
    Point<D> p;
    for (int k = 0; k < D; ++k) p[k] = x + 0.0625 * k * k;
    m.plc.points.push_back(p);
    return static_cast<std::uint32_t>(m.plc.points.size() - 1);
  };
  const auto a = add_point(10), b = add_point(11), c = add_point(1.3), d = add_point(1.6);
  m.plc.segments.push_back({{a, b}, 3});  // outside
  m.plc.segments.push_back({{c, d}, 4});  // in the cavity
  add_point(12);
  EXPECT_EQ(run(m, {}, {}).exit_code(), 0);
  // They may also stay among the points, as long as no cell needs them.
  for (std::size_t i = m.mesh.input_points; i < m.plc.points.size(); ++i) m.mesh.points.push_back(m.plc.points[i]);
  EXPECT_EQ(run(m, {}, {}).exit_code(), 0);
  // The same inside the solid is missing.
  add_point(2.25);
  const auto report = run(m, {}, {});
  EXPECT_EQ(report.count(Kind::missing_input_point), 1u);
  const auto e = static_cast<std::uint32_t>(m.plc.points.size() - 1), f = add_point(2.5);
  m.plc.segments.push_back({{e, f}, 0});
  EXPECT_EQ(run(m, {}, {}).count(Kind::segment_not_conforming), 1u);
}

TYPED_TEST(CheckOutside, SeedsInTheWrongPlace) {
  constexpr int D = TypeParam::value;
  auto m = two_regions<D>(straight<D>());
  m.plc.regions[0].point = m.plc.points[0];
  EXPECT_GT(run(m, {}, {}).count(Kind::wrong_region), 0u) << "on a corner";
  m.plc.regions[0].point[0] = -1;
  EXPECT_GT(run(m, {}, {}).count(Kind::wrong_region), 0u) << "outside";
  m = two_regions<D>(straight<D>());
  std::swap(m.plc.regions[0].attribute, m.plc.regions[1].attribute);
  EXPECT_GT(run(m, {}, {}).count(Kind::wrong_region), 0u) << "labels exchanged";
}

// Six triangles that turn round a vertex twice: every one is positive, all faces match, and the hull is a closed curve.
TEST(CheckOverlap, AFanThatTurnsTwice) {
  OutputMesh<2> mesh;
  mesh.points.push_back({{0, 0}});
  for (int i = 0; i < 6; ++i) {
    const double angle = 6.283185307179586 * i / 3, radius = i < 3 ? 1 : 1.5;
    mesh.points.push_back({{radius * std::cos(angle), radius * std::sin(angle)}});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % 6;
    mesh.cells.push_back({0, a, b});
    mesh.subsegments.push_back({{a, b}, 0});
  }
  const auto report = check(mesh, CheckOptions<2>{});
  EXPECT_EQ(report.count(Kind::overlapping), 1u);
  EXPECT_EQ(report.count(Kind::bad_link), 0u);
}

TEST(CheckReport, CountsAllAndListsSome) {
  auto m = solid_block<3>("block", 3, straight<3>());
  for (auto& cell : m.mesh.cells) std::swap(cell[0], cell[1]);
  CheckOptions<3> options;
  options.max_listed = 5;
  const auto report = run(m, options, {});
  EXPECT_EQ(report.count(Kind::inverted_cell), m.mesh.cells.size());
  EXPECT_GE(report.finding_count, m.mesh.cells.size());
  EXPECT_EQ(
      std::count_if(report.findings.begin(), report.findings.end(), [](const auto& f) { return f.kind == Kind::inverted_cell; }),
      5);
  for (const auto& f : report.findings) {
    EXPECT_EQ(f.message.back(), '.');
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(f.message[0]))) << f.message;
  }
}

TEST(CheckReport, EmptyMeshes) {
  EXPECT_EQ(check(OutputMesh<3>{}, CheckOptions<3>{}).exit_code(), 0);
  auto m = solid_block<3>("block", 1, straight<3>());
  m.mesh = {};
  const auto report = run(m, {}, {});
  EXPECT_GT(report.count(Kind::wrong_volume), 1u) << "the volume, and the walls that it is without";
  EXPECT_EQ(report.finding_count, report.count(Kind::wrong_volume));
}

}  // namespace test_check_bounds
