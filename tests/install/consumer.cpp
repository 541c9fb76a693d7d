// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes a cube from memory with an installed pgdr, and checks the mesh.
#include <pgdr/pgdr.hpp>

#include <cstdio>

int main() {
  pgdr::Plc<3> cube;
  for (int i = 0; i < 8; ++i) cube.points.push_back({{double(i & 1), double(i >> 1 & 1), double(i >> 2)}});
  const std::uint32_t sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& s : sides) cube.facets.push_back({.polygons = {{s[0], s[1], s[2], s[3]}}});

  pgdr::RefineOptions<3> options;
  options.size = 0.3;
  const pgdr::Domain<3> domain(cube);
  const auto result = pgdr::refine(domain, options);

  pgdr::CheckOptions<3> check;
  check.domain = &domain;
  check.radius_edge_bound = options.radius_edge_bound;
  check.size = options.size;
  const auto verdict = pgdr::check(result.mesh, check);
  std::printf("%zu tetrahedra, %llu poor, verdict %d\n", result.mesh.cells.size(),
              static_cast<unsigned long long>(result.poor_left), verdict.exit_code());
  return result.mesh.cells.size() > 100 && result.poor_left == 0 ? verdict.exit_code() : 1;
}
