// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "nearness/own_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "given/cover.hpp"
#include "nearness/near_set.hpp"
#include "nearness/surface_edges.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::checking {
namespace {

std::vector<SurfaceEdges::Corners> subfacets_of(const OutputMesh<3>& mesh) {
  std::vector<SurfaceEdges::Corners> list;
  list.reserve(mesh.subfacets.size());
  for (const auto& s : mesh.subfacets) list.push_back(s.vertices);
  return list;
}

Triangle3 corners(const OutputMesh<3>& mesh, std::uint32_t subfacet) {
  const auto& v = mesh.subfacets[subfacet].vertices;
  return {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
}

/// The height of each apex above the other's triangle, the lesser one.
double unevenness(const OutputMesh<3>& mesh, std::span<const SurfaceEdges::AtEdge> uses) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t k : {0, 1}) {
    const PlaneFrame frame(corners(mesh, uses[k].triangle));
    least = std::min(least, frame.width() > 0 ? std::abs(frame.place(mesh.points[uses[1 - k].apex])[2]) : 0.0);
  }
  return least;
}

class Subsegments {
 public:
  explicit Subsegments(const OutputMesh<3>& mesh) {
    for (const auto& s : mesh.subsegments) {
      const auto [a, b] = std::minmax(s.vertices[0], s.vertices[1]);
      ends_.push_back({a, b});
    }
    std::ranges::sort(ends_);
  }
  bool has(const std::array<std::uint32_t, 2>& ends) const { return std::ranges::binary_search(ends_, ends); }

 private:
  std::vector<std::array<std::uint32_t, 2>> ends_;
};

}  // namespace

Plc<3> walls_as_input(const OutputMesh<3>& mesh, const GivenInput<3>& given) {
  Plc<3> plc;
  plc.points = mesh.points;
  plc.point_markers = mesh.point_markers;
  for (const auto& s : mesh.subsegments) plc.segments.push_back({s.vertices, s.marker});
  for (const auto& s : mesh.subfacets) plc.facets.push_back({{{s.vertices[0], s.vertices[1], s.vertices[2]}}, {}, s.marker});
  plc.holes = holes_within(given.plc(), given.tolerance());
  plc.regions = given.plc().regions;
  return plc;
}

double evenness(const OutputMesh<3>& mesh, double least, double most) {
  const auto subfacets = subfacets_of(mesh);
  const Subsegments subsegments(mesh);
  double even = least;
  SurfaceEdges(subfacets, [](std::uint32_t) { return true; }).each([&](std::span<const SurfaceEdges::AtEdge> uses) {
    if (uses.size() == 2 && !subsegments.has(uses[0].ends)) even = std::max(even, unevenness(mesh, uses));
  });
  return std::min(even, most);
}

void check_edges_of_walls(const OutputMesh<3>& mesh, double even, Findings& findings) {
  const auto subfacets = subfacets_of(mesh);
  const Subsegments subsegments(mesh);
  SurfaceEdges(subfacets, [](std::uint32_t) { return true; }).each([&](std::span<const SurfaceEdges::AtEdge> uses) {
    if (subsegments.has(uses[0].ends)) return;
    const bool are_one_facet = uses.size() == 2 &&
                               mesh.subfacets[uses[0].triangle].marker == mesh.subfacets[uses[1].triangle].marker &&
                               unevenness(mesh, uses) <= even;
    if (are_one_facet) return;
    findings.add(Kind::segment_not_conforming, {uses[0].ends[0], uses[0].ends[1]}, [&] {
      return "The edge with " + list_words(uses[0].ends) + ", at which " + std::to_string(uses.size()) +
             (uses.size() == 1 ? " subfacet ends" : " subfacets meet that are not one facet") + ", is no subsegment.";
    });
  });
}

OwnFacets own_facets(const OutputMesh<3>& mesh) {
  const auto subfacets = subfacets_of(mesh);
  const Subsegments subsegments(mesh);
  OwnFacets own{detail::DisjointSets(subfacets.size()), std::vector<double>(subfacets.size(), 0)};
  SurfaceEdges(subfacets, [](std::uint32_t) { return true; }).each([&](std::span<const SurfaceEdges::AtEdge> uses) {
    if (uses.size() == 2 && !subsegments.has(uses[0].ends)) own.sets.unite(uses[0].triangle, uses[1].triangle);
  });
  std::vector<std::pair<double, std::uint32_t>> largest(subfacets.size(), {-1, 0});  // of each set: area squared, subfacet
  const auto area_of = [&](std::uint32_t s) {
    const auto [a, b, c] = corners(mesh, s);
    const auto n = detail::cross(detail::difference(b, a), detail::difference(c, a));
    return detail::dot(n, n);
  };
  for (std::uint32_t s = 0; s < subfacets.size(); ++s) {
    auto& of = largest[own.sets.find(s)];
    of = std::max(of, std::pair{area_of(s), s});
  }
  std::vector<std::array<double, 2>> heights(subfacets.size(), {0, 0});  // of each set: least, most
  for (std::uint32_t s = 0; s < subfacets.size(); ++s) {
    const std::uint32_t set = own.sets.find(s);
    const PlaneFrame frame(corners(mesh, largest[set].second));
    if (!(frame.width() > 0)) continue;
    for (const Point3& p : corners(mesh, s)) {
      const double h = frame.place(p)[2];
      heights[set] = {std::min(heights[set][0], h), std::max(heights[set][1], h)};
    }
    own.thickness[set] = heights[set][1] - heights[set][0];
  }
  return own;
}

std::vector<PoorReason> with_subfacets(const std::vector<PoorReason>& reasons, const OutputMesh<3>& mesh) {
  std::vector<detail::Box<3>> boxes;
  for (std::uint32_t s = 0; s < mesh.subfacets.size(); ++s) boxes.push_back(detail::Box<3>::of(corners(mesh, s)));
  const detail::BoxTree<3> tree(boxes);
  std::vector<PoorReason> out = reasons;
  for (PoorReason& reason : out)
    for (GivenEntity& e : reason.entities) {
      if (e.kind != EntityKind::facet) continue;
      const bool has_place = e.facet == no_entity;
      Point3 x;
      for (int i = 0; i < 3; ++i) x[i] = e.ends[0][static_cast<std::size_t>(i)];
      e.facet = no_entity;
      if (!has_place || !std::ranges::all_of(x.x, [](double c) { return std::isfinite(c); })) continue;
      double least = std::numeric_limits<double>::infinity();
      tree.nearest([&](const detail::Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); },
                   [&](std::uint32_t s) {
                     const double square = squared_distance_above(x, corners(mesh, s));
                     if (square < least || (square == least && s < e.facet)) {
                       least = square;
                       e.facet = s;
                     }
                     return least;
                   });
    }
  return out;
}

}  // namespace pgdr::checking
