// The WebGL programs and pictures of a live view.
"use strict";

// True if a processor draws instead of a graphics card. It reads uniforms so slowly that a copy of them pays for
// itself: showcase.json draws six times as fast in SwiftShader.
function isSoftware(gl) {
  const known = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(known ? known.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

// The program that draws one scene, and all others of the same shader. It compiles beside the page's work where the
// browser can.
class LiveProgram {
  #gl;
  #shaders;
  #places = new Map();
  #parallel;
  #numbers;

  constructor(gl, scene) {
    this.#gl = gl;
    this.scene = scene;
    this.program = gl.createProgram();
    this.#parallel = gl.getExtension("KHR_parallel_shader_compile");
    this.#shaders = [
      [gl.VERTEX_SHADER, `#version 300 es
        void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`],
      [gl.FRAGMENT_SHADER, "#version 300 es\n" + (isSoftware(gl) ? "#define COPY_NUMBERS\n" : "") +
        "precision highp float;\nprecision highp int;\n" + scene.shader],
    ].map(([type, text]) => this.#attach(type, text));
    gl.linkProgram(this.program);
    this.#numbers = gl.createBuffer();
  }

  #attach(type, text) {
    const gl = this.#gl, shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(this.program, shader);
    return shader;
  }

  isReady() {
    return !this.#parallel || this.#gl.getProgramParameter(this.program, this.#parallel.COMPLETION_STATUS_KHR);
  }

  // Returns the driver's reason against the program, or null.
  error() {
    const gl = this.#gl;
    if (gl.getProgramParameter(this.program, gl.LINK_STATUS)) return null;
    const reasons = this.#shaders.map(shader => gl.getShaderInfoLog(shader) || "");
    return reasons.join("").trim() || gl.getProgramInfoLog(this.program) || "it gives no reason";
  }

  delete() {
    for (const shader of this.#shaders) this.#gl.deleteShader(shader);
    this.#gl.deleteProgram(this.program);
    this.#gl.deleteBuffer(this.#numbers);
  }

  #place(name) {
    if (!this.#places.has(name)) this.#places.set(name, this.#gl.getUniformLocation(this.program, name));
    return this.#places.get(name);
  }

  set(name, values) {
    const at = this.#place(name);
    if (at === null) return;
    if (typeof values === "number") this.#gl.uniform1f(at, values);
    else this.#gl["uniform" + values.length + "f"](at, ...values);
  }

  setInteger(name, value) {
    this.#gl.uniform1i(this.#place(name), value);
  }

  // Draws with the scene's numbers from now on. The scene has this program's shader.
  use(scene) {
    const gl = this.#gl, block = gl.getUniformBlockIndex(this.program, "scene_block");
    this.scene = scene;
    gl.useProgram(this.program);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.#numbers);
    gl.bufferData(gl.UNIFORM_BUFFER, new Uint32Array(scene.numbers), gl.DYNAMIC_DRAW);
    if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(this.program, block, 0);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.#numbers);
    this.set("u_far", scene.far);
    this.set("u_bottom", scene.bottom);
    this.set("u_top", scene.top);
    this.set("u_inverse_lipschitz", scene.inverseLipschitz);
    this.set("u_lo", scene.box[0]), this.set("u_hi", scene.box[1]);
    this.set("u_slice_lo", scene.sliceBox[0]), this.set("u_slice_hi", scene.sliceBox[1]);
    this.setInteger("u_lights", scene.lights.length);
    scene.lights.forEach((light, i) => {
      this.set(`u_light[${i}]`, light.at);
      this.set(`u_power[${i}]`, [...light.power, light.radius]);
    });
    scene.surfaces.forEach((surface, i) => {
      this.set(`u_color[${i}]`, [...surface.color, surface.roughness]);
      this.set(`u_glow[${i}]`, [...surface.emission, surface.metalness]);
    });
    this.showExactness();
  }

  // Takes over the exactness of the scene's surfaces, if it is known.
  showExactness() {
    const {exactness} = this.scene;
    if (exactness) this.#gl.uniform1uiv(this.#place("u_exactness[0]"), exactness);
  }
}

// A picture in the graphics card's memory.
class LiveTarget {
  #gl;
  #buffer;
  #pixels;
  width = 0;
  height = 0;

  constructor(gl) {
    this.#gl = gl;
    this.#buffer = gl.createFramebuffer();
    this.#pixels = gl.createRenderbuffer();
  }

  // Makes this what is drawn into. Returns true if that has lost the picture, which had another size.
  bind(width, height) {
    const gl = this.#gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.#buffer);
    if (this.width === width && this.height === height) return false;
    this.width = width, this.height = height;
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.#pixels);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.#pixels);
    return true;
  }

  // Copies the lower left part of the picture into a canvas of the part's size.
  show(width, height) {
    const gl = this.#gl;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.#buffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }
}
