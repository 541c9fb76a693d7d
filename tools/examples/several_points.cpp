// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Example: selectors for what Fig. 4.1 of the dissertation proposes. Each puts points into selection disks for an aim of its own:
//
//   two at once   of the off-centre and some points about it in the disk the one that destroys the most poor triangles
//   along         points on a line in a wanted direction, through a corner if that is in the disk: edges run along it
//   ring          several points in an element that a circle passes: on the circle, evenly spaced, as many as go in at once
//
// The bounds hold for each, and its mesh is the same for any number of threads. Counts what was aimed at, beside circumcentres in
// the same input, and draws the meshes.
//
//   example_several_points [PICTURE.svg]     exit code 0 if all went as it should
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pgdr/pgdr.hpp"

namespace {

using pgdr::Point2;
using Mesh = pgdr::OutputMesh<2>;
using Edge = std::array<Point2, 2>;

Point2 moved(const Point2& p, double x, double y) { return {{p[0] + x, p[1] + y}}; }

/// Of the off-centre and points on two circles in the disk: what destroys the most poor triangles, and of equals the fewest good
/// ones.
Point2 two_at_once(const pgdr::PoorElement<2>& e, pgdr::Neighborhood<2>& mesh) {
  static const pgdr::PointSelector<2> off_center = pgdr::off_center<2>();
  Point2 best = off_center(e, mesh);
  auto most = mesh.count(best);
  constexpr int angles = 16;
  for (const double far : {0.45, 0.9})
    for (int k = 0; k < angles && most.status != pgdr::Preview<2>::Status::unknown; ++k) {
      const double a = 2 * std::numbers::pi * k / angles, r = far * e.disk.radius;
      const Point2 p = moved(e.disk.center, r * std::cos(a), r * std::sin(a));
      const auto preview = mesh.count(p);
      if (preview.status != pgdr::Preview<2>::Status::possible) continue;
      if (preview.poor < most.poor || (preview.poor == most.poor && preview.good >= most.good)) continue;
      most = preview;
      best = p;
    }
  return best;
}

constexpr double tilt = 0.3;  // of the wanted direction, in radians

/// The foot of the disk's centre on the line in the wanted direction through a corner, if that is in the disk: of three the
/// nearest, else the centre. Further points on the line, to both sides, as far apart as they have to be, and half of that more.
pgdr::SelectedPoints<2> along(const pgdr::PoorElement<2>& e) {
  const double ux = std::cos(tilt), uy = std::sin(tilt);
  Point2 best = e.circumcenter;
  double least = e.disk.radius;
  for (const Point2& corner : e.corners) {
    const double off = (e.disk.center[1] - corner[1]) * ux - (e.disk.center[0] - corner[0]) * uy;
    const Point2 p = moved(e.disk.center, off * uy, -off * ux);
    if (std::abs(off) < least && inside(e.disk, p)) {
      least = std::abs(off);
      best = p;
    }
  }
  pgdr::SelectedPoints<2> points(best);
  const double step = 1.5 * (e.circumradius - e.disk.radius);
  for (int i = 1; points.size() + 1 < pgdr::SelectedPoints<2>::most; ++i)
    for (const double far : {-i * step, i * step}) points.push_back(moved(best, far * ux, far * uy));
  return points;
}

constexpr double circle = 0.3, spacing = 0.02;  // about the middle of the unit square
constexpr Point2 middle{{0.5, 0.5}};

/// The places of a ring that are in the disk: that nearest to its centre first, then the others in the circumcircle to both
/// sides.
pgdr::SelectedPoints<2> ring(const pgdr::PoorElement<2>& e) {
  constexpr int places = static_cast<int>(2 * std::numbers::pi * circle / spacing);
  const auto place = [](int i) {
    const double a = 2 * std::numbers::pi * i / places;
    return moved(middle, circle * std::cos(a), circle * std::sin(a));
  };
  const double turn = std::atan2(e.disk.center[1] - middle[1], e.disk.center[0] - middle[0]) / (2 * std::numbers::pi);
  const int nearest = static_cast<int>(std::lround(turn * places));
  if (!inside(e.disk, place(nearest))) return e.circumcenter;
  pgdr::SelectedPoints<2> points(place(nearest));
  for (int i = 1; points.size() + 1 < pgdr::SelectedPoints<2>::most; ++i)
    for (const int side : {-i, i}) points.push_back(place(nearest + side));
  return points;
}

/// Pairs of points that are near to each other, in the unit square: there is much to refine about each.
pgdr::Plc<2> square_with_pairs() {
  pgdr::Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  plc.segments = {{{0, 1}}, {{1, 2}}, {{2, 3}}, {{3, 0}}};
  std::mt19937_64 random(4);
  const auto draw = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 12; ++i) {
    const Point2 p{{0.05 + 0.9 * draw(), 0.05 + 0.9 * draw()}};
    plc.points.push_back(p);
    plc.points.push_back(moved(p, 0.012, 0));
  }
  return plc;
}

/// How many poor triangles a point of the selector destroys on the average, where it goes in as it is.
double poor_destroyed(const pgdr::Plc<2>& plc, const pgdr::PointSelector<2>& selector) {
  int points = 0, poor = 0;
  pgdr::RefineOptions<2> options;
  options.radius_edge_bound = pgdr::min_angle_degrees(20);
  options.disk.type = pgdr::DiskType::type1;
  options.schedule.threads = 1;
  options.selector = [&](const pgdr::PoorElement<2>& e, pgdr::Neighborhood<2>& mesh) {
    const Point2 p = selector(e, mesh);
    const auto preview = mesh.count(p);
    if (preview.status == pgdr::Preview<2>::Status::possible) ++points, poor += preview.poor;
    return p;
  };
  pgdr::refine(plc, options);
  return static_cast<double>(poor) / points;
}

