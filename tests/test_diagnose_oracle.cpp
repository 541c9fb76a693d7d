// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What meets what, against clipping in rationals, pair by pair: many small random inputs with few coordinates, where
// degeneracy is common; the same scaled, and turned and rounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "clipping_oracle.hpp"
#include "domain_plcs.hpp"
#include "pgdr/diagnosis.hpp"
#include "sanitized.hpp"

namespace pgdr::test_diagnose_oracle {

using clipping::Findings;
using clipping::Oracle;

template <int D>
Findings found_by(const Diagnosis<D>& d, const Domain<D>& domain) {
  Findings out;
  for (const auto& i : d[Finding::facets_cross].listed) out.cross.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::facets_overlap].listed) out.overlap.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::segment_crosses_facet].listed)
    out.segment_facet.insert({i.what.ids[0], i.what.ids[1], i.what.ids[2]});
  const auto point = [&](std::int64_t number) {  // the Domain has points that the input has not
    return static_cast<std::uint32_t>(std::ranges::find(domain.input_of_point(), number) - domain.input_of_point().begin());
  };
  const auto segment = [&](std::int64_t p, std::int64_t q) -> std::int64_t {
    return test::find_segment(domain, point(p), point(q));
  };
  for (const auto& i : d[Finding::segments_cross].listed)
    out.segments_cross.insert({segment(i.what.ids[0], i.what.ids[1]), segment(i.what.ids[2], i.what.ids[3])});
  for (const auto& i : d[Finding::point_on_facet].listed) out.on_facet.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::point_on_segment].listed) out.on_edge.insert({i.what.ids[0], i.what.ids[1], i.what.ids[2]});
  return out;
}

struct Tally {
  int valid = 0, cross = 0, added = 0, segment_facet = 0, segments = 0, on_facet = 0, on_edge = 0, inner_edges = 0;
};

template <int D>
void compare(const Plc<D>& plc, Tally& tally) {
  std::vector<Diagnostic> refused;
  const Domain<D> domain = Domain<D>::without_invalid(plc, refused);
  const Diagnosis<D> diagnosis = diagnose(plc, {.most_listed = 1000000});
  const Findings expected = Oracle<D>(domain).found(), found = found_by(diagnosis, domain);
  EXPECT_EQ(diagnosis[Finding::invalid_entity].count, refused.size());
  ASSERT_EQ(found.cross, expected.cross);
  ASSERT_EQ(found.overlap, expected.overlap);
  ASSERT_EQ(found.segment_facet, expected.segment_facet);
  ASSERT_EQ(found.segments_cross, expected.segments_cross);
  // Where facets are crossed at a point that was added, it rests on what crosses them.
  const bool adds_points = domain.points().size() > plc.points.size();
  if (!adds_points) {
    ASSERT_EQ(found.on_facet, expected.on_facet);
    ASSERT_EQ(found.on_edge, expected.on_edge);
  }
  tally.valid += expected == Findings{};
  tally.cross += !expected.cross.empty();
  tally.added += adds_points;
  tally.segment_facet += !expected.segment_facet.empty();
  tally.segments += !expected.segments_cross.empty();
  EXPECT_TRUE(adds_points || (expected.on_facet.empty() && expected.on_edge.empty()));  // the Domain has repaired these
  for (const Diagnostic& repair : domain.repairs()) {
    tally.on_facet += repair.code == Errc::point_on_facet;
    tally.on_edge += repair.code == Errc::point_on_segment;
    tally.inner_edges += repair.code == Errc::entities_intersect;
  }
}

// On the grid {0 .. steps}^D; points distinct.
template <int D>
Plc<D> random_plc(std::mt19937_64& random, int steps) {
  const auto pick = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
  Plc<D> plc;
  const std::size_t points = 4 + pick(6);
  std::set<std::array<double, D>> taken;
  while (plc.points.size() < points) {
    Point<D> p;
    for (double& x : p.x) x = pick(static_cast<std::size_t>(steps) + 1);
    if (taken.insert(p.x).second) plc.points.push_back(p);
  }
  const auto distinct = [&](std::size_t n) {
    std::vector<std::uint32_t> v;
    while (v.size() < n)
      if (const std::uint32_t i = pick(points); !std::count(v.begin(), v.end(), i)) v.push_back(i);
    return v;
  };
  if constexpr (D == 3) {
    for (std::uint32_t k = pick(5); k-- > 0;) plc.facets.push_back({{distinct(3)}, {}, static_cast<int>(pick(2))});
    std::vector<std::uint32_t> level;  // a polygon of one plane; some of them cross themselves
    for (std::uint32_t v = 0; v < points; ++v)
      if (plc.points[v][2] == 1) level.push_back(v);
    if (level.size() > 3 && pick(2) == 0) plc.facets.push_back({{level}, {}, 0});
  }
  for (std::uint32_t k = pick(6); k-- > 0;) {
    const auto e = distinct(2);
    plc.segments.push_back({{e[0], e[1]}, 0});
  }
  return plc;
}

TEST(DiagnosisOracle, SpaceWithFewCoordinates) {
  std::mt19937_64 random(oracle::seed());
  Tally tally;
  for (int k = 0; k < (test::sanitized ? 4000 : 10000) && !HasFatalFailure(); ++k) compare(random_plc<3>(random, 2), tally);
  for (const int n : {tally.valid, tally.cross, tally.segment_facet, tally.segments, tally.on_facet, tally.on_edge, tally.added})
    EXPECT_GT(n, 30);
  EXPECT_GT(tally.inner_edges, 10);
}

TEST(DiagnosisOracle, PlaneWithFewCoordinates) {
  std::mt19937_64 random(oracle::seed() + 1);
  Tally tally;
  for (int k = 0; k < (test::sanitized ? 1500 : 4000) && !HasFatalFailure(); ++k) compare(random_plc<2>(random, 3), tally);
  for (const int n : {tally.valid, tally.segments, tally.on_edge}) EXPECT_GT(n, 100);
}

TEST(DiagnosisOracle, ScaledAndTurned) {
  std::mt19937_64 random(oracle::seed() + 2);
  Tally tally;
  for (int k = 0; k < (test::sanitized ? 200 : 500) && !HasFatalFailure(); ++k) {
    Plc<3> plc = random_plc<3>(random, 2);
    compare(test::turned(plc), tally);
    if (HasFatalFailure()) return;
    for (const double factor : {0x1p-200, 0.1, 0x1p300}) {
      Plc<3> scaled = plc;
      for (Point3& p : scaled.points)
        for (double& x : p.x) x *= factor;
      compare(scaled, tally);
    }
  }
}

}  // namespace pgdr::test_diagnose_oracle
