// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "rule/cell_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "input/words.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/error.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr {
namespace {

template <int D>
double checked_size(double s, const Point<D>& x) {
  if (s > 0) return s;  // false for NaN too
  Diagnostic d{Errc::bad_size, {}, {}, 0, {}, {{x[0], x[1], D == 3 ? x[D - 1] : 0.0}}};
  d.message = "the size function returned " + detail::to_text(s) + " at " + detail::to_text<D>(x) + "; sizes must be positive";
  throw UsageError(std::move(d));
}

template <int D>
double checked_size(const SizingField<D>& size, const Point<D>& x) {
  return checked_size<D>(size.at(x), x);
}

/// checked_size() of all, in one block.
template <int D>
void ask_checked(const SizingField<D>& size, std::span<const Point<D>> points, std::span<double> sizes) {
  size.at(points, sizes);
  for (std::size_t i = 0; i < points.size(); ++i) checked_size<D>(sizes[i], points[i]);
}

template <int D>
double rounded_det(const Simplex<D>& s) {
  const auto u = detail::difference(s[1], s[0]), v = detail::difference(s[2], s[0]);
  if constexpr (D == 2) {
    return u[0] * v[1] - u[1] * v[0];
  } else {
    return detail::dot(u, detail::cross(v, detail::difference(s[3], s[0])));
  }
}

// The determinant is D! times the measure; the right side is rounded once.
template <int D, class SimplexOf>
bool within_measure(SimplexOf simplex, const CellShape& shape, double bound) {
  const double det = std::fabs(shape.det), limit = bound * (D == 3 ? 6 : 2);
  if (det + shape.det_error <= limit * (1 - 0x1p-51)) return true;
  if (det - shape.det_error > limit * (1 + 0x1p-51)) return false;
  return measure_within<D>(simplex(), bound);
}

/// Of operations that IEEE 754 defines alone, since meshes rest on it: std::sin differs from library to library.
/// @pre 0 <= x <= 1.1
double sine(double x) {
  double sum = 1;  // sin x = x - x^3 / 3! + ...; the next term is below 2^-80 x
  for (int k = 22; k > 0; k -= 2) sum = 1 - x * x / (k * (k + 1)) * sum;
  return x * sum;
}

}  // namespace

template <int D>
CellShape shape_of(const Mesh<D>& mesh, CellId c) {
  const auto [low, high] = mesh.squared_radius_bounds(c);
  const Simplex<D> s = mesh.simplex(c);
  return {shortest_edge_squared<D>(s), low, high, rounded_det<D>(s), CellBounds<D>::infinity};
}

// The cached squared radius is off by at most the half width of the filter's band (mesh.cpp: 6 |d| / r bounds the
// relative error 2 |d| / r of r^2, and 2^-46 the roundings here), so outside the band around the bound it decides.
template <int D>
CellVerdict CellBounds<D>::test(const Mesh<D>& mesh, CellId c) const {
  return test(mesh, c, shape_of(mesh, c));
}

template <int D>
CellVerdict CellBounds<D>::test(const Mesh<D>& mesh, CellId c, const CellShape& shape) const {
  return {over_radius_edge(mesh, c, shape), over_size(mesh, c, shape)};
}

template <int D>
bool CellBounds<D>::over_radius_edge(const Mesh<D>& mesh, CellId c) const {
  return over_radius_edge(mesh, c, shape_of(mesh, c));
}

template <int D>
bool CellBounds<D>::over_radius_edge(const Mesh<D>& mesh, CellId c, const CellShape& shape) const {
  return over_ratio([&] { return mesh.simplex(c); }, shape);
}

template <int D>
bool CellBounds<D>::over_radius_edge(const Mesh<D>& mesh, const MadeCell& cell) const {
  return over_ratio([&] { return mesh.points(cell.vertices); }, cell.shape);
}

template <int D>
template <class SimplexOf>
bool CellBounds<D>::over_ratio(SimplexOf simplex, const CellShape& shape) const {
  const double limit = radius_edge_bound * radius_edge_bound * shape.shortest_edge_squared;
  if (shape.squared_radius_low > limit) return true;
  return !(shape.squared_radius_high < limit) && !radius_edge_within<D>(simplex(), radius_edge_bound);
}

