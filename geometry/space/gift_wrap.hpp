// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Gift wrapping: fills a region of space, bounded by triangles, with the constrained Delaunay triangulation of given
// points, if it has one that keeps these triangles. On each triangle of the front stands the tetrahedron to the first
// point, in the order of the pencil of spheres through the triangle, that the rest of the front does not get in the way
// of. Where a constrained Delaunay triangulation exists it is unique (spheres are the perturbed ones) and this finds it;
// else wrapping may get stuck, or end with a triangulation that has faces that are not locally Delaunay.
//
// For small regions: the cost grows with (points + triangles) times tetrahedra. A workspace; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/box.hpp"

namespace pgdr {

/// A gift wrapper, with the memory it works in.
class GiftWrap {
 public:
  using Index = std::uint16_t;        ///< into the points
  using Face = std::array<Index, 3>;  ///< orient3d of the three and a point of the region beside them is positive
  using Cell = std::array<Index, 4>;  ///< positively oriented

  /// The triangles must close the region; one may occur twice, turned over, where the region lies on both sides of it.
  /// False if wrapping gets stuck, or after `most_cells` cells, or once `ended`, asked for every cell, says so.
  bool fill(std::span<const Point3> points, std::span<const Face> front, std::size_t most_cells,
            const std::function<bool()>& ended = {});
  /// The cells made by the last fill that succeeded: they tile the region exactly.
  const std::vector<Cell>& cells() const { return cells_; }

  /// Face i of a positive cell, seen from inside it: orient3d of face and corner i is positive. Smallest index first.
  static Face face_of(const Cell& cell, int i);
  static Face turned_over(const Face& f) { return {f[0], f[2], f[1]}; }  ///< the same seen from the other side

 private:
  struct FrontFace {
    Face vertices;
    detail::Box<3> box;
  };

  bool wrap(const Face& f);
  void find_candidates(const Face& f);
  bool blocked(const Cell& cell);
  template <std::size_t N>
  detail::Box<3> box_of(const std::array<Index, N>& corners) const;
  bool meets(const Cell& cell, const Face& face) const;
  void add_to_front(const Face& f);
  std::vector<FrontFace>::iterator find_in_front(const Face& f);
  bool replace_in_front(const Cell& cell);

  std::span<const Point3> points_;
  std::vector<FrontFace> front_;
  std::vector<Cell> cells_;
  std::vector<Index> candidates_;
  std::vector<std::uint8_t> beyond_;  ///< of each point, bit i: weakly beyond face i of the cell looked at; `unknown`
};

}  // namespace pgdr
