// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A carved mesh with Steiner vertices anywhere, for tests of local changes, and what these have to keep.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "carved_meshes.hpp"
#include "cavity/cavity.hpp"
#include "input/entities.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::test {

/// Volumes of regions, areas of facets and lengths of segments.
struct Measures {
  std::map<int, double> volumes;
  std::map<EntityId, double> areas;
  std::map<EntityId, double> lengths;
};

/// A carved mesh, and Steiner vertices that go in anywhere.
struct ChangedMesh {
  Domain<3> domain;
  Mesh<3> mesh;
  Mesh<3>::Pools pools = mesh.make_pools();
  std::mt19937_64 random{1};

  explicit ChangedMesh(const Plc<3>& plc) : domain(plc) { carve_mesh(domain, mesh, pools); }

  std::vector<CellId> cells() const {
    std::vector<CellId> all;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (mesh.alive(CellId{i})) all.push_back(CellId{i});
    return all;
  }
  std::size_t below(std::size_t n) { return random() % n; }

  /// Into some cell, subfacet or subsegment, by turns.
  void insert_anywhere(int n) {
    const std::vector<CellId> all = cells();
    const CellId c = all[below(all.size())];
    const auto* k = mesh.constraints(c);
    const int at = static_cast<int>(below(6));
    Cavity<3> cavity(mesh, &domain);
    const auto goes_in = [&](Cavity<3>::Status status) {
      using Status = Cavity<3>::Status;
      return status == Status::ok && cavity.make_star_shaped() == Status::ok && cavity.keep_entities() == Status::ok;
    };
    if (n % 3 == 0) {
      if (goes_in(cavity.collect(mean(c, 15), c))) cavity.commit(pools, {EntityKind::volume, 0}, 1);
    } else if (n % 3 == 1 && at < 4 && k && (k->faces >> at & 1)) {
      const EntityId facet = k->face_entity[at];
      const Point3 x = point_on_facet(domain, facet, mean(c, 15u & ~(1u << at)));
      if (goes_in(cavity.collect_on_face(x, c, at))) cavity.commit(pools, {EntityKind::facet, facet}, 1);
    } else if (n % 3 == 2 && k && (k->edges >> at & 1)) {
      const EntityId segment = k->edge_entity[at];
      const auto [i, j] = edge_ends[at];
      const Point3 x = point_on_segment<3>(domain, segment, segment_parameter<3>(domain, segment, mean(c, 1u << i | 1u << j)));
      if (goes_in(cavity.collect_on_edge(x, c, at))) cavity.commit(pools, {EntityKind::segment, segment}, 1);
    }
  }

  std::size_t steiner_vertices() const {
    std::map<std::uint32_t, bool> seen;
    for (const CellId c : cells())
      for (const VertexId v : mesh.cell(c).vertices)
        if (mesh.vertex(v).home.kind() != EntityKind::vertex) seen[index(v)] = true;
    return seen.size();
  }

  Measures measures() const {
    Measures m;
    std::map<std::array<std::uint32_t, 2>, EntityId> edges;
    for (const CellId c : cells()) {
      const Simplex<3> s = mesh.simplex(c);
      m.volumes[mesh.region(c)] += volume(s);
      const auto* k = mesh.constraints(c);
      for (int f = 0; f < 4 && k; ++f)
        if (k->faces >> f & 1) {
          const double share = mesh.cell(c).links[f] ? 0.5 : 1;
          m.areas[k->face_entity[f]] += share * area(s[f == 0], s[f < 2 ? 2 : 1], s[f == 3 ? 2 : 3]);
        }
      for (int e = 0; e < 6 && k; ++e) {
        const auto [i, j] = edge_ends[e];
        const std::uint32_t a = index(mesh.cell(c).vertices[i]), b = index(mesh.cell(c).vertices[j]);
        if ((k->edges >> e & 1) && edges.insert({{std::min(a, b), std::max(a, b)}, k->edge_entity[e]}).second)
          m.lengths[k->edge_entity[e]] += std::sqrt(squared_distance(s[i], s[j]));
      }
    }
    return m;
  }

 private:
  static double area(const Point3& a, const Point3& b, const Point3& c) {
    const auto normal = detail::cross(detail::difference(b, a), detail::difference(c, a));
    return std::sqrt(detail::dot(normal, normal)) / 2;
  }
  static double volume(const Simplex<3>& s) {
    const auto normal = detail::cross(detail::difference(s[1], s[0]), detail::difference(s[2], s[0]));
    return std::abs(detail::dot(normal, detail::difference(s[3], s[0]))) / 6;
  }
  /// Of the corners whose bits are set.
  Point3 mean(CellId c, unsigned corners) const {
    Point3 x{};
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) x[k] += (corners >> i & 1) != 0 ? mesh.simplex(c)[i][k] / std::popcount(corners) : 0;
    return x;
  }
};

template <class Map>
void expect_near(const Map& a, const Map& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [id, x] : a) {
    ASSERT_TRUE(b.contains(id));
    EXPECT_NEAR(x, b.at(id), 1e-9 * x) << id;
  }
}

inline void expect_same(const Measures& a, const Measures& b) {
  expect_near(a.volumes, b.volumes);
  expect_near(a.areas, b.areas);
  expect_near(a.lengths, b.lengths);
}

}  // namespace pgdr::test
