// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Replacements: which fit, and what they make.
#include "change/replacement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "change/flips.hpp"
#include "changed_meshes.hpp"
#include "mesh/locally_delaunay.hpp"
#include "mesh/whole.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_change_replacement {

using test::ChangedMesh;

template <std::size_t N>
std::array<VertexId, N> sorted(std::array<VertexId, N> v) {
  std::sort(v.begin(), v.end());
  return v;
}

/// What is there, by vertices: whatever slots it is in.
template <int D>
struct Contents {
  std::map<std::array<VertexId, D + 1>, std::uint16_t> cells;
  std::map<std::array<VertexId, D>, EntityId> walls;
  std::map<std::array<VertexId, 2>, EntityId> subsegments;
  bool operator==(const Contents&) const = default;

  explicit Contents(const Mesh<D>& mesh) {
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
      const CellId c{i};
      if (!mesh.alive(c)) continue;
      const auto& v = mesh.cell(c).vertices;
      EXPECT_TRUE(cells.insert({sorted(v), mesh.region(c)}).second);
      const auto* k = mesh.constraints(c);
      for (int f = 0; f <= D && k; ++f)
        if (k->has_face(f)) walls[sorted(face_without(v, f))] = k->face_entity[f];
      for (int e = 0; e < 6 && k && D == 3; ++e)
        if (k->has_edge(e)) subsegments[sorted(ends_of_edge(v, e))] = k->edge_entity[e];
    }
  }
};

/// So many cells about one, by walks across faces.
template <int D>
std::vector<CellId> cells_about(const Mesh<D>& mesh, CellId c, std::size_t most) {
  std::vector<CellId> found{c};
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Link next : mesh.cell(found[i]).links)
      if (next && found.size() < most && std::find(found.begin(), found.end(), next.cell()) == found.end())
        found.push_back(next.cell());
  return found;
}

/// The cells themselves in place of them, the last one first, as even permutations.
template <int D>
Replacement<D> by_themselves(const Mesh<D>& mesh, std::vector<CellId> old) {
  Replacement<D> r;
  for (const CellId c : old) {
    auto v = mesh.cell(c).vertices;
    std::rotate(v.begin(), v.begin() + 1, v.begin() + 3);
    r.cells.insert(r.cells.begin(), {v, mesh.region(c)});
  }
  r.old = std::move(old);
  return r;
}

/// Three cells round the edge between the tips of the two at the face, whether they are positive or not.
Replacement<3> three_for_two(const Mesh<3>& mesh, CellId c, int face) {
  const Link link = mesh.cell(c).links[face];
  Replacement<3> r;
  r.old = {c, link.cell()};
  for (int i = 0; i < 4; ++i) {
    if (i == face) continue;
    auto v = mesh.cell(c).vertices;
    v[i] = mesh.cell(link.cell()).vertices[link.face()];
    r.cells.push_back({v, mesh.region(c)});
  }
  return r;
}

/// A cell; every other time one at the boundary.
CellId some_cell(ChangedMesh& model, std::size_t n) {
  std::vector<CellId> all = model.cells();
  if (n % 2 == 0)
    std::erase_if(all, [&](CellId c) { return !model.mesh.constraints(c) || model.mesh.constraints(c)->faces == 0; });
  return all[model.below(all.size())];
}

bool has_inner_walls(const Mesh<3>& mesh) {
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    for (int f = 0; f < 4; ++f)
      if (mesh.alive(CellId{i}) && mesh.constrained(CellId{i}, f) && mesh.cell(CellId{i}).links[f]) return true;
  return false;
}

class Replacements : public testing::TestWithParam<std::pair<const char*, Plc<3>>> {};

