// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A surface at rest, mostly the one as given: its triangles and the segments of its curves, and which are near. Immutable, any
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "replace/complex.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

class GivenSurface {
 public:
  struct Triangle {
    std::array<Point3, 3> corners;  ///< in the order of their coordinates
    std::uint32_t klass;
    /// Over the edges from corner i to the next, the other triangle of the class there; no_index if there are none, or more.
    std::array<std::uint32_t, 3> beyond{no_index, no_index, no_index};
  };
  struct Segment {
    std::array<Point3, 2> ends;
    std::uint32_t curve;
  };
  explicit GivenSurface(const SurfaceComplex& surface);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Calls visit(number, its box) for each triangle whose box meets this one.
  template <class Visit>
  void triangles_meeting(const Box<3>& box, const Visit& visit) const {
    triangle_tree_.meeting(box, visit);
  }
  template <class Visit>
  void segments_meeting(const Box<3>& box, std::uint32_t curve, const Visit& visit) const {
    segment_tree_.meeting(box, [&](std::uint32_t i) {
      if (segments_[i].curve == curve) visit(segments_[i]);
    });
  }
  /// Of the triangles of a class the one nearest to x, and where on it that is.
  struct Nearest {
    std::uint32_t triangle = no_index;
    Point3 point{};
    double square = 0;
  };
  Nearest nearest(const Point3& x, std::uint32_t klass) const;
  /// The point nearest to x on the segments of a curve.
  Point3 nearest_on_curve(const Point3& x, std::uint32_t curve) const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<Segment> segments_;
  BoxTree<3> triangle_tree_, segment_tree_;
};

}  // namespace pgdr::detail
