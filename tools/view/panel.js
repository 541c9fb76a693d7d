// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands beside the picture: the panel with its choices, the legend, and what is said of the cell under the pointer. Texts of the
// file come in as text, never as HTML.

function element(parent, tag, properties) {
  const made = Object.assign(document.createElement(tag), properties);
  parent.append(made);
  return made;
}

/** Six digits at most. */
function numberText(value) {
  if (value === null || value === undefined) return "none";
  if (Array.isArray(value)) return value.map((v) => Array.isArray(v) ? `(${numberText(v)})` : numberText(v)).join(", ");
  return Number.isFinite(value) ? String(+value.toPrecision(6)) : String(value);
}

class Panel {
  /** `actions`: setColor(word), setCut(changes), setEdges(on), home(). */
  constructor(mesh, colorings, actions) {
    const panel = document.getElementById("panel");
    element(panel, "h1", { textContent: mesh.title });
    const kind = mesh.dimension === 3 ? "tetrahedra" : "triangles";
    element(panel, "p", { textContent: `${mesh.cellCount.toLocaleString("en")} ${kind}, ${mesh.pointCount.toLocaleString("en")} points` });
    this.color = this.choice(panel, "colour", colorings.map((c) => [c.word, c.title]), (word) => actions.setColor(word));
    const axes = [["", "no cut"], ["x", "across x"], ["y", "across y"]];
    if (mesh.dimension === 3) axes.push(["z", "across z"], ["eye", "facing the eye"]);
    this.axis = this.choice(panel, "cut", axes, (axis) => actions.setCut({ axis }));
    this.place = element(panel, "div", {});
    const slider = element(element(this.place, "label", {}), "input", { type: "range", min: 0, max: 1000 });
    slider.addEventListener("input", () => actions.setCut({ share: slider.value / 1000 }));
    this.slider = slider;
    this.value = element(slider.parentElement, "span", {});
    this.flip = this.check(this.place, "the other side", (flip) => actions.setCut({ flip }));
    this.flat = this.check(this.place, "through the cells", (flat) => actions.setCut({ flat }));
    this.flat.parentElement.hidden = mesh.dimension === 2;
    this.edges = this.check(panel, "edges", actions.setEdges);
    this.edges.checked = true;
    element(panel, "button", { textContent: "whole view" }).addEventListener("click", actions.home);
  }
  choice(parent, name, rows, changed) {
    const label = element(parent, "label", { textContent: name });
    const made = element(label, "select", {});
    for (const [value, textContent] of rows) element(made, "option", { value, textContent });
    made.addEventListener("change", () => changed(made.value));
    return made;
  }
  check(parent, name, changed) {
    const label = element(parent, "label", {});
    const made = element(label, "input", { type: "checkbox" });
    label.append(name);
    made.addEventListener("change", () => changed(made.checked));
    return made;
  }
  /** As the cut is now. `value`: its place in the units of the mesh, or null. */
  showCut(cut, value) {
    this.axis.value = cut.axis;
    this.place.hidden = cut.axis === "";
    this.slider.value = 1000 * cut.share;
    this.value.textContent = value === null ? "" : numberText(value);
    this.flip.checked = cut.flip;
    this.flat.checked = cut.flat;
  }
}

const MOST_ENTRIES = 40;  // of a legend

/** `hidden`: the entries that are left out of the picture; a click on one calls `toggle(n)`. Without `toggle` nothing can be hidden. */
function showLegend(coloring, hidden, toggle) {
  const legend = document.getElementById("legend");
  legend.replaceChildren();
  element(legend, "b", { textContent: coloring.title });
  if (coloring.range) {
    const bar = element(legend, "canvas", { width: RAMP_STEPS, height: 1 });
    const context = bar.getContext("2d"), image = context.createImageData(RAMP_STEPS, 1);
    for (let i = 0; i < RAMP_STEPS; ++i) image.data.set([...coloring.table.subarray(3 * i, 3 * i + 3), 255], 4 * i);
    context.putImageData(image, 0, 0);
    const ends = element(legend, "div", { className: "ends" });
    for (const end of coloring.range) element(ends, "span", { textContent: numberText(end) });
    return;
  }
  coloring.entries.slice(0, MOST_ENTRIES).forEach((text, n) => {
    const row = element(legend, "div", {}), [r, g, b] = coloring.table.subarray(3 * n, 3 * n + 3);
    element(row, "i", {}).style.background = `rgb(${r}, ${g}, ${b})`;
    element(row, "span", { textContent: text });
    if (!toggle) return;
    row.style.cursor = "pointer";
    row.style.opacity = hidden.has(n) ? 0.35 : 1;
    row.title = "show or hide";
    row.addEventListener("click", () => toggle(n));
  });
  if (coloring.entries.length > MOST_ENTRIES) element(legend, "span", { textContent: `and ${coloring.entries.length - MOST_ENTRIES} more` });
}

/** What is known of the cell at (x, y) of the window; null: nothing is there. */
function showFigures(mesh, figures, x, y) {
  const tip = document.getElementById("tip");
  tip.hidden = !figures;
  if (!figures) return;
  tip.replaceChildren();
  const table = element(tip, "table", {});
  const row = (name, value) => {
    const line = element(table, "tr", {});
    element(line, "th", { textContent: name });
    element(line, "td", { textContent: typeof value === "string" ? value : numberText(value) });
  };
  row("cell", figures.cell);
  row("label", textOf(figures));
  row(mesh.dimension === 3 ? "volume" : "area", figures.volume);
  row("radius-edge", figures.radius_edge);
  row(mesh.dimension === 3 ? "dihedral angles" : "angles", `${numberText(figures.min_angle)} to ${numberText(figures.max_angle)} degrees`);
  if (figures.marker) row("marker", textOf(figures.marker));
  if (figures.leaf !== undefined) row("leaf", figures.leaf);
  for (const [name, value] of Object.entries(figures.fields)) row(name, value);
  const left = x + 16 + tip.offsetWidth < window.innerWidth ? x + 16 : x - 16 - tip.offsetWidth;
  tip.style.left = `${Math.max(0, left)}px`;
  tip.style.top = `${Math.max(0, Math.min(y + 12, window.innerHeight - tip.offsetHeight - 8))}px`;
}
