// The camera of a live view, and the vectors that it is made of. The scripts live_*.js are for the pages of
// `fathom emit html` and `fathom view`, in this order: live_camera.js, live_program.js, live_view.js, live_controls.js.
"use strict";

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => a.map(x => x * s);
const unit = a => scaled(a, 1 / Math.hypot(...a));

// Turns a vector about a unit axis (Rodrigues' formula).
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, dot(axis, v) * (1 - c)));
}

// A camera: position, target, up, half the image's size and orthographic, as the scene has them, and the axes that
// follow from them (runtime/sampling/camera.h).
class LiveCamera {
  constructor(pose) {
    this.pose = {...pose};
  }

  axes() {
    const {position, target, up} = this.pose, arm = add(target, position, -1), forward = unit(arm);
    let right = cross(forward, up);
    if (dot(right, right) < 1e-12) right = cross(forward, Math.abs(forward[2]) < 0.5 ? [0, 0, 1] : [1, 0, 0]);
    right = unit(right);
    return {right, up: cross(right, forward), forward, distance: Math.hypot(...arm)};
  }

  orbit(dx, dy) {
    const {right, forward} = this.axes(), pose = this.pose, pole = unit(pose.up);
    const height = Math.asin(Math.min(1, Math.max(-1, -dot(forward, pole))));
    const limit = Math.PI / 2 - 0.01, tilt = Math.min(limit, Math.max(-limit, height + dy)) - height;
    const arm = add(pose.position, pose.target, -1);
    pose.position = add(pose.target, turned(turned(arm, right, -tilt), pole, -dx));
  }

  move(x, y, z) {
    const {right, up, forward, distance} = this.axes(), pose = this.pose;
    const by = scaled(add(add(scaled(right, x), up, y), forward, z), distance);
    pose.position = add(pose.position, by);
    pose.target = add(pose.target, by);
  }

  zoom(factor) {
    const pose = this.pose;
    pose.position = add(pose.target, add(pose.position, pose.target, -1), factor);
    if (pose.orthographic) pose.half = scaled(pose.half, factor);
  }

  // Returns half the size of an image of another shape. The scene's own image fits into it.
  halfFor(width, height) {
    const half = this.pose.half, aspect = height / width;
    return aspect > half[1] / half[0] ? [half[0], half[0] * aspect] : [half[1] / aspect, half[1]];
  }

  // The camera as a statement of the scene's text.
  text() {
    const number = x => Number(x.toPrecision(6)), list = a => "[" + a.map(number).join(", ") + "]", pose = this.pose;
    const [x, y, z] = pose.up, up = x === 0 && y === 1 && z === 0 ? "" : `, up = ${list(pose.up)}`;
    const size = pose.orthographic ? `, type = "orthographic", width = ${number(2 * pose.half[0])}`
                                   : `, fov = ${number(Math.atan(pose.half[0]) * 360 / Math.PI)}`;
    return `camera (position = ${list(pose.position)}, target = ${list(pose.target)}${up}${size})`;
  }
}
