// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/written_precision.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "input/triangle_shapes.hpp"
#include "numbers/unit_scale.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/error.hpp"
#include "pgdr/plc.hpp"
#include "precision/looks.hpp"

namespace pgdr {
namespace {

constexpr int exact_digits = 4;  // and less: as people choose coordinates
constexpr int few_digits = 9;    // floats have them at most
constexpr double of_floats = 0x1p-22;
constexpr double most_off = 1e-5;       // of a face that looks planar
constexpr double clearly_bent = 1e-3;   // distances from there on are not told apart
constexpr double gap = 10;              // between the distances of planar faces and those of others
constexpr double allowance = 4;         // a plane that is fitted to many triangles may be off by more than that of one
constexpr std::size_t least_part = 20;  // one of so many segments is between triangles of such a face, if there is one

/// Of the shortest decimal number that is this double, d.ddde+xx, within what is rounded where units are changed; few_digits + 1:
/// more.
int significant_digits(double value) {
  char text[32];
  const char* const end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, few_digits - 1).ptr;
  double rounded = 0;
  std::from_chars(text, end, rounded);
  if (!(std::fabs(rounded - value) <= 0x1p-51 * std::fabs(value))) return few_digits + 1;
  const std::string_view number(text, end);
  return static_cast<int>(std::ranges::count_if(number.substr(0, number.find_last_not_of('0', number.find('e') - 1) + 1),
                                                [](char c) { return c >= '0' && c <= '9'; }));
}

/// Of the coordinates, times the power of two with which this is least (of those that make the largest 2^-40 to 2^40): a file
/// that was scaled by a power of two has lost nothing.
int most_digits(std::span<const Point3> points) {
  constexpr int farthest = 40;
  const double largest = detail::largest_coordinate(points);
  if (!(largest > 0) || !std::isfinite(largest)) return 0;
  const int exponent = std::ilogb(largest);
  int least = few_digits + 1;
  const auto try_scale = [&](int scale) {
    int most = 0;
    for (const Point3& p : points)
      for (const double c : p.x) {
        most = std::max(most, significant_digits(std::ldexp(c, scale)));
        if (most >= least) return;
      }
    least = most;
  };
  try_scale(0);  // most often it is that
  for (int to = -farthest; to <= farthest && least > exact_digits; ++to) try_scale(to - exponent);
  return least;
}

/// But for their exponents.
bool are_floats(std::span<const Point3> points) {
  int unused;
  return std::ranges::all_of(points, [&](const Point3& p) {
    return std::ranges::all_of(p.x, [&](double c) {
      const double mantissa = std::frexp(c, &unused);
      return static_cast<double>(static_cast<float>(mantissa)) == mantissa;
    });
  });
}

/// Of the facet's first triangle, its largest: four times the square of its area.
double squared_size(const Domain<3>& domain, EntityId f) {
  const auto& p = domain.points();
  const auto [a, b, c] = domain.triangles(f).front();
  const auto normal = detail::cross(detail::difference(p[b], p[a]), detail::difference(p[c], p[a]));
  return detail::dot(normal, normal);
}

/// How far the smaller facet is off the plane of the larger one, of the largest coordinate of both; `clearly_bent` at most.
double distance_off_plane(const Domain<3>& domain, EntityId f, EntityId g) {
  if (squared_size(domain, f) < squared_size(domain, g)) std::swap(f, g);
  const auto& p = domain.points();
  const auto [a, b, c] = domain.triangles(f).front();
  const double magnitude = std::max(domain.facet_magnitude(f), domain.facet_magnitude(g));
  double off = 0;
  for (const std::uint32_t q : domain.facet_points(g)) {
    off = std::max(off, detail::plane_distance(p[a], p[b], p[c], p[q]) / magnitude);
    if (!(off < clearly_bent)) return clearly_bent;
  }
  return off;
}

/// For every segment between two facets of one marker: how far one is off the plane of the other.
std::vector<double> distances_off_planes(const Domain<3>& domain) {
  std::vector<double> off;
  for (EntityId s = 0; s < domain.segments().size(); ++s) {
    const auto facets = domain.facets_of_segment(s);
    if (facets.size() == 2 && domain.facets()[facets[0]].marker == domain.facets()[facets[1]].marker)
      off.push_back(distance_off_plane(domain, facets[0], facets[1]));
  }
  return off;
}

}  // namespace

std::size_t most_facets_saved(const Domain<3>& domain, double precision) {
  const auto off = distances_off_planes(domain);
  return static_cast<std::size_t>(std::ranges::count_if(off, [&](double x) { return x <= allowance * precision; }));
}

double precision_of_distances(std::vector<double> off, std::size_t edges, const LooksOfPlanes& looks) {
  std::sort(off.begin(), off.end());
  const auto up_to = [&off](double x) {
    return static_cast<std::size_t>(std::upper_bound(off.begin(), off.end(), x) - off.begin());
  };
  const std::size_t rounded = up_to(Plc<3>{}.precision), end = up_to(most_off);
  const auto begin = std::max({rounded + 1, rounded + (edges + least_part - 1) / least_part, up_to(looks.known / allowance)});
  const auto has_gap = [&](std::size_t n) { return looks.within_gap * (up_to(gap * off[n - 1]) - n) <= n - rounded; };
  if (looks.known > 0) {
    for (std::size_t n = begin; n <= end; ++n)
      if (has_gap(n)) return std::max(looks.known, allowance * off[n - 1]);
    return looks.known;
  }
  for (std::size_t n = end; n >= begin; --n)
    if (has_gap(n)) return allowance * off[n - 1];
  return Plc<3>{}.precision;
}

double apparent_precision(const Domain<3>& domain) {
  return precision_of_distances(distances_off_planes(domain), domain.segments().size(), {});
}

double suggested_precision(const Plc<3>& plc) {
  const double written = std::max(plc.precision, written_precision(plc.points));
  if (written > Plc<3>{}.precision) return written;
  try {
    return apparent_precision(Domain<3>(plc));
  } catch (const InputError&) {
    return written;
  }
}

void set_precision_of_file(Plc<3>& plc) {
  const double rounding = plc.precision;
  plc.precision = std::max(rounding, written_precision(plc.points));
  plc.precision_of_file = plc.precision > rounding;
}

bool has_few_digits(std::span<const Point3> points) { return most_digits(points) <= few_digits; }

double written_precision(std::span<const Point3> points) {
  const int most = most_digits(points);
  switch (most) {
    case 5: return 1e-4;
    case 6: return 1e-5;
    case 7: return 1e-6;
    default: return most <= exact_digits || (most > few_digits && !are_floats(points)) ? Plc<3>{}.precision : of_floats;
  }
}

}  // namespace pgdr
