// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangles that are drawn: places, the cell and the face of each, and their colours.
//
// Corner k of triangle t has the place positions[9 t + 3 k ...]; it lies between the points ends[6 t + 2 k] and ends[6 t + 2 k + 1], at
// shares[3 t + k] of the way. tints[12 t + 4 k ...] are red, green, blue and a code: the corner k, plus 4 times one more than the
// corner whose opposite edge is no edge of the mesh, if there is one.

class Triangles {
  constructor(count) {
    this.count = 0;
    this.positions = new Float32Array(9 * count);
    this.tints = new Uint8Array(12 * count);
    this.cellOf = new Uint32Array(count);
    this.faceOf = new Int32Array(count);  // -1: none, of a triangle of the cut, or in 2D
    this.ends = new Uint32Array(6 * count);
    this.shares = new Float32Array(3 * count);
  }
  /** `points`: of `d` coordinates each. `end(k)`, `share(k)`: of corner k. */
  add(points, d, cell, face, diagonal, end, share) {
    const t = this.count++;
    this.cellOf[t] = cell;
    this.faceOf[t] = face;
    for (let k = 0; k < 3; ++k) {
      const a = end(2 * k), b = end(2 * k + 1), s = share(k);
      this.ends[6 * t + 2 * k] = a;
      this.ends[6 * t + 2 * k + 1] = b;
      this.shares[3 * t + k] = s;
      this.tints[12 * t + 4 * k + 3] = k + 4 * (diagonal + 1);
      for (let j = 0; j < d; ++j) this.positions[9 * t + 3 * k + j] = points[d * a + j] + s * (points[d * b + j] - points[d * a + j]);
    }
  }
}

/** In 2D the cells that are kept. `kept`: a byte a cell, or null for all. */
function trianglesOfPlane(mesh, kept) {
  const cells = mesh.arrays.cells, points = mesh.arrays.points;
  const made = new Triangles(mesh.cellCount);
  for (let c = 0; c < mesh.cellCount; ++c)
    if (!kept || kept[c]) made.add(points, 2, c, -1, -1, (i) => cells[3 * c + (i >> 1)], () => 0);
  return made;
}

/** In 3D these faces, and where the cut goes through cells, which `cutting` adds by the function that it gets. */
function trianglesOfSurface(mesh, faces, cutting) {
  const cells = mesh.arrays.cells, points = mesh.arrays.points, cut = [];
  if (cutting) cutting((cell, ends, shares, diagonal) => cut.push({ cell, ends, shares, diagonal }));
  const made = new Triangles(faces.length + cut.length);
  for (const face of faces) {
    const c = face >> 2, order = FACE_CORNERS[4][face & 3];
    made.add(points, 3, c, face, -1, (i) => cells[4 * c + order[i >> 1]], () => 0);
  }
  for (const { cell, ends, shares, diagonal } of cut)
    made.add(points, 3, cell, -1, diagonal, (i) => ends[i], (k) => shares[k]);
  return made;
}

/** Gives all triangles the colours of a colouring. */
function paint(triangles, coloring) {
  const { tints, ends, shares, cellOf, faceOf } = triangles, table = coloring.table;
  for (let t = 0; t < triangles.count; ++t) {
    const whole = coloring.of === "points" ? 0 : coloring.index(coloring.of === "faces" ? faceOf[t] : cellOf[t]);
    for (let k = 0; k < 3; ++k) {
      let row = whole;
      if (coloring.of === "points") {
        const from = coloring.index(ends[6 * t + 2 * k]), share = shares[3 * t + k];
        row = share > 0 ? Math.round(from + share * (coloring.index(ends[6 * t + 2 * k + 1]) - from)) : from;
      }
      for (let j = 0; j < 3; ++j) tints[12 * t + 4 * k + j] = table[3 * row + j];
    }
  }
}

/** Subsegments: places and colours of their ends. Those whose ends are both in `seen` (a byte a point, or null for all). */
function linesOf(mesh, seen, colorOf) {
  const segments = mesh.arrays.subsegments, points = mesh.arrays.points, d = mesh.dimension;
  const chosen = [];
  for (let s = 0; s < mesh.about.subsegments.rows; ++s)
    if (!seen || (seen[segments[2 * s]] && seen[segments[2 * s + 1]])) chosen.push(s);
  const positions = new Float32Array(6 * chosen.length), tints = new Uint8Array(8 * chosen.length);
  chosen.forEach((s, n) => {
    const color = colorOf(s);
    for (let k = 0; k < 2; ++k) {
      for (let j = 0; j < d; ++j) positions[6 * n + 3 * k + j] = points[d * segments[2 * s + k] + j];
      tints.set(color, 8 * n + 4 * k);
    }
  });
  return { positions, tints };
}

/** A byte a point: is it of a cell that is kept? */
function pointsOfCells(mesh, kept) {
  const seen = new Uint8Array(mesh.pointCount), cells = mesh.arrays.cells, corners = mesh.corners;
  for (let c = 0; c < mesh.cellCount; ++c)
    if (kept[c]) for (let i = 0; i < corners; ++i) seen[cells[corners * c + i]] = 1;
  return seen;
}
