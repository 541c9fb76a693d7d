// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs with inner structure, with and without automatic regions; plain, turned and scaled. Labels against those written
// down beside the inputs, and all of it through the checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "parallel_support.hpp"
#include "pgdr/diagnosis.hpp"
#include "repair_plcs.hpp"
#include "structure_plcs.hpp"

namespace pgdr {
namespace {

using test::Structure;

template <int D>
bool holds(const OutputMesh<D>& mesh, std::size_t cell, const Point<D>& p) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[cell][i]];
  for (int i = 0; i <= D; ++i) {
    Simplex<D> t = s;
    t[i] = p;
    if (orient<D>(t) == Sign::negative) return false;
  }
  return true;
}

/// 0 where there is no cell.
template <int D>
double label_at(const OutputMesh<D>& mesh, const Point<D>& p) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (holds<D>(mesh, c, p)) return mesh.regions.empty() ? -1 : mesh.regions[c];
  return 0;
}

template <int D>
test::Outcome<D> refined(const Plc<D>& plc, RegionMode mode, const std::string& what, bool mended = true, double size = INFINITY) {
  const Domain<D> domain(plc);
  EXPECT_EQ(diagnose(domain).error_count(), 0u) << what;
  RefineOptions<D> options;
  options.regions = mode;
  options.size = size;
  test::Outcome<D> out{refine<D>(domain, options), {}};
  CheckOptions<D> check_options;
  check_options.domain = &domain;
  check_options.regions = mode;
  check_options.size = size;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.reasons = &out.result.reasons;
  out.report = check<D>(out.result.mesh, check_options);
  EXPECT_EQ(out.result.stop, StopCause::finished) << what;
  EXPECT_LE(out.report.exit_code(), mended ? 1 : 6) << what << "\n" << test::findings(out.report);
  for (const auto& f : out.report.findings)
    EXPECT_TRUE(f.kind == CheckFinding::Kind::not_delaunay || f.kind == CheckFinding::Kind::bad_reason) << what << ' ' << f.message;
  return out;
}

using Motion = std::function<Point3(Point3)>;

/// The structure moved, points and probes alike.
Structure moved(Structure s, const Motion& motion) {
  for (Point3& p : s.plc.points) p = motion(p);
  for (Point3& p : s.plc.holes) p = motion(p);
  for (auto& r : s.plc.regions) r.point = motion(r.point);
  for (auto& f : s.plc.facets)
    for (Point3& p : f.holes) p = motion(p);
  for (auto& probe : s.probes) probe.at = motion(probe.at);
  return s;
}

Point3 oblique(Point3 p) {
  Plc<3> one;
  one.points = {p};
  return test::oblique(one).points[0];
}

Structure permuted(Structure s) {  // ids of points and facets in another order
  std::reverse(s.plc.facets.begin(), s.plc.facets.end());
  const auto last = static_cast<std::uint32_t>(s.plc.points.size() - 1);
  std::reverse(s.plc.points.begin(), s.plc.points.end());
  for (auto& f : s.plc.facets)
    for (auto& polygon : f.polygons)
      for (auto& v : polygon) v = last - v;
  for (auto& segment : s.plc.segments)
    for (auto& v : segment.points) v = last - v;
  return s;
}

std::vector<std::pair<std::string, Structure>> variants(const Structure& s) {
  std::vector<std::pair<std::string, Structure>> out{
      {"plain", s},
      {"permuted", permuted(s)},
      {"small", moved(s, [](Point3 p) { return Point3{{p[0] * 0x1p-40, p[1] * 0x1p-40, p[2] * 0x1p-40}}; })},
      {"oblique", moved(s, oblique)}};
  if (s.turns) out.emplace_back("turned", moved(s, [](Point3 p) { return test::turned(p, 1000); }));
  return out;
}

double span_of(const Plc<3>& plc) {
  double span = 0;
  for (const Point3& p : plc.points)
    for (const Point3& q : plc.points) span = std::max(span, squared_distance(p, q));
  return std::sqrt(span);
}

class Structures : public testing::TestWithParam<Structure> {};

TEST_P(Structures, AutomaticRegions) {
  for (const auto& [how, s] : variants(GetParam())) {
    const auto out = refined<3>(s.plc, RegionMode::automatic, how, s.mended);
    // A motion that turns changes the order of the labels, nothing else.
    const bool same_order = how == "plain" || how == "permuted" || how == "small";
    for (const auto& probe : s.probes) {
      const double label = label_at<3>(out.result.mesh, probe.at);
      if (same_order) {
        EXPECT_EQ(label, probe.label) << how << ' ' << probe.at[0] << ' ' << probe.at[1] << ' ' << probe.at[2];
      } else {
        EXPECT_EQ(label > 0, probe.label > 0) << how;
      }
    }
    std::vector<double> used = out.result.mesh.regions;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::size_t i = 0; i < used.size(); ++i) EXPECT_EQ(used[i], double(i + 1)) << how;
  }
}

TEST_P(Structures, AllThatIsEnclosedWithoutSeeds) {
  for (const auto& [how, s] : variants(GetParam())) {
    const auto out = refined<3>(s.plc, RegionMode::seeds, how, s.mended);
    EXPECT_TRUE(out.result.mesh.regions.empty());
    for (const auto& probe : s.probes)
      if (probe.label > 0) {
        EXPECT_EQ(label_at<3>(out.result.mesh, probe.at), -1) << how;
      }
  }
}

TEST_P(Structures, SameBytesForAnyThreads) {
  RefineOptions<3> options;
  options.regions = RegionMode::automatic;
  options.size = span_of(GetParam().plc) / 20;
  const test::AllowThreads allow(8);
  const auto first = refine<3>(GetParam().plc, test::with<3>(options, test::serial));
  for (const auto& runner : test::concurrent_runners)
    test::expect_same<3>(first, refine<3>(GetParam().plc, test::with<3>(options, runner)), runner.name);
}

// Fine enough that edges at which bodies or voids touch are split.
TEST_P(Structures, Fine) {
  for (const auto& [how, s] : variants(GetParam()))
    if (how == "plain" || how == "turned")
      refined<3>(s.plc, RegionMode::automatic, how, s.mended, span_of(s.plc) / 16);
}

INSTANTIATE_TEST_SUITE_P(Inputs, Structures, testing::ValuesIn(test::all_structures()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace pgdr
