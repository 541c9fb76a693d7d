// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The eye, infinitely far away: `target` in the middle of the picture, `reach` from there to its nearer edge, and the direction towards
// the eye by two angles, with z upwards; in 2D it looks down on the plane.

const USUAL_EYE = [1, -1.5, 0.8];

class Eye {
  constructor(dimension) { this.flat = dimension === 2; }
  /** As in the beginning: all of a box of these half lengths about the origin, in a picture of this size, right of its first pixels. */
  home(from, box, width, height, first) {
    const [x, y, z] = this.flat ? [0, 0, 1] : from || USUAL_EYE;
    this.azimuth = this.flat ? -Math.PI / 2 : Math.atan2(y, x || 0);
    this.elevation = Math.atan2(z, Math.hypot(x, y));
    this.target = new THREE.Vector3();
    const nearer = Math.min(width, height), margin = 1.06;
    const along = (v) => v.toArray().reduce((sum, n, k) => sum + Math.abs(n) * (box[k] || 0), 0);
    this.reach = margin * Math.max(along(this.right()) * nearer / (width - first), along(this.up()) * nearer / height, 1e-6);
    this.move(first / 2, 0, nearer / 2);
  }
  /** Towards the eye. */
  back() {
    const c = Math.cos(this.elevation);
    return new THREE.Vector3(c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), Math.sin(this.elevation));
  }
  right() { return new THREE.Vector3(-Math.sin(this.azimuth), Math.cos(this.azimuth), 0); }
  up() { return this.back().cross(this.right()); }

  /** By angles in radians. */
  turn(azimuth, elevation) {
    if (this.flat) return;
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevation));
  }
  /** By pixels, of a picture whose nearer edge is `half` pixels from its middle. */
  move(dx, dy, half) {
    const unit = this.reach / half;
    this.target.addScaledVector(this.right(), -dx * unit).addScaledVector(this.up(), dy * unit);
  }
  /** Makes things `factor` times as large, and leaves the place at (x, y) pixels from the middle where it is. */
  zoom(factor, x, y, half) {
    const unit = this.reach / half * (1 - 1 / factor);
    this.target.addScaledVector(this.right(), x * unit).addScaledVector(this.up(), -y * unit);
    this.reach = Math.min(20, Math.max(1e-6, this.reach / factor));
  }
  apply(camera, width, height) {
    const far = 4, unit = this.reach / (Math.min(width, height) / 2), back = this.back();  // the mesh lies within 2 of the origin
    camera.right = width / 2 * unit;
    camera.left = -camera.right;
    camera.top = height / 2 * unit;
    camera.bottom = -camera.top;
    const depth = this.target.dot(back);  // so that the mesh stays between the planes, wherever the target is
    camera.near = 0;
    camera.far = 2 * far;
    camera.position.copy(this.target).addScaledVector(back, far - depth);
    camera.up.copy(this.up());
    camera.lookAt(camera.position.clone().sub(back));
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }
}

/** Drags turn (with shift, another button than the first, or in 2D: move), the wheel and two fingers zoom. `changed` is called after each. */
function bindPointer(canvas, eye, changed) {
  const down = new Map();
  const place = (event) => [event.offsetX - canvas.clientWidth / 2, event.offsetY - canvas.clientHeight / 2];
  const half = () => Math.min(canvas.clientWidth, canvas.clientHeight) / 2;
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
  });
  const up = (event) => down.delete(event.pointerId);
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) return;
    const now = place(event), dx = now[0] - before[0], dy = now[1] - before[1];
    if (down.size === 2) {
      const other = [...down.entries()].find(([id]) => id !== event.pointerId)[1];
      const length = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      eye.zoom(length(now) / length(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2, half());
      eye.move(dx / 2, dy / 2, half());
    } else if (eye.flat || event.shiftKey || event.buttons > 1) {
      eye.move(dx, dy, half());
    } else {
      eye.turn(-dx * 0.008, dy * 0.008);
    }
    down.set(event.pointerId, now);
    changed();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    eye.zoom(Math.exp(-event.deltaY * 0.0015), ...place(event), half());
    changed();
  }, { passive: false });
  return { isDown: () => down.size > 0 };
}
