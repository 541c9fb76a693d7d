// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reasons of cells that the optimiser leaves: the checker holds every one, and excuses the same cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "given_names.hpp"
#include "model_plcs.hpp"
#include "refined_models.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_reasons_optimized {

using Code = PoorReason::Code;

/// Meshes and checks; how many reasons have each code.
std::map<Code, int> codes(const Plc<3>& plc, RefineOptions<3> options, const std::string& what) {
  const test::Outcome<3> out = test::refine_and_check(plc, options);
  EXPECT_LE(out.report.exit_code(), 1) << what << "\n" << test::findings(out.report);
  EXPECT_EQ(out.report.explained + out.report.unexplained, out.result.optimization.left) << what;
  EXPECT_EQ(out.report.unexplained, out.result.optimization.unexplained) << what;
  EXPECT_EQ(out.result.reasons.size(), out.result.optimization.left) << what;
  std::map<Code, int> count;
  for (const PoorReason& r : out.result.reasons) {
    ++count[r.code];
    const bool known = r.code == Code::input_dihedral || r.code == Code::small_angle;
    EXPECT_EQ(known, r.angle > 0) << what;
    EXPECT_LT(r.angle, std::max(*options.min_dihedral, 14.5)) << what;
  }
  return count;
}

/// A prism over a triangle with this angle, in degrees, at the origin.
Plc<3> wedge(double degrees, double height) {
  const double angle = degrees * std::numbers::pi / 180;
  return test::prism({{{0, 0}}, {{4, 0}}, {{4 * std::cos(angle), 4 * std::sin(angle)}}}, height);
}

TEST(OptimizedReasons, WedgesBelowTheTarget) {
  for (const double degrees : {1.0, 5.0, 12.0, 14.9, 17.0, 25.0})
    for (const double target : {15.0, 20.0}) {
      RefineOptions<3> options;
      options.min_dihedral = target;
      auto count = codes(wedge(degrees, 1), options, std::to_string(degrees) + " for " + std::to_string(target));
      if (degrees < target)
        EXPECT_GT(count[Code::input_dihedral], 0) << degrees << " for " << target;
      else
        EXPECT_EQ(count[Code::input_dihedral] + count[Code::small_angle], 0) << degrees << " for " << target;
    }
}

using Turn = std::function<Point3(const Point3&)>;
enum class Around { space_above, nothing };

/// A cone whose tip touches a floor inside of it, its sides rising at this angle, in degrees. It is empty in a box on the floor,
/// or full on a box below the floor, with nothing around it.
Plc<3> cone_on_floor(double degrees, Around around, const Turn& turn) {
  const double angle = degrees * std::numbers::pi / 180;
  const double low = around == Around::nothing ? -2 : 0;
  Plc<3> plc;
  test::add_box(plc, {{-2, -2, low}}, {{2, 2, low + 2}});
  const std::uint32_t tip = static_cast<std::uint32_t>(plc.points.size()), sides = 6;
  plc.points.push_back({{0, 0, 0}});
  std::vector<std::uint32_t> lid;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double way = 2 * std::numbers::pi * i / sides;
    plc.points.push_back({{std::cos(angle) * std::cos(way), std::cos(angle) * std::sin(way), std::sin(angle)}});
    test::add_polygon(plc, {tip, tip + 1 + i, tip + 1 + (i + 1) % sides}, 7);
    lid.push_back(tip + 1 + i);
  }
  test::add_polygon(plc, lid, 8);
  if (around == Around::space_above) plc.holes = {{{0, 0, 0.75 * std::sin(angle)}}};
  for (auto* points : {&plc.points, &plc.holes})
    for (Point3& p : *points) p = turn(p);
  return plc;
}

/// What is named, which is in one piece and has one of the facets of the input.
EntityRef entity_of(const Domain<3>& domain, const GivenEntity& name) {
  const auto is_named = [&](EntityRef e) { return test::named<3>(domain, e) == name; };
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (is_named({EntityKind::segment, s})) return {EntityKind::segment, s};
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (is_named({EntityKind::facet, f})) return {EntityKind::facet, f};
  return {};
}

