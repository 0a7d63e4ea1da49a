// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Where the viewer is: parallel projection as in the program's pictures. The cloud lies in a cube of
// side 1 from the origin.

class Camera {
  constructor(center, size) {
    this.home = {azimuth: 35, elevation: 25, zoom: 1, center, size};
    this.reset();
  }
  reset() {
    const {azimuth, elevation, zoom, center, size} = this.home;
    Object.assign(this, {azimuth, elevation, zoom, size, center: center.slice()});
  }
  axes() {  // right, up, towards the viewer
    const a = this.azimuth * Math.PI / 180, e = this.elevation * Math.PI / 180;
    const ca = Math.cos(a), sa = Math.sin(a), ce = Math.cos(e), se = Math.sin(e);
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  }
  scale(width, height) {  // pixels for the cube's side
    return 0.92 * this.zoom * Math.min(width, height) / this.size;
  }
  turn(dx, dy) {  // degrees
    this.azimuth = (this.azimuth - dx + 720) % 360;
    this.elevation = Math.max(-90, Math.min(90, this.elevation + dy));
  }
  pan(dx, dy, scale) {  // pixels
    const [right, up] = this.axes();
    for (let k = 0; k < 3; ++k) this.center[k] += (-dx * right[k] + dy * up[k]) / scale;
  }
  zoomBy(factor) {
    this.zoom = Math.max(0.2, Math.min(500, this.zoom * factor));
  }
}
