// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How often triangles go round a point. The half solid angle of each is the argument of a complex number (A. van Oosterom, J.
// Strackee: The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30(2), 1983), so that their sum is that of a product,
// and whole turns are counted where the product passes the negative axis: no arc tangent, the same result everywhere. A value.
#pragma once

#include <algorithm>
#include <cmath>

#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

class Turns {
 public:
  /// A triangle, as seen from x; positive if x is behind it, as inside of what it bounds.
  void add(const Point<3>& x, const Point<3>& a, const Point<3>& b, const Point<3>& c) {
    const auto u = unit(difference(a, x)), v = unit(difference(b, x)), w = unit(difference(c, x));
    const double im = dot(u, cross(v, w)), re = 1 + dot(u, v) + dot(v, w) + dot(w, u), size = std::sqrt(re * re + im * im);
    if (size > 0) turn(re / size, im / size);
  }
  /// The nearest whole number of turns.
  int whole() const { return whole_; }
  /// Is it within 1/4 of that?
  bool is_sure() const { return re_ >= 0; }
  /// For messages.
  double number() const { return whole_ + std::atan2(im_, re_) / (2 * 3.14159265358979323846); }

 private:
  static Vector<3> unit(Vector<3> v) {
    const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});  // of which squares do not overflow
    for (double& c : v) c /= largest;
    const double length = std::sqrt(dot(v, v));
    for (double& c : v) c /= length;
    return v;
  }
  void turn(double re, double im) {
    const double next_re = re_ * re - im_ * im, next_im = re_ * im + im_ * re,
                 size = std::sqrt(next_re * next_re + next_im * next_im);
    if (im_ >= 0 && im > 0 && next_im < 0) ++whole_;
    if (im_ < 0 && im < 0 && next_im >= 0) --whole_;
    re_ = next_re / size;
    im_ = next_im / size;
  }

  int whole_ = 0;
  double re_ = 1, im_ = 0;  // what is left over: the argument is between minus and plus half a turn
};

}  // namespace pgdr::detail
