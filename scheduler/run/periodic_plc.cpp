// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/periodic_plc.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "numbers/vectors.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

std::array<std::uint32_t, 2> sorted_pair(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

template <class T>
void make_sorted_set(std::vector<T>& all) {
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

/// What each corner of a triangle has to say at a place on it.
std::array<double, 3> weights(const Point3& x, const std::array<Point3, 3>& t) {
  const auto n = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  std::array<double, 3> w{};
  for (std::size_t i = 0; i < 3; ++i)
    w[i] = std::max(0.0, dot(cross(difference(t[(i + 1) % 3], x), difference(t[(i + 2) % 3], x)), n));
  const double sum = w[0] + w[1] + w[2];
  for (double& value : w) value = sum > 0 ? value / sum : 1.0 / 3;
  return w;
}

BoxTree<3> tree_of_lines(const SideInput<3>& input) {
  std::vector<Box<3>> boxes;
  for (const auto& line : input.lines)
    boxes.push_back(box_of_edge<3>(input.points[line.points[0]], input.points[line.points[1]], input.reach));
  return BoxTree<3>(boxes);
}

}  // namespace

PeriodicPlc::PeriodicPlc(const Plc<3>& given, const Domain<3>& domain, const SideInput<3>& input, const NearPoints<3>& points)
    : given_(given),
      domain_(domain),
      input_(input),
      points_(points),
      lines_(tree_of_lines(input)),
      number_(points.size(), no_entity),
      tree_(std::span<const Box<3>>()),
      plc_(given) {
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (input.given.contains(domain.facets()[f].marker))
      for (std::uint32_t k = 0; k < domain.triangles(f).size(); ++k) walls_.push_back({f, k});
  for (std::uint32_t v = 0; v < domain.points().size(); ++v)
    if (domain.input_of_point()[v] < given.points.size()) number_[v] = domain.input_of_point()[v];
  for (const auto& facet : given.facets) {
    const bool is_segment = facet.polygons.size() == 1 && facet.polygons[0].size() == 2;
    is_side_.push_back(!is_segment && input.given.contains(facet.marker));
  }
  plc_.facets.clear();
  plc_.facet_bodies.clear();
  plc_.source.facet_lines.clear();
}

void PeriodicPlc::add_point(const SideChain<3>& chain, const Side& side, std::uint32_t place) {
  const Point3& p = points_[side.at[place]];
  number_[side.at[place]] = static_cast<std::uint32_t>(plc_.points.size());
  plc_.points.push_back(p);
  if (!given_.point_markers.empty()) plc_.point_markers.push_back(side.marker);
  if (!given_.source.point_lines.empty()) plc_.source.point_lines.push_back(0);
  const std::size_t columns = given_.points.empty() ? 0 : given_.point_attributes.size() / given_.points.size();
  if (columns == 0) return;
  const std::uint32_t wall = side.wall[place] != no_entity ? side.wall[place] : chain.wall_at(side.marker, p);
  const auto& corners = input_.walls[wall != no_entity ? wall : 0].points;
  const auto w = weights(p, {points_[corners[0]], points_[corners[1]], points_[corners[2]]});
  for (std::size_t i = 0; i < columns; ++i) {
    double value = 0;
    for (std::size_t k = 0; k < 3; ++k) value += w[k] * domain_.point_attributes()[corners[k] * columns + i];
    plc_.point_attributes.push_back(value);
  }
}

void PeriodicPlc::number_points(const SideChain<3>& chain, const Side& side) {
  number_.resize(points_.size(), no_entity);
  for (std::uint32_t k = 0; k < side.at.size(); ++k)
    if (number_[side.at[k]] == no_entity) add_point(chain, side, k);
  for (const auto& [i, k] : chain.pieces()) {
    if (is_on_line(side, points_[side.at[i]], points_[side.at[k]]))
      pieces_.push_back(sorted_pair(number_[side.at[i]], number_[side.at[k]]));
    for (const std::uint32_t place : {i, k})
      if (const std::uint32_t v = number_[side.at[place]]; v >= given_.points.size()) on_lines_.push_back(v);
  }
}

/// Or is it there for another side?
bool PeriodicPlc::is_on_line(const Side& side, const Point3& p, const Point3& q) const {
  bool found = false;
  lines_.at(p, [&](std::uint32_t k) {
    const auto& [ends, marker] = input_.lines[k];
    const Point3 &a = points_[ends[0]], &b = points_[ends[1]];
    found = found || (marker == side.marker && part_near<3>(p, a, b, input_.reach) && part_near<3>(q, a, b, input_.reach));
  });
  return found;
}

void PeriodicPlc::add_facet(Plc<3>::Facet facet, std::uint32_t given) {
  plc_.facets.push_back(std::move(facet));
  given_facets_.push_back(given);
  if (!given_.facet_bodies.empty()) plc_.facet_bodies.push_back(given_.facet_bodies[given]);
  if (!given_.source.facet_lines.empty()) plc_.source.facet_lines.push_back(given_.source.facet_lines[given]);
}

/// It runs round as the given facet there does.
void PeriodicPlc::add_triangle(const Side& side, const SideTriangle& triangle, const SideChain<3>& chain) {
  std::array<Point3, 3> p;
  Polygon corners(3);
  Point3 middle;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = points_[side.at[triangle.places[i]]];
    corners[i] = number_[side.at[triangle.places[i]]];
  }
  for (int i = 0; i < 3; ++i) middle[i] = (p[0][i] + p[1][i] + p[2][i]) / 3;
  for (std::size_t i = 0; i < 3; ++i) edges_.push_back(sorted_pair(corners[i], corners[(i + 1) % 3]));
  const std::uint32_t wall = chain.wall_at(side.marker, middle);
  if (wall == no_entity)
    refuse_sides("the periodic sides do not match within the tolerance: that with marker " + std::to_string(side.marker) +
                     " has no facet at the image of one",
                 {}, {middle.x});
  const auto& w = input_.walls[wall].points;
  const auto normal = [](const Point3& a, const Point3& b, const Point3& c) { return cross(difference(b, a), difference(c, a)); };
  const TriangleOrigin& origin = domain_.triangle_origins(walls_[wall][0])[walls_[wall][1]];
  const bool runs_against = dot(normal(p[0], p[1], p[2]), normal(points_[w[0]], points_[w[1]], points_[w[2]])) < 0;
  if (runs_against != origin.reversed) std::swap(corners[1], corners[2]);
  add_facet({{std::move(corners)}, {}, side.marker}, origin.facet);
}

