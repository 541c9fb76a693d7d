// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The plane of triangles, in coordinates of the size of 1: normal to the sum of their normals, through the centre of their areas.
// Sums are kept in twice the digits, so that their order says nothing. Used by one thread.
#pragma once

#include <cmath>

#include "numbers/double_double.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

class FittedPlane {
 public:
  /// @param origin  near the triangles, and the same for all planes that are added to one another
  explicit FittedPlane(const Point3& origin) : origin_(origin) {}

  /// Normal to either side: towards that of what is there already. The normal of a needle that is rounded may be turned by the
  /// doubles' precision times its length over its width, which at its far end is more than any tolerance.
  void add(const Point3& a, const Point3& b, const Point3& c) {
    const DoubleDoubles<3> n = cross(exact_difference(b, a), exact_difference(c, a));
    const double weight = std::sqrt(dot(n, n).rounded());
    const DoubleDouble side = dot(n, normal_).rounded() < 0 ? -1 : 1;
    weight_ = weight_ + DoubleDouble(weight);
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      normal_[k] = normal_[k] + side * n[k];
      centre_[k] = centre_[k] + DoubleDouble(weight / 3 * ((a[i] - origin_[i]) + (b[i] - origin_[i]) + (c[i] - origin_[i])));
    }
  }
  /// Another plane of the same origin.
  void add(const FittedPlane& other) {
    const double side = dot(normal(), other.normal()) < 0 ? -1 : 1;
    weight_ = weight_ + other.weight_;
    for (std::size_t k = 0; k < 3; ++k) {
      normal_[k] = normal_[k] + other.normal_[k] * DoubleDouble(side);
      centre_[k] = centre_[k] + other.centre_[k];
    }
  }

  Vector<3> normal() const { return {normal_[0].rounded(), normal_[1].rounded(), normal_[2].rounded()}; }
  /// Twice the area that it is made of.
  double weight() const { return weight_.rounded(); }
  double distance(const Point3& p) const {
    DoubleDoubles<3> d = exact_difference(p, origin_);
    for (std::size_t k = 0; k < 3; ++k) d[k] = d[k] - centre_[k] / weight_;
    return std::fabs(dot(d, normal_).rounded()) / std::sqrt(dot(normal_, normal_).rounded());
  }

 private:
  Point3 origin_;
  DoubleDoubles<3> normal_{}, centre_{};
  DoubleDouble weight_;
};

}  // namespace pgdr::detail
