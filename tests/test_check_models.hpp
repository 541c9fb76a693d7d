// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Finished meshes made by hand, with the inputs they belong to: blocks of a lattice, each cube (square) cut by Kuhn's
// subdivision, so that all is known without a mesher. A lattice point is an integer vector; an affine map with integer
// coefficients and one division by 3 makes it a point, so that Steiner points of slanted blocks are rounded once.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::test {

template <int D>
using Lattice = std::array<int, D>;

/// (origin * 3 + sum of i_k * axis_k) / 3, exact before the division.
template <int D>
struct AffineMap {
  std::array<long, D> origin{};
  std::array<std::array<long, D>, D> axes{};
  Point<D> operator()(const Lattice<D>& i) const {
    Point<D> p;
    for (int k = 0; k < D; ++k) {
      long sum = 3 * origin[k];
      for (int a = 0; a < D; ++a) sum += i[a] * axes[a][k];
      p[k] = static_cast<double>(sum) / 3.0;
    }
    return p;
  }
};

/// Lattice steps of one unit along the axes.
template <int D>
AffineMap<D> straight() {
  AffineMap<D> map;
  for (int k = 0; k < D; ++k) map.axes[k][k] = 3;
  return map;
}

/// Steps under which Kuhn's subdivision is strictly Delaunay (nearly equilateral triangles; the body-centred cubic
/// lattice, turned), with no axis-aligned edge or face, away from the origin.
template <int D>
AffineMap<D> slanted() {
  if constexpr (D == 2)
    return {{1000, 500}, {{{7, 2}, {-5, 5}}}};
  else  // rows of {{2,-2,1},{1,2,2},{2,1,-2}} times (-1,1,1), (1,-1,1), (1,1,-1), negated to be right-handed
    return {{1000, 500, 300}, {{{3, -3, 3}, {-5, -1, 1}, {1, -1, -5}}}};
}

/// What a block is cut from.
template <int D>
struct Block {
  Lattice<D> size{};
  AffineMap<D> map = straight<D>();
  /// The region of a cube of the lattice by its lowest corner; negative: no cells.
  std::function<int(const Lattice<D>&)> region = [](const Lattice<D>&) { return 0; };
  /// The marker of a wall in the plane x_axis = at; also walls inside a region, where it is not 0.
  std::function<int(int axis, const std::vector<Lattice<D>>& corners)> marker = [](int, const auto&) { return 0; };
  /// 3D: the marker of an edge that is part of a segment of its own; 0: none.
  std::function<int(const Lattice<D>& a, const Lattice<D>& b)> edge_marker = [](const auto&, const auto&) { return 0; };
};

template <int D>
struct Model {
  std::string name;
  Plc<D> plc;
  OutputMesh<D> mesh;
};

template <int D>
class BlockMesher {
 public:
  explicit BlockMesher(const Block<D>& block) : block_(block) {}

  /// @param input the lattice points that are input points, in order.
  OutputMesh<D> run(const std::vector<Lattice<D>>& input) {
    for (const auto& i : input) vertex(i);
    mesh_.input_points = mesh_.points.size();
    for_each_cube([&](const Lattice<D>& cube) {
      if (block_.region(cube) >= 0) add_cube(cube);
    });
    for (auto& [key, face] : faces_) add_wall(key, face);
    if constexpr (D == 3) add_subsegments();
    if (std::all_of(mesh_.regions.begin(), mesh_.regions.end(), [](double r) { return r == 0; })) mesh_.regions.clear();
    return mesh_;
  }

 private:
  struct Face {
    std::vector<int> regions;
    std::array<std::uint32_t, D> vertices;
  };

  template <class Visit>
  void for_each_cube(Visit visit) const {
    Lattice<D> i{};
    for (;;) {
      visit(i);
      int k = 0;
      while (k < D && ++i[k] == block_.size[k]) i[k++] = 0;
      if (k == D) return;
    }
  }

