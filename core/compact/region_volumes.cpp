// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "compact/region_volumes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "compact/joined_points.hpp"
#include "numbers/exact_sum.hpp"
#include "space/bulk.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t nothing = 0xffffffffu;  ///< in place of a label: no cell is there

/// The labels on the two sides of a part of an entity. A subfacet of no area to speak of may be turned over by rounding, so the
/// largest one is asked; of several, whoever comes first, the one of the least labels.
struct Sides {
  double size = -1;                                      ///< of the largest so far
  std::array<std::uint32_t, 2> label{nothing, nothing};  ///< on the side of the normal (2D: on the left), and on the other
  bool is_known() const { return size >= 0; }
  bool same_on_both() const { return label[0] == label[1]; }
  void take(const Sides& o) {
    if (o.size > size || (o.size == size && o.label < label)) *this = o;
  }
};

/// Places of labels in ascending order, by the number of a region.
struct Labels {
  std::vector<double> values;
  std::vector<std::uint32_t> of_region;

  explicit Labels(std::span<const double> attributes) : values(attributes.begin(), attributes.end()) {
    if (values.empty()) values = {0.0};
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    for (const double a : attributes)
      of_region.push_back(static_cast<std::uint32_t>(std::lower_bound(values.begin(), values.end(), a) - values.begin()));
  }
  std::uint32_t of(std::uint16_t region) const { return of_region.empty() ? 0 : of_region[region]; }
};

/// A face of a cell that is part of an entity.
template <int D>
struct WallFace {
  CellId cell;
  int face;
  EntityId entity;
  std::array<VertexId, D> vertices;  ///< the cell lies on the side of their normal (2D: on the left)
  std::uint32_t here, beyond;        ///< labels
};

constexpr std::size_t slots_a_part = 1 << 14;

/// Those of the cells in one part of the slots.
template <int D, class Visit>
void each_wall_face(const Mesh<D>& mesh, const Labels& labels, std::size_t part, const Visit& visit) {
  const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(mesh.cell_bound(), (part + 1) * slots_a_part));
  for (auto i = static_cast<std::uint32_t>(part * slots_a_part); i < end; ++i) {
    const CellId c{i};
    if (!mesh.alive(c)) continue;
    const ConstraintRecord<D>* constraints = mesh.constraints(c);
    if (constraints == nullptr || constraints->faces == 0) continue;
    const CellRecord<D>& cell = mesh.cell(c);
    for (int f = 0; f <= D; ++f) {
      if (!constraints->has_face(f)) continue;
      const auto at = static_cast<std::size_t>(f);
      WallFace<D> wall{c, f, constraints->face_entity[at], {}, labels.of(mesh.region(c)), nothing};
      for (std::size_t k = 0; k < D; ++k) wall.vertices[k] = cell.vertices[face_corners<D>[at][k]];
      if (cell.links[at]) wall.beyond = labels.of(mesh.region(cell.links[at].cell()));
      visit(wall);
    }
  }
}

/// Twice the area of a triangle in its projection along the axis, positive as orient_projected is; rounded.
double projected_area(const Point3& a, const Point3& b, const Point3& c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
}

/// The sides of the entity that the face shows.
Sides sides_at(const Mesh<3>& mesh, const Domain<3>& domain, const WallFace<3>& wall) {
  const auto [a, b, c] = mesh.points(wall.vertices);
  const double area = projected_area(a, b, c, domain.facets()[wall.entity].axis);
  Sides sides{std::fabs(area), {wall.here, wall.beyond}};
  if (area < 0) std::swap(sides.label[0], sides.label[1]);
  return sides;
}

Sides sides_at(const Mesh<2>& mesh, const Domain<2>& domain, const WallFace<2>& wall) {
  const auto [a, b] = mesh.points(wall.vertices);
  const auto& ends = domain.segments()[wall.entity].points;
  const Point2 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
  const double along = (b[0] - a[0]) * (q[0] - p[0]) + (b[1] - a[1]) * (q[1] - p[1]);
  Sides sides{std::fabs(along), {wall.here, wall.beyond}};
  if (along < 0) std::swap(sides.label[0], sides.label[1]);
  return sides;
}

