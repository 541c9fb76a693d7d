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

constexpr std::uint32_t nothing = LargestFace().label;  ///< in place of a label: no cell is there

// A subfacet of no area to speak of may be turned over by rounding. So on each side of an entity the label is that of the largest
// face. Where another face is larger, which only the other side has, the entity ends what is meshed.
double size_of(const SidesOfEntity& sides) { return std::max(sides[0].size, sides[1].size); }
std::uint32_t label_of(const SidesOfEntity& sides, std::size_t side) {
  return sides[side].size == size_of(sides) ? sides[side].label : nothing;
}

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
  EntityId entity;
  std::array<VertexId, D> vertices;  ///< the cell lies on the side of their normal (2D: on the left)
  std::uint32_t label;               ///< of the cell
};

constexpr std::size_t slots_a_part = 1 << 14;

/// Those of the cells in one part of the slots, as far as they are of this part of the mesh.
template <int D, class Visit>
void each_wall_face(const Mesh<D>& mesh, const VolumesInParts& parts, const Labels& labels, std::size_t part,
                    const Visit& visit) {
  const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(mesh.cell_bound(), (part + 1) * slots_a_part));
  for (auto i = static_cast<std::uint32_t>(part * slots_a_part); i < end; ++i) {
    const CellId c{i};
    if (!mesh.alive(c)) continue;
    const ConstraintRecord<D>* constraints = mesh.constraints(c);
    if (constraints == nullptr || constraints->faces == 0 || !parts.is_own(c)) continue;
    const CellRecord<D>& cell = mesh.cell(c);
    for (int f = 0; f <= D; ++f) {
      if (!constraints->has_face(f)) continue;
      const auto at = static_cast<std::size_t>(f);
      WallFace<D> wall{c, constraints->face_entity[at], {}, labels.of(mesh.region(c))};
      for (std::size_t k = 0; k < D; ++k) wall.vertices[k] = cell.vertices[face_corners<D>[at][k]];
      visit(wall);
    }
  }
}

/// Twice the area of a triangle in its projection along the axis, positive as orient_projected is; rounded.
double projected_area(const Point3& a, const Point3& b, const Point3& c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
}

/// How large the face is, and on which side of its entity the cell lies. The cell beyond finds the same size.
struct Facing {
  double size;
  bool on_normal_side;
};

Facing facing_of(const Mesh<3>& mesh, const Domain<3>& domain, const WallFace<3>& wall) {
  auto v = mesh.points(wall.vertices);
  std::rotate(v.begin(), std::min_element(v.begin(), v.end(), lex_less<3>), v.end());
  const bool turned = lex_less<3>(v[2], v[1]);
  if (turned) std::swap(v[1], v[2]);
  const double area = projected_area(v[0], v[1], v[2], domain.facets()[wall.entity].axis);
  return {std::fabs(area), (area < 0) == turned};
}

Facing facing_of(const Mesh<2>& mesh, const Domain<2>& domain, const WallFace<2>& wall) {
  const auto [a, b] = mesh.points(wall.vertices);
  const auto& ends = domain.segments()[wall.entity].points;
  const Point2 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
  const double along = (b[0] - a[0]) * (q[0] - p[0]) + (b[1] - a[1]) * (q[1] - p[1]);
  return {std::fabs(along), along >= 0};
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
  }

  std::size_t triangles() const { return triangles_.size(); }
  /// A triangle that stands for its part.
  std::uint32_t part_of(std::uint32_t triangle) { return sets_.find(triangle); }
  /// The part to the left of the edge from a to b, in the projection; nothing if there is none.
  std::uint32_t part_along(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t t = triangle_along(a, b);
    return t == nothing ? nothing : part_of(t);
  }
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
};

/// What is known of one label.
struct Volumes {
  detail::ExactSum meshed, given;
  bool is_known = true;
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
  RegionMeasure(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> attributes, const detail::Pieces& pieces,
                VolumesInParts& parts)
      : mesh_(mesh),
        domain_(domain),
        labels_(attributes),
        joined_(domain),
        bulk_(pieces),
        parts_(parts),
        volumes_(labels_.values.size()) {}

  std::vector<RegionVolume> run() {
    parts_.together([this] { look_at_faces(); });
    parts_.join(sides_);
    if constexpr (D == 3) {
      parts_.together([this] { look_at_facets(); });
      parts_.join(patch_sides_);
    }
    std::vector<detail::ExactSum> meshed;
    for (Volumes& v : volumes_) meshed.push_back(std::move(v.meshed));
    parts_.add(meshed);
    for (std::size_t l = 0; l < volumes_.size(); ++l) volumes_[l].meshed = std::move(meshed[l]);
    parts_.together([this] { add_given(); });
    return result();
  }

 private:
  std::vector<RegionVolume> result() const {
    constexpr unsigned divisor = D == 3 ? 6 : 2;
    std::vector<RegionVolume> volumes;
    for (std::size_t l = 0; l < labels_.values.size(); ++l) {
      if (volumes_[l].meshed.is_empty()) continue;
      volumes.push_back({labels_.values[l], volumes_[l].meshed.divided_by(divisor), std::nullopt});
      if (volumes_[l].is_known) volumes.back().volume_given = volumes_[l].given.divided_by(divisor);
    }
    return volumes;
  }

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

  /// Faces between cells of one label add nothing to it: those of the two sides cancel, exactly.
  void look_at_faces() {
    sides_.resize(D == 3 ? domain_.facets().size() : domain_.segments().size());
    add_in_parts(slot_parts(), 1, [this](std::size_t part, VolumesOfLabels& volumes) {
      each_wall_face<D>(mesh_, parts_, labels_, part, [&](const WallFace<D>& wall) {
        add(volumes[wall.label].meshed, mesh_.points(wall.vertices), true);
        const Facing facing = facing_of(mesh_, domain_, wall);
        const std::lock_guard locked(lock_of(wall.entity));
        sides_[wall.entity][facing.on_normal_side ? 0 : 1].take({facing.size, wall.label});
      });
    });
  }

