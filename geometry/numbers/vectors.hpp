// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Vectors between points, in plain doubles.
#pragma once

#include <array>

#include "pgdr/types.hpp"

namespace pgdr::detail {

template <std::size_t N>
using Vector = std::array<double, N>;

template <int D>
Vector<D> difference(const Point<D>& a, const Point<D>& b) {
  Vector<D> d;
  for (int i = 0; i < D; ++i) d[i] = a[i] - b[i];
  return d;
}

inline Vector<3> cross(const Vector<3>& u, const Vector<3>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

template <std::size_t N>
double dot(const Vector<N>& u, const Vector<N>& v) {
  double s = 0;
  for (std::size_t i = 0; i < N; ++i) s += u[i] * v[i];
  return s;
}

}  // namespace pgdr::detail
