// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's bound on dihedral angles: cells below it, what excuses them, and what does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "given_names.hpp"
#include "input/sharp_angles.hpp"
#include "model_plcs.hpp"
#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/check.hpp"
#include "pgdr/predicates.hpp"
#include "test_check_models.hpp"

namespace test_check_dihedral {

using namespace pgdr;
using namespace pgdr::test;
using Kind = CheckFinding::Kind;
using Code = PoorReason::Code;
using Ids = std::vector<std::uint32_t>;

GivenEntity between(const Plc<3>& plc, std::uint32_t a, std::uint32_t b) {
  return named_segment<3>(plc.points[a], plc.points[b]);
}

/// At p, between the directions to q and r; in degrees.
double angle_at(const Plc<3>& plc, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
  const auto u = detail::difference(plc.points[q], plc.points[p]), w = detail::difference(plc.points[r], plc.points[p]);
  return std::acos(detail::dot(u, w) / std::sqrt(detail::dot(u, u) * detail::dot(w, w))) * 180 / std::numbers::pi;
}

CheckReport run(const Model<3>& model, const CheckOptions<3>& what, const std::vector<PoorReason>& reasons) {
  CheckOptions<3> options = what;
  options.input = &model.plc;
  options.reasons = &reasons;
  return check(model.mesh, options);
}

std::string listed(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

/// Of these triangles, each a facet; a mesh of these cells. The walls of the mesh are all faces with one cell, and `inner`; its
/// subsegments are the edges of `segments`.
Model<3> model_of(std::vector<Point3> points, std::size_t given, const std::vector<Ids>& facets,
                  std::vector<std::array<std::uint32_t, 4>> cells, std::vector<std::array<std::uint32_t, 3>> inner,
                  const std::vector<std::array<std::uint32_t, 2>>& segments) {
  Model<3> m;
  m.plc.points.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(given));
  for (const Ids& f : facets) m.plc.facets.push_back({{f}, {}, 0});
  m.mesh.points = std::move(points);
  m.mesh.input_points = given;
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (auto& c : cells) {
    if (orient<3>({m.mesh.points[c[0]], m.mesh.points[c[1]], m.mesh.points[c[2]], m.mesh.points[c[3]]}) != Sign::positive)
      std::swap(c[0], c[1]);
    for (int i = 0; i < 4; ++i) {
      auto face = face_without(c, i);
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  for (auto& f : inner) {
    std::sort(f.begin(), f.end());
    faces[f] = 1;
  }
  for (const auto& [face, count] : faces)
    if (count == 1) m.mesh.subfacets.push_back({face, 0});
  for (const auto& s : segments) m.mesh.subsegments.push_back({s, 0});
  m.mesh.cells = std::move(cells);
  return m;
}

constexpr std::uint32_t a = 0, b = 1, c = 2, d = 3;

/// One cell, with an angle of 5.7 degrees at the edge from a to b.
Model<3> wedge() {
  return model_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {1, 0.1, 0.5}}, 4, {{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}},
                  {{a, b, c, d}}, {}, {{a, b}, {a, c}, {a, d}, {b, c}, {b, d}, {c, d}});
}

/// The same in two cells at that edge, with a point in the middle of the edge from c to d.
Model<3> halved_wedge() {
  return model_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {1, 0.125, 0.5}, {1, 0.0625, 0.5}}, 4,
                  {{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}, {{a, b, c, 4}, {a, b, 4, d}}, {},
                  {{a, b}, {a, c}, {a, d}, {b, c}, {b, d}, {c, 4}, {4, d}});
}

/// Beside the wedge of one cell, beyond a wall, one of 84 degrees at the same edge, in two cells, the first of which has 5.7
/// degrees.
Model<3> two_wedges() {
  return model_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {1, 0.125, 0.5}, {0, 1.125, 0.5}, {0.875, 0.25, 0.5}}, 5,
                  {{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}, {a, d, 4}, {b, d, 4}, {a, b, 4}},
                  {{a, b, c, d}, {a, b, d, 5}, {a, b, 5, 4}}, {{a, b, d}},
                  {{a, b}, {a, c}, {a, d}, {b, c}, {b, d}, {c, d}, {a, 4}, {b, 4}, {d, 5}, {5, 4}});
}