  std::uint32_t vertex(const Lattice<D>& i) {
    const auto [at, fresh] = vertices_.try_emplace(i, static_cast<std::uint32_t>(mesh_.points.size()));
    if (fresh) {
      mesh_.points.push_back(block_.map(i));
      lattice_.push_back(i);
    }
    return at->second;
  }

  void add_cube(const Lattice<D>& cube) {
    std::array<int, D> order;
    for (int k = 0; k < D; ++k) order[k] = k;
    do {
      bool odd = false;
      for (int a = 0; a < D; ++a)
        for (int b = a + 1; b < D; ++b) odd ^= order[a] > order[b];
      std::array<std::uint32_t, D + 1> cell;
      Lattice<D> corner = cube;
      cell[0] = vertex(corner);
      for (int k = 0; k < D; ++k) {
        ++corner[order[k]];
        cell[k + 1] = vertex(corner);
      }
      if (odd) std::swap(cell[0], cell[1]);
      mesh_.cells.push_back(cell);
      mesh_.regions.push_back(block_.region(cube));
      for (int i = 0; i <= D; ++i) {
        std::array<std::uint32_t, D> face;
        for (int j = 0, n = 0; j <= D; ++j)
          if (j != i) face[n++] = cell[j];
        auto key = face;
        std::sort(key.begin(), key.end());
        Face& entry = faces_[key];
        entry.vertices = face;
        entry.regions.push_back(block_.region(cube));
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }

  /// The lattice axis along which the points do not change; -1 if there is none.
  template <std::size_t N>
  int flat_axis(const std::array<std::uint32_t, N>& v) const {
    for (int k = 0; k < D; ++k) {
      bool flat = true;
      for (const std::uint32_t u : v) flat &= lattice_[u][k] == lattice_[v[0]][k];
      if (flat) return k;
    }
    return -1;
  }

  void add_wall(const std::array<std::uint32_t, D>& key, const Face& face) {
    const int axis = flat_axis(key);
    if (axis < 0) return;
    std::vector<Lattice<D>> corners;
    for (const std::uint32_t v : key) corners.push_back(lattice_[v]);
    const int marker = block_.marker(axis, corners);
    if (face.regions.size() == 2 && face.regions[0] == face.regions[1] && marker == 0) return;
    if constexpr (D == 2) {
      mesh_.subsegments.push_back({face.vertices, marker});
    } else {
      mesh_.subfacets.push_back({face.vertices, marker});
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = key[k], b = key[(k + 1) % 3];
        edges_[{std::min(a, b), std::max(a, b)}].push_back({axis, marker});
      }
    }
  }

  /// Edges where other than two walls of one plane and marker meet, and those of segments of their own.
  void add_subsegments() {
    for (const auto& cell : mesh_.cells)
      for (int i = 0; i < D; ++i)
        for (int j = i + 1; j <= D; ++j) edges_[{std::min(cell[i], cell[j]), std::max(cell[i], cell[j])}];
    for (const auto& [edge, walls] : edges_) {
      const int marker = block_.edge_marker(lattice_[edge[0]], lattice_[edge[1]]);
      const bool at_walls = !walls.empty() && (walls.size() != 2 || walls[0] != walls[1]);
      if (marker || at_walls) mesh_.subsegments.push_back({edge, marker});
    }
  }

  Block<D> block_;
  OutputMesh<D> mesh_;
  std::map<Lattice<D>, std::uint32_t> vertices_;
  std::vector<Lattice<D>> lattice_;
  std::map<std::array<std::uint32_t, D>, Face> faces_;
  std::map<std::array<std::uint32_t, 2>, std::vector<std::pair<int, int>>> edges_;
};

/// The corners of a box of the lattice, the first axis fastest.
template <int D>
std::vector<Lattice<D>> box_corners(const Lattice<D>& low, const Lattice<D>& high) {
  std::vector<Lattice<D>> corners;
  for (int bits = 0; bits < 1 << D; ++bits) {
    Lattice<D> c;
    for (int k = 0; k < D; ++k) c[k] = bits >> k & 1 ? high[k] : low[k];
    corners.push_back(c);
  }
  return corners;
}

/// An input under construction: lattice points by number, walls by their corners.
template <int D>
struct PlcMaker {
  explicit PlcMaker(const AffineMap<D>& m) : map(m) {}

