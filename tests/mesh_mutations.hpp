// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Damage: each mutation makes one kind of error in a finished mesh and says which findings it may cause. A mutation
// returns false where the mesh has nothing that it could damage. Used to show that the checker catches each kind, on
// meshes made by hand and on refined ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pgdr/check.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test {

template <int D>
struct Mutation {
  using Kind = CheckFinding::Kind;
  std::string name;
  std::vector<Kind> expected;  ///< at least one of them must be found
  std::function<bool(OutputMesh<D>&)> apply;
};

template <int D>
auto& walls_of(OutputMesh<D>& mesh) {
  if constexpr (D == 2)
    return mesh.subsegments;
  else
    return mesh.subfacets;
}

template <int D>
Simplex<D> corners(const OutputMesh<D>& mesh, const std::array<std::uint32_t, D + 1>& cell) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
  return s;
}

/// What is known of a mesh's vertices from its constraints alone.
template <int D>
struct VertexKinds {
  std::vector<int> subsegments, subfacets;
  explicit VertexKinds(const OutputMesh<D>& mesh) : subsegments(mesh.points.size(), 0), subfacets(mesh.points.size(), 0) {
    for (const auto& s : mesh.subsegments)
      for (const auto v : s.vertices) ++subsegments[v];
    for (const auto& s : mesh.subfacets)
      for (const auto v : s.vertices) ++subfacets[v];
  }
  bool in_volume(std::size_t v) const { return !subsegments[v] && !subfacets[v]; }
  bool on_facet(std::size_t v) const { return !subsegments[v] && subfacets[v]; }
};

/// The first vertex for which `wanted(v)`; false if there is none.
template <int D, class Wanted>
bool first_vertex(const OutputMesh<D>& mesh, Wanted wanted, std::size_t& v) {
  for (v = 0; v < mesh.points.size(); ++v)
    if (wanted(v)) return true;
  return false;
}

/// Moves a point by k ulps of the mesh's largest coordinate along an axis.
template <int D>
void nudge(OutputMesh<D>& mesh, std::size_t v, int axis, double k) {
  double magnitude = 0;
  for (const auto& p : mesh.points)
    for (const double x : p.x) magnitude = std::max(magnitude, std::abs(x));
  mesh.points[v][axis] += k * magnitude * 0x1p-52;
}

/// The two cells at each face, by its sorted vertices.
template <int D>
std::map<std::array<std::uint32_t, D>, std::vector<std::size_t>> cells_by_face(const OutputMesh<D>& mesh) {
  std::map<std::array<std::uint32_t, D>, std::vector<std::size_t>> faces;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; i <= D; ++i) {
      std::array<std::uint32_t, D> face;
      for (int j = 0, n = 0; j <= D; ++j)
        if (j != i) face[n++] = mesh.cells[c][j];
      std::sort(face.begin(), face.end());
      faces[face].push_back(c);
    }
  return faces;
}

template <int D>
std::set<std::array<std::uint32_t, D>> wall_set(OutputMesh<D> mesh) {
  std::set<std::array<std::uint32_t, D>> set;
  for (auto& wall : walls_of(mesh)) {
    std::sort(wall.vertices.begin(), wall.vertices.end());
    set.insert(wall.vertices);
  }
  return set;
}

