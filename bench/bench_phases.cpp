// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the time of a run goes, on one thread: the phases of whole runs, each size given, as the command has them, and the
// mesh read again; then those of an insertion (points of a Delaunay triangulation, in Hilbert order, through the same
// cavities as refinement). Seconds; "user" and "system" are the processor's, of meshing alone, which count where the machine
// is shared. The file that is written goes to the folder for temporary files, or to --folder.
//
//   bench_phases [--model cube|FILE] [--sizes 0.03,0.0135] [--points 200000] [--folder FOLDER]
//
// Sizes that make some 0.2, 2, 10 and 30 million tetrahedra of the cube: 0.029,0.0133,0.0078,0.00538.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "cavity/cavity.hpp"
#include "cavity/delaunay.hpp"
#include "pgdr/pgdr.hpp"
#include "refine/work_list.hpp"
#include "space/spatial_order.hpp"
#include "unit_cube.hpp"

namespace {

using namespace pgdr;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<double> sizes{0.03, 0.0135};
  int points = 200000;
  std::string model = "cube";
  std::filesystem::path folder = std::filesystem::temp_directory_path();
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
    } else if (flag == "--model") {
      a.model = argv[i + 1];
    } else if (flag == "--folder") {
      a.folder = argv[i + 1];
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

/// Seconds of the processor so far, of this process in the program and in the kernel.
std::array<double, 2> processor() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return {seconds(usage.ru_utime), seconds(usage.ru_stime)};
}

double now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

/// The file is removed with it, whatever happens.
struct TemporaryFile {
  std::filesystem::path path;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// False: the mesh that was read is not the one that was written.
bool whole_run(const Arguments& a, double size) {
  const TemporaryFile file{a.folder / ("bench_phases." + std::to_string(getpid()) + ".vtu")};
  const double begin = now();
  const Plc<3> plc = a.model == "cube" ? unit_cube() : read_plc<3>(a.model);
  const double meshing = now();
  RefineOptions<3> options;
  if (size > 0) options.size = size;
  options.schedule.threads = 1;
  const auto start = processor();
  auto result = refine(plc, options);
  const auto end = processor();
  const double user = end[0] - start[0], system = end[1] - start[1];
  const double summing = now();
  const QualitySummary quality = summarize_quality(result.mesh);
  const double writing = now();
  write_mesh(result.mesh, file.path);
  const double written = now(), peak = peak_bytes(), cells = static_cast<double>(result.mesh.cells.size());
  const double reading = now();
  const OutputMesh<3> again = read_mesh<3>(file.path);
  const double ended = now();
  const auto& s = result.statistics;
  std::printf("%10.0f %7.3f %8.3f %8.3f %7.3f %8.3f %8.3f %7.3f %9.3f %8.3f %8.3f %8.3f %8.3f %9.1f\n", cells, meshing - begin,
              s.seconds_initial, result.scheduler.work_seconds - result.scheduler.serial_seconds, result.scheduler.serial_seconds,
              s.seconds_mesh - s.seconds_initial - s.seconds_refine - s.seconds_optimize, writing - summing, written - writing,
              ended - reading, s.seconds_mesh, user, system, 1e6 * (user + system) / cells, peak / cells);
  std::fflush(stdout);
  return again.cells == result.mesh.cells && quality.max_radius_edge > 0;
}

bool whole_runs(const Arguments& a) {
  std::printf("%10s %7s %8s %8s %7s %8s %8s %7s %9s %8s %8s %8s %8s %9s\n", "tetrahedra", "read", "initial", "visits", "serial",
              "compact", "summary", "write", "read mesh", "mesh", "user", "system", "us/tet", "bytes/tet");
  return std::all_of(a.sizes.begin(), a.sizes.end(), [&](double size) { return whole_run(a, size); });
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
    for (const CellId c : poor) list.push(Entry<3>{c, mesh.birth(c), EntryKind::cell, Entry<3>::over_size, 10});
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
  if (!whole_runs(a)) {
    std::fprintf(stderr, "bench_phases: the mesh that was read is not the one that was written\n");
    return 1;
  }
  if (insertions(a.points)) return 0;
  std::fprintf(stderr, "bench_phases: an insertion failed\n");
  return 1;
}
