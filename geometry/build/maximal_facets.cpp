// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/maximal_facets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "input/triangle_shapes.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"
#include "space/sort_by_points.hpp"

namespace pgdr::detail {
namespace {

/// Facets and their triangles, those of a group one after the other. Returns where those of each of the FacetTriangles' facets
/// begin.
std::vector<std::uint32_t> collect_groups(const BuildInput<3>& in, const FacetTriangles& faces,
                                          std::span<const std::uint32_t> roots, MaximalFacets& out) {
  out.group_of.resize(faces.facets.size());
  for (std::uint32_t f = 0; f < faces.facets.size(); ++f) {
    const TriangulatedFacet& facet = faces.facets[f];
    if (roots[f] != f) {
      out.group_of[f] = out.group_of[roots[f]];
    } else {
      out.group_of[f] = static_cast<EntityId>(out.facets.size());
      out.facets.push_back({in.plc.facets[facet.input].marker, facet.axis, facet.planar, facet.defect, 0, 0, 0, 0, 0, 0});
    }
    out.facets[out.group_of[f]].triangle_count += facet.count;
  }
  std::uint32_t total = 0;
  for (DomainFacet& f : out.facets) {
    f.first_triangle = total;
    total += std::exchange(f.triangle_count, 0);
  }
  out.triangles.resize(total);
  out.origins.resize(total);
  std::vector<std::uint32_t> places;
  for (std::uint32_t f = 0; f < faces.facets.size(); ++f) {
    const TriangulatedFacet& facet = faces.facets[f];
    DomainFacet& group = out.facets[out.group_of[f]];
    const std::uint32_t at = group.first_triangle + group.triangle_count;
    std::ranges::copy(faces.of(facet), out.triangles.begin() + at);
    std::fill_n(out.origins.begin() + at, facet.count, TriangleOrigin{facet.input, facet.reversed, facet.mixed});
    group.triangle_count += facet.count;
    places.push_back(at);
  }
  return places;
}

/// What triangles stand for beside their own facets. `places`: of collect_groups. `exchanged`: the triangle of each facet that
/// has changed places with its first one since.
void list_further_origins(const FacetTriangles& faces, std::span<const std::uint32_t> places,
                          std::span<const std::uint32_t> exchanged, MaximalFacets& out) {
  const auto add = [&](std::uint32_t f, std::uint32_t k, std::uint32_t input) {
    const EntityId group = out.group_of[f];
    const std::uint32_t t = places[f] + k, first = out.facets[group].first_triangle, other = exchanged[group];
    out.further_origins.push_back({t == first ? other : t == other ? first : t, input});
  };
  for (const auto& [f, input] : faces.repeated)
    for (std::uint32_t k = 0; k < faces.facets[f].count; ++k) add(f, k, input);
  for (const auto& [t, input] : faces.overlapped) {
    const auto after = std::ranges::upper_bound(faces.facets, t, {}, &TriangulatedFacet::first);
    const auto f = static_cast<std::uint32_t>(after - faces.facets.begin() - 1);
    add(f, t - faces.facets[f].first, input);
  }
  make_set(out.further_origins);
}

/// The largest triangle first; one projection for all, each triangle positive in it. Returns which one was the largest.
std::uint32_t orient(DomainFacet& facet, std::span<const Point3> p, const TriangleShapes& shapes, MaximalFacets& out) {
  PlanarTriangle* const t = out.triangles.data() + facet.first_triangle;
  const auto size = [&](const PlanarTriangle& s) { return std::fabs(shapes.normal(s)[static_cast<std::size_t>(facet.axis)]); };
  std::uint32_t largest = 0;
  double largest_size = -1;
  for (std::uint32_t k = 0; k < facet.triangle_count; ++k)
    if (const double s = size(t[k]); s > largest_size || (s == largest_size && shapes.is_before(t[k], t[largest]))) {
      largest = k;
      largest_size = s;
    }
  TriangleOrigin* const origin = out.origins.data() + facet.first_triangle;
  std::swap(t[0], t[largest]);
  std::swap(origin[0], origin[largest]);
  if (facet.planar)
    for (const int axis : axes_by_size(shapes.normal(t[0]))) {
      facet.axis = axis;
      if (orient_projected(p[t[0][0]], p[t[0][1]], p[t[0][2]], axis) != Sign::zero) break;
    }
  for (std::uint32_t k = 0; k < facet.triangle_count; ++k)
    if (orient_projected(p[t[k][0]], p[t[k][1]], p[t[k][2]], facet.axis) == Sign::negative) {
      std::swap(t[k][1], t[k][2]);
      origin[k].reversed = !origin[k].reversed;
    }
  return facet.first_triangle + largest;
}

/// Of two doubles within a factor of 2 the difference is exact (Sterbenz); 1.9 leaves room for points between, which are rounded.
double level(std::span<const Point3> p, std::span<const std::uint32_t> points, std::uint32_t first_point, int axis) {
  const double first = p[first_point][axis];
  double least = std::fabs(first), most = least;
  for (const std::uint32_t v : points) {
    const double x = p[v][axis];
    if (std::signbit(x) != std::signbit(first)) return 0;
    least = std::min(least, std::fabs(x));
    most = std::max(most, std::fabs(x));
  }
  return most <= 1.9 * least ? first : 0;
}

/// How far points of a facet are off the plane of this triangle.
double planarity_defect(std::span<const Point3> p, std::span<const std::uint32_t> points, const PlanarTriangle& t) {
  double defect = 0;
  for (const std::uint32_t v : points)
    if (v != t[0] && v != t[1] && v != t[2]) defect = std::max(defect, plane_distance(p[t[0]], p[t[1]], p[t[2]], p[v]));
  return defect;
}

/// The points of a facet, and what is measured of them. `points` is memory to work in.
void take_points(DomainFacet& f, std::span<const Point3> p, std::vector<std::uint32_t>& points, MaximalFacets& out) {
  points.clear();
  for (const PlanarTriangle& t : out.triangles_of(f)) points.insert(points.end(), t.begin(), t.end());
  make_set(points);
  f.first_point = static_cast<std::uint32_t>(out.points.size());
  f.point_count = static_cast<std::uint32_t>(points.size());
  out.points.insert(out.points.end(), points.begin(), points.end());
  double largest = 0;
  for (const std::uint32_t v : points)
    for (const double x : p[v].x) largest = std::max(largest, std::fabs(x));
  const PlanarTriangle& first = out.triangles[f.first_triangle];
  out.magnitudes.push_back(largest);
  out.levels.push_back(level(p, points, first[0], f.axis));
  if (!f.planar) f.planarity_defect = planarity_defect(p, points, first);
}

/// Pairs of facets with many points that have one in common. The refinement asks for every point that it puts on one, and to look
/// through the points took nine tenths of the time for a plate with 8,000 of them on its rim and holes.
void find_touching(const BuildInput<3>& in, std::size_t few_points, MaximalFacets& out) {
  std::vector<std::array<std::uint32_t, 2>> uses;  // point, facet
  for (EntityId f = 0; f < out.facets.size(); ++f)
    if (const auto points = out.points_of(out.facets[f]); points.size() > few_points)
      for (const std::uint32_t v : points) uses.push_back({v, f});
  in.stop.sort(in.bulk, uses);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    in.stop();
    for (std::size_t j = i + 1; j < uses.size() && uses[j][0] == uses[i][0]; ++j)
      out.touching.push_back({uses[i][1], uses[j][1]});
  }
  in.stop.sort(in.bulk, out.touching);
  out.touching.erase(std::unique(out.touching.begin(), out.touching.end()), out.touching.end());
}

}  // namespace

MaximalFacets make_maximal_facets(const BuildInput<3>& in, const FacetTriangles& faces, std::span<const std::uint32_t> roots,
                                  std::size_t few_points) {
  MaximalFacets out;
  const std::vector<std::uint32_t> places = collect_groups(in, faces, roots, out);
  std::vector<std::uint32_t> exchanged;
  const TriangleShapes shapes(in.points, in.scale);
  std::vector<std::uint32_t> points;
  for (DomainFacet& f : out.facets) {
    in.stop();
    exchanged.push_back(orient(f, in.points, shapes, out));
    take_points(f, in.points, points, out);
  }
  list_further_origins(faces, places, exchanged, out);
  sort_by_points(
      in.points.size(), out.triangles.size(), [&](std::uint32_t t) { return out.triangles[t]; }, out.triangles_at_begin,
      out.triangles_at);
  auto bent = std::make_shared<BentFacets>();
  for (EntityId f = 0; f < out.facets.size(); ++f)
    if (const DomainFacet& facet = out.facets[f]; !facet.planar) bent->add(f, {out.triangles_of(facet), in.points, facet.axis});
  out.bent = std::move(bent);
  find_touching(in, few_points, out);
  return out;
}

}  // namespace pgdr::detail
