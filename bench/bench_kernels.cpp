// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the hot loop stands on: predicates on points in general and in special position, and small meshes as a whole.
// Run with --benchmark_filter=REGEX; believe it from a Release build on a quiet machine alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

#include "pgdr/predicates.hpp"
#include "pgdr/refine.hpp"

namespace {

using namespace pgdr;

/// Simplices of positive orientation, and a point for each; corners on a grid of `steps` cells a side (0: no grid).
struct Samples {
  std::vector<Simplex<3>> simplices;
  std::vector<Point3> points;

  explicit Samples(int steps) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> real(0, 1);
    std::uniform_int_distribution<int> grid(0, steps > 0 ? steps : 1);
    const auto point = [&] {
      Point3 p;
      for (double& c : p.x) c = steps > 0 ? double(grid(random)) / steps : real(random);
      return p;
    };
    while (simplices.size() < 1024) {
      Simplex<3> s{point(), point(), point(), point()};
      if (orient<3>(s) == Sign::negative) std::swap(s[0], s[1]);
      if (orient<3>(s) != Sign::positive) continue;
      const Point3 p = point();
      if (std::find(s.begin(), s.end(), p) != s.end()) continue;
      simplices.push_back(s);
      points.push_back(p);
    }
  }
};

void orientation(benchmark::State& state) {
  const Samples samples(static_cast<int>(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(orient<3>(samples.simplices[i++ % 1024]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(orientation)->Arg(0)->Arg(4);

void in_sphere_test(benchmark::State& state) {
  const Samples samples(static_cast<int>(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(in_sphere_perturbed<3>(samples.simplices[i % 1024], samples.points[i % 1024]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(in_sphere_test)->Arg(0)->Arg(4);

void mesh_of_a_cube(benchmark::State& state) {
  Plc<3> cube;
  for (int i = 0; i < 8; ++i) cube.points.push_back({{double(i & 1), double(i >> 1 & 1), double(i >> 2)}});
  const std::uint32_t sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& s : sides) cube.facets.push_back({.polygons = {{s[0], s[1], s[2], s[3]}}});
  RefineOptions<3> options;
  options.size = 1.0 / static_cast<double>(state.range(0));
  std::size_t cells = 0;
  for (auto _ : state) cells = refine(cube, options).mesh.cells.size();
  state.counters["cells"] = static_cast<double>(cells);
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(cells), benchmark::Counter::kIsIterationInvariantRate);
}
/// What a call costs that makes two triangles, or with a size of 1 / n some n.
void mesh_of_a_square(benchmark::State& state) {
  Plc<2> square;
  square.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  square.segments = {{{0, 1}}, {{1, 2}}, {{2, 3}}, {{3, 0}}};
  const Domain<2> domain(square);
  RefineOptions<2> options;
  options.size = 1.0 / static_cast<double>(state.range(0));
  options.schedule.executor = Executor::serial;
  for (auto _ : state) benchmark::DoNotOptimize(refine(domain, options));
}
BENCHMARK(mesh_of_a_square)->Arg(1)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

BENCHMARK(mesh_of_a_cube)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
