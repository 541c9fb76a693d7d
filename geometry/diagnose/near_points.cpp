// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: open boundaries that are open because points which were meant to be one were written with different digits.
#include <algorithm>
#include <cmath>

#include "diagnose/diagnoser.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

constexpr double near_of_extent = 1e-6;
constexpr double near_of_coordinate = 0x1p-22;  // four ulps of a float, as binary STL files have

/// Without the underflow of squares.
template <int D>
double scaled_distance(const Point<D>& a, const Point<D>& b, double scale) {
  double square = 0;
  for (int i = 0; i < D; ++i) square += (scale * a[i] - scale * b[i]) * (scale * a[i] - scale * b[i]);
  return std::sqrt(square);
}

}  // namespace

/// On edges of one facet alone (2D: ends of one segment alone), ascending.
template <int D>
std::vector<std::uint32_t> Diagnoser<D>::open_points() const {
  std::vector<std::uint32_t> open;
  if constexpr (D == 3) {
    for (std::size_t begin = 0, n; begin < uses_.size(); begin += n) {
      n = uses_at(begin).size();
      const Edge e = uses_[begin].edge();
      if (n == 1) open.insert(open.end(), e.begin(), e.end());
    }
    std::sort(open.begin(), open.end());
    open.erase(std::unique(open.begin(), open.end()), open.end());
  } else {
    std::vector<std::uint32_t> degree(p_.size());
    for (const DomainSegment& s : domain_.segments())
      for (const std::uint32_t v : s.points) ++degree[v];
    for (std::uint32_t v = 0; v < degree.size(); ++v)
      if (degree[v] == 1) open.push_back(v);
  }
  return open;
}

/// The farthest first: what makes these one makes all one.
template <int D>
void Diagnoser<D>::find_near_points() {
  const std::vector<std::uint32_t> open = open_points();
  const auto [scale, largest] = scale_of<D>(p_);
  double extent = 0;
  for (int i = 0; i < D; ++i) {
    const auto [low, high] = std::ranges::minmax(p_, {}, [i](const Point<D>& p) { return p[i]; });
    extent = std::max(extent, scale * high[i] - scale * low[i]);
  }
  Least<std::pair<double, Edge>> pairs(options_.most_listed);
  PointGrid<D> grid(open.size(), scale, std::max(near_of_extent * extent, near_of_coordinate * largest));
  for (const std::uint32_t v : open) {
    const std::uint32_t w = grid.nearest(p_[v], p_);
    if (w == no_entity) {
      grid.insert(p_[v], v);
      continue;
    }
    pairs.add({-scaled_distance(p_[w], p_[v], scale) / scale, {w, v}});
  }
  out_[Finding::near_points].count = pairs.count();
  for (const auto& [negative, pair] : pairs.kept()) {
    const auto [w, v] = pair;
    list(Finding::near_points, Errc::near_points,
         "points " + point_words(w) + " and " + point_words(v) + ", both on open boundaries, nearly coincide", point_place(v),
         {point_number(w), point_number(v)}, {p_[w], p_[v]}, -negative);
  }
}

template void Diagnoser<2>::find_near_points();
template void Diagnoser<3>::find_near_points();

}  // namespace pgdr::detail