CheckOptions<3> below(double degrees) {
  CheckOptions<3> options;
  options.largest_cosine = claimed_cosine(degrees);
  return options;
}

TEST(CheckDihedral, CellsAreCounted) {
  const auto block = solid_block<3>("block", 2, straight<3>());  // 45, 60 and 90 degrees
  const std::uint64_t cells = block.mesh.cells.size();
  EXPECT_EQ(run(block, below(44.9), {}).exit_code(), 0);
  const auto report = run(block, below(45.1), {});
  EXPECT_EQ(report.below_dihedral, cells);
  EXPECT_EQ(report.unexplained, cells);
  EXPECT_EQ(report.explained, 0u);
  EXPECT_EQ(report.finding_count, 0u);
  EXPECT_EQ(report.exit_code(), 1);
  CheckOptions<3> alone = below(45.1);
  EXPECT_EQ(check(block.mesh, alone).unexplained, cells);
  EXPECT_EQ(run(block, {}, {}).below_dihedral, 0u);
}

/// Of the walls at the edge from a to b.
double wedge_angle(const Plc<3>& plc) {
  const auto& p = plc.points;
  return dihedral_degrees(p[a], p[b], p[c], p[d]);
}

TEST(CheckDihedral, WedgesOfTheInputExplain) {
  for (const auto& m : {wedge(), halved_wedge()}) {
    const GivenEntity sharp = between(m.plc, a, b), blunt = between(m.plc, a, c);
    const double angle = wedge_angle(m.plc);
    const auto claims = [&](const GivenEntity& s, double stated) {
      std::vector<PoorReason> all;
      for (std::uint32_t i = 0; i < m.mesh.cells.size(); ++i) all.push_back({i, Code::input_dihedral, {s, {}}, stated});
      return all;
    };
    const auto good = run(m, below(15), claims(sharp, angle));
    EXPECT_EQ(good.exit_code(), 1) << listed(good);
    EXPECT_EQ(good.below_dihedral, m.mesh.cells.size());
    EXPECT_EQ(good.explained, m.mesh.cells.size());
    EXPECT_EQ(good.unexplained, 0u);
    const GivenEntity none = named_segment<3>({0, 0, 0}, {7, 7, 7});
    for (const auto& [s, stated] : {std::pair{blunt, angle},
                                    {none, angle},
                                    {named_facet(0), angle},
                                    {GivenEntity{}, angle},
                                    {sharp, angle * (1 + 1e-9)},
                                    {sharp, angle * (1 - 1e-9)},
                                    {sharp, 0.0}}) {
      const auto wrong = run(m, below(15), claims(s, stated));
      EXPECT_EQ(wrong.explained, 0u);
      EXPECT_EQ(wrong.unexplained, m.mesh.cells.size());
      EXPECT_EQ(wrong.exit_code(), 1);
    }
  }
  // Of cells over the ratio: true but no excuse, and not true.
  const auto m = halved_wedge();
  CheckOptions<3> thin = below(15);
  thin.radius_edge_bound = 0.6;
  const double angle = wedge_angle(m.plc);
  const auto claim = [&](const GivenEntity& e, double stated) {
    return run(m, thin,
               {{0, Code::input_dihedral, {e, {}}, stated}, {1, Code::input_dihedral, {between(m.plc, a, b), {}}, angle}});
  };
  EXPECT_EQ(claim(between(m.plc, a, b), angle).explained, 2u);
  EXPECT_EQ(claim(between(m.plc, a, b), angle + 1e-9).count(Kind::bad_reason), 1u) << "another angle";
  EXPECT_EQ(claim(between(m.plc, a, c), angle).unexplained, 1u);
  EXPECT_EQ(claim(between(m.plc, a, c), angle).exit_code(), 1);
  EXPECT_EQ(claim(between(m.plc, a, d), angle).count(Kind::bad_reason), 1u);
  EXPECT_EQ(claim(named_facet(0), angle).count(Kind::bad_reason), 1u);
  // Below the halves' angles, but not the wedge's: the halves need not be.
  const auto halves = halved_wedge();
  const GivenEntity s = between(halves.plc, a, b);
  const auto report = run(halves, below(5),
                          {{0, Code::input_dihedral, {s, {}}, angle}, {1, Code::input_dihedral, {s, {}}, angle}});
  EXPECT_EQ(report.below_dihedral, 2u);
  EXPECT_EQ(report.explained, 0u);
}