/// Parts of a facet that its segments bound: each lies between two labels.
class Patches {
 public:
  Patches(const Domain<3>& domain, EntityId facet) : triangles_(domain.triangles(facet)), sets_(triangles_.size()) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) edges_.push_back({triangles_[t][k], triangles_[t][(k + 1) % 3], t});
    std::sort(edges_.begin(), edges_.end());
    std::vector<std::array<std::uint32_t, 2>> walls;
    for (const EntityId s : domain.facet_segments(facet)) {
      const auto [a, b] = domain.segments()[s].points;
      walls.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(walls.begin(), walls.end());
    for (const auto& [a, b, t] : edges_) {
      if (a > b || std::binary_search(walls.begin(), walls.end(), std::array{a, b})) continue;
      if (const std::uint32_t other = triangle_along(b, a); other != nothing) sets_.unite(t, other);
    }
    sides_.resize(triangles_.size());
  }

  /// The sides of the part to the left of the edge from a to b, in the projection.
  void take(std::uint32_t a, std::uint32_t b, const Sides& sides) {
    if (const std::uint32_t t = triangle_along(a, b); t != nothing) sides_[sets_.find(t)].take(sides);
  }
  Sides of_triangle(std::uint32_t t) { return sides_[sets_.find(t)]; }
  bool are_several() {
    for (std::uint32_t t = 1; t < triangles_.size(); ++t)
      if (sets_.find(t) != sets_.find(0)) return true;
    return false;
  }

 private:
  /// The triangle that has the edge in this direction.
  std::uint32_t triangle_along(std::uint32_t a, std::uint32_t b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::array{a, b, 0u});
    return found != edges_.end() && (*found)[0] == a && (*found)[1] == b ? (*found)[2] : nothing;
  }

  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::array<std::uint32_t, 3>> edges_;  // from, to, triangle; sorted
  detail::DisjointSets sets_;                        // of triangles
  std::vector<Sides> sides_;                         // of each set
};

/// What is known of one label.
struct Volumes {
  detail::ExactSum meshed, given;
  bool has_cells = false, is_known = true;
};

/// The labels that some of the faces have to do with. Few in one place, mostly one after the other.
class VolumesOfLabels {
 public:
  Volumes& operator[](std::uint32_t label) {
    if (last_ == nullptr || label != last_label_) {
      last_ = &of_[label];
      last_label_ = label;
    }
    return *last_;
  }
  void add_to(std::vector<Volumes>& all) const {
    for (const auto& [label, volumes] : of_) {
      all[label].meshed.add(volumes.meshed);
      all[label].given.add(volumes.given);
      all[label].has_cells = all[label].has_cells || volumes.has_cells;
      all[label].is_known = all[label].is_known && volumes.is_known;
    }
  }

 private:
  std::unordered_map<std::uint32_t, Volumes> of_;
  std::uint32_t last_label_ = nothing;
  Volumes* last_ = nullptr;
};

template <int D>
class RegionMeasure {
 public:
  RegionMeasure(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> attributes, const detail::Pieces& pieces)
      : mesh_(mesh), domain_(domain), labels_(attributes), joined_(domain), bulk_(pieces), volumes_(labels_.values.size()) {}

  std::vector<RegionVolume> run() {
    look_at_faces();
    if constexpr (D == 3) {
      add_facets();
    } else {
      add_in_parts(sides_.size(), entities_a_part, [this](std::size_t s, VolumesOfLabels& volumes) {
        const auto& ends = domain_.segments()[s].points;
        add_piece(sides_[s], ends, !joined_.with_point_or_edge(ends[0]) && !joined_.with_point_or_edge(ends[1]), volumes);
      });
    }
    constexpr unsigned divisor = D == 3 ? 6 : 2;
    std::vector<RegionVolume> volumes;
    for (std::size_t l = 0; l < labels_.values.size(); ++l) {
      if (!volumes_[l].has_cells) continue;
      volumes.push_back({labels_.values[l], volumes_[l].meshed.divided_by(divisor), std::nullopt});
      if (volumes_[l].is_known) volumes.back().volume_given = volumes_[l].given.divided_by(divisor);
    }
    return volumes;
  }

 private:
  /// What the simplex adds to the sum of a label that lies on the side of its normal (2D: on its left), or on the other.
  static void add(detail::ExactSum& sum, std::array<Point<D>, D> corners, bool on_normal_side) {
    if (on_normal_side == (D == 3)) std::swap(corners[0], corners[1]);
    std::apply([&sum](const auto&... p) { sum.add_determinant(p...); }, corners);
  }

  static constexpr std::size_t entities_a_part = 1024, locks = 256;

  /// Calls add(i, volumes) for i < count, side by side, and takes in what the volumes get.
  template <class Add>
  void add_in_parts(std::size_t count, std::size_t part, const Add& add) {
    std::vector<VolumesOfLabels> found((count + part - 1) / part);
    bulk_.parts(found.size(), [&](std::size_t k) {
      VolumesOfLabels volumes;
      for (std::size_t i = k * part; i < std::min(count, (k + 1) * part); ++i) add(i, volumes);
      found[k] = std::move(volumes);
    });
    for (const VolumesOfLabels& volumes : found) volumes.add_to(volumes_);
  }
  std::size_t slot_parts() const { return (mesh_.cell_bound() + slots_a_part - 1) / slots_a_part; }

  void look_at_faces() {
    sides_.resize(D == 3 ? domain_.facets().size() : domain_.segments().size());
    add_in_parts(slot_parts(), 1, [this](std::size_t part, VolumesOfLabels& volumes) {
      each_wall_face<D>(mesh_, labels_, part, [&](const WallFace<D>& wall) {
        volumes[wall.here].has_cells = true;
        if (wall.here != wall.beyond) add(volumes[wall.here].meshed, mesh_.points(wall.vertices), true);
        const Sides sides = sides_at(mesh_, domain_, wall);
        const std::lock_guard locked(lock_of(wall.entity));
        sides_[wall.entity].take(sides);
      });
    });
  }

