// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The same bytes for 1, 2 and 8 threads on real inputs: every .off, .stl, .obj, .poly and .smesh file of the real models
// (models_folder.hpp) of at most PGDR_MODELS_KB kilobytes (100) that the calling thread alone meshes within PGDR_MODELS_SECONDS
// (3, or 30 under a sanitizer; where it does not, the model is passed over and named).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <random>
#include <set>

#include "model_plcs.hpp"
#include "models_folder.hpp"
#include "parallel_support.hpp"
#include "pgdr/io.hpp"

namespace pgdr::test_run_models {

namespace fs = std::filesystem;

double number_from(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtod(text, nullptr);
}

std::chrono::duration<double> time_limit() {
  return std::chrono::duration<double>(number_from("PGDR_MODELS_SECONDS", test::sanitized ? 30 : 3));
}

std::vector<fs::path> models_below(const fs::path& folder) {
  const std::set<std::string> formats{".off", ".stl", ".obj", ".poly", ".smesh"};
  const double most = 1000 * number_from("PGDR_MODELS_KB", 100);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && formats.contains(entry.path().extension().string()) &&
        static_cast<double>(entry.file_size()) <= most)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

struct Tally {
  int same = 0, refused = 0, too_slow = 0;
};

/// The quality bound alone, in small leaves.
template <int D>
void compare(const fs::path& file, Tally& tally) {
  const testing::ScopedTrace trace(__FILE__, __LINE__, file.string());
  RefineOptions<D> options;
  options.schedule.floor = 10;
  options.time_limit = time_limit();
  Plc<D> plc;
  test::Outcome<D> first;
  try {
    plc = read_plc<D>(file);
    first = test::refine_and_check<D>(plc, test::with<D>(options, test::serial));
  } catch (const Error&) {
    return static_cast<void>(++tally.refused);
  }
  if (first.result.stop != StopCause::finished) {
    std::cout << "too slow: " << file.string() << '\n';
    return static_cast<void>(++tally.too_slow);
  }
  for (const auto& f : first.report.findings)  // faces beside needles may stay so (docs/limits.md)
    EXPECT_EQ(f.kind, CheckFinding::Kind::not_delaunay) << name(f.kind) << ": " << f.message;
  options.time_limit.reset();
  for (const test::Runner& runner : test::concurrent_runners)
    test::expect_same<D>(first.result, refine<D>(plc, test::with<D>(options, runner)), runner.name);
  ++tally.same;
}

/// Turned about two axes, then scaled, and shifted by seven units along the first.
Plc<3> moved(Plc<3> plc, double about_z, double about_x, double scale) {
  test::for_each_point(plc, [&](Point3& p) {
    const double x = p[0] * std::cos(about_z) - p[1] * std::sin(about_z), y = p[0] * std::sin(about_z) + p[1] * std::cos(about_z);
    p = {{scale * x + 7 * scale, scale * (y * std::cos(about_x) - p[2] * std::sin(about_x)),
          scale * (y * std::sin(about_x) + p[2] * std::cos(about_x))}};
  });
  for (auto& region : plc.regions) region.size *= std::pow(scale, 3);
  return plc;
}

// The first of these copies of gmsh's buildings_tetmesh was refused: of the subsegments between a triangle of the ground and its
// circumcentre recovery halved one that was hidden by another, for ever. The radius-edge bound is none: all cells are within.
TEST(ParallelModels, MovedCopiesAreRecovered) {
  int recovered = 0;
  for (const fs::path& file : models_below(test::models_folder())) {
    RefineOptions<3> options;
    options.radius_edge_bound = std::numeric_limits<double>::infinity();
    options.min_dihedral = 0;  // it is the recovery that is tested
    options.time_limit = time_limit();
    try {
      if (file_dimension(file) != 3) continue;
      const Plc<3> plc = read_plc<3>(file);
      if (refine<3>(plc, options).stop != StopCause::finished) continue;
      std::mt19937_64 random(1);
      std::uniform_real_distribution<double> angle(0, 6.28), power(-3, 3);
      for (int i = 0; i < 4; ++i) {
        const bool first = i == 0;
        const Plc<3> copy = moved(plc, first ? 4.0063811173173258 : angle(random), first ? 3.0727461496479851 : angle(random),
                                  first ? 287.32515773134804 : std::pow(10, power(random)));
        try {
          const test::Outcome<3> outcome = test::refine_and_check<3>(copy, options);
          if (outcome.result.stop != StopCause::finished) continue;
          EXPECT_LE(outcome.report.exit_code(), 1) << file << ", copy " << i << '\n' << test::findings(outcome.report);
          ++recovered;
        } catch (const Error& e) {
          ADD_FAILURE() << file << ", copy " << i << ": " << e.what();
        }
      }
    } catch (const Error&) {
      continue;  // refused as it is
    }
  }
  EXPECT_GE(recovered, 40);
}

TEST(ParallelModels, SameBytesForAnyThreads) {
  const test::AllowThreads allow(8);
  Tally tally;
  const auto files = models_below(test::models_folder());
  for (const fs::path& file : files) {
    int dimension = 0;
    try {
      dimension = file_dimension(file);
    } catch (const InputError&) {
      ++tally.refused;
    }
    if (dimension == 2) compare<2>(file, tally);
    if (dimension == 3) compare<3>(file, tally);
  }
  std::cout << files.size() << " files: " << tally.same << " the same for any threads, " << tally.refused << " refused, "
            << tally.too_slow << " too slow\n";
  EXPECT_GE(tally.same, 12);
  EXPECT_LT(tally.too_slow, tally.same);
}

}  // namespace pgdr::test_run_models
