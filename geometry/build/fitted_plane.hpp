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

  /// @param normal  (b - a) x (c - a), to either side: towards that of what is there already.
  void add(const Point3& a, const Point3& b, const Point3& c, const Vector<3>& normal) {
    const double weight = std::sqrt(dot(normal, normal)), side = dot(normal, this->normal()) < 0 ? -1 : 1;
    weight_ = weight_ + DoubleDouble(weight);
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      normal_[k] = normal_[k] + DoubleDouble(side * normal[k]);
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
    const Vector<3> n = normal();
    Vector<3> d;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      d[k] = (p[i] - origin_[i]) - (centre_[k] / weight_).rounded();
    }
    return std::fabs(dot(d, n)) / std::sqrt(dot(n, n));
  }

 private:
  Point3 origin_;
  DoubleDoubles<3> normal_{}, centre_{};
  DoubleDouble weight_;
};

}  // namespace pgdr::detail
