// Draws the scene of the page, and moves the camera by mouse, finger and keys.
"use strict";

const scene = JSON.parse(document.getElementById("scene").textContent);
const canvas = document.getElementById("view"), status = document.getElementById("status");
const gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => a.map(x => x * s);
const unit = a => scaled(a, 1 / Math.hypot(...a));

function say(text) {
  status.textContent = text;
}

function compile(type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function makeProgram(fragment) {
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, `#version 300 es
    void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

// The camera: position, target and up, and the axes that follow from them (runtime/sampling/camera.h).
const camera = {...scene.camera};

function axes() {
  const forward = unit(add(camera.target, camera.position, -1));
  let right = cross(forward, camera.up);
  if (dot(right, right) < 1e-12) right = cross(forward, Math.abs(forward[2]) < 0.5 ? [0, 0, 1] : [1, 0, 0]);
  right = unit(right);
  return {right, up: cross(right, forward), forward, distance: Math.hypot(...add(camera.target, camera.position, -1))};
}

// Turns a vector about a unit axis (Rodrigues' formula).
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, dot(axis, v) * (1 - c)));
}

function orbit(dx, dy) {
  const {right, forward} = axes(), pole = unit(camera.up);
  const height = Math.asin(Math.min(1, Math.max(-1, -dot(forward, pole))));
  const limit = Math.PI / 2 - 0.01, tilt = Math.min(limit, Math.max(-limit, height + dy)) - height;
  const arm = add(camera.position, camera.target, -1);
  camera.position = add(camera.target, turned(turned(arm, right, -tilt), pole, -dx));
}

function move(x, y, z) {
  const {right, up, forward, distance} = axes();
  const by = scaled(add(add(scaled(right, x), up, y), forward, z), distance);
  camera.position = add(camera.position, by);
  camera.target = add(camera.target, by);
}

function zoom(factor) {
  camera.position = add(camera.target, add(camera.position, camera.target, -1), factor);
  if (camera.orthographic) camera.half = scaled(camera.half, factor);
}

// The camera as a statement of the scene's text.
function cameraText() {
  const number = x => Number(x.toPrecision(6)), list = a => "[" + a.map(number).join(", ") + "]";
  const [x, y, z] = camera.up, up = x === 0 && y === 1 && z === 0 ? "" : `, up = ${list(camera.up)}`;
  const size = camera.orthographic ? `, type = "orthographic", width = ${number(2 * camera.half[0])}`
                                   : `, fov = ${number(Math.atan(camera.half[0]) * 360 / Math.PI)}`;
  return `camera (position = ${list(camera.position)}, target = ${list(camera.target)}${up}${size})`;
}

// coarse: share of the canvas's pixels along each axis that is drawn while the camera moves.
let program, uniform, coarse = 1, moving = 0, frame = 0;

function set(name, values) {
  const at = uniform(name);
  if (at === null) return;
  if (typeof values === "number") gl.uniform1f(at, values);
  else gl["uniform" + values.length + "f"](at, ...values);
}

function setScene() {
  set("u_exposure", scene.exposure);
  set("u_far", scene.far);
  set("u_bottom", scene.bottom);
  set("u_top", scene.top);
  gl.uniform1i(uniform("u_bounded"), scene.bound ? 1 : 0);
  if (scene.bound) set("u_lo", scene.bound[0]), set("u_hi", scene.bound[1]);
  gl.uniform1i(uniform("u_lights"), scene.lights.length);
  scene.lights.forEach((light, i) => {
    set(`u_light[${i}]`, light.at);
    set(`u_power[${i}]`, [...light.power, light.radius]);
  });
  scene.surfaces.forEach((surface, i) => {
    set(`u_color[${i}]`, [...surface.color, surface.roughness]);
    set(`u_glow[${i}]`, [...surface.emission, surface.metalness]);
  });
}

// Draws a sample per pixel, the number `sample` of those that the canvas holds the mean of. Their places in the pixel
// are Roberts' sequence ("The Unreasonable Effectiveness of Quasirandom Sequences", 2018), after the middle.
function draw(scale, sample) {
  const ratio = window.devicePixelRatio * scale, box = canvas.getBoundingClientRect();
  const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
  if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
  gl.viewport(0, 0, width, height);
  const {right, up, forward} = axes(), aspect = height / width, own = camera.half[1] / camera.half[0];
  // The scene's own image fits into the canvas.
  const half = aspect > own ? [camera.half[0], camera.half[0] * aspect] : [camera.half[1] / aspect, camera.half[1]];
  gl.uniform1i(uniform("u_orthographic"), camera.orthographic ? 1 : 0);
  set("u_size", [width, height]);
  set("u_offset", [sample * 0.7548777 % 1 - 0.5, sample * 0.5698403 % 1 - 0.5].map(x => sample > 0 ? x : 0));
  set("u_position", camera.position), set("u_target", camera.target);
  set("u_right", right), set("u_up", up), set("u_forward", forward), set("u_half", half);
  gl.blendColor(0, 0, 0, 1 / (sample + 1));
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// Draws soon: coarsely while the camera moves, so that a frame takes less than a thirtieth of a second, then finely,
// with kSamples samples per pixel one after another.
const kSamples = 16;

function redraw(sample = 0) {
  cancelAnimationFrame(frame);
  frame = requestAnimationFrame(() => {
    const start = performance.now();
    draw(moving ? coarse : 1, sample);
    gl.finish();
    const took = performance.now() - start;
    if (moving) coarse = Math.min(1, Math.max(0.125, coarse * Math.sqrt(25 / Math.max(took, 5))));
    else if (sample + 1 < kSamples) redraw(sample + 1);
  });
}

function moved() {
  clearTimeout(moving);
  moving = setTimeout(() => {
    moving = 0;
    redraw();
  }, 250);
  redraw();
}

const pointers = new Map();
canvas.addEventListener("pointerdown", event => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => pointers.delete(e.pointerId));
canvas.addEventListener("pointermove", event => {
  const last = pointers.get(event.pointerId);
  if (!last) return;
  const dx = (event.clientX - last[0]) / canvas.clientHeight, dy = (event.clientY - last[1]) / canvas.clientHeight;
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  if (event.shiftKey || event.buttons === 2 || pointers.size === 2) move(-2 * camera.half[1] * dx, 2 * camera.half[1] * dy, 0);
  else orbit(4 * dx, 4 * dy);
  moved();
});
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  zoom(Math.exp(event.deltaY * 0.001));
  moved();
}, {passive: false});
window.addEventListener("keydown", event => {
  const step = 0.05, keys = {
    ArrowLeft: () => orbit(-step, 0), ArrowRight: () => orbit(step, 0), ArrowUp: () => orbit(0, step),
    ArrowDown: () => orbit(0, -step), w: () => move(0, 0, step), s: () => move(0, 0, -step), a: () => move(-step, 0, 0),
    d: () => move(step, 0, 0), q: () => move(0, -step, 0), e: () => move(0, step, 0), "+": () => zoom(0.95),
    "-": () => zoom(1 / 0.95), Home: () => Object.assign(camera, scene.camera),
    c: () => { say(cameraText()); navigator.clipboard?.writeText(cameraText()).catch(() => {}); },
  };
  if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in keys)) return;
  event.preventDefault();
  keys[event.key]();
  moved();
});
window.addEventListener("resize", () => redraw());

function start() {
  if (!gl) return say("This browser has no WebGL2, which the live picture needs.");
  try {
    program = makeProgram("#version 300 es\nprecision highp float;\nprecision highp int;\n" + scene.shader);
  } catch (error) {
    return say("The graphics driver refuses the scene's shader: " + error.message);
  }
  gl.useProgram(program);
  const places = new Map();
  uniform = name => {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
    return places.get(name);
  };
  setScene();
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
  say(scene.summary);
  redraw();
}
start();
