// Draws a scene live in a canvas.
"use strict";

// The values of u_overlay, in order: names, and the meaning of their colours.
const kOverlays = [
  ["Light", ""], ["Base colour", ""], ["Normal", "red, green, blue: x, y, z"],
  ["Depth", "light: near; middle grey: as far as the camera's target"],
  ["Steps", "violet: few; green: more; yellow: many"],
  ["Exactness", "blue: exact distances; sand: lower bounds; red: estimates"],
];
const kNormal = 2, kExactness = 5;
const kSamples = 16;         // per pixel of a camera at rest
const kQuick = 25;           // milliseconds that a drawing should take, so that what comes next need not wait
const kFewRows = 16;
const kLeastCoarse = 0.125;  // share of the canvas's pixels along an axis

// Returns the share of work to be drawn next, relative to the last, which took so many milliseconds. These are known
// to a sixtieth of a second only.
const pace = took => took < kQuick ? 2 : took > 2 * kQuick ? kQuick / took : 1;

class LiveView {
  #gl;
  #say;
  #program = null;  // draws
  #pending = null;  // still compiles
  #scene = null;    // the last one given
  #camera = null;
  #isMoved = false;
  #overlay = 0;
  #exposure = 0;
  #slice = {axis: -1, at: 0, step: 1};
  #coarse = 0.5;    // share of the canvas's pixels along an axis that is drawn while the picture changes
  #moving = 0;      // timer that runs while the camera moves or scenes follow each other
  #next = kSamples;  // number of the sample to be drawn next
  #frame = 0;
  #row = 0;         // the first row of that sample that has not been drawn
  #rows = kFewRows;  // that are drawn at once
  #film = null;     // mean of the samples
  #fence = null;    // of the rows that the graphics card is drawing
  #started = 0;
  #coarseSize = null;  // of the coarse picture that the graphics card is drawing
  #isNew = false;   // no frame of the scene has been finished
  #isUntried = false;  // no frame of the program has been finished
  #probe = null;
  #onCamera = [];
  #onScene = [];

