// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/cell_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "optimize/numbers.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using Vector3 = detail::Vector<3>;

/// By so much each term has to be above 1, so that no rounding lets a cell pass that is not within its bounds.
constexpr double margin = 1e-9;
constexpr double step = 1.01;  // of a level

/// 1, 1 / step, 1 / step^2, ..., as far as doubles are normal numbers; each the quotient of the one before.
const std::vector<double>& thresholds() {
  static const std::vector<double> all = [] {
    std::vector<double> t;
    for (double x = 1; x > 1e-40; x /= step) t.push_back(x);
    return t;
  }();
  return all;
}

/// The lower one; 0 if the part is no number, as where squares are too large.
double lower(double q, double part) { return part >= q ? q : part > 0 ? part : 0; }

/// The least of what the six dihedral angles between faces of these inward normals count; 0 if it cannot be said, as squares of
/// areas are no numbers.
double least_of_angles(const std::array<Vector3, 4>& n) {
  std::array<double, 4> inverse;  // of squared lengths
  for (int i = 0; i < 4; ++i) {
    const double squared = detail::dot(n[i], n[i]);
    if (!(squared > 0 && squared < std::numeric_limits<double>::infinity())) return 0;
    inverse[i] = 1 / squared;
  }
  // Squares of cosines, with their signs: one root for all acute angles, and one for all others.
  double most = 0, least = 0;
  for (const auto& [i, j] : edge_ends) {
    const double product = -detail::dot(n[i], n[j]), square = product * inverse[i] * (std::fabs(product) * inverse[j]);
    most = std::max(most, square);
    least = std::min(least, square);
  }
  const double d = std::min(1 - std::sqrt(most), numbers::of_large_angles * (1 - std::sqrt(-least)));
  return d > 0 ? d : 0;
}

/// q of a cell whose radius is the root of `centre2 / twice2`, and that is q but for its size.
double with_size(double q, double twice2, double centre2, double size) {
  if (!(size < CellBounds<3>::infinity) || size * size * twice2 >= q * q * centre2) return q;
  return lower(q, size * std::sqrt(twice2 / centre2));
}

}  // namespace

double cosine_complement(double degrees) {
  const double x = degrees * (std::numbers::pi / 360), x2 = x * x;  // at most 0.53
  double sum = 0;
  for (int k = 19; k > 1; k -= 2) sum = (1 - sum) * x2 / (k * (k - 1));
  const double sine = x * (1 - sum);
  return 2 * sine * sine;
}

CellQuality::CellQuality(const CellBounds<3>& bounds, double min_dihedral)
    : bounds_(&bounds), one_minus_cos_(min_dihedral > 0 ? cosine_complement(min_dihedral) * (1 + margin) : 0) {}

double CellQuality::of(const Simplex<3>& s, int region, double enough) const {
  ++evaluated_;
  return of_with(s, region, enough, [&] { return size_for(s, region); });
}

double CellQuality::of_sized(const Simplex<3>& s, int region, double size) const {
  return of_with(s, region, 0, [size] { return size; });
}

/// The size at the cell, or what is taken for it.
double CellQuality::size_for(const Simplex<3>& s, int region) const {
  if (bounds_->sizes_vary())
    if (const auto size = sizes_near.at(centroid<3>(s), region)) return *size;
  return bounds_->size_at(s, region);
}

bool CellQuality::is_within_size(const Simplex<3>& s, int region, double size) const {
  return measure_within<3>(s, bounds_->measure_of(region)) && circumradius_within<3>(s, size);
}

/// The size is asked for only where the other measures leave it to say.
template <class SizeOf>
double CellQuality::of_with(const Simplex<3>& s, int region, double enough, SizeOf size_of) const {
  using detail::cross;
  using detail::difference;
  using detail::dot;
  const Vector3 a = difference<3>(s[1], s[0]), b = difference<3>(s[2], s[0]), c = difference<3>(s[3], s[0]);
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double det = dot(a, bc);
  if (!(det > 0)) return 0;
  double q = 1;
  if (one_minus_cos_ > 0) {
    // Inward normals of the faces opposite corners 1, 2, 3, and 0, whose areas close the surface.
    const Vector3 opposite_0 = {-bc[0] - ca[0] - ab[0], -bc[1] - ca[1] - ab[1], -bc[2] - ca[2] - ab[2]};
    q = std::min(q, least_of_angles({bc, ca, ab, opposite_0}) / one_minus_cos_);
    if (!(q > enough)) return q;
  }
  const double a2 = dot(a, a), b2 = dot(b, b), c2 = dot(c, c);
  Vector3 centre;  // from corner 0, times twice the determinant
  for (int i = 0; i < 3; ++i) centre[i] = a2 * bc[i] + b2 * ca[i] + c2 * ab[i];
  // (2 det R)^2 and (2 det)^2. By these most cells pass without a root.
  const double centre2 = dot(centre, centre) * ((1 + margin) * (1 + margin)), twice2 = 4 * det * det;
  const double ratio_bound = bounds_->radius_edge_bound;
  if (ratio_bound < CellBounds<3>::infinity) {
    const Vector3 d = difference<3>(s[2], s[1]), e = difference<3>(s[3], s[1]), f = difference<3>(s[3], s[2]);
    const double shortest2 = std::min({a2, b2, c2, dot(d, d), dot(e, e), dot(f, f)});
    const double part2 = ratio_bound * ratio_bound * shortest2 * twice2, q2 = q * q;
    if (!(part2 >= q2 * q2 * centre2)) q = lower(q, std::sqrt(std::sqrt(part2 / centre2)));
    if (!(q > enough)) return q;
  }
  q = with_size(q, twice2, centre2, size_of());
  const double measure = bounds_->measure_of(region);
  if (measure < CellBounds<3>::infinity) q = lower(q, 6 * measure / (det * (1 + margin)));
  return q;
}

int CellQuality::level(double q) {
  if (!(q > 0)) return lowest_level;
  const auto& t = thresholds();
  const auto at = std::partition_point(t.begin(), t.end(), [q](double x) { return x > q; });
  return at == t.end() ? lowest_level : -static_cast<int>(at - t.begin());
}

double CellQuality::least_of_level(int level) {
  const auto& t = thresholds();
  return level <= lowest_level || -level >= static_cast<int>(t.size()) ? 0 : t[static_cast<std::size_t>(-level)];
}

}  // namespace pgdr
