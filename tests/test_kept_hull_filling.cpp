// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Polyhedra that points leave when they are withdrawn.
#include "kept/hull_filling.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "model_plcs.hpp"
#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_kept_hull_filling {

/// A tetrahedron of this height on a triangle with legs of 100.
Hull tetrahedron(Mesh<3>& mesh, Mesh<3>::Pools& pools, double height) {
  const Simplex<3> s{{{{0, 0, 0}}, {{100, 0, 0}}, {{0, 100, 0}}, {{30, 30, height}}}};
  std::array<VertexId, 4> v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = mesh.new_vertex(pools, s[i], Home(EntityKind::volume, 0), 0);
  Hull hull;
  for (int i = 0; i < 4; ++i) {
    Hull::Face face = face_inwards(v, i);
    const auto p = mesh.points(face);
    if (orient<3>({p[0], p[1], p[2], s[static_cast<std::size_t>(i)]}) != Sign::positive) std::swap(face[0], face[1]);
    hull.faces.push_back(face);
    hull.beyond.push_back({});
  }
  return hull;
}

/// Three points on edges of manifold_hull-mask stayed on the kept boundary: about a point inside all cells were positive, but so
/// flat that doubles found no angle in them, and the place was refused. They are what the proof asks for; only they come last.
TEST(HullFilling, FlatCellsArePositive) {
  const Domain<3> domain(test::cube());
  for (const double height : {10.0, 1e-9}) {
    Mesh<3> mesh(8);
    auto pools = mesh.make_pools();
    const Hull hull = tetrahedron(mesh, pools, height);
    HullFilling filling(mesh, domain);
    const Point3 inside{{31, 32, height / 4}}, outside{{31, 32, height}};
    EXPECT_EQ(filling.is_seen_from(hull, inside, false), height == 10.0);
    EXPECT_TRUE(filling.is_seen_from(hull, inside, true));
    EXPECT_FALSE(filling.is_seen_from(hull, outside, false));
    EXPECT_FALSE(filling.is_seen_from(hull, outside, true));
    EXPECT_TRUE(filling.is_seen_from(hull, filling.better_place(hull, inside), true));
  }
}

}  // namespace pgdr::test_kept_hull_filling