TEST(CheckDihedral, TheWedgeMustBeTheCellsOwn) {
  const auto m = two_wedges();
  const GivenEntity s = between(m.plc, a, b);
  std::vector<PoorReason> claims;
  for (std::uint32_t i = 0; i < 3; ++i) claims.push_back({i, Code::input_dihedral, {s, {}}, wedge_angle(m.plc)});
  const auto report = run(m, below(10), claims);
  EXPECT_EQ(report.finding_count, 0u) << listed(report);
  EXPECT_EQ(report.below_dihedral, 2u);
  EXPECT_EQ(report.explained, 1u);
  EXPECT_EQ(report.unexplained, 1u);
}

/// A facet has an angle of 8.5 degrees at a; the edge from a to d is halved, and only one of the two cells is at a.
Model<3> sharp_corner() {
  return model_of({{0, 0, 0}, {1, 0, 0}, {1, 0.15, 0}, {0.75, 0.0625, 0.0625}, {0.375, 0.03125, 0.03125}}, 4,
                  {{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}, {{a, b, c, 4}, {4, b, c, d}}, {},
                  {{a, b}, {a, c}, {b, c}, {b, d}, {c, d}, {a, 4}, {4, d}});
}

TEST(CheckDihedral, SharpCornersExplainTheCellsAtThem) {
  const auto m = sharp_corner();
  const GivenEntity ab = between(m.plc, a, b), ac = between(m.plc, a, c), bc = between(m.plc, b, c);
  const double at_a = angle_at(m.plc, a, b, c);
  CheckOptions<3> options = below(44);
  const auto claims = [](const GivenEntity& s, const GivenEntity& t, double stated) {
    return std::vector<PoorReason>{{0, Code::small_angle, {s, t}, stated}, {1, Code::small_angle, {s, t}, stated}};
  };
  EXPECT_EQ(run(m, options, {}).below_dihedral, 2u);
  EXPECT_EQ(run(m, options, claims(ab, ac, at_a)).explained, 0u) << "there is no bound on the ratio";
  options.radius_edge_bound = 2;
  const auto ratio = run(m, options, claims(ab, ac, at_a));
  EXPECT_EQ(ratio.below_dihedral, 2u);
  EXPECT_EQ(ratio.finding_count, 0u) << listed(ratio);
  EXPECT_EQ(ratio.explained, 1u);
  EXPECT_EQ(ratio.unexplained, 1u);
  EXPECT_EQ(run(m, options, claims(ab, bc, angle_at(m.plc, b, a, c))).explained, 0u);
  EXPECT_EQ(run(m, options, claims(ab, ac, at_a + 1e-9)).explained, 0u) << "another angle";
  options.radius_edge_bound = 4;  // arcsin(1/8) is 7.2 degrees
  EXPECT_EQ(run(m, options, claims(ab, ac, at_a)).explained, 0u);
}

/// The prism over a rectangle with a notch, of 19 degrees at its tip, and a tooth beside it, of 3 degrees.
TEST(CheckDihedral, ANotchIsNoCorner) {
  const Plc<3> plc = test::prism(
      {{{0, 0}}, {{4, 0}}, {{4, 1}}, {{2, 1}}, {{1.85, 0.1}}, {{1.7, 1}}, {{1.6, 3}}, {{1.5, 1}}, {{0, 1}}}, 1);
  const Domain<3> domain(plc);
  const AngleBounds bounds{1, 1};
  const auto segment = [&](std::uint32_t p, std::uint32_t q) {
    const auto all = domain.segments();
    const auto at = std::ranges::find_if(all, [&](const DomainSegment& s) {
      return s.points == std::array{p, q} || s.points == std::array{q, p};
    });
    EXPECT_NE(at, all.end());
    return static_cast<EntityId>(at - all.begin());
  };
  EXPECT_TRUE(is_sharp_corner(domain, 6, segment(5, 6), segment(6, 7), bounds));
  EXPECT_FALSE(is_sharp_corner(domain, 4, segment(3, 4), segment(4, 5), bounds));
  EXPECT_FALSE(is_sharp_corner(domain, 5, segment(5, 6), segment(6, 7), bounds)) << "not at their common end";
  EXPECT_FALSE(is_sharp_corner(domain, 0, segment(0, 1), segment(0, 8), bounds));
  const auto meet = [&](EntityId s, EntityId t) {
    return meet_too_sharply(domain, {EntityKind::segment, s}, {EntityKind::segment, t}, bounds);
  };
  EXPECT_TRUE(meet(segment(3, 4), segment(4, 5)));
  EXPECT_TRUE(meet(segment(6, 7), segment(5, 6)));
  EXPECT_FALSE(meet(segment(0, 1), segment(0, 8)));
  EXPECT_FALSE(meet(segment(0, 1), segment(0, 1)));
}

TEST(CheckDihedral, WhatIsAdmittedIsUnexplained) {
  const auto block = solid_block<3>("block", 1, straight<3>());
  const std::uint64_t cells = block.mesh.cells.size();
  CheckOptions<3> options;
  options.radius_edge_bound = 0.5;  // below what any tetrahedron has
  for (const Code code : {Code::not_found, Code::budget}) {
    std::vector<PoorReason> reasons;
    for (std::uint32_t i = 0; i < cells; ++i) reasons.push_back({i, code, {}, 0});
    const auto report = run(block, options, reasons);
    EXPECT_EQ(report.exit_code(), 1) << listed(report);
    EXPECT_EQ(report.unexplained, cells);
    EXPECT_EQ(report.explained, 0u);
    reasons.pop_back();
    EXPECT_EQ(run(block, options, reasons).count(Kind::over_radius_edge), 1u);
  }
}

// The facets of this block meet at 60 degrees, where refinement alone may give up, and where cells can meet any of the bounds.
TEST(CheckDihedral, AnglesThatAreNotSmallExcuseNoCell) {
  const auto block = solid_block<3>("block", 2, slanted<3>());
  CheckOptions<3> refined;
  refined.radius_edge_bound = 0.5;
  CheckOptions<3> optimized = refined;
  optimized.largest_cosine = claimed_cosine(0.01);
  optimized.radius_edge_bound = refined.radius_edge_bound = 0.6;
  std::uint64_t explained = 0;
  const Domain<3> domain(block.plc);
  for (EntityId f = 0; f < 6; ++f)
    for (EntityId g = 0; g < f; ++g) {
      const EntityRef e{EntityKind::facet, f}, other{EntityKind::facet, g};
      const PoorReason claim{0, Code::small_angle, {named(domain, e), named(domain, other)}, entity_angle(domain, e, other)};
      const auto before = run(block, refined, {claim}), after = run(block, optimized, {claim});
      explained += before.explained;
      EXPECT_EQ(after.explained, 0u);
      EXPECT_EQ(after.unexplained, before.explained);
      EXPECT_EQ(after.count(Kind::bad_reason), before.count(Kind::bad_reason));
    }
  EXPECT_GT(explained, 0u);
}

TEST(CheckDihedral, DelaunayIsAskedForOnlyWhereItIsClaimed) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{1, 0}}, {{1.25, 1.5}}, {{0, 1}}};
  mesh.cells = {{0, 1, 2}, {0, 2, 3}};
  for (std::uint32_t i = 0; i < 4; ++i) mesh.subsegments.push_back({{i, (i + 1) % 4}, 0});
  CheckOptions<2> options;
  EXPECT_EQ(check(mesh, options).exit_code(), 0);
  options.delaunay = true;
  EXPECT_EQ(check(mesh, options).count(Kind::not_delaunay), 1u);
}

}  // namespace test_check_dihedral
