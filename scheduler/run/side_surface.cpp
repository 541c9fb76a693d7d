// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/side_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "input/words.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/refine.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

/// Of a triangle, in squares of the circumradius of those there in a mesh of the input without pairs: twice that of an
/// equilateral one. 30 cells with spheres have 6 % more cells so than without pairs; by that of an equilateral one 39 %.
constexpr double largest_area = 2.5980762113533156;
/// No triangle without an angle below 30 degrees that has this area, in squares of a length, has a larger circumradius.
constexpr double area_of_size = 0.4330127018922193;

std::vector<Box<3>> boxes_of(const std::vector<std::array<Point3, 3>>& triangles, double width) {
  std::vector<Box<3>> boxes;
  for (const auto& t : triangles) boxes.push_back(Box<3>::of(t).widened(width));
  return boxes;
}

Point3 middle_of(const Point3& a, const Point3& b) { return on_edge<3>(a, b, 0.5); }

}  // namespace

SideSizes::SideSizes(const OutputMesh<3>& mesh, const SideChain<3>& chain, const SizingField<3>& size)
    : chain_(chain), size_(size), width_(0x1p-40 / scale_of<3>(mesh.points).first) {
  for (const auto& side : chain.sides()) {
    std::vector<std::array<Point3, 3>> triangles;
    std::vector<double> radii;
    for (const auto& f : mesh.subfacets) {
      if (f.marker != side.marker) continue;
      triangles.push_back({mesh.points[f.vertices[0]], mesh.points[f.vertices[1]], mesh.points[f.vertices[2]]});
      const auto& t = triangles.back();
      radii.push_back(equatorial_ball(t[0], t[1], t[2]).squared_radius);
    }
    BoxTree<3> tree(boxes_of(triangles, width_));
    sides_.push_back({std::move(triangles), std::move(radii), std::move(tree)});
  }
}

double SideSizes::area_at(const Point3& on_first) const {
  double area = std::numeric_limits<double>::infinity();
  for (std::uint32_t s = 0; s < sides_.size(); ++s) {
    const Point3 p = chain_.carried(s, on_first);
    const OfSide& side = sides_[s];
    side.tree.at(p, [&](std::uint32_t k) {
      if (closest_to_simplex<3>(p, side.triangles[k]).square <= width_ * width_)
        area = std::min(area, largest_area * side.squared_radii[k]);
    });
    if (!size_.bounded()) continue;
    const double size = size_.at(p);
    if (!(size > 0)) throw UsageError({Errc::bad_size, "the size at " + to_text(p) + " is not positive", {}, 0, {}, {p.x}});
    area = std::min(area, area_of_size * size * size);
  }
  return area;
}

SidePlane::SidePlane(const Domain<3>& domain, EntityId facet) : domain_(&domain), facet_(facet) {
  const DomainFacet& f = domain.facets()[facet];
  const auto& t = domain.triangles(facet)[0];
  const auto p = [&](std::size_t i) { return domain.points()[t[i]]; };
  origin_ = p(0);
  axis_ = f.axis;
  if (f.planar && p(0)[axis_] == p(1)[axis_] && p(0)[axis_] == p(2)[axis_]) {
    level_ = origin_[axis_];
    return;
  }
  const auto unit = [](Vector<3> v) {
    const double length = std::sqrt(dot(v, v));
    for (double& x : v) x /= length;
    return v;
  };
  along_[0] = unit(difference(p(1), p(0)));
  along_[1] = unit(cross(cross(difference(p(1), p(0)), difference(p(2), p(0))), along_[0]));
}

Point2 SidePlane::flat(const Point3& p) const {
  if (level_) return {{p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}};
  const auto d = difference(p, origin_);
  return {{dot(d, along_[0]), dot(d, along_[1])}};
}

Point3 SidePlane::near(const Point2& p) const {
  Point3 x;
  if (level_) {
    x[axis_] = *level_;
    x[(axis_ + 1) % 3] = p[0];
    x[(axis_ + 2) % 3] = p[1];
    return x;
  }
  for (int i = 0; i < 3; ++i)
    x[i] = origin_[i] + (p[0] * along_[0][static_cast<std::size_t>(i)] + p[1] * along_[1][static_cast<std::size_t>(i)]);
  return x;
}

Point3 SidePlane::lifted(const Point2& p) const { return level_ ? near(p) : point_on_facet(*domain_, facet_, near(p)); }

