// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/plane_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "build/fitted_plane.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

class PartJoiner {
 public:
  explicit PartJoiner(const Domain<3>& domain) : domain_(domain), points_(domain.points()), sets_(domain.facets().size()) {
    for (const Point3& p : points_)
      for (const double x : p.x) largest_ = std::max(largest_, std::abs(x));
    std::frexp(largest_, &exponent_);
  }

  std::vector<PlanePart> join() {
    for (EntityId s = 0; s < domain_.segments().size(); ++s) {
      const auto facets = domain_.facets_of_segment(s);
      if (facets.size() != 2 || domain_.segments()[s].explicit_in_input) continue;
      if (domain_.facets()[facets[0]].marker != domain_.facets()[facets[1]].marker) continue;
      if (have_one_plane({facets[0], facets[1]})) sets_.unite(facets[0], facets[1]);
    }
    std::map<std::uint32_t, std::vector<EntityId>> groups;
    for (EntityId f = 0; f < domain_.facets().size(); ++f) groups[sets_.find(f)].push_back(f);
    std::vector<std::pair<EntityId, PlanePart>> parts;
    for (const auto& [first, facets] : groups) {
      std::optional<PlanePart> whole;
      if (facets.size() > 1) whole = part_of(facets);
      if (whole) {
        parts.emplace_back(first, std::move(*whole));
        continue;
      }
      for (const EntityId f : facets) parts.emplace_back(f, *part_of({f}));
    }
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<PlanePart> out;
    for (auto& [first, part] : parts) out.push_back(std::move(part));
    return out;
  }

 private:
  /// In coordinates of the size of 1.
  Point3 scaled(std::uint32_t v) const {
    Point3 p = points_[v];
    for (double& x : p.x) x = std::ldexp(x, -exponent_);
    return p;
  }

  FittedPlane plane_of(const std::vector<EntityId>& facets) const {
    FittedPlane plane(scaled(domain_.triangles(facets[0])[0][0]));
    for (const EntityId f : facets)
      for (const auto& t : domain_.triangles(f)) plane.add(scaled(t[0]), scaled(t[1]), scaled(t[2]));
    return plane;
  }

  bool have_one_plane(const std::vector<EntityId>& facets) const {
    const FittedPlane plane = plane_of(facets);
    const double width = std::ldexp(domain_.tolerance(), -exponent_);
    return std::ranges::all_of(facets, [&](EntityId f) {
      return std::ranges::all_of(domain_.facet_points(f), [&](std::uint32_t v) { return plane.distance(scaled(v)) <= width; });
    });
  }

  /// None if they are not one. The facet with the largest triangle comes first, and has the projection.
  std::optional<PlanePart> part_of(std::vector<EntityId> facets) const {
    if (facets.size() > 1 && !have_one_plane(facets)) return std::nullopt;
    std::stable_sort(facets.begin(), facets.end(), [this](EntityId f, EntityId g) { return size_of(f) > size_of(g); });
    PlanePart part{.marker = domain_.facets()[facets[0]].marker, .axis = domain_.facets()[facets[0]].axis};
    for (const EntityId f : facets)
      for (std::size_t k = 0; k < domain_.triangles(f).size(); ++k) {
        PlanarTriangle t = domain_.triangles(f)[k];
        const Sign way = orient_projected(points_[t[0]], points_[t[1]], points_[t[2]], part.axis);
        if (way == Sign::zero) return std::nullopt;
        if (way == Sign::negative) std::swap(t[1], t[2]);
        part.triangles.push_back(t);
        part.inputs.push_back(domain_.triangle_origins(f)[k].facet);
        part.points.insert(part.points.end(), t.begin(), t.end());
      }
    make_set(part.points);
    part.normal = plane_of(facets).normal();
    const double length = std::sqrt(dot(part.normal, part.normal));
    for (double& x : part.normal) x /= length;
    return part;
  }

  double size_of(EntityId f) const { return plane_of({f}).weight(); }

  const Domain<3>& domain_;
  std::span<const Point3> points_;
  DisjointSets sets_;
  double largest_ = 0;
  int exponent_ = 0;
};

}  // namespace

std::vector<PlanePart> plane_parts(const Domain<3>& domain) { return PartJoiner(domain).join(); }

}  // namespace pgdr::detail
