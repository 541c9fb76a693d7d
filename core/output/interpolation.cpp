// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "output/interpolation.hpp"

#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "numbers/corners.hpp"
#include "numbers/exact_sum.hpp"
#include "numbers/rounding.hpp"
#include "numbers/signed_measure.hpp"
#include "output/simplices.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

/// Of all weights together, as a part of their sum: bounds on errors are ten times what these are.
constexpr double most_error = 0x1p-40;

template <int D>
double dot(const Point<D>& a, const Point<D>& b, const Point<D>& from) {
  double s = 0;
  for (int i = 0; i < D; ++i) s += (a[i] - from[i]) * (b[i] - from[i]);
  return s;
}

/// |determinant| of the edges from the first corner, rounded.
template <int D>
double rounded_measure(const Simplex<D>& s) {
  std::array<std::array<double, D>, D> e;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) e[i][j] = s[i + 1][j] - s[0][j];
  if constexpr (D == 2) {
    return std::abs(e[0][0] * e[1][1] - e[0][1] * e[1][0]);
  } else {
    return std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                    e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]));
  }
}

/// The same, the double next to it: what its faces have with the origin, together.
template <int D>
double exact_measure(const Simplex<D>& s) {
  ExactSum sum;
  for (const auto& corners : face_corners<D>) {
    std::array<Point<D>, D> face;
    for (std::size_t k = 0; k < D; ++k) face[k] = s[corners[k]];
    std::apply([&sum](const auto&... p) { sum.add_determinant(p...); }, face);
  }
  return std::abs(sum.divided_by(1));
}

/// How far rounding may have put rounded_measure off.
template <int D>
double measure_error(const Simplex<D>& s) {
  std::array<Point<D>, D> others;
  std::copy(s.begin() + 1, s.end(), others.begin());
  return signed_measure<D>(others, s[0]).second;
}

/// The cells that are not flat.
template <int D>
std::vector<std::uint32_t> not_flat(const std::vector<Point<D>>& points, std::span<const std::array<std::uint32_t, D + 1>> all) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t c = 0; c < all.size(); ++c)
    if (orient<D>(corners_of<D>(points, all[c])) != Sign::zero) numbers.push_back(c);
  return numbers;
}

/// These, all positive.
template <int D>
std::vector<std::array<std::uint32_t, D + 1>> oriented(const std::vector<Point<D>>& points,
                                                       std::span<const std::array<std::uint32_t, D + 1>> all,
                                                       const std::vector<std::uint32_t>& numbers) {
  std::vector<std::array<std::uint32_t, D + 1>> cells;
  for (const std::uint32_t c : numbers) {
    cells.push_back(all[c]);
    if (orient<D>(corners_of<D>(points, all[c])) == Sign::negative) std::swap(cells.back()[0], cells.back()[1]);
  }
  return cells;
}

/// Faces of one cell alone; all if there are none, as where every cell occurs twice.
template <int D>
std::vector<std::array<std::uint32_t, D>> boundary(const std::vector<std::array<std::uint32_t, D + 1>>& cells) {
  std::vector<std::array<std::uint32_t, D>> faces;
  for (const auto& cell : cells)
    for (int f = 0; f <= D; ++f) {
      auto face = face_without(cell, f);
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  std::vector<std::array<std::uint32_t, D>> single;
  for (std::size_t i = 0, next; i < faces.size(); i = next) {
    for (next = i + 1; next < faces.size() && faces[next] == faces[i];) ++next;
    if (next == i + 1) single.push_back(faces[i]);
  }
  return single.empty() ? faces : single;
}

}  // namespace

std::array<double, 2> nearest_weights(const std::array<Point2, 2>& face, const Point2& x) {
  const double length = squared_distance(face[0], face[1]);
  const double t = length > 0 ? std::clamp(dot<2>(x, face[1], face[0]) / length, 0.0, 1.0) : 0;
  return {1 - t, t};
}

/// Ericson, Real-Time Collision Detection, 5.1.5.
std::array<double, 3> nearest_weights(const std::array<Point3, 3>& face, const Point3& x) {
  const auto& [a, b, c] = face;
  const double d1 = dot<3>(b, x, a), d2 = dot<3>(c, x, a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double ab = squared_distance(a, b), ac = squared_distance(a, c), ab_ac = dot<3>(b, c, a);
  const double d3 = d1 - ab, d4 = d2 - ab_ac;  // from b: along ab, ac
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 - d3 > 0 ? d1 / (d1 - d3) : 0;
    return {1 - t, t, 0};
  }
  const double d5 = d1 - ab_ac, d6 = d2 - ac;  // from c
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 - d6 > 0 ? d2 / (d2 - d6) : 0;
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double along = (d4 - d3) + (d5 - d6), t = along > 0 ? (d4 - d3) / along : 0;
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {va / sum, vb / sum, vc / sum};
}

