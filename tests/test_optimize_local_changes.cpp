// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Local changes anywhere: faces and edges are flipped, vertices move and are contracted, edges are split. The mesh stays whole
// and covers the same, and what is undone has never been.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "change/edge_ring.hpp"
#include "change/facet_flip.hpp"
#include "change/transaction.hpp"
#include "changed_meshes.hpp"
#include "mesh/whole.hpp"
#include "optimize/vertex_star.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_optimize_local_changes {

using test::expect_same;
using test::Measures;

/// All that a mesh is, slot by slot.
struct Snapshot {
  struct Cell {
    std::array<VertexId, 4> vertices;
    std::array<Link, 4> links;
    std::uint16_t birth, region;
    std::uint8_t faces, edges;
    std::array<EntityId, 4> facets;
    std::array<EntityId, 6> segments;
    bool operator==(const Cell&) const = default;
  };
  std::map<std::uint32_t, Cell> cells;
  std::vector<std::uint32_t> versions;
  bool operator==(const Snapshot&) const = default;

  explicit Snapshot(const Mesh<3>& mesh, std::uint32_t vertices) {
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
      const CellId c{i};
      if (!mesh.alive(c)) continue;
      Cell cell{mesh.cell(c).vertices, mesh.cell(c).links, mesh.birth(c), mesh.region(c), 0, 0, {}, {}};
      if (const auto* k = mesh.constraints(c)) {
        cell.faces = k->faces;
        cell.edges = k->edges;
        for (int f = 0; f < 4; ++f) cell.facets[f] = k->has_face(f) ? k->face_entity[f] : no_entity;
        for (int e = 0; e < 6; ++e) cell.segments[e] = k->has_edge(e) ? k->edge_entity[e] : no_entity;
      }
      cells[i] = cell;
    }
    for (std::uint32_t v = 0; v < vertices; ++v) versions.push_back(mesh.note(VertexId{v}).version);
  }
};

enum Kind { face_flip, edge_flip, move, contraction, split, kinds };

/// Proposes changes anywhere, and makes those that are valid.
struct Model : test::ChangedMesh {
  Replacer<3> replacer{mesh};
  Transaction transaction{mesh, replacer};
  EdgeRing ring;
  VertexStar star;
  Replacement<3> r;
  VertexId fresh = no_vertex;                      ///< that a proposal needs
  std::array<std::size_t, kinds> made{}, unfit{};  ///< valid cells, and those of them that do not fit, by kind
  std::size_t with_walls = 0;

  using ChangedMesh::ChangedMesh;

