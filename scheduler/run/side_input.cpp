// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "join/near_tests.hpp"
#include "pgdr/error.hpp"
#include "run/periodic_sides.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {

void refuse_sides(const std::string& what, const std::vector<std::int64_t>& ids,
                  const std::vector<std::array<double, 3>>& points) {
  throw UsageError({Errc::bad_option, what, {}, 0, ids, points});
}

template <int D>
std::optional<double> part_near(const Point<D>& p, const Point<D>& a, const Point<D>& b, double width) {
  if (squared_distance(p, a) <= width * width) return 0;
  if (squared_distance(p, b) <= width * width) return 1;
  return part_of_edge_near<D>(p, a, b, width);
}

template <int D>
Box<D> box_of_edge(const Point<D>& a, const Point<D>& b, double width) {
  Box<D> box = Box<D>::around(a);
  box.add(b);
  return box.widened(width);
}

template <int D>
double place_of_cut(const Point<D>& p, const Point<D>& a, const Point<D>& b) {
  constexpr double simple = 0x1p20, rounding = 0x1p-48;
  const double t = part_of_edge<D>(p, a, b), near = std::nearbyint(t * simple) / simple;
  return std::fabs(t - near) <= rounding ? near : t;
}

SideInput<2> side_input(const Plc<2>& plc, const SideMarkers& markers) {
  SideInput<2> input;
  input.reach = 2 * tolerance_of(plc);
  input.points = plc.points;
  input.numbers.resize(plc.points.size());
  std::iota(input.numbers.begin(), input.numbers.end(), std::int64_t{plc.first_index});
  std::vector<Box<2>> boxes;
  for (const auto& s : plc.segments) {
    if (!markers.contains(s.marker)) continue;
    input.lines.push_back({s.points, s.marker});
    input.walls.push_back({s.points, s.marker});
    boxes.push_back(box_of_edge<2>(plc.points[s.points[0]], plc.points[s.points[1]], input.reach));
  }
  const BoxTree<2> tree(boxes);
  std::set<std::pair<int, std::array<double, 2>>> seen;
  for (std::uint32_t v = 0; v < plc.points.size(); ++v)
    tree.at(plc.points[v], [&](std::uint32_t k) {
      const auto& [ends, marker] = input.lines[k];
      const Point2& p = plc.points[v];
      if (!part_near<2>(p, plc.points[ends[0]], plc.points[ends[1]], input.reach)) return;
      if (seen.emplace(marker, std::array{p[0] + 0.0, p[1] + 0.0}).second) input.given[marker].push_back(v);
    });
  return input;
}

SideInput<3> side_input(const Domain<3>& domain, const SideMarkers& markers) {
  SideInput<3> input;
  input.reach = 2 * domain.tolerance();
  input.points.assign(domain.points().begin(), domain.points().end());
  for (const std::uint32_t v : domain.input_of_point()) input.numbers.push_back(std::int64_t{v} + domain.first_index());
  std::map<int, std::set<std::uint32_t>> given;
  std::set<std::pair<int, EntityId>> segments;
  for (EntityId f = 0; f < domain.facets().size(); ++f) {
    const int marker = domain.facets()[f].marker;
    if (!markers.contains(marker)) continue;
    for (const auto& t : domain.triangles(f)) input.walls.push_back({t, marker});
    const auto points = domain.facet_points(f);
    given[marker].insert(points.begin(), points.end());
    for (const EntityId s : domain.facet_segments(f)) segments.emplace(marker, s);
  }
  for (const auto& [marker, s] : segments) input.lines.push_back({domain.segments()[s].points, marker});
  for (const auto& [marker, points] : given) input.given[marker].assign(points.begin(), points.end());
  return input;
}

template std::optional<double> part_near<2>(const Point2&, const Point2&, const Point2&, double);
template std::optional<double> part_near<3>(const Point3&, const Point3&, const Point3&, double);
template double place_of_cut<2>(const Point2&, const Point2&, const Point2&);
template double place_of_cut<3>(const Point3&, const Point3&, const Point3&);
template Box<2> box_of_edge<2>(const Point2&, const Point2&, double);
template Box<3> box_of_edge<3>(const Point3&, const Point3&, double);

}  // namespace pgdr::detail
