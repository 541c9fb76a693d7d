// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "output/cell_surface.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

/// A face with what lies beyond it.
template <int D>
struct Side {
  Simplex<D> cell;     ///< the face, then the opposite corner
  Point<D> centre;     ///< of the face
  Point<D> outward;    ///< normal, as long as the face is large; approximate
  double squared = 0;  ///< its squared length
};

template <int D>
Side<D> side_of(const std::vector<Point<D>>& points, const LabelledCell<D>& cell, const HullFace<D>& face) {
  Side<D> side;
  for (std::size_t i = 0; i < D; ++i) side.cell[i] = points[face.corners[i]];
  for (const std::uint32_t v : cell.corners) {
    if (std::find(face.corners.begin(), face.corners.end(), v) == face.corners.end()) side.cell[D] = points[v];
  }
  const auto edge = [&side](std::size_t i, int k) { return side.cell[i][k] - side.cell[0][k]; };
  for (int k = 0; k < D; ++k) {
    if constexpr (D == 2) {
      side.outward[k] = k == 0 ? edge(1, 1) : -edge(1, 0);
    } else {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      side.outward[k] = edge(1, l) * edge(2, m) - edge(1, m) * edge(2, l);
    }
    for (std::size_t i = 0; i < D; ++i) side.centre[k] += side.cell[i][k] / D;
  }
  // The normal points to the side from which the face's corners, with a point there, are a simplex of this sign.
  constexpr Sign beyond = D == 2 ? Sign::negative : Sign::positive;
  const double turn = orient<D>(side.cell) == beyond ? -1 : 1;
  for (int k = 0; k < D; ++k) {
    side.outward[k] *= turn;
    side.squared += side.outward[k] * side.outward[k];
  }
  return side;
}

/// Whether p lies in the closed simplex. Exact.
template <int D>
bool contains(const Simplex<D>& s, const Point<D>& p) {
  for (int k = 0; k < D; ++k) {
    const auto below = [&](const Point<D>& v) { return v[k] < p[k]; };
    const auto above = [&](const Point<D>& v) { return v[k] > p[k]; };
    if (std::all_of(s.begin(), s.end(), below) || std::all_of(s.begin(), s.end(), above)) return false;
  }
  const Sign whole = orient<D>(s);
  for (std::size_t i = 0; i <= D; ++i) {
    Simplex<D> part = s;
    part[i] = p;
    if (const Sign sign = orient<D>(part); sign != whole && sign != Sign::zero) return false;
  }
  return true;
}

/// Of what is 1 where it is largest: less than this is taken for rounding, or for 0.
constexpr double slight = 0x1p-20;

/// Is a point of the face's plane (line) inside of it, or as good as on its border? Approximate: it chooses where to look.
template <int D>
bool is_seen_inside(const Side<D>& face, const Point<D>& x) {
  const auto turn = [&](const Point<D>& p, const Point<D>& q) {  // the part of the normal that p, q and x have
    double sum = 0;
    for (int k = 0; k < D; ++k) {
      const int l = (k + 1) % D, m = (k + 2) % D;
      if constexpr (D == 3) sum += face.outward[k] * ((p[l] - x[l]) * (q[m] - x[m]) - (p[m] - x[m]) * (q[l] - x[l]));
      if constexpr (D == 2) sum += (q[k] - p[k]) * (x[k] - p[k]);
    }
    return sum;
  };
  const auto& c = face.cell;
  if constexpr (D == 2) return turn(c[0], c[1]) >= 0 && turn(c[1], c[0]) >= 0;
  const double first = turn(c[0], c[1]), second = turn(c[1], c[2]), third = turn(c[2], c[0]);
  const double sum = first + second + third, least = -slight * std::fabs(sum), turned = sum < 0 ? -1 : 1;
  return turned * first >= least && turned * second >= least && turned * third >= least;
}

/// How far from the face's centre, along its normal, the next face is; infinite if there is none.
template <int D>
double depth_beyond(const Side<D>& side, const std::vector<Side<D>>& others) {
  double depth = std::numeric_limits<double>::infinity();
  const double length = std::sqrt(side.squared);
  for (const Side<D>& other : others) {
    double slope = 0, height = 0;
    for (int k = 0; k < D; ++k) {
      slope += side.outward[k] / length * other.outward[k];
      height += (other.centre[k] - side.centre[k]) * other.outward[k];
    }
    const double at = height / slope;
    if (!(slope < -slight * std::sqrt(other.squared)) || !(at > 0) || !(at < depth)) continue;  // faces across are not seen
    Point<D> x;
    for (int k = 0; k < D; ++k) x[k] = side.centre[k] + at * (side.outward[k] / length);
    if (is_seen_inside(other, x)) depth = at;
  }
  return depth;
}

