// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "output/cell_surface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t wall = 0xffffffff;

/// A face of a cell, or a wall.
template <int D>
struct Face {
  std::array<std::uint32_t, D> corners;
  std::uint32_t cell;
  bool operator<(const Face& o) const { return corners != o.corners ? corners < o.corners : cell < o.cell; }
};

template <int D>
std::vector<Face<D>> sorted_faces(const std::vector<LabelledCell<D>>& cells,
                                  const std::vector<std::array<std::uint32_t, D>>& walls) {
  std::vector<Face<D>> faces;
  faces.reserve((D + 1) * cells.size() + walls.size());
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    for (std::size_t skip = 0; skip <= D; ++skip) {
      Face<D> face{{}, c};
      std::size_t k = 0;
      for (std::size_t i = 0; i <= D; ++i) {
        if (i != skip) face.corners[k++] = cells[c].corners[i];
      }
      std::sort(face.corners.begin(), face.corners.end());
      faces.push_back(face);
    }
  }
  for (const auto& w : walls) faces.push_back({w, wall});
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// @param faces as sorted_faces() has them
template <int D>
CellLinks<D> links_of(const std::vector<LabelledCell<D>>& cells, const std::vector<Face<D>>& faces) {
  std::array<std::uint32_t, D + 1> none;
  none.fill(no_entity);
  CellLinks<D> links(cells.size(), none);
  const auto link = [&](const Face<D>& face, std::uint32_t beyond) {
    const auto& v = cells[face.cell].corners;
    const auto is_opposite = [&](std::uint32_t x) { return !std::binary_search(face.corners.begin(), face.corners.end(), x); };
    const auto at = std::find_if(v.begin(), v.end(), is_opposite);  // none if the cell has a corner twice
    if (at != v.end()) links[face.cell][static_cast<std::size_t>(at - v.begin())] = beyond;
  };
  for (std::size_t begin = 0, end; begin < faces.size(); begin = end) {
    end = begin + 1;
    while (end < faces.size() && faces[end].corners == faces[begin].corners) ++end;
    const bool are_two = end - begin > 1 && faces[begin + 1].cell != wall && (end - begin == 2 || faces[begin + 2].cell == wall);
    if (!are_two) continue;
    link(faces[begin], faces[begin + 1].cell);
    link(faces[begin + 1], faces[begin].cell);
  }
  return links;
}

/// The centroid, if it lies inside of the cell, strictly and exactly.
template <int D>
std::optional<Point<D>> inner_centroid(const Simplex<D>& s) {
  Point<D> centre;
  for (const Point<D>& p : s) {
    for (int k = 0; k < D; ++k) centre[k] += p[k] / (D + 1);
  }
  for (const double x : centre.x) {
    if (!std::isfinite(x)) return std::nullopt;
  }
  const Sign side = orient<D>(s);
  if (side == Sign::zero) return std::nullopt;
  for (std::size_t i = 0; i <= D; ++i) {
    Simplex<D> part = s;
    part[i] = centre;
    if (orient<D>(part) != side) return std::nullopt;
  }
  return centre;
}

/// Volume (area) but for a factor. Approximate: it chooses the cell of a seed, any would do.
template <int D>
double measure(const Simplex<D>& s) {
  const auto edge = [&s](std::size_t i, int k) { return s[i][k] - s[0][k]; };
  if constexpr (D == 2) {
    return std::abs(edge(1, 0) * edge(2, 1) - edge(1, 1) * edge(2, 0));
  } else {
    double det = 0;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      det += edge(1, k) * (edge(2, l) * edge(3, m) - edge(2, m) * edge(3, l));
    }
    return std::abs(det);
  }
}

template <int D>
std::vector<RegionSeed<D>> seeds_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                    DisjointSets& parts) {
  struct Largest {
    double measure = -1;
    Point<D> centre;
  };
  std::vector<Largest> largest(cells.size());
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (cells[c].label == 0) continue;
    Simplex<D> s;
    for (std::size_t i = 0; i <= D; ++i) s[i] = points[cells[c].corners[i]];
    Largest& best = largest[parts.find(c)];
    const double m = measure<D>(s);
    if (!(m > best.measure)) continue;
    if (const auto centre = inner_centroid<D>(s)) best = {m, *centre};
  }
  std::vector<RegionSeed<D>> seeds;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (largest[c].measure >= 0) seeds.push_back({largest[c].centre, cells[c].label, 0});
  }
  return seeds;
}

}  // namespace

template <int D>
CellSurface<D> surface_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                          const std::vector<std::array<std::uint32_t, D>>& walls) {
  CellSurface<D> surface;
  std::vector<HullFace<D>> hull;
  DisjointSets parts(cells.size());
  const std::vector<Face<D>> faces = sorted_faces<D>(cells, walls);
  for (std::size_t begin = 0, end; begin < faces.size(); begin = end) {
    end = begin + 1;
    while (end < faces.size() && faces[end].corners == faces[begin].corners) ++end;
    const std::uint32_t a = faces[begin].cell, b = faces[end - 1].cell;
    if (a != wall && (end - begin == 1 || faces[begin + 1].cell == wall)) hull.push_back({faces[begin].corners, a});
    if (b == wall) continue;
    if (end - begin == 2 && cells[a].label == cells[b].label)
      parts.unite(a, b);
    else
      surface.faces.push_back(faces[begin].corners);
  }
  surface.seeds = seeds_of<D>(points, cells, parts);
  surface.voids = voids_of<D>(points, cells, hull, parts_of_hull<D>(points, cells, links_of<D>(cells, faces), hull));
  return surface;
}

template CellSurface<2> surface_of<2>(const std::vector<Point2>&, const std::vector<LabelledCell<2>>&,
                                      const std::vector<std::array<std::uint32_t, 2>>&);
template CellSurface<3> surface_of<3>(const std::vector<Point3>&, const std::vector<LabelledCell<3>>&,
                                      const std::vector<std::array<std::uint32_t, 3>>&);

}  // namespace pgdr::detail
