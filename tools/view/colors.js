// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Colourings: what is shown of cells, points or faces, as numbers of a table of colours, and the legend of that.
//
// A colouring has `word`, `title`, `of` ("cells", "points" or "faces"), `table` (RGB bytes), `index(i)` (the row of the table for a
// cell, point or face), and a legend: `range` (ends of a ramp) or `entries` (rows of classes).

const RAMP_STEPS = 255;  // of a ramp; the colour behind them is that of what is no number
const NO_NUMBER = [170, 170, 170];
/** From dark to light, evenly in lightness, as matplotlib's viridis. */
const SEQUENTIAL = ["#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725"];

function rgbOf(hex) { return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)); }

/** RAMP_STEPS colours through stops that are evenly spaced, then that of what is no number. */
function rampTable(stops) {
  const table = new Uint8Array(3 * (RAMP_STEPS + 1));
  for (let i = 0; i < RAMP_STEPS; ++i) {
    const at = i / (RAMP_STEPS - 1) * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    const from = rgbOf(stops[k]), to = rgbOf(stops[k + 1]);
    for (let j = 0; j < 3; ++j) table[3 * i + j] = Math.round(from[j] + (at - k) * (to[j] - from[j]));
  }
  table.set(NO_NUMBER, 3 * RAMP_STEPS);
  return table;
}

function flatTable(hexes) { return Uint8Array.from(hexes.flatMap(rgbOf)); }

/** The least and the largest finite number of `count`. */
function rangeOf(value, count) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < count; ++i) {
    const v = value(i);
    if (!Number.isFinite(v)) continue;
    if (v < low) low = v;
    if (v > high) high = v;
  }
  return low <= high ? [low, high] : [0, 0];
}

function rampColoring(word, title, of, value, range, stops) {
  const scale = range[1] > range[0] ? (RAMP_STEPS - 1) / (range[1] - range[0]) : 0;
  const index = (i) => {
    const v = value(i);
    return v !== v ? RAMP_STEPS : Math.min(RAMP_STEPS - 1, Math.max(0, Math.round((v - range[0]) * scale || 0)));
  };
  return { word, title, of, index, range, table: rampTable(stops) };
}

/** A colour for each of `rows`, each with a text. */
function classColoring(word, title, of, index, rows, hexes) {
  const table = flatTable(rows.length ? rows.map((_, i) => hexes[i % hexes.length]) : [hexes[0]]);
  return { word, title, of, index, table, entries: rows };
}

/** A text for a label or marker of the page's tables. */
function textOf(row) { return row.name ? `${row.name} (${row.label})` : String(row.label); }

function qualityColorings(mesh) {
  const a = mesh.arrays, regular = mesh.dimension === 3 ? Math.acos(1 / 3) * 180 / Math.PI : 60;
  const angle = mesh.dimension === 3 ? "smallest dihedral angle" : "smallest angle";
  const limits = mesh.colors.angle_limits;
  const classes = limits.map((limit, i) => `${i ? limits[i - 1] : 0} to ${limit} degrees`).concat(`${limits[limits.length - 1]} degrees and more`);
  const classOf = (c) => {
    let i = 0;
    while (i < limits.length && a.min_angle[c] >= limits[i]) ++i;
    return i;
  };
  const cellRamp = (word, title, values) => {
    const value = (c) => values[c];
    return rampColoring(word, title, "cells", value, rangeOf(value, mesh.cellCount), SEQUENTIAL);
  };
  return [rampColoring("quality", `${angle}, degrees`, "cells", (c) => a.min_angle[c], [0, regular], mesh.colors.quality),
          classColoring("dihedral", `${angle}, classes`, "cells", classOf, classes, mesh.colors.angle_classes),
          cellRamp("radius_edge", "circumradius / shortest edge", a.radius_edge),
          cellRamp("volume", mesh.dimension === 3 ? "volume" : "area", a.volume)];
}

function labelColorings(mesh, constraintOf) {
  const a = mesh.arrays, colors = mesh.colors.palette, made = [];
  const region = a.region ? (c) => a.region[c] : () => 0;
  made.push(classColoring("region", "region", "cells", region, mesh.regions.map(textOf), colors));
  const names = [...new Set(mesh.regions.map((row) => row.name || String(row.label)))];
  const nameOf = mesh.regions.map((row) => names.indexOf(row.name || String(row.label)));
  if (mesh.regions.some((row) => row.name))
    made.push(classColoring("name", "name", "cells", (c) => nameOf[region(c)], names, colors));
  const markers = a[mesh.dimension === 3 ? "subfacets_marker" : "subsegments_marker"];
  const marked = classColoring("marker", "marker of the boundary", "faces", (face) => {
    const constraint = face < 0 ? -1 : constraintOf(face);
    return constraint < 0 ? mesh.markers.length : markers[constraint];
  }, mesh.markers.map(textOf), colors);
  marked.table = flatTable([...mesh.markers.map((_, i) => colors[i % colors.length]), "#dddddd"]);
  made.push(marked);
  if (a.leaf)
    made.push({ word: "leaf", title: "leaf of the tree", of: "cells", index: (c) => a.leaf[c] % colors.length, table: flatTable(colors), entries: [] });
  return made;
}

/** One a field; of a vector its length. */
function fieldColorings(mesh) {
  return mesh.fields.map((field) => {
    const values = mesh.arrays[field.array], n = mesh.about[field.array].components;
    const value = n === 1 ? (i) => values[i] : (i) => {
      let sum = 0;
      for (let k = 0; k < n; ++k) sum += values[n * i + k] * values[n * i + k];
      return Math.sqrt(sum);
    };
    const title = field.name + (n > 1 ? " (length)" : "");
    return rampColoring(field.name, title, field.of, value, rangeOf(value, mesh.about[field.array].rows), SEQUENTIAL);
  });
}

/** All colourings of a mesh, in the order of the list. */
function coloringsOf(mesh, constraintOf) {
  return [...qualityColorings(mesh), ...labelColorings(mesh, constraintOf), ...fieldColorings(mesh)];
}
