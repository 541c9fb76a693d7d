// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_tolerance.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pgdr/error.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

/// Of the box of all points.
double diagonal_of(const Plc<3>& plc) {
  double square = 0;
  for (int i = 0; i < 3 && !plc.points.empty(); ++i) {
    double low = plc.points[0][i], high = low;
    for (const Point3& p : plc.points) {
      low = std::min(low, p[i]);
      high = std::max(high, p[i]);
    }
    square += (high - low) * (high - low);
  }
  return std::sqrt(square);
}

double largest_coordinate(const Plc<3>& plc) {
  double largest = 0;
  for (const Point3& p : plc.points)
    for (const double x : p.x) largest = std::max(largest, std::abs(x));
  return largest;
}

[[noreturn]] void refuse_tolerance(const std::string& message) {
  throw UsageError({.code = Errc::bad_option, .message = message});
}

}  // namespace

std::optional<SurfaceToleranceText> split_surface_tolerance(const std::string& text) {
  SurfaceToleranceText out{0, text.ends_with('%')};
  const char* last = text.data() + text.size() - (out.is_percent ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), last, out.number);
  if (end != last || error == std::errc::invalid_argument || std::isnan(out.number)) return std::nullopt;
  if (error == std::errc::result_out_of_range) out.number = text.find("e-") != std::string::npos ? 0 : HUGE_VAL;
  return out;
}

double surface_tolerance(const std::string& text, const Plc<3>& plc, std::optional<double> tolerance) {
  const auto given = split_surface_tolerance(text);
  if (!given) refuse_tolerance("--surface-tolerance is a length, or a percentage of the diagonal as 0.1%, not \"" + text + '"');
  const double diagonal = diagonal_of(plc);
  if (given->is_percent && !(diagonal > 0))
    refuse_tolerance("--surface-tolerance " + text + ": all points of the input are one, so that it has no diagonal");
  const double length = given->is_percent ? given->number / 100 * diagonal : given->number;
  if (!(length > 0) || !std::isfinite(length)) refuse_tolerance("--surface-tolerance has to be above 0 and finite, not " + text);
  // A tolerance of 0 leaves what rounding of doubles does, 8 ulps of the largest coordinate.
  const double joined = std::max(tolerance ? *tolerance : tolerance_of(plc), 0x1p-49 * largest_coordinate(plc));
  if (constexpr double times = 16; length < times * joined)
    refuse_tolerance(
        format("--surface-tolerance is %.6g, and has to be 16 times the tolerance within which points are one, or more, which "
               "is %.6g",
               length, joined));
  return length;
}

void require_fine_surface_tolerance(double length, const Plc<3>& plc) {
  constexpr double most_of_diagonal = 0.02;  // a length in the wrong unit would take the shape away
  const double diagonal = diagonal_of(plc);
  if (length <= most_of_diagonal * diagonal || plc.is_coarse) return;
  throw InputError({.code = Errc::tolerance_too_large,
                    .message = format("a surface tolerance of %.6g is more than a fiftieth of the diagonal, %.6g; it has to be "
                                      "confirmed (--yes-coarse) if it is meant",
                                      length, diagonal)});
}

}  // namespace pgdr::tool
