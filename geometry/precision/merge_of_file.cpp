// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Corners of .stl files that should be one point and miss each other by the rounding of zero. What a program computes as
// 0 comes out as 1e-17 at one corner and as 0 or 2e-17 at the other; floats keep all of these, while a coordinate as large as the
// model would be off by 6e-8 of it. Of 307 .stl files of other programs 37 have such corners, 8e-15 of the largest coordinate
// apart at most, and 5e-14 in two of them; none has any from there to 1e-9. Left apart, they are open boundaries, walls of no
// width that intersect, or needles that take millions of cells.
#include <algorithm>
#include <cmath>

#include "numbers/finite.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/written_precision.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

constexpr double of_rounding = 1e-13;  // of doubles that the floats were made of

/// Two floats that near each other, and not equal, are both that small.
bool has_noise(std::span<const Point3> points, double largest) {
  const double small = of_rounding * largest * 0x1p25;
  return std::ranges::any_of(points, [small](const Point3& p) {
    return std::ranges::any_of(p.x, [small](double x) { return x != 0 && std::fabs(x) <= small; });
  });
}

bool has_near_points(std::span<const Point3> points) {
  const auto [scale, largest] = detail::scale_of<3>(points);
  if (!has_noise(points, largest / scale)) return false;
  detail::PointGrid<3> grid(points.size(), scale, of_rounding * largest);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t near = grid.nearest(points[i], points);
    if (near == no_entity)
      grid.insert(points[i], i);
    else if (points[near] != points[i])
      return true;
  }
  return false;
}

bool is_valid(const Plc<3>& plc) {
  return diagnose(plc, {.most_listed = 0, .errors_only = true, .parallel = false}).error_count() == 0;
}

}  // namespace

void set_merge_of_file(Plc<3>& plc) {
  if (!plc.precision_of_file || plc.merge_within > 0) return;
  if (!std::ranges::all_of(plc.points, detail::is_finite<3>) || !has_near_points(plc.points)) return;
  plc.merge_within = of_rounding;
  if (!is_valid(plc)) plc.merge_within = 0;
}

}  // namespace pgdr
