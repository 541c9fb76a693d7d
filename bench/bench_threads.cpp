// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Scaling in one run: a model meshed with different numbers of threads and of elements, by turns, and as one region by the
// sequential algorithm; medians and ratios. The last round's meshes go through the independent checker, and the reproducible
// ones of a size must have the same bytes in all rounds. Exit code 1 if anything is wrong, 2 for wrong usage or input.
//
//   bench_threads [--model cube|graded|FILE] [--size S,...] [--threads 1,2,8] [--repeat N] [--greedy] [--leaves-only]
//                 [--split-ratio R] [--pause SECONDS]
//
// A file may be 2D; sizes are then areas. 0: no bound. --leaves-only leaves the sequential algorithm out. "ratio" is how many
// times as fast as the size's first row by leaves, "growth" how many times as long an element takes as in such a row of the
// first size; "kernel s" is the kernel's part of the processor's seconds, most of it the clearing of pages: in a virtual
// machine, memory that nobody has used for some seconds may cost twenty times as much to touch, which large runs have to pay
// and small ones that follow others have not. With --pause before every run all of them find such memory.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "pgdr/pgdr.hpp"
#include "unit_cube.hpp"

namespace {

using namespace pgdr;

struct Arguments {
  std::string model = "cube";
  std::vector<double> sizes{0.0135};
  double split_ratio = 0.5, pause = 0;
  std::vector<int> threads{1, 2};
  int repeat = 3;
  bool greedy = false, leaves_only = false;
};

[[noreturn]] void usage(const char* what) {
  std::fprintf(stderr, "bench_threads: %s\n", what);
  std::exit(2);
}

/// Of a list with commas.
template <class T, class Read>
std::vector<T> values(const std::string& list, const Read& read) {
  std::vector<T> v;
  for (std::size_t at = 0; at <= list.size(); at = std::min(list.find(',', at), list.size()) + 1)
    v.push_back(static_cast<T>(read(list.c_str() + at)));
  return v;
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag == "--greedy" || flag == "--leaves-only") {
      (flag == "--greedy" ? a.greedy : a.leaves_only) = true;
      continue;
    }
    if (++i == argc) usage("a flag lacks its value");
    const char* value = argv[i];
    if (flag == "--model")
      a.model = value;
    else if (flag == "--size")
      a.sizes = values<double>(value, std::atof);
    else if (flag == "--split-ratio")
      a.split_ratio = std::atof(value);
    else if (flag == "--pause")
      a.pause = std::atof(value);
    else if (flag == "--repeat")
      a.repeat = std::max(1, std::atoi(value));
    else if (flag == "--threads")
      a.threads = values<int>(value, std::atoi);
    else
      usage("unknown flag");
  }
  for (const int t : a.threads)
    if (t < 1) usage("not a number of threads");
  return a;
}

template <int D>
std::uint64_t fingerprint(const OutputMesh<D>& mesh) {
  std::uint64_t h = 14695981039346656037u;
  auto add = [&h](const auto& list) {
    const auto* p = reinterpret_cast<const unsigned char*>(list.data());
    for (std::size_t i = 0; i < list.size() * sizeof list[0]; ++i) h = (h ^ p[i]) * 1099511628211u;
  };
  add(mesh.points);
  add(mesh.cells);
  if constexpr (D == 3) add(mesh.subfacets);
  add(mesh.subsegments);
  return h;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

template <int D>
struct Row {
  std::string name;
  std::size_t size;  ///< number of it
  RefineOptions<D> options;
  std::vector<double> mesh, refine, kernel;
  std::size_t cells = 0;
  SchedulerStatistics scheduler;
  std::uint64_t committed = 0, bytes = 0;
  int checked = 0;

  bool reproducible() const { return options.schedule.schedule == Schedule::reproducible; }
  double seconds_a_cell() const { return median(mesh) / static_cast<double>(cells); }
};

template <int D>
RefineOptions<D> options_of(const Arguments& a, double size) {
  RefineOptions<D> options;
  options.schedule.split_ratio = a.split_ratio;
  if (a.model == "graded") {
    // Edges from s to 21.5 s across the diagonal: four orders of magnitude of volume.
    options.size = [size](const Point<D>& p) {
      double square = 0;
      for (int i = 0; i < D; ++i) square += p[i] * p[i];
      return size * (1 + 20.5 * std::sqrt(square / D));
    };
  } else if (size > 0) {
    options.size = size;
  }
  return options;
}

template <int D>
std::vector<Row<D>> make_rows(const Arguments& a) {
  std::vector<Row<D>> rows;
  for (std::size_t k = 0; k < a.sizes.size(); ++k) {
    const RefineOptions<D> base = options_of<D>(a, a.sizes[k]);
    auto add = [&](const std::string& name) -> ScheduleOptions& {
      Row<D> row;
      row.name = name;
      row.size = k;
      row.options = base;
      rows.push_back(std::move(row));
      return rows.back().options.schedule;
    };
    if (!a.leaves_only) {
      ScheduleOptions& schedule = add("one region");
      schedule.executor = Executor::serial;
      schedule.floor = std::numeric_limits<std::size_t>::max();
    }
    for (const bool greedy : {false, true})
      for (const int t : a.threads) {
        if (greedy && !a.greedy) continue;
        ScheduleOptions& schedule = add((greedy ? "greedy, " : "reproducible, ") + std::to_string(t));
        schedule.threads = t;
        if (greedy) schedule.schedule = Schedule::greedy;
      }
  }
  return rows;
}

/// The kernel's part of the processor's seconds so far.
double kernel_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_stime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_stime.tv_usec);
}

