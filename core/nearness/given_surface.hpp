// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The given facets as one complex of triangles that meet at common edges and corners alone, joined within the tolerance by the
// checker's own means: points within it are one, and where facets then meet otherwise, all is cut plane by plane, as what is left
// over of a mesh that has nothing (flat_leftovers.hpp). So the volumes between the given facets are known, how these hang
// together, and where one marker ends. Immutable once made.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "enclosed/input_volumes.hpp"
#include "given/given_input.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

class GivenSurface {
 public:
  using Corners = std::array<std::uint32_t, 3>;
  using Triangle = std::array<Point3, 3>;

  /// The input must outlive it. If the facets make no complex that is a finding, and `volumes` has none.
  GivenSurface(const GivenInput<3>& input, RegionMode mode, Findings& findings);

  std::span<const Point3> points() const { return points_; }
  std::span<const Corners> triangles() const { return triangles_; }
  Triangle corners(std::uint32_t t) const {
    return {points_[triangles_[t][0]], points_[triangles_[t][1]], points_[triangles_[t][2]]};
  }
  /// Those of the given facets that have the triangle, sorted: several where facets overlap.
  std::span<const int> markers(std::uint32_t t) const { return markers_[t]; }
  /// It touches a volume that is to be meshed, or nothing is known of volumes.
  bool is_wanted(std::uint32_t t) const { return !volumes_ || volumes_->wants(t); }
  const InputVolumes<3>* volumes() const { return volumes_ ? &*volumes_ : nullptr; }
  /// A triangle of the input, and one of the complex that lies on it.
  struct Part {
    std::uint32_t given, triangle;
    friend auto operator<=>(const Part&, const Part&) = default;
  };
  /// Those of a given triangle; none if it is thinner than what is joined.
  std::span<const Part> parts(std::uint32_t given) const;
  /// From the complex; infinite if there is none.
  double distance(const Point3& x) const;
  /// Something wanted is at the place, or a volume that is to be meshed.
  bool wants_place(const Point3& x) const;

 private:
  Plc<3> joined() const;
  void make_complex(RegionMode mode, Findings& findings);
  VolumeWalls<3> walls_of(Plc<3> joined, Findings& findings) const;
  void find_markers();

  const GivenInput<3>& input_;
  std::vector<Point3> points_;
  std::vector<Corners> triangles_;
  std::vector<std::vector<int>> markers_;
  std::vector<Part> parts_;  ///< sorted
  std::optional<InputVolumes<3>> volumes_;
  std::unique_ptr<detail::BoxTree<3>> tree_;  ///< of the triangles
};

}  // namespace pgdr::checking
