// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is in the page: the JSON that says what the mesh has, and its arrays.

const ARRAY_TYPES = { f32: Float32Array, u8: Uint8Array, u16: Uint16Array, u32: Uint32Array };

/** Bytes of base64. */
function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const whole = 1 << 20;  // characters at once, a multiple of 4
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array(text.length / 4 * 3 - padding);
  let at = 0;
  for (let begin = 0; begin < text.length; begin += whole) {
    const part = atob(text.slice(begin, begin + whole));
    for (let i = 0; i < part.length; ++i) bytes[at++] = part.charCodeAt(i);
  }
  return bytes;
}

/** The array of this name, as numbers one behind the other; its text is given back, since it may be large. */
function takeArray(name, about) {
  const holder = document.getElementById("pgdr-" + name);
  const bytes = decodeBase64(holder.textContent);
  holder.remove();
  const numbers = new ARRAY_TYPES[about.type](bytes.buffer, 0, bytes.byteLength / ARRAY_TYPES[about.type].BYTES_PER_ELEMENT);
  if (numbers.length !== about.rows * about.components) throw new Error("the array " + name + " has not the length that the page says");
  return numbers;
}

/** The mesh: what the JSON says, with the arrays as `arrays`, and the number of corners of a cell. */
function readMesh() {
  const mesh = JSON.parse(document.getElementById("pgdr-data").textContent);
  mesh.about = mesh.arrays;
  mesh.arrays = {};
  for (const [name, about] of Object.entries(mesh.about)) mesh.arrays[name] = takeArray(name, about);
  mesh.corners = mesh.dimension + 1;
  mesh.cellCount = mesh.about.cells.rows;
  mesh.pointCount = mesh.about.points.rows;
  return mesh;
}

/** The coordinate that a number of the page stands for, and back. */
function toGiven(mesh, axis, value) { return mesh.origin[axis] + mesh.scale * value; }
function fromGiven(mesh, axis, value) { return (value - mesh.origin[axis]) / mesh.scale; }