struct Made {
  Mesh mesh;
  pgdr::RefineStatistics statistics;
};

/// The mesh, which is checked and the same for one thread and for two.
Made make(const pgdr::Plc<2>& plc, const pgdr::PointSelector<2>& selector) {
  pgdr::RefineOptions<2> options;
  options.radius_edge_bound = pgdr::min_angle_degrees(20);
  options.disk.type = pgdr::DiskType::type1;
  options.selector = selector;
  options.schedule.threads = 1;
  Made made;
  auto one = pgdr::refine(plc, options);
  options.schedule.threads = 2;
  if (pgdr::refine(plc, options).mesh.points != one.mesh.points) std::printf("the meshes differ\n"), std::exit(1);
  pgdr::CheckOptions<2> wanted;
  wanted.input = &plc;
  wanted.radius_edge_bound = options.radius_edge_bound;
  if (pgdr::check(one.mesh, wanted).exit_code() != 0) std::printf("the mesh does not hold\n"), std::exit(1);
  return {std::move(one.mesh), one.statistics};
}

std::vector<Edge> edges_of(const Mesh& mesh) {
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : mesh.cells)
    for (int i = 0; i < 3; ++i) edges.insert({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  std::vector<Edge> all;
  for (const auto& [a, b] : edges) all.push_back({mesh.points[a], mesh.points[b]});
  return all;
}

bool on_circle(const Point2& p) { return std::abs(std::sqrt(squared_distance(p, middle)) - circle) < 1e-9; }

/// Within five degrees of the wanted direction.
bool is_along(const Edge& e) {
  const double x = e[1][0] - e[0][0], y = e[1][1] - e[0][1];
  const double off = std::abs(x * std::sin(tilt) - y * std::cos(tilt));
  return off < std::sin(std::numbers::pi / 36) * std::sqrt(x * x + y * y);
}

/// On the circle, both ends.
bool is_on_circle(const Edge& e) { return on_circle(e[0]) && on_circle(e[1]); }

void draw(const std::string& path, const std::vector<std::pair<const Mesh*, bool (*)(const Edge&)>>& panels) {
  constexpr int side = 300, gap = 12;
  std::ofstream svg(path);
  const std::size_t columns = panels.size() / 2;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << columns * (side + gap) - gap << ' ' << 2 * side + gap
      << "\" fill=\"none\" stroke-linecap=\"round\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    svg << "<g transform=\"translate(" << i % columns * (side + gap) << ' ' << i / columns * (side + gap) << ")\">\n";
    for (const bool is_marked : {false, true}) {
      svg << "<path stroke=\"" << (is_marked ? "#c2410c\" stroke-width=\"1.8" : "#64748b\" stroke-width=\"0.6") << "\" d=\"";
      for (const Edge& e : edges_of(*panels[i].first)) {
        if (panels[i].second(e) != is_marked) continue;
        for (int k = 0; k < 2; ++k)
          svg << (k ? 'L' : 'M') << std::round(e[k][0] * side * 10) / 10 << ' ' << std::round((1 - e[k][1]) * side * 10) / 10;
      }
      svg << "\"/>\n";
    }
    svg << "</g>\n";
  }
  svg << "</svg>\n";
}

template <class F>
double share(const std::vector<Edge>& edges, const F& f) {
  return 100.0 * static_cast<double>(std::count_if(edges.begin(), edges.end(), f)) / static_cast<double>(edges.size());
}

}  // namespace

int main(int argc, char** argv) {
  const pgdr::Plc<2> plc = square_with_pairs();
  const Made plain = make(plc, nullptr), off = make(plc, pgdr::off_center<2>()), fewer = make(plc, two_at_once),
             tilted = make(plc, along), round = make(plc, ring);
  const auto vertices_on_circle = [](const Mesh& m) { return std::count_if(m.points.begin(), m.points.end(), on_circle); };
  const double before = share(edges_of(plain.mesh), is_along), after = share(edges_of(tilted.mesh), is_along);
  std::printf("circumcentres: %zu triangles, %.1f %% of the edges along the direction\n", plain.mesh.cells.size(), before);
  const double one_by_one = poor_destroyed(plc, pgdr::off_center<2>()), at_once = poor_destroyed(plc, two_at_once);
  std::printf("off-centres:   %zu triangles, a point destroys %.2f poor ones\n", off.mesh.cells.size(), one_by_one);
  std::printf("two at once:   %zu triangles, a point destroys %.2f poor ones\n", fewer.mesh.cells.size(), at_once);
  std::printf("along:         %zu triangles, %.1f %% of the edges along the direction\n", tilted.mesh.cells.size(), after);
  std::printf("ring:          %zu triangles, %td vertices on the circle, %llu of them as further points of an element\n",
              round.mesh.cells.size(), vertices_on_circle(round.mesh),
              static_cast<unsigned long long>(round.statistics.selector_further));
  if (argc > 1) {
    const auto none = [](const Edge&) { return false; };
    draw(argv[1], {{&plain.mesh, none},
                   {&plain.mesh, is_along},
                   {&plain.mesh, is_on_circle},
                   {&fewer.mesh, none},
                   {&tilted.mesh, is_along},
                   {&round.mesh, is_on_circle}});
  }
  const bool as_meant = at_once > one_by_one + 0.5 && after > 2 * before && vertices_on_circle(plain.mesh) == 0 &&
                        vertices_on_circle(round.mesh) > 30 && round.statistics.selector_further > 20;
  return as_meant ? 0 : 1;
}
