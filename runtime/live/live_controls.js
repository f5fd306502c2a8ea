// The controls of a live view: mouse, fingers and keys, overlays, slices.
"use strict";

// The camera's controls: drag, wheel, two fingers, keys, and a double click that makes a point the camera's target.
class LiveInput {
  #view;
  #pointers = new Map();

  constructor(view) {
    const canvas = view.canvas;
    this.#view = view;
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      this.#pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, event => this.#pointers.delete(event.pointerId));
    }
    canvas.addEventListener("pointermove", event => this.#drag(event));
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("dblclick", event => {
      const box = canvas.getBoundingClientRect();
      const point = view.pointAt((event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height);
      if (point) view.change(camera => { camera.pose.target = point; });
    });
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      view.change(camera => camera.zoom(Math.exp(event.deltaY * 0.001)));
    }, {passive: false});
    window.addEventListener("keydown", event => this.#press(event));
  }

  #drag(event) {
    const last = this.#pointers.get(event.pointerId), height = this.#view.canvas.clientHeight;
    if (!last) return;
    const now = [event.clientX, event.clientY], dx = (now[0] - last[0]) / height, dy = (now[1] - last[1]) / height;
    if (dx === 0 && dy === 0) return;
    this.#pointers.set(event.pointerId, now);
    this.#view.change(camera => {
      const size = 2 * camera.pose.half[1] / (camera.pose.orthographic ? camera.axes().distance : 1);
      if (this.#pointers.size === 2) {
        const [other] = [...this.#pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
        const apart = place => Math.max(1, Math.hypot(place[0] - other[0], place[1] - other[1]));
        camera.zoom(apart(last) / apart(now));
        camera.move(-size * dx / 2, size * dy / 2, 0);
      } else if (event.shiftKey || event.buttons === 2) {
        camera.move(-size * dx, size * dy, 0);
      } else {
        camera.orbit(4 * dx, 4 * dy);
      }
    });
  }

  #press(event) {
    const view = this.#view, step = 0.05, edit = change => () => view.change(change), keys = {
      ArrowLeft: edit(c => c.orbit(-step, 0)), ArrowRight: edit(c => c.orbit(step, 0)),
      ArrowUp: edit(c => c.orbit(0, step)), ArrowDown: edit(c => c.orbit(0, -step)),
      w: edit(c => c.move(0, 0, step)), s: edit(c => c.move(0, 0, -step)), a: edit(c => c.move(-step, 0, 0)),
      d: edit(c => c.move(step, 0, 0)), q: edit(c => c.move(0, -step, 0)), e: edit(c => c.move(0, step, 0)),
      "+": edit(c => c.zoom(0.95)), "-": edit(c => c.zoom(1 / 0.95)), Home: () => view.resetCamera(),
      c: () => {
        view.say(view.cameraText());
        navigator.clipboard?.writeText(view.cameraText()).catch(() => {});
      },
    };
    // Fields, lists and buttons need their keys themselves.
    if (event.target !== view.canvas && event.target !== document.body) return;
    if (event.ctrlKey || event.metaKey || event.altKey || !view.camera || !Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key]();
  }
}

// Fills a choice of overlays, and connects it. `key` shows what the colours mean.
function connectOverlay(view, select, key) {
  kOverlays.forEach(([name], number) => select.add(new Option(name, number)));
  select.addEventListener("change", () => {
    view.overlay = Number(select.value);
    key.textContent = kOverlays[view.overlay][1];
  });
}

// Connects a choice of axis and a range of places on it with the view's slice. `place` shows the place; `step` is the
// field of the distance between lines, if there is one.
function connectSlice(view, {axis, at, place, step}) {
  const update = () => {
    const chosen = Number(axis.value);
    at.disabled = chosen < 0;
    if (chosen < 0 || !view.scene) return view.slice = {axis: -1};
    const [low, high] = view.scene.slice.map(corner => corner[chosen]), isNewAxis = chosen !== view.slice.axis;
    const before = isNewAxis ? (low + high) / 2 : view.slice.at;
    at.min = low, at.max = high, at.step = (high - low) / 200 || 1, at.value = before;
    const auto = 10 ** Math.floor(Math.log10((high - low) / 5 || 1));
    if (step) step.placeholder = auto;
    view.slice = {axis: chosen, at: Number(at.value), step: Number(step?.value) > 0 ? Number(step.value) : auto};
    place.textContent = Number(Number(at.value).toPrecision(4));
  };
  axis.addEventListener("change", update);
  step?.addEventListener("input", update);
  at.addEventListener("input", () => {
    view.slice = {at: Number(at.value)};
    place.textContent = Number(Number(at.value).toPrecision(4));
  });
  view.onScene(update);
  update();
}
