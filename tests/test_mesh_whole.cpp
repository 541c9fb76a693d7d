// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What debug builds assert while a mesh is refined finds the damage that it is there for.
#include "mesh/whole.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <utility>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "claims/claim_registry.hpp"
#include "model_plcs.hpp"
#include "run/folded_facets.hpp"

namespace pgdr::test_mesh_whole {

/// A triangulated cube, its boundary recovered.
struct Cube {
  Mesh<3> mesh;
  Mesh<3>::Pools pools = mesh.make_pools();

  explicit Cube(const Plc<3>& plc = test::cube()) {
    const Domain<3> domain(plc);
    Delaunay<3> delaunay(mesh, pools);
    delaunay.build(domain.points());
    RecoveryCounts counts;
    recover_boundary<3>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), counts);
    std::vector<Diagnostic> warnings;
    carve<3>(mesh, pools, delaunay, domain, RegionMode::seeds, warnings);
  }
  /// A living cell, and a face of it with a neighbour.
  std::pair<CellId, int> inner_face() const {
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      for (int f = 0; f < 4; ++f)
        if (mesh.alive(CellId{i}) && mesh.cell(CellId{i}).links[f]) return {CellId{i}, f};
    return {};
  }
};

/// With one face that is bent by `height`, of all that by `scale`.
Plc<3> bent_cube(double height, double scale) {
  Plc<3> plc = test::cube();
  for (Point3& p : plc.points) {
    if (p == Point3{{1, 1, 1}}) p[2] += height;
    for (double& x : p.x) x *= scale;
  }
  return plc;
}

// A facet that is planar within the tolerance of --precision alone may fold over another where that has edges as short. (A
// surface of 18,000 triangles with six digits lost a corner so, with some cells, where it had edges of 0.001 and the
// facets were coplanar within 0.0013; the mesh was written.) Here the pieces of segments are half as long as these.
TEST(MeshWhole, SegmentsAreThereInWholeBesideBentFacets) {
  const Cube cube(bent_cube(1e-5, 1));
  EXPECT_NO_THROW(require_unfolded(cube.mesh, Domain<3>(bent_cube(1e-5, 1)), RegionMode::seeds, {}));
  EXPECT_NO_THROW(require_unfolded(cube.mesh, Domain<3>(bent_cube(0, 2)), RegionMode::seeds, {}));
  try {
    require_unfolded(cube.mesh, Domain<3>(bent_cube(1e-5, 2)), RegionMode::seeds, {});
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::boundary_not_recovered);
    EXPECT_EQ(e.diagnostic().ids.size(), 2u);
    EXPECT_EQ(e.diagnostic().points.size(), 2u);
  }
}

TEST(MeshWhole, DamageIsFound) {
  Cube cube;
  Mesh<3>& mesh = cube.mesh;
  ASSERT_TRUE(detail::is_whole<3>(mesh));
  const auto [c, f] = cube.inner_face();

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

TEST(ClaimRegistry, NoTwoHoldOneLeaf) {
  Orthtree<2> tree({{0, 0}}, {{1, 1}});
  for (int level = 0; level < 3; ++level)
    for (const auto leaf : tree.leaves()) tree.split(leaf);
  detail::ClaimRegistry<2> registry;
  registry.reset(tree.node_count());
  const auto leaves = tree.leaves();  // in Morton order: the first and the last are far apart
  const auto claim = [&](std::uint32_t leaf) { return Claim<2>(tree, leaf, tree.buffer(leaf), 1); };
  const Claim<2> first = claim(leaves.front()), beside = claim(leaves[1]), far = claim(leaves.back());
  const Claim<2> all = Claim<2>::whole(tree, leaves.front());
  EXPECT_TRUE(registry.enter(first));
  EXPECT_TRUE(registry.enter(far));
  EXPECT_TRUE(registry.leave(far));
  EXPECT_TRUE(registry.leave(first));
  EXPECT_TRUE(registry.enter(all));
  EXPECT_TRUE(registry.leave(all));
  EXPECT_TRUE(registry.enter(first));
  EXPECT_FALSE(registry.enter(all));
  EXPECT_TRUE(registry.leave(all));
  EXPECT_FALSE(registry.enter(beside));
}

}  // namespace pgdr::test_mesh_whole
