// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How long another surface within a tolerance takes of given files: a line for each file with the triangles before and after, the
// seconds of replace_surface by the clock and of all threads together (with the Domain and its diagnosis), and a hash of the
// surface, which says whether two builds made the same.
//
//   bench_surface [--tolerance 0.1] [--threads 0] FILE...
//
// The tolerance is in percent of the diagonal of the points; threads 0: all.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include "pgdr/io.hpp"
#include "pgdr/surface.hpp"

namespace {

using namespace pgdr;

[[noreturn]] void usage(const char* what) {
  std::fprintf(stderr, "bench_surface: %s\n", what);
  std::exit(2);
}

double diagonal_of(const Plc<3>& plc) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax_element(plc.points.begin(), plc.points.end(),
                                                 [i](const Point3& a, const Point3& b) { return a[i] < b[i]; });
    square += ((*high)[i] - (*low)[i]) * ((*high)[i] - (*low)[i]);
  }
  return std::sqrt(square);
}

/// FNV-1a of the points and of the polygons.
std::uint64_t hash_of(const Plc<3>& plc) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
  for (const Point3& p : plc.points)
    for (const double x : p.x) add(std::bit_cast<std::uint64_t>(x));
  for (const auto& facet : plc.facets)
    for (const auto& polygon : facet.polygons)
      for (const std::uint32_t v : polygon) add(v);
  return hash;
}

void measure(const char* file, double percent) {
  const Plc<3> plc = read_plc<3>(file);
  if (plc.points.empty()) usage("no points");
  const std::clock_t before = std::clock();
  const ReplacedSurface made = replace_surface(plc, {.tolerance = percent / 100 * diagonal_of(plc)});
  const double all_threads = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  const auto& r = made.report;
  std::printf("%s  %llu -> %llu triangles  %.3f s, of all threads %.3f s  %016llx\n", file,
              static_cast<unsigned long long>(r.triangles[0]), static_cast<unsigned long long>(r.triangles[1]), r.seconds,
              all_threads, static_cast<unsigned long long>(hash_of(made.plc)));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  double percent = 0.1;
  int threads = 0;
  std::vector<const char*> files;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag.rfind("--", 0) != 0) {
      files.push_back(argv[i]);
      continue;
    }
    if (++i == argc) usage("a flag lacks its value");
    if (flag == "--tolerance")
      percent = std::atof(argv[i]);
    else if (flag == "--threads")
      threads = std::max(0, std::atoi(argv[i]));
    else
      usage("unknown flag");
  }
  int code = 0;
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : threads);
  for (const char* file : files) try {
      arena.execute([&] { measure(file, percent); });
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s: %s\n", file, e.what());
      code = 1;
    }
  return code;
}
