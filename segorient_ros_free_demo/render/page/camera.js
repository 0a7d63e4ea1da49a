// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Where the viewer is: parallel projection as in the program's pictures. The cloud lies in a cube of
// side 1 from the origin.

class Camera {
  // Shows positions (three numbers a point, 0 to 65535) as large as they fit.
  constructor(positions) {
    this.home = {azimuth: 35, elevation: 25, zoom: 1, center: [0, 0, 0], sides: [1, 1]};
    this.reset();
    const axes = this.axes(), low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    for (let i = 0; i < positions.length; i += 3) {
      for (let k = 0; k < 3; ++k) {
        const axis = axes[k];
        const v = axis[0] * positions[i] + axis[1] * positions[i + 1] + axis[2] * positions[i + 2];
        if (v < low[k]) low[k] = v;
        if (v > high[k]) high[k] = v;
      }
    }
    const middle = low.map((l, k) => (l + high[k]) / 131070);
    this.home.center = [0, 1, 2].map((a) => axes.reduce((sum, axis, k) => sum + axis[a] * middle[k], 0));
    this.home.sides = [0, 1].map((k) => Math.max(1e-3, (high[k] - low[k]) / 65535));
    this.reset();
  }
  reset() {
    Object.assign(this, this.home, {center: this.home.center.slice()});
  }
  axes() {  // right, up, towards the viewer
    const a = this.azimuth * Math.PI / 180, e = this.elevation * Math.PI / 180;
    const ca = Math.cos(a), sa = Math.sin(a), ce = Math.cos(e), se = Math.sin(e);
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  }
  scale(width, height) {  // pixels for the cube's side
    return 0.92 * this.zoom * Math.min(width / this.sides[0], height / this.sides[1]);
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
