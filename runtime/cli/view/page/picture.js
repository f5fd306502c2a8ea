// The pictures: the live one, and over it the true one of the same camera, which the server renders.
"use strict";

import {byId, get, latest, post, short} from "./server.js";

// Each choice sets the live picture's overlay and the true picture's layer. Not every choice exists in both.
const kChoices = [
  ["light", "Light", 0, "color"],
  ["base", "Base colour", 1, "albedo"],
  ["normal", "Normal", 2, "normal"],
  ["depth", "Depth", 3, "depth"],
  ["steps", "Steps", 4, "evaluations"],
  ["instructions", "Instructions (true picture)", 4, "instructions"],
  ["exactness", "Exactness (live picture)", 5, "color"],
];
const kMaxPixels = 2 ** 21, kMinSide = 16, kMaxSide = 4096;  // of the true picture
const kStill = 4;  // pixels that a pointer may move in a click

const stage = byId("stage"), image = byId("true"), mark = byId("mark");

export const view = new LiveView(byId("live"), text => { byId("status").textContent = text; });

let mode = view.isAble ? "both" : "true", layer = "color";
let cameraId = Math.floor(Math.random() * 9e8);  // pages that are open at the same time differ
let asked = "";       // the last view that the server was asked for
let event = null;     // the newest picture's facts
let shownCamera = 0;  // of the true picture in the page
let shown = 0;        // its number
let shownVersion = 0, version = 0;  // of the scene: that of the true picture, and the newest good one
const viewCallbacks = [], clickCallbacks = [];

export const pictureNumber = () => shown;
// The version of the scene that the true picture in the page shows.
export const pictureVersion = () => shownVersion;
// The number of the view that the server was asked for last.
export const viewId = () => cameraId;
// Calls back when the camera or the size has changed, so that facts about pixels are out of date.
export const onView = callback => viewCallbacks.push(callback);
// Calls back with the place of a click, pixels of the true picture.
export const onPixel = callback => clickCallbacks.push(callback);

function pictureSize() {
  const width = Math.max(1, stage.clientWidth), height = Math.max(1, stage.clientHeight);
  const scale = Math.min(window.devicePixelRatio, Math.sqrt(kMaxPixels / (width * height)));
  const side = length => Math.min(kMaxSide, Math.max(kMinSide, Math.floor(length * scale)));
  return [side(width), side(height)];
}

function wantedView() {
  const [width, height] = pictureSize();
  const camera = view.isMoved ? {...view.camera, half: view.halfFor(width, height)} : null;
  return {width, height, camera};
}

const sendView = latest(async () => {
  const wanted = wantedView();
  await post("camera", {id: cameraId, ...wanted});
}, 30);

// Asks for the true picture of the camera as it is now.
export function askForView(isAgain = false) {
  if (!view.camera) return;
  const text = JSON.stringify(wantedView());
  if (text === asked && !isAgain) return;
  asked = text;
  ++cameraId;
  mark.hidden = true;
  showPictures();
  sendView();
  for (const callback of viewCallbacks) callback();
}

function showPictures() {
  const isCurrent = shown > 0 && shownCamera === cameraId && image.naturalWidth > 0;
  stage.dataset.mode = mode;
  image.hidden = mode === "live" || !isCurrent;
  const isOld = shownVersion !== version;
  byId("side-true").textContent = !isCurrent ? "true picture to come" : isOld ? "true, before the change" : "true";
  byId("side-live").hidden = mode === "true" && isCurrent;
  byId("side-true").hidden = mode === "live";
  byId("split").hidden = mode !== "both";
}

// Shows a file in the place of the last one, which stays until the new one is decoded.
async function swap(blob) {
  const url = URL.createObjectURL(blob), next = new Image(), before = image.src;
  next.src = url;
  await next.decode();
  image.src = url;
  await image.decode();
  if (before) URL.revokeObjectURL(before);
}

