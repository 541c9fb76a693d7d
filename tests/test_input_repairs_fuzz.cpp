// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Random inputs with few coordinates: either a mesh that passes the checker, or a typed error; never a hang. What the
// Domain cannot refuse by itself has no points left on what they do not belong to. PGDR_FUZZ: how many times the usual
// number of inputs.
#include <gtest/gtest.h>

#include <cstdlib>

#include "domain_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/refine.hpp"
#include "repair_plcs.hpp"

namespace pgdr::test_input_repairs_fuzz {

struct Tally {
  int meshed = 0, refused = 0, repaired = 0;
};

std::string findings(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

double area(const Plc<3>& plc, const std::vector<std::uint32_t>& polygon) {
  double sum = 0;  // convex
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += test::area(plc.points[polygon[0]], plc.points[polygon[k]], plc.points[polygon[k + 1]]);
  return sum;
}

// Facets cover after their repair what they covered before.
void expect_same_area(const Plc<3>& plc, const Domain<3>& domain) {
  for (const Diagnostic& d : domain.repairs())
    if (d.code == Errc::repeated_facet || d.code == Errc::facets_overlap) return;
  double given = 0, now = 0;
  for (const auto& f : plc.facets) given += area(plc, f.polygons[0]);
  for (EntityId f = 0; f < domain.facets().size(); ++f) now += test::area(domain, f);
  EXPECT_NEAR(given, now, 1e-12 * given);
}
void expect_same_area(const Plc<2>&, const Domain<2>&) {}

template <int D>
void mesh(const Plc<D>& plc, RegionMode regions, Tally& tally) {
  const Diagnosis<D> diagnosis = diagnose(plc);
  EXPECT_EQ(diagnosis[Finding::point_on_segment].count, 0u);
  EXPECT_EQ(diagnosis[Finding::point_on_facet].count, 0u);
  try {
    const Domain<D> domain(plc);
    expect_same_area(plc, domain);
    RefineOptions<D> options;
    options.max_vertices = 3000;
    options.regions = regions;
    const auto result = refine<D>(domain, options);
    EXPECT_EQ(diagnosis.error_count(), 0u);
    CheckOptions<D> check_options;
    check_options.input = &plc;
    check_options.tolerance = domain.tolerance();
    check_options.regions = regions;
    if (result.stop == StopCause::finished) check_options.radius_edge_bound = options.radius_edge_bound;
    check_options.largest_cosine = result.optimization.claimed_cosine;
    check_options.delaunay = result.delaunay;
    check_options.reasons = &result.reasons;
    const CheckReport report = check<D>(result.mesh, check_options);
    if (result.stop == StopCause::finished) {
      EXPECT_LE(report.exit_code(), 1) << findings(report);
    } else
      for (const auto& f : report.findings) EXPECT_EQ(f.kind, CheckFinding::Kind::bad_reason) << findings(report);
    ++tally.meshed;
    tally.repaired += !domain.repairs().empty();
  } catch (const InputError& e) {
    EXPECT_GT(diagnosis.error_count(), 0u) << e.what();
    ++tally.refused;
  }
}

int count(int usual) {
  const char* factor = std::getenv("PGDR_FUZZ");
  return factor == nullptr ? usual : usual * std::atoi(factor);
}

template <class Make>
void run(int n, Make&& make, Tally& tally) {
  for (int k = 0; k < n; ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::GridPlcs plcs(seed);
    auto plc = make(plcs);
    if (k % 5 == 0) plc = test::oblique(plc);
    mesh(k % 3 == 0 ? test::moved(plc, k, k % 41 - 20, k % 2 * 0.375) : plc,
         k % 4 < 2 ? RegionMode::automatic : RegionMode::seeds, tally);
  }
  std::cout << tally.meshed << " meshed, " << tally.repaired << " repaired, " << tally.refused << " refused\n";
}

TEST(RepairsFuzz, Cubes) {
  Tally tally;
  run(
      count(150), [](test::GridPlcs& p) { return p.cube(); }, tally);
  EXPECT_GT(tally.repaired, 40);
  EXPECT_GT(tally.refused, 10);
}

TEST(RepairsFuzz, Soups) {
  Tally tally;
  run(
      count(200), [](test::GridPlcs& p) { return p.soup(); }, tally);
  EXPECT_GT(tally.refused, 30);
}

TEST(RepairsFuzz, Planes) {
  Tally tally;
  run(
      count(300), [](test::GridPlcs& p) { return p.plane(); }, tally);
  EXPECT_GT(tally.repaired, 50);
  EXPECT_GT(tally.refused, 20);
}

}  // namespace pgdr::test_input_repairs_fuzz
