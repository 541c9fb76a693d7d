// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Steiner vertices go in anywhere and are taken out again by move: the mesh stays whole, and covers the same.
#include "change/vertex_move.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/cavity.hpp"
#include "cavity/delaunay.hpp"
#include "change/flips.hpp"
#include "input/entities.hpp"
#include "mesh/locally_delaunay.hpp"
#include "mesh/whole.hpp"
#include "model_plcs.hpp"
#include "numbers/vectors.hpp"
#include "space/corner_means.hpp"

namespace pgdr::test_change_local {

/// Volumes of regions, areas of facets and lengths of segments.
struct Measures {
  std::map<int, double> volumes;
  std::map<EntityId, double> areas;
  std::map<EntityId, double> lengths;
};

struct Model {
  Domain<3> domain;
  Mesh<3> mesh;
  Mesh<3>::Pools pools = mesh.make_pools();
  std::mt19937_64 random{1};

  explicit Model(const Plc<3>& plc) : domain(plc) {
    Delaunay<3> delaunay(mesh, pools);
    delaunay.build(domain.points());
    RecoveryCounts counts;
    recover_boundary<3>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
    std::vector<Diagnostic> warnings;
    carve<3>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
  }

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

  /// Takes some vertex of the cell out; false if it stays.
  bool take_out_at(CellId c) {
    VertexMove move(mesh, domain);
    if (move.collect(mesh.cell(c).vertices[below(4)], c, 1000) != VertexMove::Status::ok) return false;
    const std::vector<VertexId> targets = move.targets();
    if (targets.empty()) return false;
    move.aim(targets[below(targets.size())]);
    if (!move.is_valid()) return false;
    move.commit(pools);
    return true;
  }

  /// Moves some vertex of the cell, on its entity, a part of the way to a neighbour there; false if it stays.
  bool move_at(CellId c) {
    VertexMove move(mesh, domain);
    const VertexId v = mesh.cell(c).vertices[below(4)];
    if (move.collect(v, c, 1000) != VertexMove::Status::ok) return false;
    const std::vector<VertexId> targets = move.targets();
    if (targets.empty()) return false;
    const Point3 &from = mesh.point(v), &to = mesh.point(targets[below(targets.size())]);
    const double part = std::uniform_real_distribution<double>(-0.5, 0.9)(random);
    Point3 x;
    for (int k = 0; k < 3; ++k) x[k] = from[k] + part * (to[k] - from[k]);
    const Home home = mesh.vertex(v).home;
    if (home.kind() == EntityKind::facet) x = point_on_facet(domain, home.id(), x);
    if (home.kind() == EntityKind::segment)
      x = point_on_segment<3>(domain, home.id(), segment_parameter<3>(domain, home.id(), x));
    move.aim(x);
    if (!move.is_valid()) return false;
    move.commit(pools);
    return true;
  }

  /// Makes one of the flips that there are at the cell; false if it may not be.
  bool flip_at(CellId c) {
    LocalFlips<3> flips(mesh, domain);
    std::vector<LocalFlips<3>::Flip> all;
    std::vector<CellId> seen;
    flips.find_flips(c, all, seen);
    if (all.empty()) return false;
    const auto& flip = all[below(all.size())];
    const auto violations = flips.violations_after(flip);
    if (!violations) return false;
    const auto inner = std::count_if(violations->begin(), violations->end(), [](const auto& v) { return v.inner; });
    const std::size_t before = flips.violations_before(flip), everywhere = violating_faces();
    flips.make(pools, flip);
    std::size_t found = 0;
    for (const CellId made : flips.new_cells())
      for (int f = 0; f < 4; ++f) found += violates(mesh, made, f);
    EXPECT_EQ(found, violations->size());
    EXPECT_EQ(violating_faces() - everywhere, violations->size() - inner / 2 - before);
    return true;
  }

