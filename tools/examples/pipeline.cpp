// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Example: meshing as one stage of a parallel program. Parts arrive as flat arrays, all are meshed at once inside of one task
// arena that they share, progress of all is shown together, and a part that nobody wants any more is cancelled. Each mesh is
// checked, and handed on by moving its arrays.
//
//   example_pipeline [SIZE]     exit code 0 if all went as it should
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "pgdr/pgdr.hpp"

namespace {

/// A part as a pipeline has it: a closed surface in flat arrays.
struct Surface {
  std::string name;
  std::vector<double> xyz;
  std::vector<std::uint32_t> triangles;
};

/// A prism over a regular polygon of radius 0.5 and height 1.
Surface prism(unsigned sides) {
  Surface s{"prism of " + std::to_string(sides) + " sides", {}, {}};
  for (unsigned i = 0; i < 2 * sides; ++i) {
    const double a = 2 * std::numbers::pi * (i % sides) / sides;
    s.xyz.insert(s.xyz.end(), {0.5 * std::cos(a), 0.5 * std::sin(a), i < sides ? 0.0 : 1.0});
  }
  for (unsigned i = 0; i < sides; ++i) {
    const unsigned j = (i + 1) % sides;
    for (const unsigned corner : {i, j, j + sides, i, j + sides, i + sides}) s.triangles.push_back(corner);
    if (i < 2) continue;  // fans of the two ends, from their first corners
    for (const unsigned corner : {0u, i - 1, i, sides, sides + i - 1, sides + i}) s.triangles.push_back(corner);
  }
  return s;
}

/// One part on its way.
struct Job {
  Surface surface;
  double size;
  std::stop_source cancel;
  std::atomic<std::uint64_t> vertices{0};  ///< so far
  pgdr::StopCause stop = pgdr::StopCause::finished;
  std::vector<std::array<std::uint32_t, 4>> cells;  ///< what the next stage takes
  bool valid = false;
  std::string error;
};

/// Runs on any thread of the arena; what a refinement has no work for, another one takes.
void mesh(Job& job) {
  const pgdr::Plc<3> plc = pgdr::plc_from_arrays<3>(job.surface.xyz, job.surface.triangles);
  pgdr::RefineOptions<3> options;
  options.size = job.size;
  options.stop = job.cancel.get_token();
  options.partial_mesh = false;  // who cancels here wants no mesh
  options.progress = [&job](const pgdr::Progress& p) { job.vertices = p.vertices; };
  pgdr::RefineResult<3> result = pgdr::refine(plc, options);
  job.stop = result.stop;
  if (result.stop != pgdr::StopCause::finished) return;
  pgdr::CheckOptions<3> check;
  check.input = &plc;
  check.radius_edge_bound = options.radius_edge_bound;
  check.size = options.size;
  check.reasons = &result.reasons;
  job.valid = pgdr::check(result.mesh, check).exit_code() <= 1;
  job.cells = std::move(result.mesh.cells);
}

}  // namespace

int main(int argc, char** argv) {
  const double size = argc > 1 ? std::atof(argv[1]) : 0.05;
  std::vector<Job> jobs(6);
  for (unsigned i = 0; i < jobs.size(); ++i) {
    jobs[i].surface = prism(4 + 3 * i);
    jobs[i].size = size;
  }
  Job& unwanted = jobs.back();
  unwanted.size = size / 20;  // some thousand times the others' work

  // Meanwhile: what is shown to a person, who cancels the part that takes for ever.
  std::atomic<std::size_t> done{0};
  std::jthread watcher([&](const std::stop_token& over) {
    while (!over.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      std::uint64_t vertices = 0;
      for (const Job& job : jobs) vertices += job.vertices;
      std::printf("%zu of %zu parts done, %llu vertices at least\n", done.load(), jobs.size(),
                  static_cast<unsigned long long>(vertices));
      if (done + 1 >= jobs.size()) unwanted.cancel.request_stop();
    }
  });
  tbb::task_arena arena;
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, jobs.size(),
        [&](std::size_t i) {
          try {
            mesh(jobs[i]);
          } catch (const pgdr::Error& e) {  // names the culprits; the other parts go on
            jobs[i].error = e.what();
          }
          ++done;
        },
        tbb::simple_partitioner());
  });
  watcher.request_stop();
  watcher.join();

  bool good = true;
  for (const Job& job : jobs) {
    const bool cancelled = job.stop == pgdr::StopCause::cancelled;
    std::printf("%-20s %8zu tetrahedra, %s\n", job.surface.name.c_str(), job.cells.size(),
                !job.error.empty() ? job.error.c_str()
                : cancelled        ? "cancelled"
                : job.valid        ? "valid"
                                   : "NOT VALID");
    good = good && job.error.empty() && (&job == &unwanted ? cancelled && job.cells.empty() : job.valid);
  }
  return good ? 0 : 1;
}