template <int D>
MeshInterpolation<D>::MeshInterpolation(std::vector<Point<D>> points, std::span<const Cell> cells)
    : points_(std::move(points)),
      numbers_(not_flat<D>(points_, cells)),
      cells_(oriented<D>(points_, cells, numbers_)),
      faces_(boundary<D>(cells_)),
      cell_tree_(boxes(cells_), TreeCut::at_medians),
      face_tree_(boxes(faces_), TreeCut::at_medians) {}

template <int D>
template <std::size_t N>
auto MeshInterpolation<D>::boxes(const std::vector<std::array<std::uint32_t, N>>& simplices) const -> std::vector<Box<D>> {
  std::vector<Box<D>> all;
  all.reserve(simplices.size());
  for (const auto& s : simplices) {
    auto box = Box<D>::empty();
    for (const std::uint32_t v : s) box.add(points_[v]);
    all.push_back(box);
  }
  return all;
}

template <int D>
std::uint32_t MeshInterpolation<D>::place_of(const Point<D>& x) const {
  std::uint32_t home = none;
  cell_tree_.at(x, [&](std::uint32_t c) {
    if (c < home && holds(c, x)) home = c;
  });
  return home;
}

template <int D>
std::uint32_t MeshInterpolation<D>::cell_at(const Point<D>& x) const {
  const std::uint32_t home = place_of(x);
  return home == none ? none : numbers_[home];
}

template <int D>
auto MeshInterpolation<D>::at(const Point<D>& x) const -> WeightedCorners<D + 1> {
  const std::uint32_t home = place_of(x);
  return home != none ? inside(home, x) : outside(x);
}

template <int D>
bool MeshInterpolation<D>::holds(std::uint32_t c, const Point<D>& x) const {
  const Simplex<D> corners = corners_of<D>(points_, cells_[c]);
  for (int i = 0; i <= D; ++i) {
    Simplex<D> s = corners;
    s[i] = x;
    if (orient<D>(s) == Sign::negative) return false;
  }
  return true;
}

/// The weights are measures of what x has in the place of a corner. Those of a cell that is all but flat, as cells at planes that
/// are turned may be, are rounding and nothing else, unless they are exact.
template <int D>
auto MeshInterpolation<D>::inside(std::uint32_t c, const Point<D>& x) const -> WeightedCorners<D + 1> {
  const Simplex<D> corners = corners_of<D>(points_, cells_[c]);
  WeightedCorners<D + 1> result{cells_[c], {}};
  const auto with_x = [&](int i) {
    Simplex<D> s = corners;
    s[i] = x;
    return s;
  };
  double sum = 0, error = 0;
  for (int i = 0; i <= D; ++i) {
    result.weight[i] = rounded_measure<D>(with_x(i));
    sum += result.weight[i];
    error += measure_error<D>(with_x(i));
  }
  if (error > most_error * sum)
    for (int i = 0; i <= D; ++i) result.weight[i] = exact_measure<D>(with_x(i));
  return result;
}

template <int D>
auto MeshInterpolation<D>::outside(const Point<D>& x) const -> WeightedCorners<D + 1> {
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t best = none;
  WeightedCorners<D + 1> result{};
  result.corner.fill(faces_[0][0]);
  result.weight[0] = 1;
  face_tree_.nearest([&](const Box<D>& box, std::uint32_t) { return box.squared_distance_to(x) * (1 - rounding::of_pruning); },
                     [&](std::uint32_t f) {
                       std::array<Point<D>, D> face;
                       for (int i = 0; i < D; ++i) face[i] = points_[faces_[f][i]];
                       const auto weight = nearest_weights(face, x);
                       Point<D> p{};
                       for (int i = 0; i < D; ++i)
                         for (int j = 0; j < D; ++j) p[j] += weight[i] * face[i][j];
                       const double d = squared_distance(p, x);
                       if (d > nearest || (d == nearest && f > best)) return nearest;
                       nearest = d;
                       best = f;
                       for (int i = 0; i < D; ++i) {
                         result.corner[i] = faces_[f][i];
                         result.weight[i] = weight[i];
                       }
                       result.corner[D] = result.corner[0];
                       result.weight[D] = 0;
                       return nearest;
                     });
  return result;
}

template class MeshInterpolation<2>;
template class MeshInterpolation<3>;

}  // namespace pgdr::detail
