// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Example: a thread-scaling study. Meshes the unit cube with 1, 2, 4, ... threads by turns, prints medians and speed-ups as a
// table, and draws them beside the ideal and the limit that the longest chain of visits sets. Also a test: all meshes must be
// the same.
//
//   example_scaling [PLOT.svg [SIZE [MOST THREADS [REPETITIONS]]]]
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "pgdr/pgdr.hpp"

namespace {

struct Row {
  int threads;
  std::vector<double> seconds;
  double limit = 0;  ///< work over critical path, of the last run
  std::uint64_t visits = 0;

  double median() const {
    std::vector<double> s = seconds;
    std::nth_element(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(s.size() / 2), s.end());
    return s[s.size() / 2];
  }
};

pgdr::Plc<3> unit_cube() {
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
  const std::uint32_t triangles[] = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                     2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
  return pgdr::plc_from_arrays<3>(xyz, triangles);
}

/// Speed-up over threads, in a square plot whose axes have the same scale.
void write_plot(const std::string& file, const std::vector<Row>& rows, std::size_t cells) {
  constexpr double side = 360, margin = 50;
  const double most = rows.back().threads;
  const auto x = [&](double threads) { return margin + side * threads / most; };
  const auto y = [&](double speed_up) { return margin + side - side * std::min(speed_up, most) / most; };
  std::ofstream out(file);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << side + 2 * margin << "\" height=\"" << side + 2 * margin
      << "\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  const auto text = [&](double at_x, double at_y, const char* anchor, const std::string& words) {
    out << "<text x=\"" << at_x << "\" y=\"" << at_y << "\" text-anchor=\"" << anchor << "\">" << words << "</text>\n";
  };
  const auto curve = [&](const char* style, const auto& value) {
    out << "<polyline fill=\"none\" " << style << " points=\"";
    for (const Row& row : rows) out << x(row.threads) << ',' << y(value(row)) << ' ';
    out << "\"/>\n";
  };
  out << "<path d=\"M" << margin << ' ' << margin << 'v' << side << 'h' << side << "\" fill=\"none\" stroke=\"black\"/>\n";
  for (const Row& row : rows) {
    text(x(row.threads), margin + side + 18, "middle", std::to_string(row.threads));
    text(margin - 8, y(row.threads) + 4, "end", std::to_string(row.threads));
  }
  curve("stroke=\"#999\" stroke-dasharray=\"5 4\"", [](const Row& r) { return r.threads; });
  curve("stroke=\"#e08a1e\" stroke-dasharray=\"2 3\"", [](const Row& r) { return std::min<double>(r.threads, r.limit); });
  curve("stroke=\"#2a62b0\" stroke-width=\"2\"", [&](const Row& r) { return rows[0].median() / r.median(); });
  for (const Row& row : rows)
    out << "<circle r=\"4\" fill=\"#2a62b0\" cx=\"" << x(row.threads) << "\" cy=\"" << y(rows[0].median() / row.median())
        << "\"/>\n";
  text(margin + side / 2, margin + side + 38, "middle", "threads");
  text(margin, margin - 28, "start", "speed-up, unit cube, " + std::to_string(cells) + " tetrahedra");
  text(margin, margin - 10, "start", "grey: ideal; orange: no schedule can do better");
  out << "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  const std::string plot = argc > 1 ? argv[1] : "scaling.svg";
  const double size = argc > 2 ? std::atof(argv[2]) : 0.04;
  const int most = std::max(1, argc > 3 ? std::atoi(argv[3]) : static_cast<int>(std::thread::hardware_concurrency()));
  const int repetitions = argc > 4 ? std::max(1, std::atoi(argv[4])) : 3;

  // TBB starts no more threads than the program allows, which is one a core if nothing is said.
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(most));
  std::vector<Row> rows;
  for (int t = 1; t < most; t *= 2) rows.push_back({t, {}});
  rows.push_back({most, {}});

  const pgdr::Domain<3> domain(unit_cube());
  pgdr::OutputMesh<3> first;
  for (int round = 0; round < repetitions; ++round)
    for (Row& row : rows) {
      pgdr::RefineOptions<3> options;
      options.size = size;
      options.schedule.threads = row.threads;
      const auto result = pgdr::refine(domain, options);
      row.seconds.push_back(result.statistics.seconds_mesh);
      row.limit = result.scheduler.work_seconds / result.scheduler.critical_path_seconds;
      row.visits = result.scheduler.visits;
      if (first.cells.empty()) first = result.mesh;
      if (result.mesh.points != first.points || result.mesh.cells != first.cells) {
        std::printf("WRONG: the mesh depends on the number of threads\n");
        return 1;
      }
    }
  std::printf("%zu tetrahedra, %d runs each\n%8s %10s %10s %10s %10s\n", first.cells.size(), repetitions, "threads", "seconds",
              "speed-up", "at most", "visits");
  for (const Row& row : rows)
    std::printf("%8d %10.3f %10.2f %10.1f %10llu\n", row.threads, row.median(), rows[0].median() / row.median(), row.limit,
                static_cast<unsigned long long>(row.visits));
  write_plot(plot, rows, first.cells.size());
  return 0;
}
