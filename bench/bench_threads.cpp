// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Thread scaling in one run: a model meshed with different numbers of threads, by turns, and as one region by the
// sequential algorithm; medians and ratios. Every mesh goes through the independent checker, and the reproducible ones
// must have the same bytes. Exit code 1 if anything is wrong.
//
//   bench_threads [--model cube|graded|FILE] [--size S] [--threads 1,2,8] [--repeat N] [--greedy] [--split-ratio R]
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "pgdr/pgdr.hpp"
#include "unit_cube.hpp"

namespace {

using namespace pgdr;

struct Arguments {
  std::string model = "cube";
  double size = 0.0135, split_ratio = 0.5;
  std::vector<int> threads{1, 2};
  int repeat = 3;
  bool greedy = false;
};

[[noreturn]] void usage(const char* what) {
  std::fprintf(stderr, "bench_threads: %s\n", what);
  std::exit(2);
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag == "--greedy") {
      a.greedy = true;
      continue;
    }
    if (++i == argc) usage("a flag lacks its value");
    const char* value = argv[i];
    if (flag == "--model") a.model = value;
    else if (flag == "--size") a.size = std::atof(value);
    else if (flag == "--split-ratio") a.split_ratio = std::atof(value);
    else if (flag == "--repeat") a.repeat = std::max(1, std::atoi(value));
    else if (flag == "--threads") {
      a.threads.clear();
      for (const char* p = value; *p; p += std::strcspn(p, ","), p += *p == ',') a.threads.push_back(std::atoi(p));
    } else usage("unknown flag");
  }
  return a;
}

std::uint64_t fingerprint(const OutputMesh<3>& mesh) {
  std::uint64_t h = 14695981039346656037u;
  auto add = [&h](const void* p, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) h = (h ^ static_cast<const unsigned char*>(p)[i]) * 1099511628211u;
  };
  add(mesh.points.data(), mesh.points.size() * sizeof mesh.points[0]);
  add(mesh.cells.data(), mesh.cells.size() * sizeof mesh.cells[0]);
  add(mesh.subfacets.data(), mesh.subfacets.size() * sizeof mesh.subfacets[0]);
  return h;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

struct Row {
  std::string name;
  RefineOptions<3> options;
  std::vector<double> mesh, refine;
  RefineResult<3> last;
  std::uint64_t bytes = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  const Domain<3> domain(a.model == "cube" || a.model == "graded" ? unit_cube() : read_plc<3>(a.model));
  RefineOptions<3> base;
  base.schedule.split_ratio = a.split_ratio;
  if (a.model == "graded") {
    // Edges from s to 21.5 s across the diagonal: four orders of magnitude of volume.
    base.size = [s = a.size](const Point<3>& p) {
      return s * (1 + 20.5 * std::sqrt((p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / 3));
    };
  } else if (a.size > 0) {
    base.size = a.size;
  }
  std::vector<Row> rows;
  rows.push_back({"one region", base, {}, {}, {}, 0});
  rows.back().options.schedule.executor = Executor::serial;
  rows.back().options.schedule.floor = std::numeric_limits<std::size_t>::max();
  for (const bool greedy : {false, true})
    for (const int t : a.threads) {
      if (greedy && !a.greedy) continue;
      rows.push_back({(greedy ? "greedy, " : "reproducible, ") + std::to_string(t), base, {}, {}, {}, 0});
      rows.back().options.schedule.threads = t;
      if (greedy) rows.back().options.schedule.schedule = Schedule::greedy;
    }
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(*std::max_element(a.threads.begin(), a.threads.end())));
  bool good = true;
  for (int round = 0; round < a.repeat; ++round)
    for (Row& row : rows) {
      row.last = refine(domain, row.options);
      row.mesh.push_back(row.last.statistics.seconds_mesh);
      row.refine.push_back(row.last.statistics.seconds_refine);
      const std::uint64_t bytes = fingerprint(row.last.mesh);
      if (row.options.schedule.schedule == Schedule::reproducible && round > 0 && bytes != row.bytes) good = false;
      row.bytes = bytes;
    }
  std::printf("%-18s %10s %8s %8s %6s %7s %7s %9s %6s %6s  %s\n", "schedule, threads", "tetrahedra", "mesh s", "refine s",
              "leaves", "visits", "aside %", "work/path", "ratio", "check", "bytes");
  for (Row& row : rows) {
    CheckOptions<3> check_options;
    check_options.domain = &domain;
    check_options.radius_edge_bound = row.options.radius_edge_bound;
    check_options.size = row.options.size;
    check_options.reasons = &row.last.reasons;
    const int checked = check<3>(row.last.mesh, check_options).exit_code();
    const auto& s = row.last.scheduler;
    std::printf("%-18s %10zu %8.3f %8.3f %6llu %7llu %7.2f %9.1f %6.2f %6d  %016llx\n", row.name.c_str(),
                row.last.mesh.cells.size(), median(row.mesh), median(row.refine),
                static_cast<unsigned long long>(s.leaves), static_cast<unsigned long long>(s.visits),
                100.0 * double(s.set_aside) / double(std::max<std::uint64_t>(row.last.statistics.insertions_committed, 1)),
                s.work_seconds / s.critical_path_seconds, median(rows[1].mesh) / median(row.mesh), checked,
                static_cast<unsigned long long>(row.bytes));
    good = good && checked <= 1;
    if (&row != &rows[0] && row.options.schedule.schedule == Schedule::reproducible) good = good && row.bytes == rows[1].bytes;
  }
  if (!good) std::printf("WRONG: a mesh did not pass the checker, or bytes differ\n");
  return good ? 0 : 1;
}
