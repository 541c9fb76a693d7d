// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a file lacks the digits that would have made its planar faces planar, where that matters. The share of needles is by an
// estimate of how many elements a facet takes for its shape alone: d^2 / A, of its diameter and its area, is the number of
// squares as wide as a strip that fill it, and 2 / sin a of a triangle with a corner of a small angle a. At 8 such a corner
// has 14.47 degrees, and every mesh that keeps the facet has a poor cell there (sharp_corners.hpp).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "numbers/finite.hpp"
#include "numbers/unit_scale.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/written_precision.hpp"
#include "precision/looks.hpp"
#include "space/box_tree.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr {
namespace {

constexpr double needle = 8;  // d^2 / A from there on
constexpr double share_of_needles = 1. / 3;
constexpr double least_digits = 1e-5;  // of six; with fewer, a face may be as far off as one wants to see

/// A facet of the file, or several in one plane.
struct Shape {
  Point3 origin{};             ///< a point of it
  detail::Vector<3> normal{};  ///< as long as twice its area
  detail::Box<3> box;
  double area = 0;

  void add(const Shape& o) {
    box.add(o.box);
    area += o.area;
  }
  double needleness() const {
    const auto d = detail::difference(box.high, box.low);
    return detail::dot(d, d) / area;
  }
  double width() const {
    const auto d = detail::difference(box.high, box.low);
    return area / std::sqrt(detail::dot(d, d));
  }
  double magnitude() const {
    double largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::fabs(box.low[k]), std::fabs(box.high[k])});
    return largest;
  }
};

/// The facets of a file that has not been looked at: points that do not exist, and facets of no area, are passed over.
class FileFacets {
 public:
  explicit FileFacets(const Plc<3>& plc) : plc_(plc), points_(detail::in_unit_scale(plc.points)), shapes_(plc.facets.size()) {
    find_distinct_points();
    for (std::uint32_t f = 0; f < shapes_.size(); ++f) add(f);
    std::sort(uses_.begin(), uses_.end());
  }

  /// The share that needles have which `precision` would make part of a larger facet.
  double share_kept_apart(double precision) {
    detail::DisjointSets planes(shapes_.size());
    std::vector<std::uint32_t> nearly;
    for_each_joint([&](std::uint32_t f, std::uint32_t g) {
      const double off = distance_off_plane(f, g);
      if (off <= plc_.precision)
        planes.unite(f, g);
      else if (off <= precision)
        nearly.insert(nearly.end(), {f, g});
    });
    std::vector<bool> is_nearly(shapes_.size());
    for (const std::uint32_t f : nearly) is_nearly[planes.find(f)] = true;
    std::vector<Shape> whole = shapes_;
    for (std::uint32_t f = 0; f < whole.size(); ++f)
      if (const std::uint32_t of = planes.find(f); of != f && shapes_[f].area > 0) whole[of].add(shapes_[f]);
    double all = 0, apart = 0;
    for (std::uint32_t f = 0; f < whole.size(); ++f) {
      if (planes.find(f) != f || !(whole[f].area > 0)) continue;
      const double takes = whole[f].needleness();
      all += takes;
      if (is_nearly[f] && takes > needle && (is_of_planar_face_.empty() || is_of_planar_face_[f])) apart += takes;
    }
    return all > 0 ? apart / all : 0;
  }

  /// How far the facets at an edge are off one plane, for each edge of two that are so by more than the rounding of doubles.
  std::vector<double> distances_off_planes() const {
    std::vector<double> off;
    for_each_joint([&](std::uint32_t f, std::uint32_t g) {
      if (const double distance = distance_off_plane(f, g); distance > Plc<3>{}.precision) off.push_back(distance);
    });
    return off;
  }

  /// Looks from now on at faces alone that are planar within `precision` with all facets of them, one after the other, that are.
  /// (The sides of a round body are no more off than that, each from the next. Needles narrower than that lie in any plane.)
  void keep_to_planar_faces(double precision) {
    detail::DisjointSets faces(shapes_.size());
    const auto has_plane = [&](std::uint32_t f) { return shapes_[f].width() > precision * shapes_[f].magnitude(); };
    for_each_joint([&](std::uint32_t f, std::uint32_t g) {
      if (has_plane(f) && has_plane(g) && distance_off_plane(f, g) <= precision) faces.unite(f, g);
    });
    std::vector<Plane> planes(shapes_.size());
    for (std::uint32_t f = 0; f < shapes_.size(); ++f) planes[faces.find(f)].add(shapes_[f]);
    is_of_planar_face_.assign(shapes_.size(), true);
    for (std::uint32_t f = 0; f < shapes_.size(); ++f) {
      const std::uint32_t face = faces.find(f);
      if (shapes_[f].area > 0 && distance_off(planes[face], f) > precision * planes[face].whole.magnitude())
        is_of_planar_face_[face] = false;
    }
    for (std::uint32_t f = 0; f < shapes_.size(); ++f) is_of_planar_face_[f] = is_of_planar_face_[faces.find(f)];
  }

 private:
  using Use = std::pair<std::array<std::uint32_t, 2>, std::uint32_t>;  // an edge, a facet