  /// Every other time one with subfacets.
  CellId some_cell() {
    const bool at_facet = below(2) == 0;
    const auto& out = transaction.removed();  // which are in their slots, but no part of the mesh
    while (true) {
      const CellId c{static_cast<std::uint32_t>(below(mesh.cell_bound()))};
      if (!mesh.alive(c) || std::find(out.begin(), out.end(), c) != out.end()) continue;
      if (!at_facet || (mesh.constraints(c) && mesh.constraints(c)->faces != 0)) return c;
    }
  }
  bool propose(Kind kind, CellId c) {
    r.clear();
    fresh = no_vertex;
    switch (kind) {
      case face_flip: return propose_face_flip(c, static_cast<int>(below(4)));
      case edge_flip: return propose_edge_flip(c, static_cast<int>(below(6)));
      case move: return propose_move(c, mesh.cell(c).vertices[below(4)]);
      case contraction: return propose_contraction(c, mesh.cell(c).vertices[below(4)]);
      case split: return propose_split(c, static_cast<int>(below(6)));
      default: return false;
    }
  }
  bool propose_face_flip(CellId c, int face) {
    const Link link = mesh.cell(c).links[face];
    if (!link || mesh.constrained(c, face)) return false;
    r.old = {c, link.cell()};
    for (int i = 0; i < 4; ++i) {
      if (i == face) continue;
      auto v = mesh.cell(c).vertices;
      v[i] = mesh.cell(link.cell()).vertices[link.face()];
      r.cells.push_back({v, mesh.region(c)});
    }
    return true;
  }
  /// A fan about any vertex, on each side.
  bool propose_edge_flip(CellId c, int edge) {
    if (collect_ring(mesh, nullptr, c, edge, 30, ring) != Reach::ok) return false;
    const auto sides = sides_without_edge(mesh, domain, ring);
    r.old = ring.cells;
    for (const RingSide& side : sides) {
      const bool whole = ring.closed && side.count == ring.cells.size();
      const std::size_t n = side.count + (whole ? 0 : 1), hub = below(n);
      if (n < 3) return false;  // a flat cell: those beside it would get walls
      for (std::size_t k = 1; k + 1 < n; ++k) {
        std::array at{hub, (hub + k) % n, (hub + k + 1) % n};
        std::sort(at.begin(), at.end());
        std::array<VertexId, 3> v;
        for (int i = 0; i < 3; ++i) v[i] = ring.vertex(side.first + at[i]);
        const std::uint16_t region = mesh.region(ring.cell(side.first));
        r.cells.push_back({{v[0], v[1], v[2], ring.ends[1]}, region});
        r.cells.push_back({{v[2], v[1], v[0], ring.ends[0]}, region});
      }
    }
    std::vector<VertexId> tips;
    for (std::size_t i = 0; i < ring.walls.size(); ++i)
      if (ring.walls[i] != no_entity) tips.push_back(ring.vertices[i]);
    if (!sides.empty() && !tips.empty()) {
      const auto facet = *std::find_if(ring.walls.begin(), ring.walls.end(), [](EntityId w) { return w != no_entity; });
      for (const VertexId end : ring.ends) r.walls.push_back({{tips[0], tips[1], end}, facet});
    }
    return !sides.empty();
  }
  Point3 on_entity(Home home, const Point3& x) const {
    if (home.kind() == EntityKind::facet) return point_on_facet(domain, home.id(), x);
    if (home.kind() == EntityKind::segment)
      return point_on_segment<3>(domain, home.id(), segment_parameter<3>(domain, home.id(), x));
    return x;
  }
  Point3 between(VertexId a, VertexId b, double part) const {
    Point3 x;
    for (int k = 0; k < 3; ++k) x[k] = mesh.point(a)[k] + part * (mesh.point(b)[k] - mesh.point(a)[k]);
    return x;
  }
  /// A part of the way to a neighbour on its own entity.
  bool propose_move(CellId c, VertexId v) {
    if (collect_star(mesh, nullptr, v, c, 1000, star) != Reach::ok) return false;
    const auto targets = contraction_targets(mesh, star);
    if (targets.empty()) return false;
    const double part = std::uniform_real_distribution<double>(-0.5, 0.9)(random);
    fresh = mesh.new_vertex(pools, on_entity(star.home, between(v, targets[below(targets.size())], part)), star.home, 0);
    return substitute(mesh, domain, star, fresh, r);
  }
  bool propose_contraction(CellId c, VertexId v) {
    if (collect_star(mesh, nullptr, v, c, 1000, star) != Reach::ok) return false;
    const auto targets = contraction_targets(mesh, star);
    return !targets.empty() && substitute(mesh, domain, star, targets[below(targets.size())], r);
  }
  bool propose_split(CellId c, int edge) {
    if (collect_ring(mesh, nullptr, c, edge, 60, ring) != Reach::ok) return false;
    const auto* pinched = mesh.pinched_edges();
    if (ring.segment != no_entity && pinched && pinched->has(ring.segment)) return false;
    Home home{EntityKind::volume, 0};
    for (const EntityId wall : ring.walls) {
      if (wall == no_entity || ring.segment != no_entity) continue;
      if (home.kind() == EntityKind::facet && home.id() != wall) return false;
      home = Home(EntityKind::facet, wall);
    }
    if (ring.segment != no_entity) home = Home(EntityKind::segment, ring.segment);
    const auto [a, b] = ring.ends;
    fresh = mesh.new_vertex(pools, on_entity(home, between(a, b, 0.5)), home, 0);
    r.old = ring.cells;
    for (std::size_t i = 0; i < ring.cells.size(); ++i) {
      const std::uint16_t region = mesh.region(ring.cells[i]);
      r.cells.push_back({{a, fresh, ring.vertices[i], ring.vertex(i + 1)}, region});
      r.cells.push_back({{fresh, b, ring.vertices[i], ring.vertex(i + 1)}, region});
    }
    for (std::size_t i = 0; i < ring.walls.size(); ++i) {
      if (ring.walls[i] == no_entity) continue;
      r.walls.push_back({{a, fresh, ring.vertices[i]}, ring.walls[i]});
      r.walls.push_back({{fresh, b, ring.vertices[i]}, ring.walls[i]});
    }
    if (ring.segment != no_entity) r.subsegments = {{{a, fresh}, ring.segment}, {{fresh, b}, ring.segment}};
    return true;
  }
  /// Are all cells positive, and none flat but for rounding?
  bool is_valid() const {
    const auto facets = facets_at(mesh, r.old);
    return std::all_of(r.cells.begin(), r.cells.end(), [&](const auto& cell) {
      std::array<Home, 4> homes;
      for (int i = 0; i < 4; ++i) homes[i] = mesh.vertex(cell.vertices[i]).home;
      return orient<3>(mesh.points(cell.vertices)) == Sign::positive && !lie_on_one(domain, homes, facets);
    });
  }
  bool change(Kind kind, CellId c) {
    const bool good = propose(kind, c) && is_valid();
    const bool fits = good && replacer.fits(r);
    unfit[kind] += good && !fits;
    if (!fits) {
      if (fresh != no_vertex) pools.vertices.give(index(fresh));
      return false;
    }
    if (fresh != no_vertex) transaction.add_vertex(fresh);
    transaction.commit(pools, r);
    ++made[kind];
    with_walls += !r.walls.empty();
    return true;
  }
};