  // `say` shows a text to the user.
  constructor(canvas, say) {
    this.canvas = canvas;
    this.#say = say;
    this.#gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    this.#prepare();
    canvas.addEventListener("webglcontextlost", event => {
      event.preventDefault();
      this.#program = this.#pending = this.#fence = null;
      this.#say("The graphics card has given up on the live picture: the scene may be too much for it.");
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.#prepare();
      if (this.#scene) this.setScene(this.#scene);
    });
    new ResizeObserver(() => this.#settleSoon()).observe(canvas);
    new LiveInput(this);
  }

  #prepare() {
    const gl = this.#gl;
    if (!gl) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    this.#film = new LiveTarget(gl), this.#probe = new LiveTarget(gl);
  }

  // Shows a scene as soon as its shader is compiled. The scene before it stays until then, and for good if the driver
  // refuses the shader. A camera that the user has moved stays, too.
  setScene(scene) {
    this.#scene = scene;
    if (!this.#camera || !this.#isMoved) this.#camera = new LiveCamera(scene.camera);
    if (!this.#gl) return this.#say("This browser has no WebGL2, which the live picture needs.");
    if (this.#pending?.scene.shader === scene.shader) return;
    this.#pending?.delete();
    this.#pending = null;
    if (this.#program?.scene.shader === scene.shader) {
      this.#adopt(this.#program);
      return this.#drawAhead();
    }
    this.#pending = new LiveProgram(this.#gl, scene);
    this.#wake();
  }

  #adopt(program) {
    if (program !== this.#program) {
      this.#program?.delete();
      this.#isUntried = true;
      this.#rows = kFewRows;
    }
    this.#program = program;
    program.use(this.#scene);
    this.#isNew = true;
    this.#say(this.#scene.summary);
    this.#tellCamera();
    this.#settleSoon();
  }

  #finishPending() {
    if (!this.#pending?.isReady()) return;
    const program = this.#pending, error = this.#gl.isContextLost() ? null : program.error();
    this.#pending = null;
    if (error === null) return this.#adopt(program);
    program.delete();
    const stays = this.#program ? "; the last scene stays" : "";
    this.#say(`The graphics driver refuses the scene's shader${stays}: ${error}`);
  }

  // Takes over the exactness of the surfaces of the scene given last, which the page may know later than the scene.
  setExactness(exactness) {
    if (!this.#scene) return;
    this.#scene.exactness = exactness;
    if (this.#program?.scene !== this.#scene) return;
    this.#program.showExactness();
    this.#redraw();
  }

  // False in a browser that cannot draw.
  get isAble() { return this.#gl !== null; }
  // The scene in the picture, or null.
  get scene() { return this.#program?.scene ?? null; }
  // False while the camera is the scene's own.
  get isMoved() { return this.#isMoved; }
  get camera() { return this.#camera ? {...this.#camera.pose} : null; }
  set camera(pose) { this.change(camera => Object.assign(camera.pose, pose)); }
  get overlay() { return this.#overlay; }
  set overlay(number) { this.#overlay = number, this.#settleSoon(); }
  // Stops added to the scene's exposure.
  get exposure() { return this.#exposure; }
  set exposure(stops) { this.#exposure = stops, this.#settleSoon(); }
  get slice() { return {...this.#slice}; }
  set slice(slice) { Object.assign(this.#slice, slice), this.#settleSoon(); }

  // Calls back at every change of the camera.
  onCamera(callback) { this.#onCamera.push(callback); }
  // Calls back when the first frame of a scene has been drawn.
  onScene(callback) { this.#onScene.push(callback); }

  halfFor(width, height) { return this.#camera.halfFor(width, height); }
  cameraText() { return this.#camera.text(); }
  say(text) { this.#say(text); }

  // Changes the camera by a function of it.
  change(edit) {
    if (!this.#camera) return;
    edit(this.#camera);
    this.#isMoved = true;
    this.#settleSoon();
    this.#tellCamera();
  }

  resetCamera() {
    if (!this.#scene) return;
    this.#camera = new LiveCamera(this.#scene.camera);
    this.#isMoved = false;
    this.#settleSoon();
    this.#tellCamera();
  }

  #tellCamera() { for (const callback of this.#onCamera) callback(this.camera); }

  #settleSoon() {
    clearTimeout(this.#moving);
    this.#moving = setTimeout(() => {
      this.#moving = 0;
      this.#redraw();
    }, 250);
    this.#redraw();
  }

  #redraw() {
    this.#next = this.#row = 0;
    this.#wake();
  }

  #wake() { this.#frame ||= requestAnimationFrame(() => this.#tick()); }

  // Draws coarsely while the picture changes, so that a frame takes less than a thirtieth of a second, then finely,
  // with kSamples samples per pixel one after another. No drawing takes the graphics card long, so that the next
  // change need not wait.
  #tick() {
    this.#frame = 0;
    if (!this.#gl || this.#gl.isContextLost()) return;
    this.#finishPending();
    if (this.#fence) this.#finishDrawing();
    if (this.#program && !this.#fence && this.#next < kSamples) this.#drawNext();
    if (this.#pending || this.#fence || (this.#program && this.#next < kSamples)) this.#wake();
  }

  // Draws at once instead of in the browser's next frame, unless the graphics card is busy.
  #drawAhead() {
    if (!this.#fence) this.#drawNext();
  }

  #drawNext() {
    const gl = this.#gl;
    if (this.#moving) this.#drawCoarsely();
    else this.#drawStrip();
    this.#started = performance.now();
    this.#fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  #drawCoarsely() {
    this.#coarseSize = this.#size(this.#coarse);
    this.#film.bind(...this.#size(1));
    this.#draw(...this.#coarseSize, 0);
    this.#next = kSamples;
  }

  // Draws the next rows of a sample beside the canvas. The canvas gets whole samples only.
  #drawStrip() {
    const gl = this.#gl, [width, height] = this.#size(1);
    if (this.#film.bind(width, height)) this.#next = this.#row = 0;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, this.#row, width, this.#rows);
    this.#draw(width, height, this.#next);
    gl.disable(gl.SCISSOR_TEST);
    this.#row += this.#rows;
  }

  // Shows what the graphics card has finished, if that is a whole picture.
  #finishDrawing() {
    const gl = this.#gl;
    if (gl.clientWaitSync(this.#fence, 0, 0) === gl.TIMEOUT_EXPIRED) return;
    gl.deleteSync(this.#fence);
    this.#fence = null;
    const took = performance.now() - this.#started, {width, height} = this.#film, coarse = this.#coarseSize;
    this.#coarseSize = null;
    if (coarse) {
      // Drivers finish a program when it first draws.
      if (!this.#isUntried) this.#coarse = Math.min(1, Math.max(kLeastCoarse, this.#coarse * Math.sqrt(pace(took))));
      this.#isUntried = false;
      return this.#show(...coarse);
    }
    this.#rows = Math.min(height, Math.max(kFewRows, Math.round(this.#rows * pace(took))));
    if (this.#row < height) return;
    this.#row = 0;
    ++this.#next;
    this.#show(width, height);
  }

  // Copies the lower left part of the film, which has been drawn, into a canvas of that part's size.
  #show(width, height) {
    const canvas = this.canvas;
    if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
    this.#film.show(width, height);
    this.#tellScene();
  }

  #tellScene() {
    if (!this.#isNew) return;
    this.#isNew = false;
    for (const callback of this.#onScene) callback(this.#program.scene);
  }

  // Returns the canvas's size in pixels, a share of those of the screen along each axis.
  #size(share) {
    const ratio = window.devicePixelRatio * share;
    return [this.canvas.clientWidth, this.canvas.clientHeight].map(length => Math.max(1, Math.round(length * ratio)));
  }

  // Draws a sample per pixel, the number `sample` of those that the picture is the mean of. Their places in the
  // pixel are Roberts' sequence ("The Unreasonable Effectiveness of Quasirandom Sequences", 2018), after the middle.
  #draw(width, height, sample) {
    const gl = this.#gl;
    gl.viewport(0, 0, width, height);
    this.#setView(width, height, this.#overlay, this.#slice.axis);
    const place = [sample * 0.7548777 % 1 - 0.5, sample * 0.5698403 % 1 - 0.5];
    this.#program.set("u_offset", sample > 0 ? place : [0, 0]);
    gl.blendColor(0, 0, 0, 1 / (sample + 1));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  #setView(width, height, overlay, axis) {
    const program = this.#program, camera = this.#camera, {right, up, forward} = camera.axes();
    program.setInteger("u_orthographic", camera.pose.orthographic ? 1 : 0);
    program.set("u_size", [width, height]);
    program.set("u_position", camera.pose.position), program.set("u_target", camera.pose.target);
    program.set("u_right", right), program.set("u_up", up), program.set("u_forward", forward);
    program.set("u_half", camera.halfFor(width, height));
    program.set("u_exposure", program.scene.exposure * 2 ** this.#exposure);
    program.setInteger("u_overlay", overlay);
    program.setInteger("u_slice_axis", axis);
    program.set("u_slice_at", this.#slice.at), program.set("u_slice_step", this.#slice.step);
  }

  // Returns the surface's point at (x, y), shares of the canvas from its upper left corner, or null. Halves the ray's
  // length until its end is at the surface: a shorter ray's pixel is that of a miss.
  pointAt(x, y) {
    const gl = this.#gl, program = this.#program;
    if (!program) return null;
    const {width, height} = this.canvas, far = program.scene.far, seen = new Uint8Array(4);
    this.#probe.bind(1, 1);
    gl.viewport(0, 0, 1, 1);
    gl.blendColor(0, 0, 0, 1);
    this.#setView(width, height, kNormal, -1);
    program.set("u_offset", [x * width - 0.5, (1 - y) * height - 0.5]);
    const colorTo = end => {
      program.set("u_far", end);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, seen);
      return seen.join();
    };
    const miss = colorTo(0), isHit = colorTo(far) !== miss;
    let near = 0, end = far;
    for (let i = 0; isHit && i < 24; ++i) {
      const middle = (near + end) / 2;
      if (colorTo(middle) === miss) near = middle;
      else end = middle;
    }
    program.set("u_far", far);
    return isHit ? this.#along(x, y, end) : null;
  }

  #along(x, y, distance) {
    const {right, up, forward} = this.#camera.axes(), {position, orthographic} = this.#camera.pose;
    const half = this.#camera.halfFor(this.canvas.width, this.canvas.height);
    const aside = add(scaled(right, (2 * x - 1) * half[0]), up, (1 - 2 * y) * half[1]);
    if (orthographic) return add(add(position, aside), forward, distance);
    return add(position, unit(add(forward, aside)), distance);
  }
}
