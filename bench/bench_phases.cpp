// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the time of a run goes, on one thread (seconds; processor: the processor's, which counts where the machine is shared):
// the phases of whole runs (the unit cube, each size given), then those of an
// insertion (points of a Delaunay triangulation, in Hilbert order, through the same cavities as refinement).
//
//   bench_phases [--sizes 0.03,0.0135] [--points 200000]
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "pgdr/cavity.hpp"
#include "pgdr/delaunay.hpp"
#include "pgdr/pgdr.hpp"
#include "pgdr/spatial_order.hpp"
#include "pgdr/work_list.hpp"
#include "unit_cube.hpp"

namespace {

using namespace pgdr;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<double> sizes{0.03, 0.0135};
  int points = 200000;
};

[[noreturn]] void usage(const char* what) {
  std::fprintf(stderr, "bench_phases: %s\n", what);
  std::exit(2);
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 == argc) usage("a flag lacks its value");
    const std::string flag = argv[i];
    if (flag == "--points") {
      a.points = std::max(100, std::atoi(argv[i + 1]));
    } else if (flag == "--sizes") {
      a.sizes.clear();
      for (const char* p = argv[i + 1]; *p; p += std::strcspn(p, ","), p += *p == ',') a.sizes.push_back(std::atof(p));
    } else {
      usage("unknown flag");
    }
  }
  return a;
}

/// The peak of the process so far: sizes should grow.
double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void whole_runs(const std::vector<double>& sizes) {
  std::printf("%10s %9s %9s %9s %9s %9s %9s %9s %9s\n", "tetrahedra", "initial", "visits", "serial", "compact",
              "mesh s", "processor", "M tets/s", "bytes/tet");
  for (const double size : sizes) {
    RefineOptions<3> options;
    options.size = size;
    options.schedule.threads = 1;
    const std::clock_t start = std::clock();
    const auto result = refine(unit_cube(), options);
    const double processor = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const auto& s = result.statistics;
    const double cells = static_cast<double>(result.mesh.cells.size());
    std::printf("%10.0f %9.3f %9.3f %9.3f %9.3f %9.3f %9.3f %9.3f %9.1f\n", cells, s.seconds_initial,
                result.scheduler.work_seconds - result.scheduler.serial_seconds, result.scheduler.serial_seconds,
                s.seconds_mesh - s.seconds_initial - s.seconds_refine, s.seconds_mesh, processor, cells / processor / 1e6,
                peak_bytes() / cells);
  }
}

/// Sums up what passes between one call and the next, less what the clock itself takes.
class Split {
 public:
  explicit Split(std::size_t phases) : seconds_(phases, 0.0), last_(Clock::now()) {
    const auto start = Clock::now();
    for (int i = 0; i < 1000; ++i) last_ = Clock::now();
    clock_ = std::chrono::duration<double>(last_ - start).count() / 1000;
  }
  void start() { last_ = Clock::now(); }
  void end(std::size_t phase) {
    const auto now = Clock::now();
    seconds_[phase] += std::chrono::duration<double>(now - last_).count() - clock_;
    last_ = now;
  }
  double seconds(std::size_t phase) const { return seconds_[phase]; }

 private:
  std::vector<double> seconds_;
  Clock::time_point last_;
  double clock_ = 0;
};

/// The first half of the points makes a triangulation, the second is timed.
bool insertions(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Point3> points(static_cast<std::size_t>(count) / 2), rest(points.size());
  for (auto* some : {&points, &rest})
    for (Point3& p : *some) p = {{uniform(random), uniform(random), uniform(random)}};
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  Delaunay<3> delaunay(mesh, pools);
  if (!delaunay.build(points)) return false;
  CellBounds<3> bounds;
  bounds.radius_edge_bound = 2;
  bounds.size = 0.01;
  WorkList<3> list;
  Cavity<3> cavity(mesh);
  constexpr const char* names[] = {"locate", "collect", "judge", "commit", "bounds", "lists"};
  Split split(std::size(names));
  double deleted = 0, made = 0, listed = 0;
  CellId hint{0};
  while (!mesh.alive(hint)) hint = CellId{index(hint) + 1};
  const auto order = insertion_order<3>(rest);
  for (const std::uint32_t i : order) {
    split.start();
    const CellId seed = locate<3>(mesh, rest[i], hint);
    split.end(0);
    if (cavity.collect(rest[i], seed) != Cavity<3>::Status::ok) return false;
    split.end(1);
    deleted += static_cast<double>(cavity.cells().size());
    split.start();
    if (cavity.make_star_shaped() != Cavity<3>::Status::ok) return false;
    split.end(2);
    cavity.commit(pools, Home(EntityKind::volume, 0), 0);
    split.end(3);
    const auto& cells = cavity.new_cells();
    std::vector<CellId> poor;
    for (std::size_t n = 0; n < cells.size(); ++n)
      if (!mesh.is_ghost(cells[n]) && bounds.test(mesh, cells[n], cavity.shape_of_new(n))) poor.push_back(cells[n]);
    split.end(4);
    for (const CellId c : poor) list.push(Entry<3>{c, mesh.cell(c).vertices, EntryKind::cell, 0, 10, mesh.birth(c)});
    for (std::size_t n = 0; n < poor.size(); ++n) listed += list.pop_poor(mesh).alive(mesh) ? 1 : 0;
    split.end(5);
    made += static_cast<double>(cells.size());
    hint = cells.front();
  }
  const double n = static_cast<double>(rest.size());
  std::printf("\nan insertion: %.1f cells deleted, %.1f made, %.1f listed\n", deleted / n, made / n, listed / n);
  double sum = 0;
  for (std::size_t p = 0; p < std::size(names); ++p) {
    std::printf("%10s %8.3f us\n", names[p], 1e6 * split.seconds(p) / n);
    sum += split.seconds(p);
  }
  std::printf("%10s %8.3f us\n", "all", 1e6 * sum / n);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  whole_runs(a.sizes);
  if (insertions(a.points)) return 0;
  std::fprintf(stderr, "bench_phases: an insertion failed\n");
  return 1;
}
