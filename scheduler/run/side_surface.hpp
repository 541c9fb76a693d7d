// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The first side of a chain of periodic sides as a surface of triangles, made plane by plane by the refinement of 2D. One thread
// calls; meshes of planes are made by all.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/refine_options.hpp"
#include "run/periodic_sides.hpp"

namespace pgdr::detail {

/// How large triangles of a chain of sides may be, on the first of them. Immutable once made, any thread may ask.
class SideSizes {
 public:
  /// All must outlive it. @param mesh  of the input, its sides as they like; without cells: anything goes
  SideSizes(const OutputMesh<3>& mesh, const SideChain<3>& chain, const SizingField<3>& size);
  /// The largest area of a triangle about there.
  double area_at(const Point3& on_first) const;

 private:
  struct OfSide {
    std::vector<std::array<Point3, 3>> triangles;
    std::vector<double> squared_radii;
    BoxTree<3> tree;
  };
  const SideChain<3>& chain_;
  const SizingField<3>& size_;
  double width_ = 0;  // within which a triangle is at a place
  std::vector<OfSide> sides_;
};

/// A facet's plane, in coordinates of its own. A value.
class SidePlane {
 public:
  SidePlane(const Domain<3>& domain, EntityId facet);
  Point2 flat(const Point3& p) const;
  Point3 near(const Point2& p) const;    ///< there, but for rounding
  Point3 lifted(const Point2& p) const;  ///< on the facet, rounded once

 private:
  const Domain<3>* domain_;
  EntityId facet_;
  std::optional<double> level_;  // parallel to two axes: the coordinate on the third
  int axis_ = 2;
  Point3 origin_;
  std::array<std::array<double, 3>, 2> along_{};
};

/// A triangle of a side: places of the chain, and the facet of the Domain that it lies on.
struct SideTriangle {
  std::array<std::uint32_t, 3> places;
  EntityId facet;
};

class SideSurface {
 public:
  /// All must outlive it, and the chain stay where it is.
  SideSurface(const Domain<3>& domain, SideChain<3>& chain, const SideInput<3>& input);

  /// Meshes all planes whose pieces are other ones than the last time. @returns of each piece of the chain where these meshes
  /// cut it. @param keep  no outline is divided
  std::vector<std::vector<Cuts>> mesh(const RefineOptions<2>& options, const SideSizes& sizes, bool keep);
  /// The triangles of the last meshes, which have divided no piece; the chain gets places for their points inside.
  std::vector<SideTriangle> take_triangles();

 private:
  using Piece = SideChain<3>::Piece;
  struct Plane {
    EntityId facet;
    SidePlane plane;
    std::vector<std::uint32_t> places{};   // ascending
    std::vector<Piece> pieces{};           // places
    std::vector<std::uint32_t> numbers{};  // of these in the chain
    std::vector<Point2> holes{};
    std::optional<OutputMesh<2>> mesh{};  // of these pieces; its first points are the places
  };

  void assign();
  std::vector<std::uint32_t> planes_at(const Point3& p) const;
  std::uint32_t number_of(const Plane& plane, std::uint32_t place) const;
  Plc<2> outline(const Plane& plane) const;
  void find_holes(Plane& plane, RefineOptions<2> options);
  void require_covered(const Point3& p, bool is_covered) const;
  void add_cuts(const Plane& plane, std::vector<std::vector<Cuts>>& cuts) const;
  OutputMesh<2> meshed(const Plane& plane, const RefineOptions<2>& options) const;

  const Domain<3>& domain_;
  SideChain<3>& chain_;
  const SideInput<3>& input_;
  std::vector<Plane> planes_;
  std::vector<std::pair<std::uint32_t, std::array<Point3, 3>>> triangles_;  // of planes, of the Domain
  BoxTree<3> tree_;                                                         // of these
};

}  // namespace pgdr::detail
