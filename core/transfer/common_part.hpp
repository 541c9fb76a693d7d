// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What two simplices have in common, in doubles. Pure functions, any thread.
#pragma once

#include <array>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// The inside of a simplex as half-spaces, in coordinates relative to its first corner, so that what is far from the origin loses
/// nothing but the rounding of its coordinates.
template <int D>
class InsideOf {
 public:
  explicit InsideOf(const Simplex<D>& simplex);
  /// Volume (area).
  double measure() const { return measure_; }
  /// The measure of what the other simplex has in common with this one.
  /// @param sides  if there is anything: which sides of the other simplex bound it, as bits; side k is opposite corner k
  double common_with(const Simplex<D>& other, unsigned& sides) const;

 private:
  using Vector = std::array<double, D>;
  struct Plane {
    Vector normal;  ///< inwards
    double offset;  ///< normal . x + offset >= 0 inside
    double at(const Vector& x) const {
      double sum = offset;
      for (std::size_t i = 0; i < D; ++i) sum += normal[i] * x[i];
      return sum;
    }
  };

  Vector relative(const Point<D>& p) const {
    Vector x;
    for (int i = 0; i < D; ++i) x[static_cast<std::size_t>(i)] = p[i] - origin_[i];
    return x;
  }

  Point<D> origin_;
  std::array<Vector, D + 1> corners_;
  std::array<Plane, D + 1> planes_;
  double measure_ = 0;
};

extern template class InsideOf<2>;
extern template class InsideOf<3>;

}  // namespace pgdr::detail