SideSurface::SideSurface(const Domain<3>& domain, SideChain<3>& chain, const SideInput<3>& input)
    : domain_(domain), chain_(chain), input_(input), tree_(std::span<const Box<3>>()) {
  std::vector<Box<3>> boxes;
  for (EntityId f = 0; f < domain.facets().size(); ++f) {
    if (domain.facets()[f].marker != chain.first().marker) continue;
    for (const auto& t : domain.triangles(f)) {
      const std::array<Point3, 3> corners{domain.points()[t[0]], domain.points()[t[1]], domain.points()[t[2]]};
      triangles_.push_back({static_cast<std::uint32_t>(planes_.size()), corners});
      boxes.push_back(Box<3>::of(corners).widened(input.reach));
    }
    planes_.push_back({.facet = f, .plane = SidePlane(domain, f)});
  }
  tree_ = BoxTree<3>(boxes);
}

/// Ascending.
std::vector<std::uint32_t> SideSurface::planes_at(const Point3& p) const {
  std::vector<std::uint32_t> found;
  tree_.at(p, [&](std::uint32_t k) {
    if (closest_to_simplex<3>(p, triangles_[k].second).square <= input_.reach * input_.reach)
      found.push_back(triangles_[k].first);
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Which pieces and places are on which plane.
void SideSurface::assign() {
  const auto& at = chain_.first().at;
  std::vector<std::vector<std::uint32_t>> planes_of(at.size()), places(planes_.size());
  for (std::uint32_t k = 0; k < at.size(); ++k) {
    planes_of[k] = planes_at(chain_.point(chain_.first(), k));
    for (const std::uint32_t f : planes_of[k]) places[f].push_back(k);
  }
  std::vector<std::vector<Piece>> pieces(planes_.size());
  std::vector<std::vector<std::uint32_t>> numbers(planes_.size());
  for (std::uint32_t n = 0; n < chain_.pieces().size(); ++n) {
    const auto& [i, k] = chain_.pieces()[n];
    const Point3 &a = chain_.point(chain_.first(), i), &b = chain_.point(chain_.first(), k);
    bool is_on_any = false;
    for (const std::uint32_t f : planes_at(middle_of(a, b))) {
      if (!std::ranges::binary_search(planes_of[i], f) || !std::ranges::binary_search(planes_of[k], f)) continue;
      is_on_any = true;
      pieces[f].push_back(chain_.pieces()[n]);
      numbers[f].push_back(n);
    }
    if (!is_on_any)
      refuse_sides(
          "the periodic sides do not match within the tolerance: a line between two points of another would be between " +
              to_text(a) + " and " + to_text(b) + " of that with marker " + std::to_string(chain_.first().marker) +
              ", where there is no facet of it",
          {}, {a.x, b.x});
  }
  for (std::uint32_t f = 0; f < planes_.size(); ++f) {
    Plane& plane = planes_[f];
    if (plane.pieces != pieces[f] || plane.places != places[f]) plane.mesh.reset();
    plane.pieces = std::move(pieces[f]);
    plane.places = std::move(places[f]);
    plane.numbers = std::move(numbers[f]);
  }
}

std::uint32_t SideSurface::number_of(const Plane& plane, std::uint32_t place) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(plane.places, place) - plane.places.begin());
}

/// The marker of each segment is the number of the piece on the plane.
Plc<2> SideSurface::outline(const Plane& plane) const {
  Plc<2> plc;
  for (const std::uint32_t k : plane.places) plc.points.push_back(plane.plane.flat(chain_.point(chain_.first(), k)));
  for (std::size_t n = 0; n < plane.pieces.size(); ++n)
    plc.segments.push_back({{number_of(plane, plane.pieces[n][0]), number_of(plane, plane.pieces[n][1])}, static_cast<int>(n)});
  plc.holes = plane.holes;
  return plc;
}

OutputMesh<2> SideSurface::meshed(const Plane& plane, const RefineOptions<2>& options) const {
  try {
    OutputMesh<2> mesh = refine(outline(plane), options).mesh;
    if (mesh.input_points == plane.places.size() || options.stop.stop_requested()) return mesh;
    refuse_sides("two places of the periodic side with marker " + std::to_string(chain_.first().marker) +
                 " are one within the tolerance");
  } catch (const InputError& e) {
    const Point3 p = domain_.points()[domain_.facet_points(plane.facet)[0]];
    refuse_sides("the lines on the periodic side with marker " + std::to_string(chain_.first().marker) +
                     " and those that others of its chain have do not fit, on its facet at " + to_text(p) + ": " + e.what(),
                 {}, {p.x});
  }
}

/// What its lines enclose is covered by the facet, or is none of it; and the same is so on all other sides. Lines of all sides
/// are here: so each side covers all of such a part or nothing, and one place decides.
void SideSurface::find_holes(Plane& plane, RefineOptions<2> options) {
  options.refine = false;
  options.size = {};
  options.regions = RegionMode::all;
  plane.holes.clear();
  const OutputMesh<2> mesh = meshed(plane, options);
  struct Largest {
    double area = -1;
    Point2 middle{};
  };
  std::map<double, Largest> largest;  // by label
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto p = [&](std::size_t i) { return mesh.points[mesh.cells[c][i]]; };
    const auto u = difference(p(1), p(0)), v = difference(p(2), p(0));
    const double area = u[0] * v[1] - u[1] * v[0];
    Largest& l = largest[mesh.regions.empty() ? 0 : mesh.regions[c]];
    if (area > l.area) l = {area, {{(p(0)[0] + p(1)[0] + p(2)[0]) / 3, (p(0)[1] + p(1)[1] + p(2)[1]) / 3}}};
  }
  for (const auto& [label, l] : largest) {
    const Point3 p = plane.plane.near(l.middle);
    const auto planes = planes_at(p);
    const auto number = static_cast<std::uint32_t>(&plane - planes_.data());
    if (!std::ranges::binary_search(planes, number)) plane.holes.push_back(l.middle);
    require_covered(p, !planes.empty());
  }
}

