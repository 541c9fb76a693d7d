// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/triangle_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {

std::array<int, 3> axes_by_size(const std::array<double, 3>& normal) {
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int i, int j) {
    return std::fabs(normal[static_cast<std::size_t>(i)]) > std::fabs(normal[static_cast<std::size_t>(j)]);
  });
  return axes;
}

std::pair<TriangleShapes::Triangle, bool> TriangleShapes::by_coordinates(Triangle t) const {
  bool is_turned = false;
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {0, 1}})
    if (lex_less(points_[t[j]], points_[t[i]])) {
      std::swap(t[i], t[j]);
      is_turned = !is_turned;
    }
  return {t, is_turned};
}

bool TriangleShapes::is_before(const Triangle& t, const Triangle& u) const {
  const Triangle a = by_coordinates(t).first, b = by_coordinates(u).first;
  return std::ranges::lexicographical_compare(
      a, b, [](const Point3& p, const Point3& q) { return lex_less(p, q); }, [this](std::uint32_t v) { return points_[v]; },
      [this](std::uint32_t v) { return points_[v]; });
}

std::array<double, 3> TriangleShapes::normal(const Triangle& t) const {
  auto [sorted, is_turned] = by_coordinates(t);
  if (is_turned) std::swap(sorted[1], sorted[2]);
  const Point3 a = scaled(sorted[0]), b = scaled(sorted[1]), c = scaled(sorted[2]);
  double u[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    w[i] = c[i] - a[i];
  }
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}

std::pair<int, int> TriangleShapes::visible_side(const Triangle& t) const {
  const auto& p = points_;
  for (const int axis : axes_by_size(normal(t)))
    if (const Sign side = orient_projected(p[t[0]], p[t[1]], p[t[2]], axis); side != Sign::zero)
      return {axis, side == Sign::positive ? 1 : -1};
  throw ResourceError({.code = Errc::internal, .message = "a triangle of a facet is flat"});
}

}  // namespace pgdr::detail