void PeriodicPlc::add(const SideChain<3>& chain, const std::vector<SideTriangle>& triangles) {
  for (const std::uint32_t s : chain.order()) {
    const Side& side = chain.sides()[s];
    number_points(chain, side);
    for (const SideTriangle& t : triangles) add_triangle(side, t, chain);
  }
}

/// An edge with all new points on it, but its end.
auto PeriodicPlc::divided(std::uint32_t a, std::uint32_t b) const -> Polygon {
  const Point3 &p = plc_.points[a], &q = plc_.points[b];
  std::vector<std::pair<double, std::uint32_t>> along;
  tree_.meeting(box_of_edge<3>(p, q, input_.reach), [&](std::uint32_t k) {
    const auto t = part_near<3>(plc_.points[on_lines_[k]], p, q, input_.reach);
    if (t && *t > 0 && *t < 1) along.emplace_back(*t, on_lines_[k]);
  });
  std::ranges::sort(along);
  Polygon chain{a};
  for (const auto& [t, v] : along) chain.push_back(v);
  return chain;
}

auto PeriodicPlc::divided(const Polygon& polygon) const -> Polygon {
  Polygon all;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Polygon edge = divided(polygon[i], polygon[(i + 1) % polygon.size()]);
    all.insert(all.end(), edge.begin(), edge.end());
  }
  return all;
}

void PeriodicPlc::add_other_facets() {
  for (std::uint32_t f = 0; f < given_.facets.size(); ++f) {
    if (is_side_[f]) continue;
    Plc<3>::Facet facet{{}, given_.facets[f].holes, given_.facets[f].marker};
    for (const Polygon& polygon : given_.facets[f].polygons) {
      if (polygon.size() != 2) {
        facet.polygons.push_back(polygon.size() < 2 ? polygon : divided(polygon));
        continue;
      }
      Polygon line = divided(polygon[0], polygon[1]);
      line.push_back(polygon[1]);
      for (std::size_t i = 1; i < line.size(); ++i) facet.polygons.push_back({line[i - 1], line[i]});
    }
    if (given_.facets[f].polygons.size() > 1 || facet.polygons.size() == 1) {
      add_facet(std::move(facet), f);
      continue;
    }
    for (const Polygon& piece : facet.polygons) add_facet({{piece}, {}, facet.marker}, f);  // it is a segment
  }
}

void PeriodicPlc::add_segments() {
  plc_.segments.clear();
  plc_.source.segment_lines.clear();
  for (std::size_t s = 0; s < given_.segments.size(); ++s) {
    const auto& [ends, marker] = given_.segments[s];
    Polygon line = divided(ends[0], ends[1]);
    line.push_back(ends[1]);
    for (std::size_t i = 1; i < line.size(); ++i) {
      plc_.segments.push_back({{line[i - 1], line[i]}, marker});
      if (!given_.source.segment_lines.empty()) plc_.source.segment_lines.push_back(given_.source.segment_lines[s]);
    }
  }
}

void PeriodicPlc::finish(PeriodicInput<3>& out) {
  make_sorted_set(on_lines_);
  std::vector<Box<3>> boxes;
  for (const std::uint32_t v : on_lines_) boxes.push_back(Box<3>::around(plc_.points[v]));
  tree_ = BoxTree<3>(boxes);
  add_other_facets();
  add_segments();
  make_sorted_set(edges_);
  make_sorted_set(pieces_);
  out.inner_edges.clear();
  std::ranges::set_difference(edges_, pieces_, std::back_inserter(out.inner_edges));
  out.added_points = plc_.points.size() - given_.points.size();
  out.plc = std::move(plc_);
  out.given_facets = std::move(given_facets_);
}

}  // namespace pgdr::detail