  std::uint32_t point(const Lattice<D>& i) {
    const auto at = std::find(lattice.begin(), lattice.end(), i);
    if (at != lattice.end()) return static_cast<std::uint32_t>(at - lattice.begin());
    lattice.push_back(i);
    plc.points.push_back(map(i));
    return static_cast<std::uint32_t>(lattice.size() - 1);
  }
  void segment(const Lattice<D>& a, const Lattice<D>& b, int marker = 0) {
    plc.segments.push_back({{point(a), point(b)}, marker});
  }
  void polygon(const std::vector<Lattice<D>>& corners, int marker = 0) {
    typename Plc<D>::Facet facet;
    facet.polygons.emplace_back();
    for (const auto& c : corners) facet.polygons[0].push_back(point(c));
    facet.marker = marker;
    plc.facets.push_back(facet);
  }
  /// The boundary of a box, the marker of the side x_axis = low or high being 1 + 2 * axis (+ 1).
  void box(const Lattice<D>& low, const Lattice<D>& high) {
    const auto c = box_corners<D>(low, high);
    if constexpr (D == 2) {
      segment(c[0], c[2], 1);
      segment(c[1], c[3], 2);
      segment(c[0], c[1], 3);
      segment(c[2], c[3], 4);
    } else {
      polygon({c[0], c[2], c[6], c[4]}, 1);
      polygon({c[1], c[3], c[7], c[5]}, 2);
      polygon({c[0], c[1], c[5], c[4]}, 3);
      polygon({c[2], c[3], c[7], c[6]}, 4);
      polygon({c[0], c[1], c[3], c[2]}, 5);
      polygon({c[4], c[5], c[7], c[6]}, 6);
    }
  }

