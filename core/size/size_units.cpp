// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes of edges, radii, areas and volumes as those that cells are held to.
#include <cmath>
#include <memory>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr {
namespace {

/// Measured on cubes and polygons of 500 to 40,000 cells: the mean edge is 1.30 to 1.33 of the bound on the circumradius, and
/// 1.25 to 1.28 of the root of the bound on the area.
constexpr double radius_of_edge = 0.75, area_of_edge = 0.625;
constexpr double area_in_circle = 1.299038105676658;     // of the regular triangle, for radius 1: 3 sqrt 3 / 4
constexpr double volume_in_sphere = 0.5132002392796674;  // of the regular tetrahedron: 8 sqrt 3 / 27

/// By steps of Newton from a start within a factor of 2: the same bits everywhere, which std::cbrt does not promise.
double cube_root(double x) {
  if (!(x > 0) || !std::isfinite(x)) return x;
  int exponent = 0;
  std::frexp(x, &exponent);
  const int third = exponent >= 0 ? exponent / 3 : -((2 - exponent) / 3);
  const double part = std::ldexp(x, -3 * third);  // 0.5 to 8
  double root = 1.5;
  for (int step = 0; step < 8; ++step) root = (2 * root + part / (root * root)) / 3;
  return std::ldexp(root, third);
}

void require_unit(int dimension, SizeUnit unit) {
  if (unit == (dimension == 2 ? SizeUnit::volume : SizeUnit::area))
    throw UsageError({.code = Errc::bad_option,
                      .message = dimension == 2 ? "sizes of volumes are for 3D; in 2D there are areas"
                                                : "sizes of areas are for 2D; in 3D there are volumes"});
}

}  // namespace

template <int D>
double in_usual_unit(double size, SizeUnit unit) {
  require_unit(D, unit);
  if (unit == usual_size_unit<D>() || !(size > 0)) return size;
  if (unit == SizeUnit::volume) return cube_root(size / volume_in_sphere);
  if (D == 3) return radius_of_edge * size;
  return (unit == SizeUnit::edge ? area_of_edge : area_in_circle) * size * size;
}

template <int D>
SizingField<D> in_usual_unit(SizingField<D> field, SizeUnit unit) {
  require_unit(D, unit);
  if (unit == usual_size_unit<D>() || !field.bounded()) return field;
  if (field.is_constant()) return in_usual_unit<D>(field.at({}), unit);
  if (!field.is_by_blocks()) return [field, unit](const Point<D>& x) { return in_usual_unit<D>(field.at(x), unit); };
  return SizingField<D>::by_blocks([field, unit](std::span<const Point<D>> points, std::span<double> sizes) {
    field.at(points, sizes);
    for (double& size : sizes) size = in_usual_unit<D>(size, unit);
  });
}

template <int D>
double growth_of_unit(SizeUnit unit) {
  require_unit(D, unit);
  if (unit != SizeUnit::edge && unit != SizeUnit::radius) return 1;
  return D == 3 ? in_usual_unit<D>(1, unit) : std::sqrt(in_usual_unit<D>(1, unit));
}

#define PGDR_INSTANTIATE(D)                                                    \
  template PGDR_API double in_usual_unit<D>(double, SizeUnit);                 \
  template PGDR_API SizingField<D> in_usual_unit<D>(SizingField<D>, SizeUnit); \
  template PGDR_API double growth_of_unit<D>(SizeUnit);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
