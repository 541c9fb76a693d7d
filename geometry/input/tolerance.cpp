// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The default tolerance of an input.
#include <algorithm>
#include <cmath>

#include "input/diagonal.hpp"
#include "numbers/finite.hpp"
#include "pgdr/plc.hpp"
#include "space/box.hpp"

namespace pgdr {
namespace {

constexpr double ulps_of_doubles = 8, ulps_of_floats = 2;
constexpr int double_digits = 52, float_digits = 23;
constexpr double most_of_floats = 1e-6;  // of the diagonal: far from the origin floats keep no shape that could be told

}  // namespace

template <int D>
double detail::diagonal_of(const Box<D>& box) {
  double longest = 0, square = 0;
  for (int i = 0; i < D; ++i) longest = std::max(longest, box.high[i] - box.low[i]);
  if (!(longest > 0)) return 0;
  for (int i = 0; i < D; ++i) square += (box.high[i] - box.low[i]) / longest * ((box.high[i] - box.low[i]) / longest);
  return longest * std::sqrt(square);
}

template <int D>
double rounding_tolerance(const Plc<D>& plc) {
  if (plc.points.empty() || !std::ranges::all_of(plc.points, detail::is_finite<D>)) return 0;
  auto box = detail::Box<D>::around(plc.points[0]);
  for (const Point<D>& p : plc.points) box.add(p);
  double largest = 0;
  for (int i = 0; i < D; ++i) {
    largest = std::max({largest, std::fabs(box.low[i]), std::fabs(box.high[i])});
  }
  if (largest == 0) return 0;
  const double diagonal = detail::diagonal_of<D>(box);
  const auto ulps = [&](double count, int digits) { return std::ldexp(count, std::ilogb(largest) - digits); };
  const double of_floats = ulps(ulps_of_floats, float_digits);
  return plc.are_floats && of_floats <= most_of_floats * diagonal ? of_floats : ulps(ulps_of_doubles, double_digits);
}

template double detail::diagonal_of(const Box<2>&);
template double detail::diagonal_of(const Box<3>&);
template PGDR_API double rounding_tolerance(const Plc<2>&);
template PGDR_API double rounding_tolerance(const Plc<3>&);

}  // namespace pgdr