/// Replaces two cells at an unconstrained face by the D cells round the edge between their apexes (2-2 flip in 2D, 2-3
/// flip in 3D), where all are positive and an apex of the old ones was outside the other's sphere by more than
/// rounding.
template <int D>
bool flip_to_non_delaunay(OutputMesh<D>& mesh) {
  const auto walls = wall_set(mesh);
  for (const auto& [face, cells] : cells_by_face(mesh)) {
    if (cells.size() != 2 || walls.contains(face)) continue;
    std::array<std::uint32_t, 2> apex{};
    for (int k = 0; k < 2; ++k)
      for (const auto v : mesh.cells[cells[k]])
        if (std::find(face.begin(), face.end(), v) == face.end()) apex[k] = v;
    const auto ball = circumsphere<D>(corners(mesh, mesh.cells[cells[0]]));
    if (squared_distance(mesh.points[apex[1]], ball.center) < ball.squared_radius * (1 + 0x1p-10)) continue;
    // Each vertex of the face in turn is replaced by the other apex in the first cell.
    std::vector<std::array<std::uint32_t, D + 1>> fresh;
    for (const auto v : face) {
      auto cell = mesh.cells[cells[0]];
      *std::find(cell.begin(), cell.end(), v) = apex[1];
      if (orient<D>(corners(mesh, cell)) == Sign::positive) fresh.push_back(cell);
    }
    if (fresh.size() != D) continue;
    const double label = mesh.regions.empty() ? 0 : mesh.regions[cells[0]];
    mesh.cells[cells[0]] = fresh[0];
    mesh.cells[cells[1]] = fresh[1];
    for (std::size_t i = 2; i < fresh.size(); ++i) {
      mesh.cells.push_back(fresh[i]);
      if (!mesh.regions.empty()) mesh.regions.push_back(label);
    }
    return true;
  }
  return false;
}

/// Mutations of cells and points that need no input to be found.
template <int D>
std::vector<Mutation<D>> soundness_mutations() {
  using K = CheckFinding::Kind;
  std::vector<Mutation<D>> list;
  list.push_back({"swap two vertices of a cell", {K::inverted_cell}, [](auto& m) {
                    std::swap(m.cells[0][0], m.cells[0][1]);
                    return true;
                  }});
  list.push_back({"delete a cell", {K::bad_link, K::stray_constraint}, [](auto& m) {
                    m.cells.erase(m.cells.begin() + static_cast<long>(m.cells.size() / 2));
                    if (!m.regions.empty()) m.regions.pop_back();
                    return true;
                  }});
  list.push_back({"duplicate a cell", {K::bad_link}, [](auto& m) {
                    m.cells.push_back(m.cells[m.cells.size() / 2]);
                    if (!m.regions.empty()) m.regions.push_back(m.regions[(m.cells.size() - 1) / 2]);
                    return true;
                  }});
  list.push_back({"a vertex that does not exist", {K::bad_index}, [](auto& m) {
                    m.cells[1][0] = static_cast<std::uint32_t>(m.points.size());
                    return true;
                  }});
  list.push_back({"a coordinate that is not a number", {K::not_finite}, [](auto& m) {
                    m.points.back()[0] = std::numeric_limits<double>::quiet_NaN();
                    return true;
                  }});
  list.push_back({"a vertex twice in a cell", {K::repeated_vertex}, [](auto& m) {
                    m.cells[2][1] = m.cells[2][0];
                    return true;
                  }});
  list.push_back({"two points at one place", {K::duplicate_point}, [](auto& m) {
                    const auto& cell = m.cells[m.cells.size() / 2];
                    m.points[cell[1]] = m.points[cell[0]];
                    return true;
                  }});
  list.push_back({"merge two vertices", {K::repeated_vertex}, [](auto& m) {
                    const auto merged = m.cells[m.cells.size() / 2];
                    for (auto& cell : m.cells) std::replace(cell.begin(), cell.end(), merged[1], merged[0]);
                    return true;
                  }});
  list.push_back({"a copy of a point that is used by one cell", {K::duplicate_point}, [](auto& m) {
                    m.points.push_back(m.points[m.cells[0][0]]);
                    if (!m.point_markers.empty()) m.point_markers.push_back(0);
                    m.cells[0][0] = static_cast<std::uint32_t>(m.points.size() - 1);
                    return true;
                  }});
  list.push_back({"move a volume vertex through a face", {K::inverted_cell}, [](auto& m) {
                    const VertexKinds<D> kinds(m);
                    std::size_t v;
                    const auto inner = [&](auto u) { return kinds.in_volume(u) && u >= m.input_points; };
                    if (!first_vertex(m, inner, v)) return false;
                    const auto cell = *std::find_if(m.cells.begin(), m.cells.end(),
                                                    [&](const auto& c) { return std::find(c.begin(), c.end(), v) != c.end(); });
                    auto& p = m.points[v];  // its mirror image in the centroid of the opposite face
                    for (int i = 0; i < D; ++i) {
                      double sum = 0;
                      for (const auto u : cell)
                        if (u != v) sum += m.points[u][i];
                      p[i] = 2 * sum / D - p[i];
                    }
                    return true;
                  }});
  list.push_back({"flip a face", {K::not_delaunay}, [](auto& m) { return flip_to_non_delaunay(m); }});
  list.push_back({"drop a wall on the hull", {K::bad_link, K::segment_not_conforming}, [](auto& m) {
                    const auto faces = cells_by_face(m);
                    auto& walls = walls_of(m);
                    for (std::size_t w = 0; w < walls.size(); ++w) {
                      auto key = walls[w].vertices;
                      std::sort(key.begin(), key.end());
                      if (faces.at(key).size() != 1) continue;
                      walls.erase(walls.begin() + static_cast<long>(w));
                      return true;
                    }
                    return false;
                  }});
  list.push_back({"a wall that is no face", {K::stray_constraint}, [](auto& m) {
                    auto wall = walls_of(m)[0];
                    const auto walls = wall_set(m);
                    const auto faces = cells_by_face(m);
                    for (std::uint32_t v = 0; v < m.points.size(); ++v) {
                      wall.vertices[0] = v;
                      auto key = wall.vertices;
                      std::sort(key.begin(), key.end());
                      if (std::adjacent_find(key.begin(), key.end()) != key.end() || faces.contains(key)) continue;
                      walls_of(m).push_back(wall);
                      return true;
                    }
                    return false;
                  }});
  list.push_back({"a wall listed twice", {K::stray_constraint}, [](auto& m) {
                    walls_of(m).push_back(walls_of(m)[0]);
                    return true;
                  }});
  list.push_back({"a label too many", {K::bad_index}, [](auto& m) {
                    m.regions.assign(m.cells.size() + 1, 0);
                    return true;
                  }});
  list.push_back({"another label in the middle of a region", {K::wrong_region}, [](auto& m) {
                    m.regions.resize(m.cells.size(), 0);
                    m.regions[m.cells.size() / 2] += 1;
                    return true;
                  }});
  return list;
}

