// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws by three.js: triangles with their edges, and lines. Edges are drawn by the triangles themselves, from the place within each, and
// fade where triangles are small. What is beyond the plane of a flat cut is left out pixel by pixel.

const TRIANGLE_VERTEX = `
attribute vec4 tint;
varying vec3 vColor, vPlace, vSeen, vWithin;
void main() {
  float code = floor(tint.a * 255.0 + 0.5), corner = mod(code, 4.0), hidden = floor(code / 4.0 + 0.01);
  vWithin = vec3(corner < 0.5, corner > 0.5 && corner < 1.5, corner > 1.5);
  if (hidden > 0.5) vWithin = max(vWithin, vec3(hidden < 1.5, hidden > 1.5 && hidden < 2.5, hidden > 2.5));
  vColor = tint.rgb;
  vPlace = position;
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vSeen = seen.xyz;
  gl_Position = projectionMatrix * seen;
}`;
const TRIANGLE_FRAGMENT = `
uniform vec4 plane;
uniform vec3 ink;
uniform float edges, shade;
varying vec3 vColor, vPlace, vSeen, vWithin;
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  vec3 normal = normalize(cross(dFdx(vSeen), dFdy(vSeen)));
  float light = mix(1.0, 0.62 + 0.38 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.65, 0.6)))), shade);
  vec3 width = max(fwidth(vWithin), vec3(1e-7)), inside = smoothstep(vec3(0.0), 1.3 * width, vWithin);
  float pixels = 1.0 / max(width.x, max(width.y, width.z));
  float strength = edges * 0.85 * sqrt(clamp((pixels - 1.5) / 12.5, 0.0, 1.0));
  float edge = 1.0 - min(inside.x, min(inside.y, inside.z));
  gl_FragColor = vec4(mix(light * vColor, ink, strength * edge), 1.0);
}`;
const LINE_VERTEX = `
attribute vec4 tint;
varying vec3 vColor, vPlace;
void main() {
  vColor = tint.rgb;
  vPlace = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 3e-4;  // before the triangles that it bounds
}`;
const LINE_FRAGMENT = `
uniform vec4 plane;
varying vec3 vColor, vPlace;
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  gl_FragColor = vec4(vColor, 1.0);
}`;
const BEHIND_EVERYTHING = 1e3;  // offset of a plane that nothing is beyond
const PLANE_WIDTH = 1e-5;       // what lies in the plane is drawn
const MOST_SMOOTH = 300000;     // cells in 2D, all of which are drawn: of more, edges are not smoothed, which halves the work

class Scene {
  constructor(canvas, mesh) {
    const antialias = mesh.dimension === 3 || mesh.cellCount < MOST_SMOOTH;
    const context = canvas.getContext("webgl2", { antialias });
    if (!context) throw new Error("This browser has no WebGL 2, by which the mesh is drawn.");
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias });
    this.renderer.setClearColor(0xffffff, 1);
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 8);
    this.scene = new THREE.Scene();
    this.plane = { value: new THREE.Vector4(0, 0, 0, BEHIND_EVERYTHING) };
    this.edges = { value: 1 };
    const ink = rgbOf(mesh.colors.ink).map((c) => c / 255);
    this.triangles = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.ShaderMaterial({
      vertexShader: TRIANGLE_VERTEX, fragmentShader: TRIANGLE_FRAGMENT, side: THREE.DoubleSide, extensions: { derivatives: true },
      uniforms: { plane: this.plane, edges: this.edges, ink: { value: new THREE.Vector3(...ink) }, shade: { value: mesh.dimension - 2 } },
    }));
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.ShaderMaterial({
      vertexShader: LINE_VERTEX, fragmentShader: LINE_FRAGMENT, uniforms: { plane: this.plane },
    }));
    for (const object of [this.triangles, this.lines]) {
      object.frustumCulled = false;
      this.scene.add(object);
    }
  }
  /** `normal` null: no plane. */
  setPlane(normal, offset) {
    if (normal) this.plane.value.set(normal[0], normal[1], normal[2] || 0, offset + PLANE_WIDTH);
    else this.plane.value.set(0, 0, 0, BEHIND_EVERYTHING);
  }
  setTriangles(triangles) { this.replace(this.triangles, triangles.positions.subarray(0, 9 * triangles.count), triangles.tints.subarray(0, 12 * triangles.count)); }
  setLines({ positions, tints }) { this.replace(this.lines, positions, tints); }
  replace(object, positions, tints) {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry();
    object.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    object.geometry.setAttribute("tint", new THREE.BufferAttribute(tints, 4, true));
    object.visible = positions.length > 0;
  }
  /** After the tints of the triangles have changed. */
  repaint() { this.triangles.geometry.attributes.tint.needsUpdate = true; }
  draw(eye) {
    const width = this.canvas.clientWidth || 1, height = this.canvas.clientHeight || 1;
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(width, height, false);
    eye.apply(this.camera, width, height);
    this.renderer.render(this.scene, this.camera);
  }
}
