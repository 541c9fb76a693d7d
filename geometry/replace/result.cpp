// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/result.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "replace/numbers.hpp"
#include "replace/shape.hpp"
#include "replace/to_plc.hpp"
#include "space/bulk.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

/// Twice its area.
double area_of(const Point3& a, const Point3& b, const Point3& c) {
  const auto n = cross(difference(b, a), difference(c, a));
  return std::sqrt(dot(n, n));
}

double least_height(const std::array<Point3, 3>& t) {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, distance(t[i], t[(i + 1) % 3]));
  return longest > 0 ? area_of(t[0], t[1], t[2]) / longest : 0;
}

}  // namespace

ResultMaker::ResultMaker(const Plc<3>& input, const Domain<3>& domain, const ChangingSurface& surface)
    : input_(input), domain_(domain), s_(surface) {
  for (const SurfaceFace& f : surface.complex.faces) corners_.push_back(f.corners);
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const TriangleOrigin& origin : domain.triangle_origins(f)) facets_.push_back(origin.facet);
}

void ResultMaker::measure(SurfaceReport& report, std::size_t when) const {
  const SurfaceComplex& c = s_.complex;
  const HalfTangent sharp = half_tangent(numbers::poor_corner);
  HalfTangent least = wide_corner;
  std::set<std::uint32_t> groups;
  std::vector<double> heights;
  for (std::uint32_t f = 0; f < c.faces.size(); ++f) {
    if (!c.faces[f].alive) continue;
    const HalfTangent corner = least_corner(c, f);
    least = std::min(least, corner);
    report.sharp_triangles[when] += corner < sharp;
    if (when == 0 && corner < sharp) heights.push_back(least_height(c.triangle(f)));
    ++report.triangles[when];
    if (c.faces[f].group != no_index) groups.insert(c.faces[f].group);
  }
  report.smallest_corner[when] = degrees_of(least);
  report.flat_groups[when] = groups.size();
  std::sort(heights.begin(), heights.end());
  if (!heights.empty()) report.sharp_heights = {heights[heights.size() / 2], heights.back()};
  report.corners = 0;
  for (std::uint32_t v = 0; v < c.points.size(); ++v)
    report.corners += c.order[v] == VertexOrder::fixed && !c.faces_at[v].empty();
}

void ResultMaker::make(ReplacedSurface& out) const {
  SurfacePlc made = to_plc(s_.complex, s_.loose);
  Plc<3>& plc = made.plc;
  plc.holes = holes_within(input_, domain_.tolerance());
  plc.regions = input_.regions;
  plc.names = input_.names;
  plc.body_names = input_.body_names;
  plc.first_index = input_.first_index;
  plc.source.file = input_.source.file;
  if (!input_.facet_bodies.empty())
    for (const std::uint32_t face : made.face_of_facet)
      plc.facet_bodies.push_back(s_.complex.classes[s_.complex.faces[face].klass].body);
  for (const std::uint32_t face : made.face_of_facet) {
    const auto t = s_.complex.triangle(face);
    Point3 centre;
    for (int i = 0; i < 3; ++i) centre[i] = (t[0][i] + t[1][i] + t[2][i]) / 3;
    out.facet_of_input.push_back(facets_[s_.given.nearest(centre, s_.complex.faces[face].klass).triangle]);
  }
  add_point_data(made.vertex_of_point, plc);
  out.plc = std::move(plc);
  measure_distances(out.report);
}

void ResultMaker::add_point_data(const std::vector<std::uint32_t>& vertices, Plc<3>& plc) const {
  const auto markers = domain_.point_markers();
  for (const std::uint32_t v : vertices) {
    if (!markers.empty()) plc.point_markers.push_back(v < markers.size() ? markers[v] : 0);
    if (domain_.attributes_per_point() > 0) add_attributes(v, plc);
  }
}

std::uint32_t ResultMaker::class_at(std::uint32_t vertex) const {
  std::uint32_t least = no_index;
  for (const std::uint32_t f : s_.complex.faces_at[vertex]) least = std::min(least, s_.complex.faces[f].klass);
  return least;
}

/// Those of a point as given, or interpolated on the nearest given triangle.
void ResultMaker::add_attributes(std::uint32_t vertex, Plc<3>& plc) const {
  const std::size_t n = domain_.attributes_per_point();
  const auto given = domain_.point_attributes();
  const auto points = domain_.points();
  const Point3& p = s_.complex.at(vertex);
  if (vertex < points.size() && points[vertex] == p) {
    const auto own = given.subspan(vertex * n, n);
    plc.point_attributes.insert(plc.point_attributes.end(), own.begin(), own.end());
    return;
  }
  const auto nearest = s_.given.nearest(p, class_at(vertex));
  const auto& c = corners_[nearest.triangle];
  const Point3 &a = points[c[0]], &b = points[c[1]], &d = points[c[2]], &x = nearest.point;
  const double u = area_of(x, b, d), v = area_of(a, x, d), w = area_of(a, b, x), all = u + v + w;
  for (std::size_t k = 0; k < n; ++k)
    plc.point_attributes.push_back((u * given[c[0] * n + k] + v * given[c[1] * n + k] + w * given[c[2] * n + k]) / all);
}

void ResultMaker::measure_distances(SurfaceReport& report) const {
  const SurfaceComplex& c = s_.complex;
  const auto points = domain_.points();
  double farthest = -1;
  const auto take = [&](const Point3& p, double square, double& largest) {
    largest = std::max(largest, std::sqrt(square));
    if (square < farthest || (square == farthest && !lex_less(p, report.farthest_point))) return;
    farthest = square;
    report.farthest_point = p;
  };
  // Each point once for each class that it is a corner of.
  using Asked = std::pair<std::uint32_t, std::uint32_t>;
  const auto take_all = [&](std::vector<Asked> asked, const GivenSurface& other, std::span<const Point3> places,
                            double& largest) {
    std::sort(asked.begin(), asked.end());
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    std::vector<double> squares(asked.size());
    Bulk(true).each(asked.size(),
                    [&](std::size_t k) { squares[k] = other.nearest(places[asked[k].first], asked[k].second).square; });
    for (std::size_t k = 0; k < asked.size(); ++k) take(places[asked[k].first], squares[k], largest);
  };
  std::vector<Asked> now, given;
  for (const SurfaceFace& f : c.faces)
    for (const std::uint32_t v : f.corners)
      if (f.alive && (v >= points.size() || !(points[v] == c.at(v)))) now.emplace_back(v, f.klass);
  for (std::size_t t = 0; t < corners_.size(); ++t)
    for (const std::uint32_t v : corners_[t])
      if (c.faces_at[v].empty() || !(points[v] == c.at(v))) given.emplace_back(v, s_.given.triangles()[t].klass);
  take_all(std::move(now), s_.given, c.points, report.to_given);
  take_all(std::move(given), GivenSurface(c), points, report.from_given);
}

}  // namespace pgdr::detail
