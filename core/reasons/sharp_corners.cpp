// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/sharp_corners.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

#include "input/bent_facets.hpp"
#include "numbers/vectors.hpp"

namespace pgdr {
namespace sharp_corners {

/// A segment of a facet (2D: of no facet) at one of its ends, seen along the facet's axis.
struct Side {
  std::uint32_t point;
  EntityId facet;
  double polar;  ///< angle of its direction, in radians
  EntityId segment;
  auto place() const { return std::tuple(point, facet); }
};

/// A corner of a subfacet (2D: of a cell) at an input point.
struct Corner {
  std::uint32_t point;
  EntityId facet;
  VertexId at;
  std::array<VertexId, 2> others;
};

/// Is f(corner) true for any of the cell?
template <int D, class F>
bool any_corner(const Mesh<D>& mesh, CellId c, const F& f) {
  const auto in_triangle = [&](const std::array<VertexId, 3>& v, EntityId facet) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Home home = mesh.vertex(v[i]).home;
      if (home.kind() == EntityKind::vertex && f(Corner{home.id(), facet, v[i], {v[(i + 1) % 3], v[(i + 2) % 3]}})) return true;
    }
    return false;
  };
  const auto& v = mesh.cell(c).vertices;
  if constexpr (D == 2) {
    return in_triangle(v, no_entity);
  } else {
    const auto* constraints = mesh.constraints(c);
    for (int i = 0; constraints && i <= D; ++i) {
      const auto& face = face_corners<D>[i];
      if (constraints->has_face(i) && in_triangle({v[face[0]], v[face[1]], v[face[2]]}, constraints->face_entity[i])) return true;
    }
    return false;
  }
}

template <int D>
class SharpCorners {
 public:
  /// `wanted`: the domain points that will be asked for.
  SharpCorners(const Domain<D>& domain, double radius_edge_bound, const std::vector<char>& wanted, const detail::Bulk& bulk)
      : domain_(&domain), largest_(std::asin(std::min(0.5 / radius_edge_bound, 1.0)) * (180 / std::numbers::pi)) {
    sides_ = bulk.gather<Side>(domain.segments().size(), [&](std::size_t s, std::vector<Side>& found) {
      for (const std::uint32_t p : domain.segments()[s].points)
        if (wanted[p] != 0) add_sides(static_cast<EntityId>(s), p, found);
    });
    bulk.sort(sides_, [](const Side& a, const Side& b) {
      return std::tuple(a.place(), a.polar, a.segment) < std::tuple(b.place(), b.polar, b.segment);
    });
  }

  bool meets(const Mesh<D>& mesh, CellId c) const {
    return any_corner(mesh, c, [&](const Corner& corner) { return is_sharp(mesh, corner); });
  }

 private:
  /// No segment passes through a subfacet, so that it lies between the two that are next to it.
  bool is_sharp(const Mesh<D>& mesh, const Corner& corner) const {
    const auto at_place = std::equal_range(sides_.begin(), sides_.end(), Side{corner.point, corner.facet, 0, 0},
                                           [](const Side& a, const Side& b) { return a.place() < b.place(); });
    const std::span<const Side> sides(at_place.first, at_place.second);
    if (sides.size() < 2) return false;
    const double polar = middle(corner.facet, mesh.point(corner.at), mesh.point(corner.others[0]), mesh.point(corner.others[1]));
    const auto beyond = std::upper_bound(sides.begin(), sides.end(), polar, [](double p, const Side& s) { return p < s.polar; });
    const Side& left = beyond == sides.end() ? sides.front() : *beyond;
    const Side& right = beyond == sides.begin() ? sides.back() : *(beyond - 1);
    const double width = left.polar - right.polar;
    return (width < 0 ? width + 2 * std::numbers::pi : width) < std::numbers::pi &&
           entity_angle(*domain_, {EntityKind::segment, left.segment}, {EntityKind::segment, right.segment}) < largest_;
  }

  void add_sides(EntityId s, std::uint32_t p, std::vector<Side>& sides) const {
    const auto& ends = domain_->segments()[s].points;
    const Point<D>& from = domain_->points()[p];
    const Point<D>& to = domain_->points()[ends[0] == p ? ends[1] : ends[0]];
    const auto add = [&](EntityId facet) { sides.push_back({p, facet, middle(facet, from, to, to), s}); };
    if constexpr (D == 2) {
      add(no_entity);
    } else {
      for (const EntityId f : domain_->facets_of_segment(s)) add(f);
    }
  }
  /// Polar angle of the direction midway between those from `from` to a and to b.
  double middle(EntityId facet, const Point<D>& from, const Point<D>& a, const Point<D>& b) const {
    std::array<double, 2> sum{};
    for (const Point<D>* to : {&a, &b}) {
      detail::Vector<2> d;
      if constexpr (D == 2) {
        d = detail::difference<2>(*to, from);
      } else {
        const int axis = domain_->facets()[facet].axis;
        d = detail::difference<2>(detail::projected(*to, axis), detail::projected(from, axis));
      }
      const double length = std::hypot(d[0], d[1]);
      for (std::size_t i = 0; i < 2; ++i) sum[i] += d[i] / length;
    }
    return std::atan2(sum[1], sum[0]);
  }

  const Domain<D>* domain_;
  double largest_;           // angle of a sharp corner, in degrees
  std::vector<Side> sides_;  // by place, then counter-clockwise
};

}  // namespace sharp_corners

template <int D>
std::uint64_t count_in_sharp_corners(const Mesh<D>& mesh, const Domain<D>& domain, double radius_edge_bound,
                                     std::span<const CellId> cells, const detail::Bulk& bulk) {
  std::vector<char> wanted(domain.points().size());
  bulk.each(cells.size(), [&](std::size_t i) {
    sharp_corners::any_corner(mesh, cells[i], [&](const sharp_corners::Corner& corner) {
      std::atomic_ref(wanted[corner.point]).store(1, std::memory_order_relaxed);
      return false;
    });
  });
  const sharp_corners::SharpCorners<D> sharp(domain, radius_edge_bound, wanted, bulk);
  constexpr std::size_t cells_a_part = 512;
  std::vector<std::uint64_t> counts((cells.size() + cells_a_part - 1) / cells_a_part);
  bulk.parts(counts.size(), [&](std::size_t part) {
    for (std::size_t i = part * cells_a_part; i < std::min(cells.size(), (part + 1) * cells_a_part); ++i)
      counts[part] += sharp.meets(mesh, cells[i]) ? 1 : 0;
  });
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

template std::uint64_t count_in_sharp_corners<2>(const Mesh<2>&, const Domain<2>&, double, std::span<const CellId>,
                                                 const detail::Bulk&);
template std::uint64_t count_in_sharp_corners<3>(const Mesh<3>&, const Domain<3>&, double, std::span<const CellId>,
                                                 const detail::Bulk&);

}  // namespace pgdr
