// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How the diagnosis of an input grows with it: a bumpy torus, and two that run through each other, which have many pairs of
// triangles to find. Least of some runs; a JSON object with --json. Exit code 1 if the first is refused or
// the second is not.
//
//   bench_diagnosis [--triangles 10000,30000,100000,300000,1000000] [--repeat 3] [--threads 0] [--json]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace {

using namespace pgdr;

struct Arguments {
  std::vector<int> triangles{10000, 30000, 100000, 300000, 1000000};
  int repeat = 3;
  int threads = 0;  // all
  bool json = false;
};

[[noreturn]] void usage(const char* what) {
  std::fprintf(stderr, "bench_diagnosis: %s\n", what);
  std::exit(2);
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag == "--json") {
      a.json = true;
      continue;
    }
    if (++i == argc) usage("a flag lacks its value");
    if (flag == "--repeat")
      a.repeat = std::max(1, std::atoi(argv[i]));
    else if (flag == "--threads")
      a.threads = std::max(0, std::atoi(argv[i]));
    else if (flag == "--triangles") {
      a.triangles.clear();
      for (const char* p = argv[i]; *p; p += std::strcspn(p, ","), p += *p == ',') a.triangles.push_back(std::atoi(p));
    } else
      usage("unknown flag");
  }
  return a;
}

/// A torus about the z axis of side x side quadrilaterals, each as two triangles; no four of its points in a plane but by chance.
void add_torus(Plc<3>& plc, int side, double shift) {
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  const double step = 2 * std::numbers::pi / side;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double u = step * i, v = step * j, r = 0.4 + 0.03 * std::sin(5 * u) * std::cos(3 * v + u);
      plc.points.push_back({{shift + (1 + r * std::cos(v)) * std::cos(u), (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v)}});
    }
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i % side * side + j % side); };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      plc.facets.push_back({.polygons = {{a, b, c}}});
      plc.facets.push_back({.polygons = {{a, c, d}}});
    }
}

struct Surface {
  const char* name;
  bool sound;
  Plc<3> plc;
};

std::vector<Surface> surfaces(int triangles) {
  const auto side = [&](int of) { return std::max(3, static_cast<int>(std::lround(std::sqrt(triangles / (2.0 * of))))); };
  std::vector<Surface> all{{"torus", true, {}}, {"two tori that cross", false, {}}};
  add_torus(all[0].plc, side(1), 0);
  add_torus(all[1].plc, side(2), 0);
  add_torus(all[1].plc, side(2), 0.91);
  return all;
}

struct Row {
  double seconds = 1e300, processor = 1e300;
  std::uint64_t errors = 0, pairs = 0;
};

Row time(const Plc<3>& plc, int repeat) {
  Row row;
  for (int n = 0; n < repeat; ++n) {
    const std::clock_t processor = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis<3> diagnosis = diagnose(plc);
    row.seconds = std::min(row.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    row.processor = std::min(row.processor, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    row.errors = diagnosis.error_count();
    row.pairs = diagnosis[Finding::facets_cross].count;
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  tbb::task_arena arena(a.threads > 0 ? a.threads : tbb::task_arena::automatic);
  bool good = true;
  const char* separator = "";
  if (a.json)
    std::printf("{\"rows\": [");
  else
    std::printf("%-20s %10s %10s %10s %12s %12s\n", "surface", "triangles", "seconds", "processor", "us/triangle", "pairs found");
  for (const int triangles : a.triangles)
    for (const Surface& s : surfaces(triangles)) {
      const Row row = arena.execute([&] { return time(s.plc, a.repeat); });
      const std::size_t n = s.plc.facets.size();
      good = good && (row.errors == 0) == s.sound && (row.pairs == 0) == s.sound;
      if (a.json)
        std::printf(
            "%s{\"surface\": \"%s\", \"triangles\": %zu, \"seconds\": %.6f, \"processor_seconds\": %.6f, "
            "\"pairs\": %llu}",
            separator, s.name, n, row.seconds, row.processor, static_cast<unsigned long long>(row.pairs));
      else
        std::printf("%-20s %10zu %10.3f %10.3f %12.3f %12llu\n", s.name, n, row.seconds, row.processor,
                    1e6 * row.processor / static_cast<double>(n), static_cast<unsigned long long>(row.pairs));
      separator = ", ";
    }
  if (a.json) std::printf("], \"good\": %s}\n", good ? "true" : "false");
  if (!good) std::fprintf(stderr, "WRONG: a sound surface is refused, or a crossing is not found\n");
  return good ? 0 : 1;
}
