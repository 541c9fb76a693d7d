// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The optimiser's stages of a run: when they are there, what is said of them, what ends them, and that meshes do not depend on
// threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "parallel_support.hpp"
#include "pgdr/error.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/selectors.hpp"

namespace pgdr::test_run_optimizing {

RefineOptions<3> fine(double size = 0.3) {
  RefineOptions<3> options;
  options.size = size;
  options.schedule.executor = Executor::serial;
  return options;
}

Errc refused(const RefineOptions<3>& options) {
  try {
    refine<3>(test::cube(), options);
  } catch (const UsageError& e) {
    return e.diagnostic().code;
  }
  return Errc::internal;
}

TEST(OptimizerRun, BoundsOnAnglesAreChecked) {
  for (const double wrong : {-1.0, -1e-300, 35.001, 90.0, std::numeric_limits<double>::quiet_NaN()}) {
    RefineOptions<3> options = fine();
    options.min_dihedral = wrong;
    EXPECT_EQ(refused(options), Errc::bad_option) << wrong;
  }
  const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
  RefineOptions<2> planar;
  planar.min_dihedral = 15;
  EXPECT_THROW(refine<2>(plc_from_arrays<2>(xy, segments), planar), UsageError);
  planar.min_dihedral = 0;
  EXPECT_EQ(refine<2>(plc_from_arrays<2>(xy, segments), planar).optimization.target, 0);
}

TEST(OptimizerRun, IsThereUnlessPointsAreChosen) {
  const auto target_of = [](const RefineOptions<3>& options) {
    const RefineResult<3> r = refine<3>(test::cube(), options);
    EXPECT_EQ(r.delaunay, r.optimization.target == 0);
    EXPECT_EQ(r.optimization.claimed_cosine<1, r.optimization.target> 0);
    EXPECT_EQ(r.statistics.seconds_optimize > 0, r.optimization.target > 0);
    return r.optimization.target;
  };
  RefineOptions<3> options = fine();
  EXPECT_EQ(target_of(options), default_min_dihedral);
  options.selector = off_center<3>();
  EXPECT_EQ(target_of(options), 0);
  options.min_dihedral = 12.5;
  EXPECT_EQ(target_of(options), 12.5);
  options.refine = false;
  EXPECT_THROW(target_of(options), UsageError);
  options.min_dihedral.reset();
  EXPECT_EQ(target_of(options), 0);
  options = fine();
  options.min_dihedral = 0;
  EXPECT_EQ(target_of(options), 0);
}

TEST(OptimizerRun, WarnsOfWhatIsBeyondPractice) {
  for (const double angle : {30.0, 30.5}) {
    RefineOptions<3> options = fine(0.8);
    options.min_dihedral = angle;
    const auto warnings = refine<3>(test::cube(), options).warnings;
    const bool warned = std::any_of(warnings.begin(), warnings.end(),
                                    [](const Diagnostic& d) { return d.code == Errc::beyond_theory; });
    EXPECT_EQ(warned, angle > 30);
  }
}

std::vector<std::string> stages_of(const RefineOptions<3>& options) {
  const RefineResult<3> r = refine<3>(test::cube(), options);
  std::vector<std::string> names;
  double end = 0;
  for (const StageTime& s : r.statistics.stages) {
    names.push_back(s.name);
    EXPECT_GE(s.start, end - 1e-9) << s.name;
    EXPECT_LE(s.path, s.work + 1e-9) << s.name;
    end = s.start + s.seconds;
  }
  EXPECT_LE(end, r.statistics.seconds_mesh);
  return names;
}

TEST(OptimizerRun, StagesAreInTheReport) {
  RefineOptions<3> options = fine();
  EXPECT_EQ(stages_of(options), (std::vector<std::string>{"prepare", "diagnose", "triangulate", "recover", "carve", "list",
                                                          "insert", "shortest_edge", "budget", "optimize_cheap",
                                                          "optimize_strong", "optimize_rest", "reasons", "count", "number"}));
  options.min_dihedral = 0;
  EXPECT_EQ(stages_of(options),
            (std::vector<std::string>{"prepare", "diagnose", "triangulate", "recover", "carve", "list", "insert", "last_resort",
                                      "violations", "shortest_edge", "reasons", "budget", "count", "number"}));
}

TEST(OptimizerRun, WithoutItTheMeshIsDelaunay) {
  RefineOptions<3> options = fine(0.2);
  options.min_dihedral = 0;
  const test::Outcome<3> outcome = test::refine_and_check<3>(test::turned<3>(test::l_block()), options);
  EXPECT_TRUE(outcome.result.delaunay);
  EXPECT_EQ(outcome.report.exit_code(), 0) << test::findings(outcome.report);
}

TEST(OptimizerRun, IsReproducible) {
  RefineOptions<3> options;
  options.schedule.floor = 20;
  for (const double target : {15.0, 25.0}) {
    options.min_dihedral = target;
    options.size = 0.12;
    const auto r = test::expect_reproducible<3>(test::turned<3>(test::cube()), options, "cube");
    EXPECT_GT(r.scheduler.leaves, 16u);
    EXPECT_GT(r.optimization.evaluated, r.mesh.cells.size());
    options.size = 0.3;
    test::expect_reproducible<3>(test::turned<3>(test::block_with_cavity()), options, "block", test::two_if_quick);
    options.size = {};
    test::expect_reproducible<3>(test::icosphere(2), options, "icosphere", test::two_if_quick);
  }
}

// Points may not come any more, but all else goes on, and the run finishes.
TEST(OptimizerRun, KeepsToTheBudgetOfVertices) {
  RefineOptions<3> options = fine(0.25);
  options.min_dihedral = 0;
  const std::uint64_t refined = refine<3>(test::cube(), options).mesh.points.size();
  options.min_dihedral = 25;
  for (const std::uint64_t more : {1, 2, 5}) {
    options.max_vertices = refined + more;
    const test::Outcome<3> outcome = test::refine_and_check<3>(test::cube(), options);
    EXPECT_EQ(outcome.result.stop, StopCause::finished);
    EXPECT_FALSE(outcome.result.delaunay);
    EXPECT_LE(outcome.result.mesh.points.size(), options.max_vertices);
    EXPECT_LE(outcome.report.exit_code(), 1) << test::findings(outcome.report);
  }
}

/// What the mesh is, whatever ended the run.
void expect_sound(const RefineResult<3>& r, const Plc<3>& plc) {
  CheckOptions<3> check_options;
  check_options.input = &plc;
  const CheckReport report = check<3>(r.mesh, check_options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
}

// Sizes are asked for by the optimiser, too: whenever one of these calls cancels the run, or throws, all is in order.
TEST(OptimizerRun, MayEndAnywhere) {
  const Plc<3> plc = test::cube();
  std::atomic<std::uint64_t> calls{0}, last{std::numeric_limits<std::uint64_t>::max()};
  bool throws = false;
  std::stop_source source;
  RefineOptions<3> options = fine();
  options.min_dihedral = 20;
  options.size = SizingField<3>([&](const Point3&) {
    if (++calls > last) {
      if (throws) throw std::runtime_error("enough");
      source.request_stop();
    }
    return 0.3;
  });
  options.stop = source.get_token();
  ASSERT_FALSE(refine<3>(plc, options).delaunay);
  const std::uint64_t all = calls;
  bool before = false, within = false;
  for (int part = 1; part < 12; ++part) {
    last = all * static_cast<std::uint64_t>(part) / 12;
    calls = 0;
    throws = true;
    EXPECT_THROW(refine<3>(plc, options), std::runtime_error);
    calls = 0;
    throws = false;
    const RefineResult<3> r = refine<3>(plc, options);
    source = {};
    options.stop = source.get_token();
    EXPECT_EQ(r.stop, StopCause::cancelled);
    EXPECT_TRUE(r.reasons.empty() || r.delaunay);
    expect_sound(r, plc);
    (r.delaunay ? before : within) = true;
  }
  EXPECT_TRUE(before);
  EXPECT_TRUE(within);
}

}  // namespace pgdr::test_run_optimizing
