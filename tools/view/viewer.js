// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The viewer: puts the parts together, and keeps what is shown. `window.pgdrView` is the same for scripts: see `doorOf`.

class Viewer {
  constructor() {
    const begin = performance.now();
    this.mesh = readMesh();
    const decoded = performance.now();
    this.canvas = document.getElementById("view");
    document.title = `${this.mesh.title} - pgdr`;
    this.beyond = this.mesh.dimension === 3 ? neighboursOf(this.mesh.arrays.cells, 4) : null;
    this.hull = this.beyond ? surfaceOf(this.beyond, 4, null) : null;
    const joined = performance.now();
    this.constraintOf = constraintFinder(this.mesh);
    this.colorings = coloringsOf(this.mesh, this.constraintOf);
    this.hidden = new Set();  // regions
    this.cut = { axis: "", share: 0.5, flip: false, flat: false, normal: null };
    this.eye = new Eye(this.mesh.dimension);
    this.home();
    this.scene = new Scene(this.canvas, this.mesh);
    this.panel = new Panel(this.mesh, this.colorings, {
      setColor: (word) => this.setColor(word), setCut: (changes) => this.setCut(changes), home: () => this.home(),
      setEdges: (on) => { this.scene.edges.value = on ? 1 : 0; this.redraw(); } });
    this.begin();
    this.bind();
    this.draw();
    document.getElementById("message").hidden = true;
    this.timing = { decode: decoded - begin, faces: joined - decoded, first: performance.now() - begin };
  }

  /** As the page says. */
  begin() {
    if (this.mesh.cut) {
      const axis = this.mesh.cut.axis, eye = this.mesh.from || USUAL_EYE;
      this.cut.axis = "xyz"[axis];
      this.cut.flip = eye[axis] < 0;
      this.cut.share = this.shareOf(fromGiven(this.mesh, axis, this.mesh.cut.value));
    }
    this.setColor(this.mesh.color);
    this.setCut({});
  }

  bind() {
    const pointer = bindPointer(this.canvas, this.eye, () => { showFigures(this.mesh, null); this.redraw(); });
    let last = null;
    const look = () => {
      const event = last;
      last = null;
      if (event && !pointer.isDown()) showFigures(this.mesh, this.pick(event.clientX, event.clientY), event.clientX, event.clientY);
    };
    this.canvas.addEventListener("pointermove", (event) => {
      if (last === null && !pointer.isDown()) requestAnimationFrame(look);
      last = event;
    });
    this.canvas.addEventListener("pointerleave", () => { last = null; showFigures(this.mesh, null); });
    window.addEventListener("resize", () => this.redraw());
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }
  draw() {
    this.waiting = false;
    this.scene.draw(this.eye);
  }
  home() {
    const half = this.mesh.high.map((high, k) => (high - this.mesh.low[k]) / 2 / this.mesh.scale);
    const width = this.canvas.clientWidth || 1, panel = 235;
    this.eye.home(this.mesh.from, half, width, this.canvas.clientHeight || 1, width > 3 * panel ? panel : 0);
    if (this.scene) this.redraw();
  }

  /** Ends of the mesh along the normal of the cut, by the corners of its bounds. */
  ends(normal) {
    let low = 0, high = 0;
    for (let k = 0; k < this.mesh.dimension; ++k) {
      const a = normal[k] * fromGiven(this.mesh, k, this.mesh.low[k]), b = normal[k] * fromGiven(this.mesh, k, this.mesh.high[k]);
      low += Math.min(a, b);
      high += Math.max(a, b);
    }
    return [low, high];
  }
  normalOf(axis) {
    if (axis === "eye") return this.eye.back().toArray();
    return ["x", "y", "z"].map((name) => name === axis ? 1 : 0);
  }
  shareOf(place) {
    const [low, high] = this.ends(this.normalOf(this.cut.axis));
    return high > low ? (place - low) / (high - low) : 0.5;
  }

  /** Changes of `cut`: axis ("x", "y", "z", "eye" or ""), share (of the way through the mesh), flip, flat. */
  setCut(changes) {
    const cut = Object.assign(this.cut, changes);
    if ("axis" in changes || !cut.normal) cut.normal = cut.axis ? this.normalOf(cut.axis) : null;
    let plane = null;
    if (cut.normal) {
      const [low, high] = this.ends(cut.normal), offset = low + cut.share * (high - low), sign = cut.flip ? -1 : 1;
      plane = { normal: cut.normal.map((n) => sign * n), offset: sign * offset };
      const axis = "xyz".indexOf(cut.axis);
      this.panel.showCut(cut, axis < 0 ? null : toGiven(this.mesh, axis, offset));
    } else {
      this.panel.showCut(cut, null);
    }
    this.shape(plane);
  }