  /// Files that repeat points for every facet have neighbours, too.
  void find_distinct_points() {
    std::vector<std::uint32_t> order(points_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto& p = points_;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return lex_less(p[a], p[b]); });
    first_equal_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      first_equal_[order[i]] = i > 0 && p[order[i]] == p[order[i - 1]] ? first_equal_[order[i - 1]] : order[i];
  }
  void add(std::uint32_t f) {
    const auto& polygons = plc_.facets[f].polygons;
    for (const auto& polygon : polygons)
      for (const std::uint32_t v : polygon)
        if (v >= points_.size()) return;
    for (const auto& polygon : polygons) {
      if (polygon.size() < 3) continue;
      add_polygon(f, polygon);
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::uint32_t a = first_equal_[polygon[i]], b = first_equal_[polygon[(i + 1) % polygon.size()]];
        if (a != b) uses_.push_back({{std::min(a, b), std::max(a, b)}, f});
      }
    }
  }
  /// The largest polygon is the facet's shape.
  void add_polygon(std::uint32_t f, const std::vector<std::uint32_t>& polygon) {
    Shape shape;
    const Point3& origin = shape.origin = points_[polygon[0]];
    shape.box = detail::Box<3>::around(origin);
    for (std::size_t i = 1; i < polygon.size(); ++i) {
      shape.box.add(points_[polygon[i]]);
      const auto part = detail::cross(detail::difference(points_[polygon[i - 1]], origin),
                                      detail::difference(points_[polygon[i]], origin));
      for (std::size_t k = 0; k < 3; ++k) shape.normal[k] += part[k];
    }
    shape.area = std::sqrt(detail::dot(shape.normal, shape.normal)) / 2;
    if (shape.area > shapes_[f].area) shapes_[f] = shape;
  }
  /// Two facets of one marker that an edge is of, and no other.
  template <class Visit>
  void for_each_joint(const Visit& visit) const {
    for (std::size_t i = 0, j = 0; i < uses_.size(); i = j) {
      while (j < uses_.size() && uses_[j].first == uses_[i].first) ++j;
      if (j - i != 2) continue;
      const std::uint32_t f = uses_[i].second, g = uses_[i + 1].second;
      if (f == g || plc_.facets[f].marker != plc_.facets[g].marker) continue;
      if (shapes_[f].area > 0 && shapes_[g].area > 0) visit(f, g);
    }
  }
  /// Of the smaller one, from the plane of the larger, of the largest coordinate of both.
  double distance_off_plane(std::uint32_t f, std::uint32_t g) const {
    if (shapes_[f].area < shapes_[g].area) std::swap(f, g);
    const Point3& origin = shapes_[f].origin;
    double off = 0;
    for (const auto& polygon : plc_.facets[g].polygons)
      for (const std::uint32_t v : polygon)
        off = std::max(off, std::fabs(detail::dot(shapes_[f].normal, detail::difference(points_[v], origin))));
    return off / (2 * shapes_[f].area) / std::max(shapes_[f].magnitude(), shapes_[g].magnitude());
  }

  /// Of facets that are nearly coplanar: their mean normal, and where on average they are.
  struct Plane {
    detail::Vector<3> normal{}, origin{};  // the latter times the area
    Shape whole;
    void add(const Shape& s) {
      if (!(s.area > 0)) return;
      if (whole.area == 0) whole.box = s.box;
      whole.add(s);
      const double side = detail::dot(normal, s.normal) < 0 ? -1 : 1;  // orientation need not be consistent yet
      for (std::size_t k = 0; k < 3; ++k) {
        normal[k] += side * s.normal[k];
        origin[k] += s.area * s.origin.x[k];
      }
    }
  };
  double distance_off(const Plane& plane, std::uint32_t f) const {
    Point3 origin;
    for (int k = 0; k < 3; ++k) origin[k] = plane.origin[static_cast<std::size_t>(k)] / plane.whole.area;
    double off = 0;
    for (const auto& polygon : plc_.facets[f].polygons)
      for (const std::uint32_t v : polygon)
        off = std::max(off, std::fabs(detail::dot(plane.normal, detail::difference(points_[v], origin))));
    return off / std::sqrt(detail::dot(plane.normal, plane.normal));
  }

  const Plc<3>& plc_;
  std::vector<Point3> points_;              // scaled
  std::vector<std::uint32_t> first_equal_;  // of each point, one that stands for all in its place
  std::vector<Shape> shapes_;               // of each facet; area 0: not known
  std::vector<Use> uses_;                   // sorted
  std::vector<bool> is_of_planar_face_;     // of each facet; empty: all count
};

/// What coordinates look rounded to by how far facets are off the planes of others. In a file of few digits that was turned,
/// needles tell their planes, and how far others are off these, within ten times their rounding. Floats that were converted once
/// more, from other units or another place, are off by some units of their last digit, and bent faces by far more.
double precision_by_looks(const FileFacets& facets, const Plc<3>& plc) {
  std::vector<double> off = facets.distances_off_planes();
  const std::size_t edges = off.size();
  if (plc.precision_of_file) return precision_of_distances(std::move(off), edges, {.known = plc.precision});
  return precision_of_distances(std::move(off), edges, {.within_gap = 3});
}

}  // namespace

void set_precision_of_digits(Plc<3>& plc) {
  if (plc.precision > least_digits || !std::ranges::all_of(plc.points, detail::is_finite<3>)) return;
  double precision = written_precision(plc.points);
  const bool by_looks = plc.precision_of_file || (precision <= plc.precision && !has_few_digits(plc.points));
  if (!by_looks && (precision <= plc.precision || precision > least_digits)) return;
  FileFacets facets(plc);
  if (by_looks) {
    precision = precision_by_looks(facets, plc);
    if (precision <= plc.precision) return;
    facets.keep_to_planar_faces(precision);
  }
  if (!(facets.share_kept_apart(precision) > share_of_needles)) return;
  plc.precision = precision;
  plc.precision_of_file = true;
}

}  // namespace pgdr