  AffineMap<D> map;
  std::vector<Lattice<D>> lattice;
  Plc<D> plc;
};

/// Markers as PlcMaker::box gives them, for a box of the lattice; 0 inside.
template <int D>
int box_marker(const Lattice<D>& low, const Lattice<D>& high, int axis, const std::vector<Lattice<D>>& corners) {
  const int at = corners[0][axis];
  for (int k = 0; k < D; ++k)
    for (const auto& c : corners)
      if (c[k] < low[k] || c[k] > high[k]) return 0;
  return at == low[axis] ? 1 + 2 * axis : at == high[axis] ? 2 + 2 * axis : 0;
}

/// A solid block.
template <int D>
Model<D> solid_block(const std::string& name, int n, const AffineMap<D>& map) {
  Lattice<D> low{}, high;
  high.fill(n);
  PlcMaker<D> maker(map);
  maker.box(low, high);
  Block<D> block{high, map};
  block.marker = [=](int axis, const auto& corners) { return box_marker<D>(low, high, axis, corners); };
  return {name, maker.plc, BlockMesher<D>(block).run(maker.lattice)};
}

/// Two regions, 1 and 2, with a wall (marker 7) between them; on the outside, markers are as of one block.
template <int D>
Model<D> two_regions(const AffineMap<D>& map) {
  Lattice<D> low{}, high, low_wall{}, high_wall;
  high.fill(2);
  high[0] = 4;
  high_wall = high;
  low_wall[0] = high_wall[0] = 2;
  PlcMaker<D> maker(map);
  auto left = high, right = low;
  left[0] = right[0] = 2;
  maker.box(low, left);
  auto walls = maker.plc;
  maker.box(right, high);
  // The two boxes give the wall twice, as markers 2 and 1: keep one.
  if constexpr (D == 2) {
    maker.plc.segments[1].marker = 7;
    maker.plc.segments.erase(maker.plc.segments.begin() + 4);
  } else {
    maker.plc.facets[1].marker = 7;
    maker.plc.facets.erase(maker.plc.facets.begin() + 6);
  }
  for (const int region : {1, 2}) {
    Lattice<D> inside{};
    inside[0] = region == 1 ? 1 : 3;
    for (int k = 1; k < D; ++k) inside[k] = 1;
    Point<D> p = map(inside);
    maker.plc.regions.push_back({p, static_cast<double>(region), 0});
  }
  Block<D> block{high, map};
  block.region = [](const Lattice<D>& cube) { return cube[0] < 2 ? 1 : 2; };
  block.marker = [=](int axis, const auto& corners) {
    bool on_wall = axis == 0;
    for (const auto& c : corners) on_wall &= c[0] == 2;
    return on_wall ? 7 : box_marker<D>(low, high, axis, corners);
  };
  return {"two_regions", maker.plc, BlockMesher<D>(block).run(maker.lattice)};
}

/// A block with a cavity of one cube in the middle; `filled`: the cavity is meshed too, which is wrong.
template <int D>
Model<D> cavity(const AffineMap<D>& map, bool filled = false) {
  Lattice<D> low{}, high, inner_low, inner_high;
  high.fill(3);
  inner_low.fill(1);
  inner_high.fill(2);
  PlcMaker<D> maker(map);
  maker.box(low, high);
  maker.box(inner_low, inner_high);
  Point<D> middle;
  for (int k = 0; k < D; ++k) middle[k] = map(inner_low)[k] / 2 + map(inner_high)[k] / 2;
  // Off the diagonal, which is an edge of the filled cavity's cells.
  middle[0] += (map(inner_high)[0] - map(inner_low)[0]) / 16 + 0.03125;
  maker.plc.holes.push_back(middle);
  Block<D> block{high, map};
  block.region = [=](const Lattice<D>& cube) { return cube == inner_low && !filled ? -1 : 0; };
  block.marker = [=](int axis, const auto& corners) {
    const int inner = box_marker<D>(inner_low, inner_high, axis, corners);
    return inner ? inner : box_marker<D>(low, high, axis, corners);
  };
  return {"cavity", maker.plc, BlockMesher<D>(block).run(maker.lattice)};
}

/// A block with a wall inside that bounds nothing (marker 9).
template <int D>
Model<D> loose_wall(const AffineMap<D>& map) {
  Lattice<D> low{}, high, a, b;
  high.fill(3);
  high[0] = 4;
  a.fill(1);
  b.fill(2);
  a[0] = b[0] = 2;
  PlcMaker<D> maker(map);
  maker.box(low, high);
  if constexpr (D == 2)
    maker.segment(a, b, 9);
  else
    maker.polygon({{2, 1, 1}, {2, 2, 1}, {2, 2, 2}, {2, 1, 2}}, 9);
  Block<D> block{high, map};
  block.marker = [=](int axis, const auto& corners) {
    const int wall = box_marker<D>(a, b, axis, corners);
    return wall ? 9 : box_marker<D>(low, high, axis, corners);
  };
  return {"loose_wall", maker.plc, BlockMesher<D>(block).run(maker.lattice)};
}

/// A block whose facets have all that a facet may have. Top: a frame (marker 6) round a square (8). Bottom: a loose
/// segment (11) and a loose point inside. Side x = 0: two rectangles with equal markers, which are one facet; side
/// x = 3: two with different ones (2, 12). A loose segment (13) in the volume. All input points are multiples of `u`
/// steps of the lattice: 3 of a slanted one, where they must be exact for facets to be planar.
inline Model<3> patchwork(const AffineMap<3>& map, int u) {
  PlcMaker<3> maker(map);
  const auto scaled = [u](std::vector<Lattice<3>> corners) {
    for (auto& c : corners)
      for (int& x : c) x *= u;
    return corners;
  };
  const auto polygon = [&](const std::vector<Lattice<3>>& corners, int marker) { maker.polygon(scaled(corners), marker); };
  const auto point = [&](int x, int y, int z) { return maker.point({u * x, u * y, u * z}); };
  polygon({{0, 0, 0}, {0, 1, 0}, {0, 1, 3}, {0, 0, 3}}, 1);
  polygon({{0, 1, 0}, {0, 3, 0}, {0, 3, 3}, {0, 1, 3}}, 1);
  polygon({{3, 0, 0}, {3, 1, 0}, {3, 1, 3}, {3, 0, 3}}, 2);
  polygon({{3, 1, 0}, {3, 3, 0}, {3, 3, 3}, {3, 1, 3}}, 12);
  polygon({{0, 0, 0}, {3, 0, 0}, {3, 0, 3}, {0, 0, 3}}, 3);
  polygon({{0, 3, 0}, {3, 3, 0}, {3, 3, 3}, {0, 3, 3}}, 4);
  const auto ring = [](int z) {
    return std::vector<Lattice<3>>{{0, 0, z}, {3, 0, z}, {3, 1, z}, {3, 3, z}, {0, 3, z}, {0, 1, z}};
  };
  auto& plc = maker.plc;
  polygon(ring(0), 5);
  plc.facets.back().polygons.push_back({point(1, 1, 0), point(2, 1, 0)});
  plc.facets.back().polygons.push_back({point(2, 2, 0)});
  plc.segments.push_back({{point(1, 1, 0), point(2, 1, 0)}, 11});
  const std::vector<Lattice<3>> square{{1, 1, 3}, {2, 1, 3}, {2, 2, 3}, {1, 2, 3}};
  polygon(ring(3), 6);
  auto& hole = plc.facets.back().polygons.emplace_back();
  for (const auto& c : scaled(square)) hole.push_back(maker.point(c));
  Point<3> seed;
  for (int k = 0; k < 3; ++k) seed[k] = map(scaled(square)[0])[k] / 2 + map(scaled(square)[2])[k] / 2;
  plc.facets.back().holes.push_back(seed);
  polygon(square, 8);
  plc.segments.push_back({{point(1, 1, 1), point(1, 1, 2)}, 13});
  Block<3> block{{3 * u, 3 * u, 3 * u}, map};
  block.marker = [u](int axis, const std::vector<Lattice<3>>& corners) {
    bool far = true, middle = true;
    for (const auto& c : corners) {
      far &= c[1] >= u;
      middle &= c[0] >= u && c[0] <= 2 * u && c[1] >= u && c[1] <= 2 * u;
    }
    const int marker = box_marker<3>({0, 0, 0}, {3 * u, 3 * u, 3 * u}, axis, corners);
    return marker == 2 && far ? 12 : marker == 6 && middle ? 8 : marker;
  };
  block.edge_marker = [u](const Lattice<3>& a, const Lattice<3>& b) {
    // The edge lies on the axis-parallel line through `from` within `u` steps of it.
    const auto on = [&](const Lattice<3>& from, int axis) {
      for (const auto& p : {a, b})
        for (int k = 0; k < 3; ++k)
          if (p[k] < from[k] || p[k] > from[k] + (k == axis ? u : 0)) return false;
      return true;
    };
    return on({u, u, 0}, 0) ? 11 : on({u, u, u}, 2) ? 13 : 0;
  };
  return {"patchwork", plc, BlockMesher<3>(block).run(maker.lattice)};
}

template <int D>
std::vector<Model<D>> all_models() {
  std::vector<Model<D>> models;
  for (const auto& map : {straight<D>(), slanted<D>()}) {
    models.push_back(solid_block<D>("block", 3, map));
    models.push_back(two_regions<D>(map));
    models.push_back(cavity<D>(map));
    models.push_back(loose_wall<D>(map));
  }
  if constexpr (D == 3) {
    models.push_back(patchwork(straight<3>(), 1));
    models.push_back(patchwork(slanted<3>(), 3));
  }
  return models;
}

}  // namespace pgdr::test