  /// Those that their segments divide: also where a part is in the mesh, and another is outside.
  void look_at_facets() requires(D == 3) {
    const std::size_t facets = sides_.size();
    patches_.resize(facets);
    std::vector<char> any((facets + entities_a_part - 1) / entities_a_part);
    bulk_.parts(any.size(), [&](std::size_t k) {
      for (std::size_t f = k * entities_a_part; f < std::min(facets, (k + 1) * entities_a_part); ++f) {
        if (size_of(sides_[f]) < 0 || domain_.facets()[f].triangle_count == 1) continue;
        if (Patches patches(domain_, static_cast<EntityId>(f)); patches.are_several())
          patches_[f] = std::make_unique<Patches>(std::move(patches));
        any[k] = any[k] || patches_[f];
      }
    });
    if (std::ranges::count(any, 0) == std::ssize(any)) return;
    first_patch_.resize(facets);
    std::size_t patches = 0;
    for (std::size_t f = 0; f < facets; ++f) {
      first_patch_[f] = patches;
      if (patches_[f]) patches += patches_[f]->triangles();
    }
    patch_sides_.resize(patches);
    bulk_.parts(slot_parts(), [&](std::size_t part) {
      each_wall_face<D>(mesh_, parts_, labels_, part, [&](const WallFace<D>& wall) {
        if (!patches_[wall.entity]) return;
        const std::lock_guard locked(lock_of(wall.entity));
        look_at_segments(wall);
      });
    });
  }

  /// What the input's segments (3D: the triangles of its facets) add.
  void add_given() {
    add_in_parts(sides_.size(), entities_a_part, [this](std::size_t i, VolumesOfLabels& volumes) {
      if constexpr (D == 3) {
        const auto f = static_cast<EntityId>(i);
        const auto triangles = domain_.triangles(f);
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
          add_piece(patches_[f] ? patch_sides_[first_patch_[f] + patches_[f]->part_of(t)] : sides_[f], triangles[t],
                    is_given(f, t), volumes);
      } else {
        const auto& ends = domain_.segments()[i].points;
        add_piece(sides_[i], ends, !joined_.with_point_or_edge(ends[0]) && !joined_.with_point_or_edge(ends[1]), volumes);
      }
    });
  }

  /// Tells the parts of the facet on whose segments the subfacet lies.
  void look_at_segments(const WallFace<3>& wall) requires(D == 3) {
    const Facing facing = facing_of(mesh_, domain_, wall);
    const auto& corners = mesh_.cell(wall.cell).vertices;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId from = wall.vertices[k], to = wall.vertices[(k + 1) % 3];
      const int edge = edge_of_ends[corner_of(corners, from)][corner_of(corners, to)];
      if (!mesh_.is_subsegment(wall.cell, edge)) continue;
      if (!facing.on_normal_side) std::swap(from, to);
      auto [p, q] = domain_.segments()[mesh_.constraints(wall.cell)->edge_entity[static_cast<std::size_t>(edge)]].points;
      const Point3 &a = mesh_.point(from), &b = mesh_.point(to), &c = domain_.points()[p], &d = domain_.points()[q];
      double along = 0;
      for (int i = 0; i < 3; ++i) along += (b[i] - a[i]) * (d[i] - c[i]);
      if (along < 0) std::swap(p, q);
      if (const std::uint32_t part = patches_[wall.entity]->part_along(p, q); part != nothing)
        patch_sides_[first_patch_[wall.entity] + part][facing.on_normal_side ? 0 : 1].take({facing.size, wall.label});
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
  void add_piece(const SidesOfEntity& sides, const std::array<std::uint32_t, D>& corners, bool given,
                 VolumesOfLabels& volumes) const {
    if (label_of(sides, 0) == label_of(sides, 1)) return;
    std::array<Point<D>, D> points;
    for (std::size_t k = 0; k < D; ++k) points[k] = domain_.points()[corners[k]];
    for (const std::size_t side : {0u, 1u}) {
      const std::uint32_t label = label_of(sides, side);
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
  VolumesInParts& parts_;
  std::vector<Volumes> volumes_;                   // by label
  std::vector<SidesOfEntity> sides_;               // of each facet (2D: segment)
  std::vector<std::unique_ptr<Patches>> patches_;  // 3D: of each facet that has several
  std::vector<SidesOfEntity> patch_sides_;         // of these
  std::vector<std::size_t> first_patch_;           // of each facet, in patch_sides_
  std::array<std::mutex, locks> locks_;            // for what is known of an entity
};

}  // namespace

template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces, VolumesInParts& parts) {
  return RegionMeasure<D>(mesh, domain, region_attributes, pieces, parts).run();
}

template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces) {
  VolumesInParts all;
  return region_volumes<D>(mesh, domain, region_attributes, pieces, all);
}

template std::vector<RegionVolume> region_volumes(const Mesh<2>&, const Domain<2>&, std::span<const double>,
                                                  const detail::Pieces&);
template std::vector<RegionVolume> region_volumes(const Mesh<3>&, const Domain<3>&, std::span<const double>,
                                                  const detail::Pieces&);
template std::vector<RegionVolume> region_volumes(const Mesh<2>&, const Domain<2>&, std::span<const double>,
                                                  const detail::Pieces&, VolumesInParts&);
template std::vector<RegionVolume> region_volumes(const Mesh<3>&, const Domain<3>&, std::span<const double>,
                                                  const detail::Pieces&, VolumesInParts&);

}  // namespace pgdr
