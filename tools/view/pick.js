// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is under the pointer: the nearest drawn triangle there, and the figures of its cell.

/** The triangle nearest to the eye at (x, y), pixels from the middle of the picture, y downwards; -1: none. */
function triangleAt(triangles, eye, plane, x, y, half) {
  const unit = eye.reach / half, r = eye.right(), u = eye.up(), b = eye.back();
  const px = eye.target.dot(r) + x * unit, py = eye.target.dot(u) - y * unit;
  const p = triangles.positions, sx = [0, 0, 0], sy = [0, 0, 0];
  let nearest = -1, depth = -Infinity;
  for (let t = 0; t < triangles.count; ++t) {
    for (let k = 0; k < 3; ++k) {
      const i = 9 * t + 3 * k;
      sx[k] = p[i] * r.x + p[i + 1] * r.y + p[i + 2] * r.z - px;
      sy[k] = p[i] * u.x + p[i + 1] * u.y + p[i + 2] * u.z - py;
    }
    const w0 = sx[1] * sy[2] - sx[2] * sy[1], w1 = sx[2] * sy[0] - sx[0] * sy[2], w2 = sx[0] * sy[1] - sx[1] * sy[0];
    if (!((w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0))) continue;
    const sum = w0 + w1 + w2;
    if (sum === 0) continue;  // seen from its side
    const at = (j) => (w0 * p[9 * t + j] + w1 * p[9 * t + 3 + j] + w2 * p[9 * t + 6 + j]) / sum;
    const place = [at(0), at(1), at(2)];
    if (plane.x * place[0] + plane.y * place[1] + plane.z * place[2] > plane.w) continue;
    const d = place[0] * b.x + place[1] * b.y + place[2] * b.z;
    if (d > depth) {
      depth = d;
      nearest = t;
    }
  }
  return nearest;
}

/** What is known of the cell and the face of a triangle. Fields of points are those of the cell's corners, in their order. */
function figuresOf(mesh, triangles, triangle, constraintOf) {
  const a = mesh.arrays, cell = triangles.cellOf[triangle], face = triangles.faceOf[triangle];
  const region = a.region ? mesh.regions[a.region[cell]] : null;
  const corners = [...a.cells.subarray(mesh.corners * cell, mesh.corners * (cell + 1))];
  const figures = { cell, corners, label: region ? region.label : 0, name: region ? region.name : "", volume: a.volume[cell],
                    radius_edge: a.radius_edge[cell], min_angle: a.min_angle[cell], max_angle: a.max_angle[cell], fields: {} };
  if (a.leaf) figures.leaf = a.leaf[cell];
  const constraint = face < 0 ? -1 : constraintOf(face);
  if (constraint >= 0) figures.marker = mesh.markers[a.subfacets_marker[constraint]];
  for (const field of mesh.fields) {
    const n = mesh.about[field.array].components;
    const row = (i) => n === 1 ? a[field.array][i] : [...a[field.array].subarray(n * i, n * (i + 1))];
    figures.fields[field.name] = field.of === "cells" ? row(cell) : corners.map(row);
  }
  return figures;
}
