// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Faces of cells (2D: edges): which two cells have one in common, and which are the surface of the cells that are kept. Face
// corners * c + i is the one of cell c opposite its corner i.

/** The corners of the face opposite corner i, in 3D counterclockwise seen from outside of a cell of positive orientation. */
const FACE_CORNERS = { 3: [[1, 2], [2, 0], [0, 1]], 4: [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] };

/** Sorted vertices of all faces, three numbers each; those of an edge have the larger twice. */
function sortedFaces(vertices, corners, count) {
  const sorted = new Uint32Array(3 * count);
  for (let f = 0; f < count; ++f) {
    let a = vertices[corners * f], b = vertices[corners * f + 1], c = corners > 2 ? vertices[corners * f + 2] : Math.max(a, b), t;
    if (a > b) { t = a; a = b; b = t; }
    if (b > c) { t = b; b = c; c = t; }
    if (a > b) { t = a; a = b; b = t; }
    sorted[3 * f] = a; sorted[3 * f + 1] = b; sorted[3 * f + 2] = c;
  }
  return sorted;
}

/** Finds a face by its sorted vertices: a table with open addresses, at most half full, so that each look takes a few steps. */
class FaceTable {
  constructor(faces) {
    this.faces = faces;
    let size = 16;
    while (size < faces.length / 3 * 2) size *= 2;
    this.slots = new Int32Array(size).fill(-1);
    this.mask = size - 1;
  }
  /** The face in the table with these vertices; if there is none, f is put in, unless it is negative, and -1 comes back. */
  find(a, b, c, f) {
    let slot = (Math.imul(a, 0x9e3779b1) ^ Math.imul(b, 0x85ebca6b) ^ Math.imul(c, 0xc2b2ae35));
    slot = (slot ^ slot >>> 15) & this.mask;
    for (;; slot = slot + 1 & this.mask) {
      const g = this.slots[slot];
      if (g < 0) {
        if (f >= 0) this.slots[slot] = f;
        return -1;
      }
      if (this.faces[3 * g] === a && this.faces[3 * g + 1] === b && this.faces[3 * g + 2] === c) return g;
    }
  }
}

/** The vertices of all faces of all cells. */
function facesOfCells(cells, corners) {
  const each = FACE_CORNERS[corners].length, size = corners - 1;
  const vertices = new Uint32Array(cells.length * size);
  let at = 0;
  for (let c = 0; c < cells.length; c += corners)
    for (let i = 0; i < each; ++i)
      for (let k = 0; k < size; ++k) vertices[at++] = cells[c + FACE_CORNERS[corners][i][k]];
  return sortedFaces(vertices, size, cells.length);
}

/** Of each face the cell beyond, or -1. A face that more than two cells have, as in what is no mesh, has two of them. */
function neighboursOf(cells, corners) {
  const faces = facesOfCells(cells, corners);
  const table = new FaceTable(faces);
  const beyond = new Int32Array(cells.length).fill(-1);
  for (let f = 0; f < beyond.length; ++f) {
    const g = table.find(faces[3 * f], faces[3 * f + 1], faces[3 * f + 2], f);
    if (g < 0 || beyond[g] >= 0) continue;
    beyond[f] = Math.floor(g / corners);
    beyond[g] = Math.floor(f / corners);
  }
  return beyond;
}

/** Faces of a kept cell with no kept cell beyond. `kept`: a byte a cell, or null for all. */
function surfaceOf(beyond, corners, kept) {
  const faces = [];
  for (let f = 0, c = 0; f < beyond.length; f += corners, ++c) {
    if (kept && !kept[c]) continue;
    for (let i = 0; i < corners; ++i) {
      const other = beyond[f + i];
      if (other < 0 || (kept && !kept[other])) faces.push(f + i);
    }
  }
  return faces;
}

/** A function that says which constraint a face of a cell is, or -1. */
function constraintFinder(mesh) {
  const name = mesh.dimension === 3 ? "subfacets" : "subsegments", size = mesh.dimension;
  const faces = sortedFaces(mesh.arrays[name], size, mesh.about[name].rows);
  const table = new FaceTable(faces);
  for (let f = 0; f < faces.length / 3; ++f) table.find(faces[3 * f], faces[3 * f + 1], faces[3 * f + 2], f);
  return function (face) {
    const cell = Math.floor(face / mesh.corners) * mesh.corners, order = FACE_CORNERS[mesh.corners][face % mesh.corners];
    const key = sortedFaces(order.map((k) => mesh.arrays.cells[cell + k]), size, 1);
    return table.find(key[0], key[1], key[2], -1);
  };
}
