// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies of unit cubes of a grid, with two triangles a square: wherever they meet, they have corners and edges in common.
#pragma once

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "pgdr/plc.hpp"

namespace pgdr::test {

using Cube = std::array<int, 3>;

/// A body of unit cubes.
using Body = std::set<Cube>;

inline Body box(const Cube& low, const Cube& high) {
  Body cubes;
  for (int x = low[0]; x < high[0]; ++x)
    for (int y = low[1]; y < high[1]; ++y)
      for (int z = low[2]; z < high[2]; ++z) cubes.insert({x, y, z});
  return cubes;
}

/// Two triangles of a unit square of the grid, whose normals look along the axis or against it.
inline void add_square(Plc<3>& plc, Cube low, int axis, bool along, std::uint32_t body, int marker = 0) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  std::array<std::uint32_t, 4> v;
  for (std::uint32_t k = 0; k < 4; ++k) {
    Cube x = low;
    x[static_cast<std::size_t>(i)] += k == 1 || k == 2;
    x[static_cast<std::size_t>(j)] += k >= 2;
    v[k] = static_cast<std::uint32_t>(plc.points.size());
    plc.points.push_back({{double(x[0]), double(x[1]), double(x[2])}});
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    plc.facets.push_back({{{a, along ? b : c, along ? c : b}}, {}, marker});
    plc.facet_bodies.push_back(body);
  };
  add(v[0], v[1], v[2]);
  add(v[0], v[2], v[3]);
}

inline void add_surface(Plc<3>& plc, const Body& cubes, std::uint32_t body, bool outwards = true) {
  for (const Cube& c : cubes)
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Cube next = c, low = c;
        next[static_cast<std::size_t>(axis)] += step;
        if (step == 1) low = next;
        if (!cubes.contains(next)) add_square(plc, low, axis, (step == 1) == outwards, body);
      }
}

inline Plc<3> surfaces(const std::vector<Body>& bodies) {
  Plc<3> plc;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) add_surface(plc, bodies[b], b);
  return plc;
}

inline Point<3> turned(const Point<3>& p) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Point<3> q{{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]}};
  return {{q[0], c * q[1] - s * q[2], s * q[1] + c * q[2]}};
}

inline Plc<3> turned(Plc<3> plc) {
  for (Point<3>& p : plc.points) p = turned(p);
  return plc;
}

}  // namespace pgdr::test