class LocalChanges : public testing::TestWithParam<std::pair<const char*, Plc<3>>> {};

TEST_P(LocalChanges, LeaveTheMeshWhole) {
  Model model(GetParam().second);
  const Measures before = model.measures();
  const std::size_t recovered = model.steiner_vertices();
  for (int n = 0; n < 900; ++n) model.insert_anywhere(n);
  ASSERT_GT(model.steiner_vertices(), recovered + 200);
  for (int n = 0; n < 6000; ++n) {
    const bool grows = model.mesh.pinched_edges() ? n < 400 : n < 800;
    const Kind kind = static_cast<Kind>(model.below(grows ? kinds : contraction));
    model.change(kind == contraction && grows ? split : kind, model.some_cell());
    if (n % 100 != 0) continue;
    ASSERT_TRUE(detail::is_whole<3>(model.mesh)) << n;
  }
  EXPECT_GT(model.made[face_flip], 100u);
  EXPECT_GT(model.made[edge_flip], 100u);
  EXPECT_GT(model.made[move], 300u);
  EXPECT_GT(model.made[split], 100u);
  EXPECT_GT(model.with_walls, 100u);
  ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  expect_same(before, model.measures());

  const std::size_t inserted = model.steiner_vertices();
  std::size_t taken_out = 0;
  for (int n = 0; n < 30000; ++n) {
    if (!model.change(contraction, model.some_cell()) || ++taken_out % 20 != 0) continue;
    ASSERT_TRUE(detail::is_whole<3>(model.mesh));
    ASSERT_EQ(model.steiner_vertices(), inserted - taken_out);
  }
  EXPECT_LE(model.steiner_vertices(), inserted / 5);
  for (const std::size_t unfit : model.unfit) EXPECT_EQ(unfit, 0u);
  ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  expect_same(before, model.measures());
}

TEST_P(LocalChanges, AreUndoneTogether) {
  Model model(GetParam().second);
  for (int n = 0; n < 600; ++n) model.insert_anywhere(n);
  const Measures measures = model.measures();
  std::size_t changed = 0;
  for (int round = 0; round < 80; ++round) {
    const Snapshot before(model.mesh, model.mesh.vertex_bound());
    const std::uint32_t vertices = model.mesh.vertex_bound();
    model.transaction.begin();
    CellId at = model.some_cell();
    for (int n = 0; n < 40; ++n) {
      const Kind kind = static_cast<Kind>(model.below(kinds));
      if (kind == contraction || !model.change(kind, at)) continue;  // which closes the hull with cells beside it
      ++changed;
      for (const CellId c : model.transaction.made()) ASSERT_TRUE(model.mesh.alive(c));
      at = model.transaction.made()[model.below(model.transaction.made().size())];
    }
    if (round % 4 == 3) {
      model.transaction.keep(model.pools);
    } else {
      model.transaction.undo(model.pools);
      ASSERT_EQ(Snapshot(model.mesh, vertices).cells == before.cells, true) << round;
    }
    EXPECT_TRUE(model.transaction.made().empty() && model.transaction.removed().empty());
    ASSERT_TRUE(detail::is_whole<3>(model.mesh));
    if (round % 10 == 0) expect_same(measures, model.measures());
  }
  EXPECT_GT(changed, 300u);
}

TEST_P(LocalChanges, UndoingBringsVersionsBack) {
  Model model(GetParam().second);
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  for (int n = 0; n < 200; ++n) model.change(edge_flip, model.some_cell());
  const Snapshot before(model.mesh, model.mesh.vertex_bound());
  model.transaction.begin();
  for (int n = 0; n < 100; ++n) model.change(n % 2 ? edge_flip : move, model.some_cell());
  EXPECT_NE(Snapshot(model.mesh, static_cast<std::uint32_t>(before.versions.size())).versions, before.versions);
  model.transaction.undo(model.pools);
  EXPECT_EQ(Snapshot(model.mesh, static_cast<std::uint32_t>(before.versions.size())).versions, before.versions);
}