TEST_P(Replacements, ByTheSameCellsChangeNothing) {
  ChangedMesh model(GetParam().second);
  for (int n = 0; n < 600; ++n) model.insert_anywhere(n);
  const Contents<3> before(model.mesh);
  Replacer<3> replacer(model.mesh);
  for (int n = 0; n < 300; ++n) {
    const auto r = by_themselves(model.mesh, cells_about(model.mesh, some_cell(model, n), 1 + model.below(60)));
    ASSERT_TRUE(replacer.fits(r));
    replacer.commit(model.pools, r);
    ASSERT_EQ(replacer.new_cells().size(), r.cells.size());
    for (std::size_t i = 0; i < r.cells.size(); ++i)
      ASSERT_EQ(model.mesh.cell(replacer.new_cells()[i]).vertices, r.cells[i].vertices);
    if (n % 10 != 0) continue;
    ASSERT_TRUE(detail::is_whole<3>(model.mesh));
  }
  EXPECT_TRUE(detail::is_whole<3>(model.mesh));
  EXPECT_EQ(Contents<3>(model.mesh), before);
}

TEST_P(Replacements, WhatDoesNotFitIsFound) {
  ChangedMesh model(GetParam().second);
  for (int n = 0; n < 600; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  Replacer<3> replacer(mesh);
  const std::vector<CellId> all = model.cells();
  std::size_t walls = 0, inner_walls = 0, subsegments = 0;
  for (int n = 0; n < 300; ++n) {
    const auto good = by_themselves(mesh, cells_about(mesh, some_cell(model, n), 2 + model.below(20)));
    ASSERT_TRUE(replacer.fits(good));
    const auto fits = [&](auto damage) {
      auto r = good;
      damage(r);
      return replacer.fits(r);
    };
    EXPECT_FALSE(fits([](auto& r) { r.cells.pop_back(); })) << "a cell is missing";
    EXPECT_FALSE(fits([](auto& r) { r.cells.push_back(r.cells.front()); })) << "a cell twice";
    EXPECT_FALSE(fits([](auto& r) { r.old.pop_back(); })) << "more than there was";
    EXPECT_FALSE(fits([](auto& r) { r.old.push_back(r.old.front()); })) << "an old cell twice";
    EXPECT_FALSE(fits([](auto& r) { std::swap(r.cells[0].vertices[0], r.cells[0].vertices[1]); })) << "a cell turned over";
    EXPECT_FALSE(fits([](auto& r) { ++r.cells[0].region; })) << "another region";
    EXPECT_FALSE(fits([&](auto& r) { r.cells[0].vertices[0] = mesh.cell(all[0]).vertices[0]; }) &&
                 !has_corner(good.cells[0].vertices, mesh.cell(all[0]).vertices[0]))
        << "another vertex";
    const CellId c = good.old[0];
    const auto& v = mesh.cell(c).vertices;
    for (int f = 0; f < 4; ++f) {
      const auto face = face_without(v, f);
      const bool constrained = mesh.constrained(c, f);
      walls += constrained;
      const EntityId facet = constrained ? mesh.constraints(c)->face_entity[f] : 0;
      EXPECT_EQ(fits([&](auto& r) { r.walls.push_back({face, facet}); }), constrained) << "a wall that is none";
      if (constrained && mesh.cell(c).links[f]) {
        ++inner_walls;
        EXPECT_FALSE(replacer.fits(three_for_two(mesh, c, f))) << "a wall would go";
      }
      EXPECT_FALSE(fits([&](auto& r) { r.walls.push_back({face, facet + 1}); })) << "a wall of another facet";
    }
    for (int e = 0; e < 6; ++e) {
      const bool is = mesh.is_subsegment(c, e);
      subsegments += is;
      const EntityId segment = is ? mesh.constraints(c)->edge_entity[e] : 0;
      EXPECT_EQ(fits([&](auto& r) { r.subsegments.push_back({ends_of_edge(v, e), segment}); }), is);
      EXPECT_FALSE(fits([&](auto& r) { r.subsegments.push_back({ends_of_edge(v, e), segment + 1}); }));
    }
  }
  EXPECT_GT(walls, 100u);
  EXPECT_EQ(inner_walls > 0, has_inner_walls(mesh));
  EXPECT_GT(subsegments, 50u);
}

INSTANTIATE_TEST_SUITE_P(Models, Replacements,
                         testing::Values(std::pair{"cube", test::cube()}, std::pair{"turned_cube", test::turned(test::cube())},
                                         std::pair{"two_regions", test::two_region_cube()},
                                         std::pair{"turned_two_regions", test::turned(test::two_region_cube())},
                                         std::pair{"marked_facet", test::cube_with_marked_facet()},
                                         std::pair{"plate_with_hole", test::turned(test::plate_with_hole())}),
                         [](const auto& info) { return std::string(info.param.first); });

// Two boxes that touch along an edge alone.
TEST(ReplacementsAtPinchedEdges, AreListed) {
  ChangedMesh model(test::boxes({{{{0, 0, 0}}, {{1, 1, 1}}}, {{{1, 1, 0}}, {{2, 2, 1}}}}));
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  ASSERT_TRUE(mesh.pinched_edges());
  const auto listed = [&](CellId c) {
    std::size_t lists = 0;
    const auto* k = mesh.constraints(c);
    for (int e = 0; e < 6 && k; ++e)
      if (k->has_edge(e) && mesh.pinched_edges()->has(k->edge_entity[e])) {
        const auto [a, b] = ends_of_edge(mesh.cell(c).vertices, e);
        const std::vector<CellId> cells = mesh.pinched_edges()->cells(a, b);
        EXPECT_EQ(std::count(cells.begin(), cells.end(), c), 1);
        for (const CellId other : cells) EXPECT_TRUE(mesh.alive(other));
        ++lists;
      }
    return lists;
  };
  Replacer<3> replacer(mesh);
  std::size_t lists = 0;
  for (const CellId c : model.cells()) {
    if (!mesh.alive(c) || listed(c) == 0) continue;
    const auto r = by_themselves(mesh, cells_about(mesh, c, 1 + model.below(6)));
    ASSERT_TRUE(replacer.fits(r));
    replacer.commit(model.pools, r);
    for (const CellId made : replacer.new_cells()) lists += listed(made);
  }
  EXPECT_GT(lists, 20u);
  EXPECT_TRUE(detail::is_whole<3>(mesh));
}

TEST(ReplacementsInSpace, CountVersionsOnce) {
  ChangedMesh model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  Replacer<3> replacer(mesh);
  std::vector<std::uint32_t> versions(mesh.vertex_bound(), 0);
  std::size_t flips = 0;
  for (int n = 0; n < 100; ++n) {
    const std::vector<CellId> all = model.cells();
    const CellId c = all[model.below(all.size())];
    const int face = static_cast<int>(model.below(4));
    if (!mesh.cell(c).links[face] || mesh.constrained(c, face)) continue;
    const auto r = three_for_two(mesh, c, face);
    const auto turned = [&](const auto& cell) { return orient<3>(mesh.points(cell.vertices)) != Sign::positive; };
    if (std::any_of(r.cells.begin(), r.cells.end(), turned)) continue;
    ASSERT_TRUE(replacer.fits(r));
    ++flips;
    std::set<VertexId> about;
    for (const CellId c : r.old) about.insert(mesh.cell(c).vertices.begin(), mesh.cell(c).vertices.end());
    for (const VertexId v : about) versions[index(v)] = mesh.note(v).version;
    replacer.commit(model.pools, r);
    for (const VertexId v : about) EXPECT_EQ(mesh.note(v).version, versions[index(v)] + 1);
  }
  EXPECT_GT(flips, 10u);
  EXPECT_TRUE(detail::is_whole<3>(mesh));
}

/// Faces of these cells that are not locally Delaunay; those between two of them twice.
int violations_at(const Mesh<3>& mesh, const std::vector<CellId>& cells) {
  int count = 0;
  for (const CellId c : cells)
    for (int f = 0; f < 4; ++f) count += violates(mesh, c, f);
  return count;
}

/// Makes three cells of two where they are positive, `most` times. @returns how often
std::size_t disturb(ChangedMesh& model, Replacer<3>& replacer, std::size_t most) {
  Mesh<3>& mesh = model.mesh;
  std::size_t flips = 0;
  for (int n = 0; n < 2000 && flips < most; ++n) {
    const std::vector<CellId> all = model.cells();
    const CellId c = all[model.below(all.size())];
    const int face = static_cast<int>(model.below(4));
    if (!mesh.cell(c).links[face] || mesh.constrained(c, face)) continue;
    const auto r = three_for_two(mesh, c, face);
    const auto turned = [&](const auto& cell) { return orient<3>(mesh.points(cell.vertices)) != Sign::positive; };
    if (std::any_of(r.cells.begin(), r.cells.end(), turned) || !replacer.fits(r)) continue;
    const int expected = replacer.violations(r, 1000);
    EXPECT_LE(replacer.violations(r, 0), std::min(expected, 2));
    replacer.commit(model.pools, r);
    EXPECT_EQ(expected, violations_at(mesh, replacer.new_cells()));
    ++flips;
  }
  return flips;
}

// Where a face is flipped that was locally Delaunay, it is flipped back, and all others are left.
TEST(ReplacementsInSpace, ViolationsAreCountedAndFlippedAway) {
  ChangedMesh model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  Replacer<3> replacer(mesh);
  LocalFlips<3> flips(mesh, model.domain);
  const auto repair = [&] {
    std::size_t made = 0;
    for (bool any = true; any && made < 10000;) {
      any = false;
      for (const CellId c : model.cells())
        for (int f = 0; f < 4 && mesh.alive(c); ++f) {
          if (!violates(mesh, c, f) || flips.repair(model.pools, c, f) != LocalFlips<3>::Outcome::flipped) continue;
          any = true;
          ++made;
        }
    }
    return made;
  };
  repair();
  const int before = violations_at(mesh, model.cells());
  ASSERT_GT(disturb(model, replacer, 60), 20u);
  EXPECT_GT(violations_at(mesh, model.cells()), before);
  const std::size_t made = repair();
  EXPECT_GT(made, 10u);
  EXPECT_LT(made, 1000u) << "it does not end";
  EXPECT_LE(violations_at(mesh, model.cells()), before);
  EXPECT_TRUE(detail::is_whole<3>(mesh));
}

// The four faces of a cell have no border together, so that they could be a part of any facet.
TEST(ReplacementsInSpace, SetWallsOnBothSides) {
  ChangedMesh model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  Replacer<3> replacer(mesh);
  std::size_t walled = 0;
  for (const CellId c : model.cells()) {
    const auto& links = mesh.cell(c).links;
    const auto beside_walls = [&](Link next) { return !next || mesh.constraints(next.cell()); };
    if (mesh.constraints(c) || std::any_of(links.begin(), links.end(), beside_walls)) continue;
    auto r = by_themselves(mesh, {c});
    for (int f = 0; f < 4; ++f) r.walls.push_back({face_without(mesh.cell(c).vertices, f), 3});
    const std::array<Link, 4> beyond = links;
    ASSERT_TRUE(replacer.fits(r));
    replacer.commit(model.pools, r);
    for (const Link next : beyond) {
      ASSERT_TRUE(mesh.constrained(next.cell(), next.face()));
      EXPECT_EQ(mesh.entity_of_face(next.cell(), next.face()).id, 3u);
    }
    ++walled;
  }
  EXPECT_GT(walled, 20u);
  EXPECT_TRUE(detail::is_whole<3>(mesh));
}

TEST(ReplacementsInSpace, KeptCellsStayInTheirSlots) {
  ChangedMesh model(test::cube());
  for (int n = 0; n < 300; ++n) model.insert_anywhere(n);
  Mesh<3>& mesh = model.mesh;
  Replacer<3> replacer(mesh);
  const std::vector<CellId> all = model.cells();
  const auto r = by_themselves(mesh, cells_about(mesh, all[7], 9));
  const std::uint16_t birth = mesh.birth(r.old[3]);
  replacer.commit(model.pools, r, Replacer<3>::OldCells::kept);
  for (const CellId c : r.old) EXPECT_TRUE(mesh.alive(c));
  EXPECT_EQ(mesh.birth(r.old[3]), birth);
  for (const CellId c : r.old) mesh.free_cell(model.pools, c);
  EXPECT_TRUE(detail::is_whole<3>(mesh));
}

TEST(ReplacementsInSpace, TakeFlatCellsOffTheHull) {
  ChangedMesh model(test::cube());
  Mesh<3>& mesh = model.mesh;
  // Any cell with two faces at the hull will do, as nothing here asks for planes: they take the two others in their place.
  Replacer<3> replacer(mesh);
  std::size_t tried = 0;
  for (const CellId c : model.cells()) {
    std::vector<int> open, inner;
    for (int f = 0; f < 4; ++f) (mesh.cell(c).links[f] ? inner : open).push_back(f);
    if (open.size() != 2 || tried > 0) continue;
    ++tried;
    auto* k = mesh.constraints(c);
    // All in one facet, and no subsegment between the two faces.
    const Replacement<3> whole{
        {c}, {}, {{face_without(mesh.cell(c).vertices, inner[0]), 0}, {face_without(mesh.cell(c).vertices, inner[1]), 0}}, {}};
    EXPECT_FALSE(replacer.fits(whole)) << "two facets, and a subsegment";
    for (const int f : open) k->face_entity[f] = 0;
    k->edges &= static_cast<std::uint8_t>(~(1 << edge_of_ends[inner[0]][inner[1]]));
    EXPECT_TRUE(replacer.fits(whole));
    auto one = whole;
    one.walls.pop_back();
    EXPECT_FALSE(replacer.fits(one)) << "a face of the rim stays open";
    const std::array beyond{mesh.cell(c).links[inner[0]], mesh.cell(c).links[inner[1]]};
    replacer.commit(model.pools, whole);
    EXPECT_EQ(replacer.new_cells(), (std::vector{beyond[0].cell(), beyond[1].cell()}));
    for (const Link link : beyond) {
      EXPECT_FALSE(mesh.cell(link.cell()).links[link.face()]);
      EXPECT_TRUE(mesh.constrained(link.cell(), link.face()));
    }
    EXPECT_TRUE(detail::is_whole<3>(mesh));
  }
  EXPECT_EQ(tried, 1u);
}

/// A carved mesh of a planar input.
struct PlanarMesh {
  Domain<2> domain;
  Mesh<2> mesh;
  Mesh<2>::Pools pools = mesh.make_pools();

  explicit PlanarMesh(const Plc<2>& plc) : domain(plc) {
    Delaunay<2> delaunay(mesh, pools);
    delaunay.build(domain.points());
    RecoveryCounts counts;
    recover_boundary<2>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
    std::vector<Diagnostic> warnings;
    carve<2>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
  }
};

TEST(ReplacementsInThePlane, FlipAndAreRejected) {
  PlanarMesh model(test::square_with_hole());
  Mesh<2>& mesh = model.mesh;
  ASSERT_TRUE(detail::is_whole<2>(mesh));
  Replacer<2> replacer(mesh);
  std::size_t flips = 0, walls = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    for (int f = 0; f < 3; ++f) {
      const CellId c{i};
      if (!mesh.alive(c) || !mesh.cell(c).links[f]) continue;
      const auto same = by_themselves(mesh, cells_about(mesh, c, 3));
      ASSERT_TRUE(replacer.fits(same));
      auto bad = same;
      bad.cells.pop_back();
      EXPECT_FALSE(replacer.fits(bad));
      bad = same;
      std::swap(bad.cells[0].vertices[0], bad.cells[0].vertices[1]);
      EXPECT_FALSE(replacer.fits(bad));
      const Link link = mesh.cell(c).links[f];
      const VertexId apex = mesh.cell(link.cell()).vertices[link.face()];
      Replacement<2> r;
      r.old = {c, link.cell()};
      for (int k = 0; k < 3; ++k) {
        if (k == f) continue;
        auto v = mesh.cell(c).vertices;
        v[k] = apex;
        r.cells.push_back({v, mesh.region(c)});
      }
      if (mesh.constrained(c, f)) {
        ++walls;
        EXPECT_FALSE(replacer.fits(r)) << "a subsegment would go";
        continue;
      }
      ASSERT_TRUE(replacer.fits(r));
      if (orient<2>(mesh.points(r.cells[0].vertices)) != Sign::positive ||
          orient<2>(mesh.points(r.cells[1].vertices)) != Sign::positive)
        continue;
      replacer.commit(model.pools, r);
      ++flips;
      ASSERT_TRUE(detail::is_whole<2>(mesh));
      break;
    }
  EXPECT_GT(flips, 5u);
  EXPECT_EQ(walls, 3u);
}

}  // namespace pgdr::test_change_replacement
