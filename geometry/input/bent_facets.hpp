// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets that are planar within rounding alone: which triangle of such a facet holds a point in the facet's projection. The plane
// of that triangle is the facet there. Made once; any number of threads may ask.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "numbers/rounding.hpp"
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

/// A point of the facet for in-circle tests. Their heights are |x|^2, in which a bend, or an ulp by which a Steiner point is off
/// its facet, counts the more the farther away the origin is; so the dropped coordinate is taken from one of its points instead
/// (the others are compared by differences alone), where that is exact, or the facet is uneven anyway.
inline Point3 levelled(const Domain<3>& domain, EntityId f, Point3 p) {
  const int axis = domain.facets()[f].axis;
  p[axis] -= is_uneven(domain, f) ? domain.points()[domain.triangles(f)[0][0]][axis] : domain.facet_level(f);
  return p;
}

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
