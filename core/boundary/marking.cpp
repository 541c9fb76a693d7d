// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/marking.hpp"

#include <algorithm>

#include "mesh/cell_blocks.hpp"

namespace pgdr::detail {

void mark_constraints(Mesh<3>& mesh, Mesh<3>::Pools& pools, const WantedFaces& faces, const WantedEdges& edges,
                      const Bulk& bulk) {
  each_cell(mesh, pools, bulk, [&](CellId c, Mesh<3>::Pools& own) {
    const auto& corners = mesh.cell(c).vertices;
    std::array<VertexId, 4> v = corners;
    std::sort(v.begin(), v.end());
    faces.each_of(v, [&](const WantedFaces::Item& face) {
      // The corners' numbers add up to 6.
      int opposite = 6;
      for (const VertexId w : face.vertices) opposite -= corner_of(corners, w);
      mesh.constrain_face(own, c, opposite, face.what);
    });
    edges.each_of(v, [&](const WantedEdges::Item& edge) {
      const int e = edge_of_ends[corner_of(corners, edge.vertices[0])][corner_of(corners, edge.vertices[1])];
      mesh.constrain_edge(own, c, e, edge.what);
    });
  });
}

}  // namespace pgdr::detail