/// The least of the sizes that apply; infinity if there are none. `simplex()` is asked where one is a function.
template <int D>
template <class SimplexOf>
double CellBounds<D>::size_of(SimplexOf simplex, int region) const {
  const SizingField<D>* of_region = region_size.empty() ? &size : &region_size[region];
  if (size.is_constant() && of_region->is_constant()) return std::min(size.at({}), of_region->at({}));
  const Point<D> x = centroid<D>(simplex());
  const double least = checked_size<D>(size, x);
  return of_region == &size ? least : std::min(least, checked_size<D>(*of_region, x));
}

template <int D>
double CellBounds<D>::size_at(const Simplex<D>& s, int region) const {
  if (!size.bounded() && region_size.empty()) return infinity;
  return size_of([&s]() -> const Simplex<D>& { return s; }, region);
}

template <int D>
double CellBounds<D>::measure_of(int region) const {
  return region_measure.empty() ? max_measure : std::min(max_measure, region_measure[region]);
}

template <int D>
void CellBounds<D>::sizes_at(std::span<const Point<D>> centroids, std::span<const int> regions, std::span<double> sizes) const {
  ask_checked<D>(size, centroids, sizes);
  if (region_size.empty()) return;
  std::vector<std::vector<std::size_t>> cells_of(region_size.size());
  for (std::size_t i = 0; i < centroids.size(); ++i) cells_of[static_cast<std::size_t>(regions[i])].push_back(i);
  std::vector<Point<D>> points;
  std::vector<double> of_region;
  for (std::size_t r = 0; r < region_size.size(); ++r) {
    points.clear();
    for (const std::size_t i : cells_of[r]) points.push_back(centroids[i]);
    of_region.resize(points.size());
    ask_checked<D>(region_size[r], points, of_region);
    for (std::size_t k = 0; k < points.size(); ++k) sizes[cells_of[r][k]] = std::min(sizes[cells_of[r][k]], of_region[k]);
  }
}

template <int D>
bool CellBounds<D>::asks_blocks() const {
  const auto by_blocks = [](const SizingField<D>& field) { return field.is_by_blocks(); };
  return by_blocks(size) || std::any_of(region_size.begin(), region_size.end(), by_blocks);
}

template <int D>
bool CellBounds<D>::sizes_vary() const {
  const auto is_function = [](const SizingField<D>& field) { return !field.is_constant(); };
  return is_function(size) || std::any_of(region_size.begin(), region_size.end(), is_function);
}

template <int D>
std::uint32_t CellBounds<D>::over_size(const Mesh<D>& mesh, CellId c, const CellShape& shape) const {
  const auto simplex = [&] { return mesh.simplex(c); };
  const int region = mesh.region(c);
  if (!size.bounded() && region_size.empty()) return over(simplex, region, shape, nullptr);
  const double bound = size_of(simplex, region);
  return over(simplex, region, shape, &bound);
}

template <int D>
std::uint32_t CellBounds<D>::over_size(const Mesh<D>& mesh, const MadeCell& cell, double size) const {
  return over([&] { return mesh.points(cell.vertices); }, cell.region, cell.shape, &size);
}

/// `size`: the bound of size; null: there is none.
template <int D>
template <class SimplexOf>
std::uint32_t CellBounds<D>::over(SimplexOf simplex, int region, const CellShape& shape, const double* size) const {
  std::uint32_t cells = 0;
  const auto bound_measure = [&](double bound) {
    if (within_measure<D>(simplex, shape, bound)) return;
    cells = std::max(cells, cells_to_fill(shape.det, average_det_of_measure<D>(bound)));
  };
  if (size) {
    if constexpr (D == 3) {
      const double limit = *size * *size;
      if (shape.squared_radius_low > limit || (!(shape.squared_radius_high < limit) && !circumradius_within<D>(simplex(), *size)))
        cells = cells_to_fill(shape.det, average_det_of_radius(*size));
    } else {
      bound_measure(*size);
    }
  }
  const double measure = measure_of(region);
  if (measure != std::numeric_limits<double>::infinity()) bound_measure(measure);
  return cells;
}

double min_angle_degrees(double degrees) {
  constexpr double equilateral = 60;
  if (!(degrees > 0 && degrees <= equilateral))
    throw UsageError({Errc::bad_option, "the smallest angle of triangles must be above 0 and at most 60 degrees", {}, 0, {}, {}});
  return 1 / (2 * sine(degrees * std::numbers::pi / 180));
}

template CellShape shape_of(const Mesh<2>&, CellId);
template CellShape shape_of(const Mesh<3>&, CellId);
template class CellBounds<2>;
template class CellBounds<3>;

}  // namespace pgdr
