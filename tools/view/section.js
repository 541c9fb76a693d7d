// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The cut: a plane, whose side beyond it stays. It keeps cells whole, by their centroids, or cuts them flat.

/** Of each point its signed distance from the plane normal * x = offset. */
function distancesFrom(mesh, normal, offset) {
  const points = mesh.arrays.points, d = mesh.dimension;
  const distances = new Float32Array(mesh.pointCount);
  for (let p = 0; p < distances.length; ++p) {
    let sum = -offset;
    for (let k = 0; k < d; ++k) sum += normal[k] * points[d * p + k];
    distances[p] = sum;
  }
  return distances;
}

/** A byte a cell: 1 if its centroid is not beyond the plane. */
function cellsBehind(mesh, distances) {
  const cells = mesh.arrays.cells, corners = mesh.corners;
  const kept = new Uint8Array(mesh.cellCount);
  for (let c = 0, at = 0; c < kept.length; ++c) {
    let sum = 0;
    for (let i = 0; i < corners; ++i) sum += distances[cells[at++]];
    kept[c] = sum <= 0 ? 1 : 0;
  }
  return kept;
}

const TETRAHEDRON_EDGES = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/**
 * Where the plane cuts tetrahedra: calls `add(cell, ends, shares)` for every triangle, whose corner k lies between the points
 * ends[2 k] and ends[2 k + 1], at shares[k] of the way. `diagonal` is the corner opposite the edge that a quadrilateral was split
 * along, else -1.
 */
function cutTetrahedra(mesh, distances, kept, add) {
  const cells = mesh.arrays.cells;
  for (let c = 0; c < mesh.cellCount; ++c) {
    if (kept && !kept[c]) continue;
    let above = 0;
    for (let i = 0; i < 4; ++i) if (distances[cells[4 * c + i]] > 0) above |= 1 << i;
    if (above === 0 || above === 15) continue;
    const crossed = TETRAHEDRON_EDGES.filter(([i, k]) => (above >> i & 1) !== (above >> k & 1))
      .map(([i, k]) => [cells[4 * c + i], cells[4 * c + k]]);
    const triangle = (chosen, diagonal) => add(c, chosen.flat(), chosen.map(([a, b]) => distances[a] / (distances[a] - distances[b])),
                                               diagonal);
    if (crossed.length === 3) {
      triangle(crossed, -1);
    } else {  // edges 0 and 3 have no corner in common: they are opposite corners of the quadrilateral
      triangle([crossed[0], crossed[1], crossed[3]], 1);
      triangle([crossed[0], crossed[3], crossed[2]], 2);
    }
  }
}