/// The point beyond the centre of the face, so far, if it is strictly beyond and in no cell.
template <int D>
std::optional<Point<D>> free_point(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                   const Side<D>& side, double distance) {
  const double length = std::sqrt(side.squared);
  Point<D> p;
  for (int k = 0; k < D; ++k) p[k] = side.centre[k] + distance * (side.outward[k] / length);
  if (!std::all_of(p.x.begin(), p.x.end(), [](double x) { return std::isfinite(x); })) return std::nullopt;
  Simplex<D> beyond = side.cell;
  beyond[D] = p;
  if (orient<D>(beyond) != -orient<D>(side.cell)) return std::nullopt;  // lost in rounding
  const bool free = std::none_of(cells.begin(), cells.end(), [&](const LabelledCell<D>& c) {
    Simplex<D> s;
    for (std::size_t i = 0; i <= D; ++i) s[i] = points[c.corners[i]];
    return contains<D>(s, p);
  });
  return free ? std::optional(p) : std::nullopt;
}

/// A point beyond the face and in no cell: half way to the face opposite, or, where something is in the way, near the face.
template <int D>
std::optional<Point<D>> point_beyond(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                     const Side<D>& side, double depth) {
  const double length = std::sqrt(side.squared), size = D == 2 ? length : std::sqrt(length);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  if (std::isfinite(depth))
    if (const auto p = free_point<D>(points, cells, side, depth / 2)) return p;
  for (const int halvings : {20, 30, 40})
    if (const auto p = free_point<D>(points, cells, side, std::ldexp(size, -halvings))) return p;
  return std::nullopt;
}

/// Of the strip between two parallel planes that has these faces: across the sum of their normals, each turned as the largest is.
template <int D>
double width_of(const std::vector<Side<D>>& sides, const Side<D>& largest) {
  Point<D> normal;
  double squared = 0;
  for (const Side<D>& side : sides) {
    double turn = 0;
    for (int k = 0; k < D; ++k) turn += side.outward[k] * largest.outward[k];
    for (int k = 0; k < D; ++k) normal[k] += turn < 0 ? -side.outward[k] : side.outward[k];
  }
  for (const double x : normal.x) squared += x * x;
  double low = 0, high = 0;
  for (const Side<D>& side : sides)
    for (std::size_t i = 0; i < D; ++i) {
      double height = 0;
      for (int k = 0; k < D; ++k) height += (side.cell[i][k] - largest.centre[k]) * normal[k];
      low = std::min(low, height);
      high = std::max(high, height);
    }
  return (high - low) / std::sqrt(squared);
}

/// What the volume (area) inside of a closed part is, but for a factor; negative where the cells are outside.
template <int D>
double measure_inside(const std::vector<Side<D>>& sides) {
  double measure = 0;
  for (const Side<D>& side : sides)
    for (int k = 0; k < D; ++k) measure += (side.centre[k] - sides[0].centre[k]) * side.outward[k];
  return measure;
}

/// The largest sides of a void are tried, up to so many, for one that has most room beyond it.
constexpr std::size_t most_tried = 8;

template <int D>
std::optional<CellVoid<D>> void_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                   std::vector<Side<D>>& sides) {
  if (!(measure_inside(sides) < 0)) return std::nullopt;
  std::stable_sort(sides.begin(), sides.end(), [](const Side<D>& a, const Side<D>& b) { return a.squared > b.squared; });
  std::vector<std::pair<double, std::size_t>> tried;  // depth, side
  for (std::size_t k = 0; k < std::min(sides.size(), most_tried); ++k) tried.emplace_back(depth_beyond(sides[k], sides), k);
  std::stable_sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [depth, k] : tried)
    if (const auto p = point_beyond<D>(points, cells, sides[k], depth)) return CellVoid<D>{*p, width_of(sides, sides[0])};
  return std::nullopt;
}

}  // namespace

template <int D>
std::vector<CellVoid<D>> voids_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                  const std::vector<HullFace<D>>& hull, const std::vector<std::uint32_t>& parts) {
  std::map<std::uint32_t, std::vector<Side<D>>> by_part;
  for (std::uint32_t f = 0; f < hull.size(); ++f) by_part[parts[f]].push_back(side_of<D>(points, cells[hull[f].cell], hull[f]));
  std::vector<CellVoid<D>> voids;
  for (auto& [first, sides] : by_part)
    if (const auto found = void_of<D>(points, cells, sides)) voids.push_back(*found);
  return voids;
}

template std::vector<CellVoid<2>> voids_of<2>(const std::vector<Point2>&, const std::vector<LabelledCell<2>>&,
                                              const std::vector<HullFace<2>>&, const std::vector<std::uint32_t>&);
template std::vector<CellVoid<3>> voids_of<3>(const std::vector<Point3>&, const std::vector<LabelledCell<3>>&,
                                              const std::vector<HullFace<3>>&, const std::vector<std::uint32_t>&);

}  // namespace pgdr::detail
