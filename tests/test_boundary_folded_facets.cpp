// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the boundary is held against once it is recovered: facets that fold over others are found.
#include "run/folded_facets.hpp"

#include <gtest/gtest.h>

#include "carved_meshes.hpp"

namespace pgdr::test_boundary_folded_facets {

using test::Carved;

/// With one face that is bent by `height`, of all that by `scale`.
Plc<3> bent_cube(double height, double scale) {
  Plc<3> plc = test::cube();
  for (Point3& p : plc.points) {
    if (p == Point3{{1, 1, 1}}) p[2] += height;
    for (double& x : p.x) x *= scale;
  }
  return plc;
}

// A facet that is planar within the tolerance alone may fold over another where that has edges as short. (A
// surface of 18,000 triangles with six digits lost a corner so, with some cells, where it had edges of 0.001 and the
// facets were coplanar within 0.0013; the mesh was written.) Here the pieces of segments are half as long as these.
TEST(FoldedFacets, SegmentsAreThereInWholeBesideBentFacets) {
  const Carved cube(bent_cube(1e-5, 1));
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

// A bent quadrilateral has two triangles in the mesh, of one diagonal or the other. A facet that is one of these has it in common
// with the quadrilateral, whose it stays. (It was marked as that of one, and the other had a gap.)
TEST(FoldedFacets, ATriangleOfTwoFacetsIsThatOfTheFirst) {
  const Plc<3> cube = bent_cube(1e-5, 1);
  const auto top = cube.facets[5].polygons[0];
  for (std::size_t left_out = 0; left_out < top.size(); ++left_out) {
    Plc<3> plc = cube;
    std::vector<std::uint32_t> triangle = top;
    triangle.erase(triangle.begin() + static_cast<std::ptrdiff_t>(left_out));
    plc.facets.push_back({{triangle}, {}, 7});
    const Carved carved(plc);
    EXPECT_NO_THROW(require_unfolded(carved.mesh, Domain<3>(plc), RegionMode::seeds, {})) << left_out;
  }
}

}  // namespace pgdr::test_boundary_folded_facets