void SideSurface::require_covered(const Point3& p, bool is_covered) const {
  for (std::uint32_t s = 0; s < chain_.sides().size(); ++s) {
    const auto& side = chain_.sides()[s];
    const Point3 image = chain_.carried(s, p);
    if (chain_.is_on(side, image) == is_covered) continue;
    refuse_sides("the periodic sides do not match within the tolerance: that with marker " +
                     std::to_string(chain_.first().marker) + " has " + (is_covered ? "a" : "no") + " facet at " + to_text(p) +
                     ", and that with marker " + std::to_string(side.marker) + " has " + (is_covered ? "none" : "one") + " at " +
                     to_text(image),
                 {}, {p.x, image.x});
  }
}

void SideSurface::add_cuts(const Plane& plane, std::vector<std::vector<Cuts>>& cuts) const {
  const OutputMesh<2>& mesh = *plane.mesh;
  const auto given = static_cast<std::uint32_t>(plane.places.size());
  std::map<std::size_t, std::set<double>> cut;  // by piece
  for (const auto& s : mesh.subsegments) {
    const auto n = static_cast<std::size_t>(s.marker);
    const auto end = [&](std::size_t k) { return mesh.points[number_of(plane, plane.pieces[n][k])]; };
    for (const std::uint32_t v : s.vertices)
      if (v >= given) cut[n].insert(place_of_cut<2>(mesh.points[v], end(0), end(1)));
  }
  for (const auto& [n, places] : cut) cuts[plane.numbers[n]].emplace_back(places.begin(), places.end());
}

std::vector<std::vector<Cuts>> SideSurface::mesh(const RefineOptions<2>& options, const SideSizes& sizes, bool keep) {
  assign();
  std::vector<std::vector<Cuts>> cuts(chain_.pieces().size());
  for (Plane& plane : planes_) {
    if (!plane.mesh || keep) {
      RefineOptions<2> own = options;
      find_holes(plane, own);
      own.keep_boundary = keep;
      own.size = [&](const Point2& p) { return sizes.area_at(plane.plane.near(p)); };
      plane.mesh = meshed(plane, own);
    }
    add_cuts(plane, cuts);
  }
  return cuts;
}

std::vector<SideTriangle> SideSurface::take_triangles() {
  std::vector<SideTriangle> triangles;
  for (const Plane& plane : planes_) {
    const OutputMesh<2>& mesh = *plane.mesh;
    std::vector<std::uint32_t> place(plane.places);
    for (std::size_t v = place.size(); v < mesh.points.size(); ++v)
      place.push_back(chain_.add_inner_place(plane.plane.lifted(mesh.points[v])));
    for (const auto& cell : mesh.cells) triangles.push_back({{place[cell[0]], place[cell[1]], place[cell[2]]}, plane.facet});
  }
  return triangles;
}

}  // namespace pgdr::detail
