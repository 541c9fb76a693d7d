// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Other numbers for cells and vertices: the mesh is the same one, who was told the numbers finds every cell again, and what is
// kept in coordinates says what it said.
#include "mesh/renumbering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "carved_meshes.hpp"
#include "mesh/whole.hpp"
#include "space/bulk.hpp"

namespace pgdr::test_mesh_renumbering {

using detail::Renumbering;

/// What a cell is, whatever its number and those of its vertices.
struct Content {
  Simplex<3> corners;
  std::array<Home, 4> homes;
  std::array<std::uint32_t, 4> versions;
  std::uint16_t region;
  std::uint8_t faces, edges;
  std::uint64_t surroundings;
  bool operator==(const Content&) const = default;
};

Content content_of(const Mesh<3>& mesh, CellId c) {
  Content content{mesh.simplex(c), {}, {}, mesh.region(c), 0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    content.homes[i] = mesh.vertex(mesh.cell(c).vertices[i]).home;
    content.versions[i] = mesh.note(mesh.cell(c).vertices[i]).version;
  }
  if (const auto* k = mesh.constraints(c)) {
    content.faces = k->faces;
    content.edges = k->edges;
  }
  const CellName name{c, mesh.birth(c)};
  content.surroundings = surroundings_of<3>(mesh, {&name, 1}, 1).value_or(0);
  return content;
}

TEST(Renumbering, KeepsAllButTheNumbers) {
  test::Carved carved(test::icosphere(2));
  Mesh<3>& mesh = carved.mesh;
  for (std::uint32_t v = 0; v < mesh.vertex_bound(); ++v) mesh.note(VertexId{v}).version = v;
  std::vector<CellName> alive, dead;
  std::vector<Content> before;
  std::vector<std::uint64_t> places;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    if (mesh.birth(c) > 0) dead.push_back({c, static_cast<std::uint16_t>(mesh.birth(c) - 1)});
    if (!mesh.alive(c)) continue;
    alive.push_back({c, mesh.birth(c)});
    before.push_back(content_of(mesh, c));
    places.push_back(place_hash<3>(mesh, c));
  }
  ASSERT_GT(alive.size(), 50u);
  ASSERT_GT(dead.size(), 50u);
  std::vector<std::uint64_t> distinct = places;
  std::sort(distinct.begin(), distinct.end());
  EXPECT_EQ(std::unique(distinct.begin(), distinct.end()), distinct.end());

  std::mt19937_64 random(5);
  for (int round = 0; round < 3; ++round) {
    Renumbering<3> to(mesh, random);
    to.apply();
    ASSERT_TRUE(detail::is_whole<3>(mesh));
    std::size_t moved = 0;
    for (std::size_t i = 0; i < alive.size(); ++i) {
      const CellId old = alive[i].cell;
      to.rename(alive[i].cell, alive[i].birth);
      moved += old != alive[i].cell ? 1 : 0;
      EXPECT_EQ(mesh.birth(alive[i].cell), alive[i].birth);
      EXPECT_EQ(content_of(mesh, alive[i].cell), before[i]);
      EXPECT_EQ(place_hash<3>(mesh, alive[i].cell), places[i]);
    }
    EXPECT_GT(moved, alive.size() / 2);
    for (CellName& name : dead) {
      to.rename(name.cell, name.birth);
      EXPECT_NE(mesh.birth(name.cell), name.birth);
      EXPECT_FALSE(surroundings_of<3>(mesh, {&name, 1}, 1));
    }
  }
}

// Two boxes that meet along an edge: the lists of the cells there name the cells, and are found, by the new numbers.
TEST(Renumbering, PinchedEdges) {
  Plc<3> plc = test::cube();
  const auto corners = static_cast<std::uint32_t>(plc.points.size());
  const Plc<3> other = test::cube();
  for (const Point3& p : other.points) plc.points.push_back({{p[0] + 1, p[1] + 1, p[2]}});
  for (auto facet : other.facets) {
    for (auto& polygon : facet.polygons)
      for (auto& v : polygon) v += corners;
    plc.facets.push_back(facet);
  }
  const Domain<3> domain(plc);
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  test::carve_mesh(domain, mesh, pools);
  mesh.find_pinched_edges(domain.segments().size(), detail::Bulk(detail::OneByOne()));
  ASSERT_TRUE(mesh.pinched_edges());
  using Corners = std::pair<std::array<Point3, 2>, std::size_t>;
  const auto fans = [&] {
    std::vector<Corners> all;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
      const CellId c{i};
      const auto* k = mesh.alive(c) ? mesh.constraints(c) : nullptr;
      for (int e = 0; k && e < 6; ++e) {
        if (!k->has_edge(e) || !mesh.pinched_edges()->has(k->edge_entity[e])) continue;
        const auto [a, b] = ends_of_edge(mesh.cell(c).vertices, e);
        const auto cells = mesh.pinched_edges()->cells(a, b);
        EXPECT_NE(std::find(cells.begin(), cells.end(), c), cells.end());
        std::array ends{mesh.point(a), mesh.point(b)};
        std::sort(ends.begin(), ends.end(), lex_less<3>);
        all.emplace_back(ends, cells.size());
      }
    }
    std::sort(all.begin(), all.end(), [](const Corners& x, const Corners& y) {
      return x.first[0] == y.first[0] ? lex_less<3>(x.first[1], y.first[1]) : lex_less<3>(x.first[0], y.first[0]);
    });
    return all;
  };
  const auto before = fans();
  ASSERT_GE(before.size(), 2u);
  std::mt19937_64 random(7);
  Renumbering<3> to(mesh, random);
  to.apply();
  EXPECT_EQ(fans(), before);
}

}  // namespace pgdr::test_mesh_renumbering