  /** Makes the triangles and lines anew. `plane`: of the cut, or null. */
  shape(plane) {
    const mesh = this.mesh, flat = plane && this.cut.flat && mesh.dimension === 3;
    const distances = plane && distancesFrom(mesh, plane.normal, plane.offset);
    const visible = this.visibleCells();
    let kept = visible;
    if (plane && !flat) {
      kept = cellsBehind(mesh, distances);
      if (visible) for (let c = 0; c < kept.length; ++c) kept[c] &= visible[c];
    }
    if (mesh.dimension === 2) {
      this.triangles = trianglesOfPlane(mesh, kept);
    } else {
      const faces = kept ? surfaceOf(this.beyond, 4, kept) : this.hull;
      this.triangles = trianglesOfSurface(mesh, faces, flat ? (add) => cutTetrahedra(mesh, distances, kept, add) : null);
    }
    this.scene.setPlane(flat ? plane.normal : null, flat ? plane.offset : 0);
    this.keptPoints = kept ? pointsOfCells(mesh, kept) : null;
    paint(this.triangles, this.coloring);
    this.scene.setTriangles(this.triangles);
    this.paintLines();
    this.redraw();
  }
  paintLines() {
    const marked = this.coloring.word === "marker" && this.mesh.dimension === 2, ink = rgbOf(this.mesh.colors.ink);
    const markers = this.mesh.arrays.subsegments_marker, table = this.coloring.table;
    this.scene.setLines(linesOf(this.mesh, this.keptPoints, (s) => marked ? table.subarray(3 * markers[s], 3 * markers[s] + 3) : ink));
  }
  /** A byte a cell, or null if no region is hidden. */
  visibleCells() {
    const regions = this.mesh.arrays.region;
    if (!regions || this.hidden.size === 0) return null;
    return Uint8Array.from(regions, (r) => this.hidden.has(r) ? 0 : 1);
  }

  setColor(word) {
    this.coloring = this.colorings.find((c) => c.word === word) || this.colorings[0];
    this.panel.color.value = this.coloring.word;
    this.legend();
    if (!this.triangles) return;
    paint(this.triangles, this.coloring);
    this.scene.repaint();
    this.paintLines();
    this.redraw();
  }
  legend() {
    const hides = this.coloring.word === "region" && this.mesh.regions.length > 1;
    showLegend(this.coloring, this.hidden, hides ? (n) => this.hide(n, !this.hidden.has(n)) : null);
  }
  /** Leaves a region out of the picture, or not. */
  hide(region, hidden) {
    hidden ? this.hidden.add(region) : this.hidden.delete(region);
    this.legend();
    this.setCut({});
  }

  /** Figures of the cell at a pixel of the window, or null. */
  pick(x, y) {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    const triangle = triangleAt(this.triangles, this.eye, this.scene.plane.value, x - width / 2, y - height / 2, Math.min(width, height) / 2);
    return triangle < 0 ? null : figuresOf(this.mesh, this.triangles, triangle, this.constraintOf);
  }
}

/** What scripts may ask and change. Lengths are in the units of the mesh, angles in degrees. */
function doorOf(viewer) {
  const mesh = viewer.mesh;
  return {
    ready: true,
    dimension: mesh.dimension,
    counts: { points: mesh.pointCount, cells: mesh.cellCount, hull: viewer.hull ? viewer.hull.length : 0 },
    bounds: [mesh.low, mesh.high],
    colorings: viewer.colorings.map((c) => c.word),
    timing: viewer.timing,
    state() {
      const { axis, share, flip, flat } = viewer.cut;
      return { color: viewer.coloring.word, range: viewer.coloring.range || null, triangles: viewer.triangles.count,
               cut: axis && { axis, share, flip, flat }, hidden: [...viewer.hidden] };
    },
    array: (name) => mesh.arrays[name],
    setColor(word) { viewer.setColor(word); viewer.draw(); },
    /** As Viewer.setCut; with `value`, a coordinate, instead of share. null: no cut. */
    setCut(changes) {
      if (changes && "value" in changes) {
        viewer.cut.axis = changes.axis || viewer.cut.axis;
        changes = { ...changes, share: viewer.shareOf(fromGiven(mesh, "xyz".indexOf(viewer.cut.axis), changes.value)) };
        delete changes.value;
      }
      viewer.setCut(changes || { axis: "" });
      viewer.draw();
    },
    turn(azimuth, elevation) { viewer.eye.turn(azimuth * Math.PI / 180, elevation * Math.PI / 180); viewer.draw(); },
    zoom(factor) { viewer.eye.zoom(factor, 0, 0, 1); viewer.draw(); },
    hide(region, hidden) { viewer.hide(region, hidden); viewer.draw(); },
    pick: (x, y) => viewer.pick(x, y),
  };
}

/** After the browser has painted that the mesh is being read, which may take a second. */
function start() {
  try {
    window.pgdrView = doorOf(new Viewer());
  } catch (error) {
    document.getElementById("message").textContent = `The mesh cannot be shown: ${error.message}`;
    window.pgdrView = { ready: false, error: String(error.stack || error) };
  }
}
requestAnimationFrame(() => setTimeout(start, 0));
