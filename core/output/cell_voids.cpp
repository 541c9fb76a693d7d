// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "output/cell_surface.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

/// The parts of the hull, united at the ridges of exactly two faces: elsewhere parts touch.
template <int D>
DisjointSets parts_of(const std::vector<HullFace<D>>& hull) {
  struct Ridge {
    std::array<std::uint32_t, D - 1> corners;
    std::uint32_t face;
    bool operator<(const Ridge& o) const { return corners != o.corners ? corners < o.corners : face < o.face; }
  };
  std::vector<Ridge> ridges;
  ridges.reserve(D * hull.size());
  for (std::uint32_t f = 0; f < hull.size(); ++f) {
    for (std::size_t skip = 0; skip < D; ++skip) {
      Ridge ridge{{}, f};
      std::size_t k = 0;
      for (std::size_t i = 0; i < D; ++i) {
        if (i != skip) ridge.corners[k++] = hull[f].corners[i];
      }
      std::sort(ridge.corners.begin(), ridge.corners.end());
      ridges.push_back(ridge);
    }
  }
  std::sort(ridges.begin(), ridges.end());
  DisjointSets parts(hull.size());
  for (std::size_t begin = 0, end; begin < ridges.size(); begin = end) {
    end = begin + 1;
    while (end < ridges.size() && ridges[end].corners == ridges[begin].corners) ++end;
    if (end - begin == 2) parts.unite(ridges[begin].face, ridges[begin + 1].face);
  }
  return parts;
}

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

/// A point just beyond the face and in no cell: as near as 2^-20 of the size of the face, or nearer if the void is
/// thinner there.
template <int D>
std::optional<Point<D>> point_beyond(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                     const Side<D>& side) {
  const double length = std::sqrt(side.squared), size = D == 2 ? length : std::sqrt(length);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  for (const int halvings : {20, 30, 40}) {
    Point<D> p;
    for (int k = 0; k < D; ++k) p[k] = side.centre[k] + std::ldexp(size, -halvings) * (side.outward[k] / length);
    if (!std::all_of(p.x.begin(), p.x.end(), [](double x) { return std::isfinite(x); })) return std::nullopt;
    Simplex<D> beyond = side.cell;
    beyond[D] = p;
    if (orient<D>(beyond) != -orient<D>(side.cell)) return std::nullopt;  // lost in rounding
    const bool free = std::none_of(cells.begin(), cells.end(), [&](const LabelledCell<D>& c) {
      Simplex<D> s;
      for (std::size_t i = 0; i <= D; ++i) s[i] = points[c.corners[i]];
      return contains<D>(s, p);
    });
    if (free) return p;
  }
  return std::nullopt;
}

}  // namespace

template <int D>
std::vector<Point<D>> points_in_voids(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                      const std::vector<HullFace<D>>& hull) {
  struct Part {
    Point<D> origin;
    double measure = 0;  ///< of what is inside the part, but for a factor; negative where the cells are outside
    std::uint32_t largest = 0;
    double squared = -1;
  };
  DisjointSets parts = parts_of<D>(hull);
  std::map<std::uint32_t, Part> found;
  for (std::uint32_t f = 0; f < hull.size(); ++f) {
    const Side<D> side = side_of<D>(points, cells[hull[f].cell], hull[f]);
    Part& part = found.try_emplace(parts.find(f), Part{side.centre}).first->second;
    for (int k = 0; k < D; ++k) part.measure += (side.centre[k] - part.origin[k]) * side.outward[k];
    if (side.squared > part.squared) {
      part.largest = f;
      part.squared = side.squared;
    }
  }
  std::vector<Point<D>> holes;
  for (const auto& [first, part] : found) {
    if (!(part.measure < 0)) continue;
    const HullFace<D>& face = hull[part.largest];
    if (const auto p = point_beyond<D>(points, cells, side_of<D>(points, cells[face.cell], face))) holes.push_back(*p);
  }
  return holes;
}

template std::vector<Point2> points_in_voids<2>(const std::vector<Point2>&, const std::vector<LabelledCell<2>>&,
                                                const std::vector<HullFace<2>>&);
template std::vector<Point3> points_in_voids<3>(const std::vector<Point3>&, const std::vector<LabelledCell<3>>&,
                                                const std::vector<HullFace<3>>&);

}  // namespace pgdr::detail