const fetchPicture = latest(async () => {
  if (!event || mode === "live" || event.camera !== cameraId) return;
  const wanted = event, exposure = byId("exposure").value;
  const response = await get("picture", {layer, exposure, denoise: byId("denoise").value});
  const blob = await response.blob();
  if (blob.size === 0 || wanted.camera !== cameraId) return;  // out of date
  await swap(blob);
  shown = Number(response.headers.get("X-Picture")) || wanted.number;
  shownCamera = wanted.camera;
  shownVersion = wanted.version;
  image.dataset.picture = shown;
  showPictures();
});

// The server compiles the scene once more to know the exactness of its surfaces, so it is asked only when needed.
const fetchExactness = latest(async () => {
  if (view.overlay === kExactness) view.setExactness(await (await get("exactness")).json());
});

export function setSceneVersion(number) {
  version = number;
  fetchExactness();
  showPictures();
}

export function tellPicture(data) {
  event = data;
  const {samples, spp, seconds, noise, width, height, done, camera} = data;
  if (camera !== cameraId) return;
  byId("progress-bar").value = spp > 0 ? samples / spp : 0;
  const facts = [samples === 0 ? "first look" : `${samples} of ${spp} samples`, `${width} × ${height}`];
  if (noise !== null) facts.push(`noise ${short(Number(noise.toPrecision(2)))}`);
  facts.push(`${seconds.toFixed(1)} s`);
  if (done) facts.push("done");
  byId("progress-text").textContent = facts.join(" · ");
  byId("progress").dataset.done = String(done);
  byId("progress").dataset.samples = samples;
  fetchPicture();
}

function connectBar() {
  const overlay = byId("overlay");
  for (const [value, text] of kChoices) overlay.add(new Option(text, value));
  overlay.addEventListener("change", () => {
    const choice = kChoices.find(([value]) => value === overlay.value);
    view.overlay = choice[2], layer = choice[3];
    fetchExactness();
    byId("side-live").textContent = kOverlays[view.overlay][1] ? `live – ${kOverlays[view.overlay][1]}` : "live";
    fetchPicture();
  });
  document.querySelector(`input[name="mode"][value="${mode}"]`).checked = true;
  byId("mode").addEventListener("change", change => {
    mode = change.target.value;
    showPictures();
    fetchPicture();
  });
  byId("exposure").addEventListener("input", () => {
    const stops = Number(byId("exposure").value);
    view.exposure = stops;
    byId("exposure-stops").textContent = stops > 0 ? `+${stops}` : stops;
    fetchPicture();
  });
  byId("denoise").addEventListener("change", () => fetchPicture());
  const split = byId("split");
  split.addEventListener("input", () => stage.style.setProperty("--split", `${split.value}%`));
}

// Marks the place, shares of the stage, and asks about it.
function choosePixel(x, y) {
  mark.style.left = `${100 * x}%`;
  mark.style.top = `${100 * y}%`;
  mark.hidden = false;
  const [width, height] = pictureSize();
  for (const callback of clickCallbacks) callback(x * width, y * height);
}

function connectClicks() {
  const canvas = view.canvas;
  let pressed = null;
  canvas.addEventListener("pointerdown", down => {
    pressed = down.isPrimary && down.button === 0 && !down.shiftKey ? [down.clientX, down.clientY] : null;
  });
  canvas.addEventListener("pointerup", up => {
    const isStill = pressed && Math.hypot(up.clientX - pressed[0], up.clientY - pressed[1]) <= kStill;
    pressed = null;
    if (!isStill || !up.isPrimary) return;
    const box = stage.getBoundingClientRect();
    const within = x => Math.min(1, Math.max(0, x));
    choosePixel(within((up.clientX - box.x) / box.width), within((up.clientY - box.y) / box.height));
  });
  canvas.addEventListener("keydown", press => { if (press.key === "Enter") choosePixel(0.5, 0.5); });
}

connectBar();
connectClicks();
showPictures();
view.onCamera(() => askForView());
new ResizeObserver(() => askForView()).observe(stage);