  void add_facets() requires(D == 3) {
    const std::size_t facets = sides_.size();
    std::vector<std::unique_ptr<Patches>> parts(facets);  // also where a part is in the mesh, and another is outside
    std::vector<char> any((facets + entities_a_part - 1) / entities_a_part);
    bulk_.parts(any.size(), [&](std::size_t k) {
      for (std::size_t f = k * entities_a_part; f < std::min(facets, (k + 1) * entities_a_part); ++f) {
        if (!sides_[f].is_known() || domain_.facets()[f].triangle_count == 1) continue;
        if (Patches patches(domain_, static_cast<EntityId>(f)); patches.are_several())
          parts[f] = std::make_unique<Patches>(std::move(patches));
        any[k] = any[k] || parts[f];
      }
    });
    if (std::ranges::count(any, 0) < std::ssize(any))
      bulk_.parts(slot_parts(), [&](std::size_t part) {
        each_wall_face<D>(mesh_, labels_, part, [&](const WallFace<D>& wall) {
          if (!parts[wall.entity]) return;
          const std::lock_guard locked(lock_of(wall.entity));
          look_at_segments(wall, *parts[wall.entity]);
        });
      });
    add_in_parts(facets, entities_a_part, [&](std::size_t i, VolumesOfLabels& volumes) {
      const auto f = static_cast<EntityId>(i);
      const auto triangles = domain_.triangles(f);
      for (std::uint32_t t = 0; t < triangles.size(); ++t)
        add_piece(parts[f] ? parts[f]->of_triangle(t) : sides_[f], triangles[t], is_given(f, t), volumes);
    });
  }

  /// Tells the parts of the facet on whose segments the subfacet lies.
  void look_at_segments(const WallFace<3>& wall, Patches& patches) const requires(D == 3) {
    const Sides sides = sides_at(mesh_, domain_, wall);
    const auto& corners = mesh_.cell(wall.cell).vertices;
    const bool positive = sides.label[0] == wall.here && sides.label[1] == wall.beyond;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId from = wall.vertices[k], to = wall.vertices[(k + 1) % 3];
      const int edge = edge_of_ends[corner_of(corners, from)][corner_of(corners, to)];
      if (!mesh_.is_subsegment(wall.cell, edge)) continue;
      if (!positive) std::swap(from, to);
      auto [p, q] = domain_.segments()[mesh_.constraints(wall.cell)->edge_entity[static_cast<std::size_t>(edge)]].points;
      const Point3 &a = mesh_.point(from), &b = mesh_.point(to), &c = domain_.points()[p], &d = domain_.points()[q];
      double along = 0;
      for (int i = 0; i < 3; ++i) along += (b[i] - a[i]) * (d[i] - c[i]);
      if (along < 0) std::swap(p, q);
      patches.take(p, q, sides);
    }
  }

  std::mutex& lock_of(EntityId e) { return locks_[e % locks]; }

  /// Is the triangle of the facet part of what was given, and not of what the tolerance has made of that?
  bool is_given(EntityId f, std::uint32_t triangle) const requires(D == 3) {
    const bool planar = domain_.facets()[f].planar;
    if (!planar && domain_.triangle_origins(f)[triangle].mixed) return false;
    return std::ranges::none_of(domain_.triangles(f)[triangle], [&](std::uint32_t v) {
      return joined_.with_point_or_edge(v) || (!planar && joined_.with_facet(v));
    });
  }

  /// A segment (2D), or a triangle of a facet.
  void add_piece(const Sides& sides, const std::array<std::uint32_t, D>& corners, bool given, VolumesOfLabels& volumes) const {
    if (sides.same_on_both()) return;
    std::array<Point<D>, D> points;
    for (std::size_t k = 0; k < D; ++k) points[k] = domain_.points()[corners[k]];
    for (const std::size_t side : {0u, 1u}) {
      const std::uint32_t label = sides.label[side];
      if (label == nothing) continue;
      Volumes& of = volumes[label];
      add(of.given, points, side == 0);
      if (!given) of.is_known = false;
    }
  }

  const Mesh<D>& mesh_;
  const Domain<D>& domain_;
  const Labels labels_;
  const detail::JoinedPoints<D> joined_;
  const detail::Bulk bulk_;
  std::vector<Volumes> volumes_;         // by label
  std::vector<Sides> sides_;             // of each facet (2D: segment)
  std::array<std::mutex, locks> locks_;  // for what is known of an entity
};

}  // namespace

template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces) {
  return RegionMeasure<D>(mesh, domain, region_attributes, pieces).run();
}

template std::vector<RegionVolume> region_volumes(const Mesh<2>&, const Domain<2>&, std::span<const double>,
                                                  const detail::Pieces&);
template std::vector<RegionVolume> region_volumes(const Mesh<3>&, const Domain<3>&, std::span<const double>,
                                                  const detail::Pieces&);

}  // namespace pgdr