INSTANTIATE_TEST_SUITE_P(Models, LocalChanges,
                         testing::Values(std::pair{"cube", test::cube()}, std::pair{"turned_cube", test::turned(test::cube())},
                                         std::pair{"two_regions", test::two_region_cube()},
                                         std::pair{"turned_two_regions", test::turned(test::two_region_cube())},
                                         std::pair{"marked_facet", test::cube_with_marked_facet()},
                                         std::pair{"plate_with_hole", test::turned(test::plate_with_hole())},
                                         std::pair{"pinched",
                                                   test::boxes({{{{0, 0, 0}}, {{1, 1, 1}}}, {{{1, 1, 0}}, {{2, 2, 1}}}})}),
                         [](const auto& info) { return std::string(info.param.first); });

TEST(VertexStars, KeepTheInput) {
  Model model(test::cube());
  for (int n = 0; n < 100; ++n) model.insert_anywhere(n);
  for (const CellId c : model.cells())
    for (const VertexId v : model.mesh.cell(c).vertices) {
      const bool of_input = model.mesh.vertex(v).home.kind() == EntityKind::vertex;
      EXPECT_EQ(collect_star(model.mesh, nullptr, v, c, 1000, model.star), of_input ? Reach::stays : Reach::ok);
    }
}

TEST(VertexStars, ThatAreLargeAreLeftAlone) {
  Model model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  std::size_t large = 0;
  for (const CellId c : model.cells())
    for (const VertexId v : model.mesh.cell(c).vertices) {
      const Reach reach = collect_star(model.mesh, nullptr, v, c, 12, model.star);
      EXPECT_LE(model.star.cells.size(), 12u);
      large += reach == Reach::stays;
      if (reach == Reach::stays) continue;
      const std::size_t all = model.star.cells.size();
      EXPECT_EQ(collect_star(model.mesh, nullptr, v, c, all, model.star), Reach::ok);
      EXPECT_EQ(collect_star(model.mesh, nullptr, v, c, all - 1, model.star), all > 1 ? Reach::stays : Reach::ok);
    }
  EXPECT_GT(large, 100u);
}

// Cells that would fill the space round a subsegment, too.
TEST(EdgeRings, SubsegmentsMayNotGo) {
  Model model(test::two_region_cube());
  for (int n = 0; n < 400; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  std::size_t rings = 0;
  for (const CellId c : model.cells())
    for (int e = 0; e < 6; ++e) {
      EdgeRing& ring = model.ring;
      if (!mesh.is_subsegment(c, e) || collect_ring(mesh, nullptr, c, e, 100, ring) != Reach::ok) continue;
      EXPECT_TRUE(sides_without_edge(mesh, model.domain, ring).empty());
      const std::size_t n = ring.vertices.size();
      if (n < 3) continue;
      model.r.clear();
      model.r.old = ring.cells;
      for (std::size_t k = 1; k + 1 < n; ++k) {
        const VertexId x = ring.vertices[0], y = ring.vertices[k], z = ring.vertices[k + 1];
        model.r.cells.push_back({{x, y, z, ring.ends[1]}, mesh.region(c)});
        model.r.cells.push_back({{z, y, x, ring.ends[0]}, mesh.region(c)});
      }
      for (const VertexId end : ring.ends)
        model.r.walls.push_back({{ring.vertices[0], ring.vertices[n - 1], end}, ring.walls[0]});
      EXPECT_FALSE(model.replacer.fits(model.r));
      ++rings;
    }
  EXPECT_GT(rings, 100u);
}

TEST(EdgeRings, GoRoundInOrder) {
  Model model(test::two_region_cube());
  for (int n = 0; n < 400; ++n) model.insert_anywhere(n);
  std::size_t open = 0, closed = 0;
  for (const CellId c : model.cells())
    for (int e = 0; e < 6; ++e) {
      EdgeRing& ring = model.ring;
      ASSERT_EQ(collect_ring(model.mesh, nullptr, c, e, 100, ring), Reach::ok);
      ASSERT_EQ(ring.vertices.size(), ring.cells.size() + (ring.closed ? 0 : 1));
      ASSERT_EQ(ring.walls.size(), ring.vertices.size());
      EXPECT_EQ(std::count(ring.cells.begin(), ring.cells.end(), c), 1);
      ++(ring.closed ? closed : open);
      for (std::size_t i = 0; i < ring.cells.size(); ++i) {
        auto v = model.mesh.cell(ring.cells[i]).vertices;
        std::array<VertexId, 4> w{ring.ends[0], ring.ends[1], ring.vertices[i], ring.vertex(i + 1)};
        EXPECT_EQ(orient<3>(model.mesh.points(w)), Sign::positive);
        std::sort(v.begin(), v.end());
        std::sort(w.begin(), w.end());
        EXPECT_EQ(v, w);
      }
    }
  EXPECT_GT(open, 100u);
  EXPECT_GT(closed, 100u);
}

}  // namespace pgdr::test_optimize_local_changes
