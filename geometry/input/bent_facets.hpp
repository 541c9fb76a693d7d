// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets that are planar within rounding alone: which triangle of such a facet holds a point in the facet's projection. The plane
// of that triangle is the facet there. Made once; any number of threads may ask.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/domain.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

/// p without coordinate `axis`.
inline Point2 projected(const Point3& p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

/// Is the facet off its plane by more than the doubles of its corners, as in files of few digits? Then what holds in a plane,
/// or after a rotation, need not hold up to rounding.
inline bool is_uneven(const Domain<3>& domain, EntityId f) {
  return domain.facets()[f].planarity_defect > rounding::of_plane * domain.facet_magnitude(f);
}

/// The points of a facet for in-circle tests. Their heights are |x|^2, in which an ulp by which a Steiner point is off its facet
/// counts the more the farther away the origin is; so the dropped coordinate is taken from a level near it, where that is exact
/// (the others are compared by differences alone). A bend counts the more the farther a point is from that level, too: in a
/// circle of radius r, whose points are some distance L from it, all that is off the plane by more than r^2 / L decides, however
/// small beside r. So points of an uneven facet are put into its plane.
class LevelledFacet {
 public:
  LevelledFacet(const Domain<3>& domain, EntityId f) : axis_(domain.facets()[f].axis), level_(domain.facet_level(f)) {
    if (is_uneven(domain, f)) take_plane(domain.triangles(f), domain.points());
  }

  Point3 operator()(Point3 p) const {
    if (is_uneven_)
      p[axis_] = slopes_[0] * (p[(axis_ + 1) % 3] - anchor_[(axis_ + 1) % 3]) +
                 slopes_[1] * (p[(axis_ + 2) % 3] - anchor_[(axis_ + 2) % 3]);
    else
      p[axis_] -= level_;
    return p;
  }

 private:
  /// The sum of the triangles' normals is that of the plane which the outline is nearest to as a whole.
  void take_plane(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const Point3> points) {
    is_uneven_ = true;
    anchor_ = points[triangles[0][0]];
    std::array<double, 3> normal{};
    for (const auto& t : triangles) {
      const auto n = cross(difference(points[t[1]], points[t[0]]), difference(points[t[2]], points[t[0]]));
      for (std::size_t i = 0; i < 3; ++i) normal[i] += n[i];
    }
    const auto along = [&](int axis) { return normal[static_cast<std::size_t>(axis % 3)]; };
    slopes_ = {-along(axis_ + 1) / along(axis_), -along(axis_ + 2) / along(axis_)};
  }

  int axis_;
  double level_;
  bool is_uneven_ = false;
  Point3 anchor_;
  std::array<double, 2> slopes_{};
};

/// The triangles of one facet, by what they cover in its projection.
class BentFacet {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  BentFacet(std::span<const Triangle> triangles, std::span<const Point3> points, int axis)
      : axis_(axis), tree_(boxes(triangles, points, axis)) {}

  /// The first triangle (by its place) for which `holds(k)` is true, of those whose projected boxes have x.
  template <class Holds>
  std::optional<std::uint32_t> first(const Point3& x, Holds&& holds) const {
    std::optional<std::uint32_t> found;
    tree_.at(projected(x, axis_), [&](std::uint32_t k) {
      if ((!found || k < *found) && holds(k)) found = k;
    });
    return found;
  }

 private:
  static std::vector<Box<2>> boxes(std::span<const Triangle> triangles, std::span<const Point3> points, int axis) {
    std::vector<Box<2>> out;
    for (const Triangle& t : triangles) {
      Box<2> box = Box<2>::around(projected(points[t[0]], axis));
      for (const std::uint32_t v : t) box.add(projected(points[v], axis));
      out.push_back(box);
    }
    return out;
  }

  int axis_;
  BoxTree<2> tree_;
};

/// The bent facets of a Domain; exactly planar ones are not among them.
class BentFacets {
 public:
  void add(EntityId f, BentFacet facet) { facets_.emplace_back(f, std::move(facet)); }  ///< by ascending f
  const BentFacet* find(EntityId f) const {
    const auto at = std::lower_bound(facets_.begin(), facets_.end(), f, [](const auto& a, EntityId b) { return a.first < b; });
    return at != facets_.end() && at->first == f ? &at->second : nullptr;
  }

 private:
  std::vector<std::pair<EntityId, BentFacet>> facets_;
};

}  // namespace pgdr::detail
