// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How long a cancelled run takes to return: the unit cube, cancelled from another thread at times spread over the whole run,
// until after its last insertion. From request_stop() to the return of refine(), with all memory given back; and the
// processor time that went into that, all threads together, which other programs do not disturb. Partial
// meshes go through the independent checker. Exit code 1 if one is not valid, or a run took longer than the limit.
//
//   bench_cancel [--size S] [--cancels N] [--threads T] [--limit MILLISECONDS]
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "pgdr/pgdr.hpp"
#include "unit_cube.hpp"

namespace {

using namespace pgdr;
using Clock = std::chrono::steady_clock;

struct Arguments {
  double size = 0.0135, limit = 100;
  int cancels = 10, threads = 0;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i];
    if (flag == "--size")
      a.size = std::atof(argv[i + 1]);
    else if (flag == "--cancels")
      a.cancels = std::max(1, std::atoi(argv[i + 1]));
    else if (flag == "--threads")
      a.threads = std::atoi(argv[i + 1]);
    else if (flag == "--limit")
      a.limit = std::atof(argv[i + 1]);
    else
      std::exit((std::fprintf(stderr, "bench_cancel: unknown flag %s\n", argv[i]), 2));
  }
  return a;
}

double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

struct Cancelled {
  double latency = 0, cpu = 0;  ///< 0 if the run had ended before
  std::size_t cells = 0;
  StopCause stop = StopCause::finished;
  bool valid = true;
};

Cancelled cancelled_after(Clock::duration delay, const Plc<3>& plc, RefineOptions<3> options) {
  const Domain<3> domain(plc);
  std::stop_source source;
  options.stop = source.get_token();
  Clock::time_point asked;
  std::clock_t asked_cpu = 0;
  const auto start = Clock::now();
  std::thread other([&] {
    std::this_thread::sleep_until(start + delay);
    asked = Clock::now();
    asked_cpu = std::clock();
    source.request_stop();
  });
  const auto result = refine(domain, options);
  const auto end = Clock::now();
  const std::clock_t end_cpu = std::clock();
  other.join();
  const double cpu = 1000.0 * static_cast<double>(end_cpu - asked_cpu) / CLOCKS_PER_SEC;
  Cancelled c{asked < end ? milliseconds(end - asked) : 0, asked < end ? cpu : 0, result.mesh.cells.size(), result.stop, true};
  if (c.cells == 0) return c;
  CheckOptions<3> check_options;
  check_options.input = &plc;
  check_options.delaunay = result.delaunay;
  c.valid = check(result.mesh, check_options).exit_code() == 0;
  return c;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  a.threads > 0 ? std::size_t(a.threads) : std::thread::hardware_concurrency());
  const Plc<3> cube = unit_cube();
  RefineOptions<3> options;
  options.size = a.size;
  options.schedule.threads = a.threads;
  const auto start = Clock::now();
  const auto whole = refine(cube, options);
  const auto time = Clock::now() - start;
  std::printf("%zu tetrahedra in %.0f ms (refined after %.0f) on %d threads\n", whole.mesh.cells.size(), milliseconds(time),
              1000 * (whole.statistics.seconds_initial + whole.statistics.seconds_refine + whole.statistics.seconds_optimize),
              whole.scheduler.threads);
  std::printf("%-12s %-10s %10s %10s %12s %8s\n", "partial mesh", "after ms", "stop", "cells", "latency ms", "cpu ms");
  bool good = true;
  for (const bool partial : {true, false})
    for (int i = 1; i <= a.cancels; ++i) {
      options.partial_mesh = partial;
      const auto delay = time * i / a.cancels * 99 / 100;
      const Cancelled c = cancelled_after(delay, cube, options);
      std::printf("%-12s %-10.0f %10s %10zu %12.1f %8.1f%s\n", partial ? "yes" : "no", milliseconds(delay),
                  c.stop == StopCause::cancelled ? "cancelled" : "finished", c.cells, c.latency, c.cpu,
                  c.valid ? "" : "  NOT VALID");
      good = good && c.valid && c.latency <= a.limit;
    }
  if (!good) std::printf("WRONG: a mesh is not valid, or a run took longer than %.0f ms to end\n", a.limit);
  return good ? 0 : 1;
}
