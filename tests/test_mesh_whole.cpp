// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What debug builds assert while a mesh is refined finds the damage that it is there for.
#include "mesh/whole.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "carved_meshes.hpp"

namespace pgdr::test_mesh_whole {

using test::Carved;

/// A living cell, and a face of it with a neighbour.
std::pair<CellId, int> inner_face(const Mesh<3>& mesh) {
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    for (int f = 0; f < 4; ++f)
      if (mesh.alive(CellId{i}) && mesh.cell(CellId{i}).links[f]) return {CellId{i}, f};
  return {};
}

TEST(MeshWhole, DamageIsFound) {
  Carved cube(test::cube());
  Mesh<3>& mesh = cube.mesh;
  ASSERT_TRUE(detail::is_whole<3>(mesh));
  const auto [c, f] = inner_face(mesh);

  mesh.mark(c);
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  mesh.unmark(c);

  std::swap(mesh.cell(c).vertices[0], mesh.cell(c).vertices[1]);
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  std::swap(mesh.cell(c).vertices[0], mesh.cell(c).vertices[1]);

  const Link link = mesh.cell(c).links[f];
  mesh.cell(c).links[f] = Link(link.cell(), (link.face() + 1) % 4);
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  mesh.cell(c).links[f] = Link();
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  mesh.cell(c).links[f] = link;

  auto& constraints = mesh.ensure_constraints(cube.pools, c);
  constraints.part = 1;
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  constraints.part = 0;
  constraints.faces ^= static_cast<std::uint8_t>(1 << f);
  EXPECT_FALSE(detail::is_whole<3>(mesh));
  constraints.faces ^= static_cast<std::uint8_t>(1 << f);
  for (int e = 0; e < 6; ++e)
    if (edge_ends[e][0] != f && edge_ends[e][1] != f) {
      constraints.edges ^= static_cast<std::uint8_t>(1 << e);
      EXPECT_FALSE(detail::is_whole<3>(mesh));
      constraints.edges ^= static_cast<std::uint8_t>(1 << e);
    }
  EXPECT_TRUE(detail::is_whole<3>(mesh));

  mesh.free_cell(cube.pools, c);
  EXPECT_FALSE(detail::is_whole<3>(mesh));
}

}  // namespace pgdr::test_mesh_whole