/// Meshes once more, and checks the last round's mesh. False if the bytes are not those of the rounds before.
template <int D>
bool run(const Plc<D>& plc, const Domain<D>& domain, bool last, Row<D>& row) {
  const double kernel_before = kernel_seconds();
  const RefineResult<D> result = refine(domain, row.options);
  row.kernel.push_back(kernel_seconds() - kernel_before);
  row.mesh.push_back(result.statistics.seconds_mesh);
  row.refine.push_back(result.statistics.seconds_refine);
  row.cells = result.mesh.cells.size();
  row.scheduler = result.scheduler;
  row.committed = result.statistics.insertions_committed;
  const std::uint64_t bytes = fingerprint(result.mesh);
  const bool same = row.mesh.size() == 1 || bytes == row.bytes;
  row.bytes = bytes;
  if (last) {
    CheckOptions<D> options;
    options.input = &plc;
    options.radius_edge_bound = row.options.radius_edge_bound;
    options.size = row.options.size;
    options.largest_cosine = result.optimization.claimed_cosine;
    options.delaunay = result.delaunay;
    options.reasons = &result.reasons;
    row.checked = check<D>(result.mesh, options).exit_code();
  }
  return same || !row.reproducible();
}

template <int D>
int bench(const Arguments& a, const Plc<D>& plc) {
  const Domain<D> domain(plc);
  std::vector<Row<D>> rows = make_rows<D>(a);
  bool good = true;
  for (int round = 0; round < a.repeat; ++round)
    for (Row<D>& row : rows) {
      std::this_thread::sleep_for(std::chrono::duration<double>(a.pause));
      good = run(plc, domain, round + 1 == a.repeat, row) && good;
    }
  std::printf("%-18s %10s %8s %8s %8s %6s %7s %7s %9s %6s %6s %6s %6s  %s\n", "schedule, threads", "elements", "mesh s",
              "refine s", "kernel s", "leaves", "visits", "aside %", "work/path", "M/s", "ratio", "growth", "check", "bytes");
  const std::size_t first = a.leaves_only ? 0 : 1, rows_a_size = rows.size() / a.sizes.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row<D>& row = rows[i];
    const Row<D>& base = rows[row.size * rows_a_size + first];
    const auto& s = row.scheduler;
    std::printf("%-18s %10zu %8.3f %8.3f %8.3f %6llu %7llu %7.2f %9.1f %6.2f %6.2f %6.2f %6d  %016llx\n", row.name.c_str(),
                row.cells, median(row.mesh), median(row.refine), median(row.kernel), static_cast<unsigned long long>(s.leaves),
                static_cast<unsigned long long>(s.visits),
                100.0 * double(s.set_aside) / double(std::max<std::uint64_t>(row.committed, 1)),
                s.work_seconds / s.critical_path_seconds, 1e-6 / row.seconds_a_cell(), median(base.mesh) / median(row.mesh),
                row.seconds_a_cell() / rows[i % rows_a_size].seconds_a_cell(), row.checked,
                static_cast<unsigned long long>(row.bytes));
    const bool by_leaves = i % rows_a_size >= first;
    good = good && row.checked <= 1 && (!by_leaves || !row.reproducible() || row.bytes == base.bytes);
  }
  if (!good) std::printf("WRONG: a mesh did not pass the checker, or bytes differ\n");
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  const Arguments a = parse(argc, argv);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(*std::max_element(a.threads.begin(), a.threads.end())));
  if (a.model == "cube" || a.model == "graded") return bench<3>(a, unit_cube());
  return file_dimension(a.model) == 2 ? bench<2>(a, read_plc<2>(a.model)) : bench<3>(a, read_plc<3>(a.model));
} catch (const std::exception& e) {
  usage(e.what());
}