/// How many reasons name a facet, and another or a segment, that have a point in common, and no segment at it.
int count_gaps(const Domain<3>& domain, const std::vector<PoorReason>& reasons) {
  return static_cast<int>(std::count_if(reasons.begin(), reasons.end(), [&](const PoorReason& r) {
    if (r.code != Code::small_angle) return false;
    EntityRef e = entity_of(domain, r.entities[0]), f = entity_of(domain, r.entities[1]);
    if (e.kind == EntityKind::facet) std::swap(e, f);
    if (f.kind != EntityKind::facet) return false;
    const auto own = domain.facet_segments(f.id);
    if (e.kind == EntityKind::segment) return std::find(own.begin(), own.end(), e.id) == own.end();
    const auto others = domain.facet_segments(e.id);
    return std::find_first_of(own.begin(), own.end(), others.begin(), others.end()) == own.end();
  }));
}

// A cone whose tip touches the floor at 3 degrees: the thin cells at the tip had no reason, as facets had to share a segment for
// one.
TEST(OptimizedReasons, FacetsThatShareOnePointForceCellsThere) {
  const auto as_it_is = [](const Point3& p) { return p; };
  const auto turned = [](const Point3& p) {  // by no right angle, and far away
    return Point3{0.48 * p[0] - 0.64 * p[1] + 0.6 * p[2] + 4e5, 0.8 * p[0] + 0.6 * p[1] + 5e6,
                  -0.36 * p[0] + 0.48 * p[1] + 0.8 * p[2]};
  };
  for (const auto& turn : {Turn(as_it_is), Turn(turned)})
    for (const auto around : {Around::space_above, Around::nothing})
      for (const double degrees : {2.0, 3.5, 4.0, 45.0, 89.0}) {
        const std::string what = std::to_string(degrees) + (around == Around::nothing ? ", nothing around" : "");
        RefineOptions<3> options;
        options.min_dihedral = 15;
        const Plc<3> plc = cone_on_floor(degrees, around, turn);
        const test::Outcome<3> out = test::refine_and_check(plc, options);
        EXPECT_LE(out.report.exit_code(), 1) << what << "\n" << test::findings(out.report);
        EXPECT_EQ(out.report.unexplained, out.result.optimization.unexplained) << what;
        // Thinner than arcsin(sin 15 / 4), 3.71 degrees, with cells between.
        const bool forced = degrees < 3.7 && around == Around::space_above;
        EXPECT_EQ(count_gaps(Domain<3>(plc), out.result.reasons) > 0, forced) << what;
      }
}

// The reason holds for the thin cells at the tip alone.
TEST(OptimizedReasons, NoOtherCellsAreForcedThere) {
  const Plc<3> plc = cone_on_floor(3, Around::space_above, [](const Point3& p) { return p; });
  const Domain<3> domain(plc);
  RefineOptions<3> options;
  options.min_dihedral = 15;
  auto result = refine<3>(domain, options);
  const auto is_gap = [&](const PoorReason& r) { return count_gaps(domain, {r}) > 0; };
  const auto gap = std::find_if(result.reasons.begin(), result.reasons.end(), is_gap);
  ASSERT_NE(gap, result.reasons.end());
  const auto entities = gap->entities;
  const double angle = gap->angle;
  const auto explained = [&] {
    CheckOptions<3> check_options;
    check_options.input = &plc;
    check_options.radius_edge_bound = options.radius_edge_bound;
    check_options.largest_cosine = result.optimization.claimed_cosine;
    check_options.reasons = &result.reasons;
    return check(result.mesh, check_options).explained;
  };
  const std::uint64_t before = explained();
  int given = 0;
  for (PoorReason& r : result.reasons)
    if (r.code == Code::not_found || r.code == Code::budget) {
      r.code = Code::small_angle;
      r.entities = entities;
      r.angle = angle;
      ++given;
    }
  EXPECT_GT(given, 0);
  EXPECT_EQ(explained(), before);
}

TEST(OptimizedReasons, HoldForStructures) {
  int left = 0;
  for (const auto& s : test::all_structures()) {
    RefineOptions<3> options;
    options.min_dihedral = 20;
    options.regions = RegionMode::automatic;
    for (const auto& [code, n] : codes(s.turns ? test::turned(s.plc) : s.plc, options, s.name)) left += n;
  }
  RecordProperty("left", left);
}

}  // namespace pgdr::test_reasons_optimized