  /// That are not locally Delaunay.
  std::size_t violating_faces() const {
    std::size_t sides = 0;
    for (const CellId c : cells())
      for (int f = 0; f < 4; ++f) sides += violates(mesh, c, f);
    EXPECT_EQ(sides % 2, 0u);
    return sides / 2;
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
  Point3 mean(CellId c, unsigned corners) const { return detail::mean_of_corners<3>(mesh.simplex(c), corners); }
};

template <class Map>
void expect_near(const Map& a, const Map& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [id, x] : a) {
    ASSERT_TRUE(b.contains(id));
    EXPECT_NEAR(x, b.at(id), 1e-9 * x) << id;
  }
}

void expect_same(const Measures& a, const Measures& b) {
  expect_near(a.volumes, b.volumes);
  expect_near(a.areas, b.areas);
  expect_near(a.lengths, b.lengths);
}

class LocalChanges : public testing::TestWithParam<std::pair<const char*, Plc<3>>> {};

TEST_P(LocalChanges, LeaveTheMeshWhole) {
  Model model(GetParam().second);
  const Measures before = model.measures();
  const std::size_t recovered = model.steiner_vertices();
  for (int n = 0; n < 900; ++n) model.insert_anywhere(n);
  const std::size_t inserted = model.steiner_vertices();
  ASSERT_GT(inserted, recovered + 200);
  ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  expect_same(before, model.measures());

  std::size_t moves = 0, flips = 0;
  for (int n = 0; n < 3000; ++n) {
    const std::vector<CellId> all = model.cells();
    const CellId c = all[model.below(all.size())];
    (n % 2 ? moves : flips) += n % 2 ? model.move_at(c) : model.flip_at(c);
    if (n % 100 != 0) continue;
    ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  }
  EXPECT_GT(moves, 300u);
  EXPECT_GT(flips, 100u);
  EXPECT_EQ(model.steiner_vertices(), inserted);
  ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  expect_same(before, model.measures());

  std::size_t taken_out = 0;
  for (int n = 0; n < 20000; ++n) {
    const std::vector<CellId> all = model.cells();
    if (!model.take_out_at(all[model.below(all.size())])) continue;
    if (++taken_out % 20 != 0) continue;
    ASSERT_TRUE(detail::is_whole<3>(model.mesh));
    ASSERT_EQ(model.steiner_vertices(), inserted - taken_out);
  }
  EXPECT_LE(model.steiner_vertices(), inserted / 10);
  EXPECT_EQ(model.steiner_vertices(), inserted - taken_out);
  ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  expect_same(before, model.measures());
}

INSTANTIATE_TEST_SUITE_P(Models, LocalChanges,
                         testing::Values(std::pair{"cube", test::cube()}, std::pair{"turned_cube", test::turned(test::cube())},
                                         std::pair{"two_regions", test::two_region_cube()},
                                         std::pair{"turned_two_regions", test::turned(test::two_region_cube())},
                                         std::pair{"marked_facet", test::cube_with_marked_facet()},
                                         std::pair{"plate_with_hole", test::turned(test::plate_with_hole())}),
                         [](const auto& info) { return std::string(info.param.first); });

TEST(VertexMove, KeepsTheInput) {
  Model model(test::cube());
  VertexMove move(model.mesh, model.domain);
  for (const CellId c : model.cells())
    for (const VertexId v : model.mesh.cell(c).vertices) {
      const bool of_input = model.mesh.vertex(v).home.kind() == EntityKind::vertex;
      EXPECT_EQ(move.collect(v, c, 1000), of_input ? VertexMove::Status::stays : VertexMove::Status::ok);
    }
}

TEST(VertexMove, LeavesLargeStarsAlone) {
  Model model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  VertexMove move(model.mesh, model.domain);
  for (const CellId c : model.cells())
    for (const VertexId v : model.mesh.cell(c).vertices) {
      const auto status = move.collect(v, c, 12);
      EXPECT_LE(move.cells().size(), 12u);
      if (status == VertexMove::Status::stays) continue;
      const std::size_t all = move.cells().size();
      EXPECT_EQ(move.collect(v, c, all), VertexMove::Status::ok);
      EXPECT_EQ(move.collect(v, c, all - 1), VertexMove::Status::stays);
    }
}

}  // namespace pgdr::test_change_local
