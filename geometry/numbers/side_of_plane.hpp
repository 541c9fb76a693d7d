// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The side of one plane on which many points lie: what depends on the plane alone is computed once. Values, any thread.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {

/// A plane by three of its points, which it keeps.
class SideOfPlane {
 public:
  SideOfPlane() = default;
  SideOfPlane(const Point3& a, const Point3& b, const Point3& c) : a_(a), b_(b), c_(c) {
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double l = (b[i] - a[i]) * (c[j] - a[j]), r = (b[j] - a[j]) * (c[i] - a[i]);
      normal_[static_cast<std::size_t>(k)] = l - r;
      magnitude_[static_cast<std::size_t>(k)] = std::fabs(l) + std::fabs(r);
    }
  }

  /// orient3d(a, b, c, p), counted only where the plain evaluation does not decide.
  Sign of(const Point3& p) const {
    // The terms, and so the bound, of orient_filter<3> (predicates.cpp).
    const double x = p[0] - a_[0], y = p[1] - a_[1], z = p[2] - a_[2];
    const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
    const double det = normal_[0] * x + normal_[1] * y + normal_[2] * z;
    const double bound = 8.01 * 0x1p-53 * (magnitude_[0] * ax + magnitude_[1] * ay + magnitude_[2] * az) + 0x1p-900;
    if (ax + ay + az < 0x1p150) {
      if (det > bound) return Sign::positive;
      if (det < -bound) return Sign::negative;
    }
    return orient3d(a_, b_, c_, p);
  }

 private:
  Point3 a_, b_, c_;
  std::array<double, 3> normal_{}, magnitude_{};
};

}  // namespace pgdr::detail