/// Mutations that only a comparison with the input shows.
template <int D>
std::vector<Mutation<D>> conformity_mutations() {
  using K = CheckFinding::Kind;
  std::vector<Mutation<D>> list;
  list.push_back({"change the marker of a wall", {K::wrong_marker}, [](auto& m) {
                    walls_of(m).back().marker += 1;
                    return true;
                  }});
  list.push_back({"change the marker of a subsegment", {K::wrong_marker}, [](auto& m) {
                    m.subsegments[0].marker += 1;
                    return true;
                  }});
  list.push_back({"change the marker of an input point", {K::wrong_marker}, [](auto& m) {
                    m.point_markers.resize(m.points.size(), 0);
                    m.point_markers[0] += 77;
                    return true;
                  }});
  list.push_back({"drop a subsegment", {K::segment_not_conforming}, [](auto& m) {
                    m.subsegments.erase(m.subsegments.begin() + static_cast<long>(m.subsegments.size() / 2));
                    return true;
                  }});
  list.push_back({"turn all labels into others", {K::wrong_region}, [](auto& m) {
                    for (double& r : m.regions) r += 10;
                    return !m.regions.empty();
                  }});
  list.push_back({"forget the labels", {K::wrong_region}, [](auto& m) {
                    const bool any = !m.regions.empty();
                    m.regions.clear();
                    return any;
                  }});
  list.push_back({"move an input point by an ulp", {K::missing_input_point}, [](auto& m) {
                    m.points[0][0] = std::nextafter(m.points[0][0], 1e300);
                    return true;
                  }});
  list.push_back({"a loose point", {K::unreferenced_point}, [](auto& m) {
                    auto p = m.points[0];
                    for (int i = 0; i < D; ++i) p[i] += 0.1234375;
                    m.points.push_back(p);
                    if (!m.point_markers.empty()) m.point_markers.push_back(0);
                    return true;
                  }});
  list.push_back({"shift a point of a segment by 100 ulps", {K::segment_not_conforming}, [](auto& m) {
                    const VertexKinds<D> kinds(m);
                    std::size_t v;
                    const auto steiner = [&](auto u) { return u >= m.input_points && kinds.subsegments[u] == 2; };
                    if (!first_vertex(m, steiner, v)) return false;
                    for (int i = 0; i < D; ++i) nudge(m, v, i, i == 0 ? 100 : 160);
                    return true;
                  }});
  if constexpr (D == 3) {
    list.push_back({"shift a point of a facet by 100 ulps", {K::facet_not_conforming, K::stray_constraint}, [](auto& m) {
                      const VertexKinds<D> kinds(m);
                      std::size_t v;
                      if (!first_vertex(
                              m, [&](auto u) { return u >= m.input_points && kinds.on_facet(u); }, v))
                        return false;
                      for (int i = 0; i < D; ++i) nudge(m, v, i, 100 + 30 * i);
                      return true;
                    }});
    list.push_back({"a face inside a region listed as a subfacet", {K::facet_not_conforming, K::stray_constraint}, [](auto& m) {
                      const auto walls = wall_set(m);
                      for (const auto& [face, cells] : cells_by_face(m))
                        if (cells.size() == 2 && !walls.contains(face)) {
                          m.subfacets.push_back({face, 0});
                          return true;
                        }
                      return false;
                    }});
    list.push_back({"an inner edge listed as a subsegment", {K::stray_constraint}, [](auto& m) {
                      std::set<std::array<std::uint32_t, 2>> edges;
                      for (const auto& s : m.subsegments)
                        edges.insert({std::min(s.vertices[0], s.vertices[1]), std::max(s.vertices[0], s.vertices[1])});
                      for (const auto& cell : m.cells) {
                        const std::array<std::uint32_t, 2> e{std::min(cell[0], cell[1]), std::max(cell[0], cell[1])};
                        if (edges.contains(e)) continue;
                        m.subsegments.push_back({e, 0});
                        return true;
                      }
                      return false;
                    }});
  } else {
    list.push_back({"an inner edge listed as a subsegment", {K::stray_constraint}, [](auto& m) {
                      const auto walls = wall_set(m);
                      for (const auto& [face, cells] : cells_by_face(m))
                        if (cells.size() == 2 && !walls.contains(face)) {
                          m.subsegments.push_back({face, 0});
                          return true;
                        }
                      return false;
                    }});
  }
  list.push_back({"drop all walls inside", {K::segment_not_conforming, K::facet_not_conforming}, [](auto& m) {
                    const auto faces = cells_by_face(m);
                    const auto inside = [&](const auto& wall) {
                      auto key = wall.vertices;
                      std::sort(key.begin(), key.end());
                      return faces.at(key).size() == 2;
                    };
                    return std::erase_if(walls_of(m), inside) > 0;
                  }});
  list.push_back({"leave out a region", {K::wrong_volume}, [](auto& m) {
                    if (m.regions.empty()) return false;
                    const double gone = m.regions[0];
                    for (std::size_t c = m.cells.size(); c-- > 0;)
                      if (m.regions[c] == gone) {
                        m.cells.erase(m.cells.begin() + static_cast<long>(c));
                        m.regions.erase(m.regions.begin() + static_cast<long>(c));
                      }
                    const auto faces = cells_by_face(m);
                    std::erase_if(walls_of(m), [&](const auto& wall) {
                      auto key = wall.vertices;
                      std::sort(key.begin(), key.end());
                      return !faces.contains(key);
                    });
                    return !m.cells.empty();
                  }});
  return list;
}

}  // namespace pgdr::test
