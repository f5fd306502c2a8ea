// The page of `fathom view`: follows the server's events, and connects the panels with each other.
"use strict";

import {byId, element, get, latest} from "./server.js";
import {askForView, onPixel, onView, pictureNumber, pictureVersion, setSceneVersion, tellPicture, view, viewId} from "./picture.js";
import {redrawMask} from "./mask.js";
import {askPixel, onAnswer, onPixelLine, outdatePixel} from "./pixel.js";
import {chooseLine, onProgramLine, setVersion, showProgram} from "./program.js";
import {sendAgain, showParameters} from "./parameters.js";
import {markLine, onLine, showSource} from "./source.js";
import {showTab} from "./tabs.js";

const kPatience = 4000;  // milliseconds without the server before the page says how to go on
const kRetry = 3000;

let sceneVersion = 0;      // newest version of the scene that the page knows
let goodVersion = 0;       // newest version without errors
const versions = new Map();  // from the live picture's scenes to their versions
let liveFrame = null;      // {version, time} of the first frame of the newest scene

function connection(state, text) {
  byId("connection").dataset.state = state;
  byId("connection").textContent = text;
}

const loadScene = latest(async () => {
  const scene = await (await get("scene")).json();
  sceneVersion = scene.version;
  const isNew = scene.live && (scene.good || goodVersion === 0);
  // First, because drawing takes longest.
  if (isNew) {
    versions.clear();
    versions.set(scene.live, scene.version);
    view.setScene(scene.live);
  }
  document.title = `${scene.name} – Fathom`;
  byId("name").textContent = scene.name;
  byId("name").title = scene.path;
  showSource(scene);
  document.body.dataset.good = String(scene.good);
  if (!isNew) return;
  goodVersion = scene.version;
  showParameters(scene.parameters);
  setVersion(scene.version);
  setSceneVersion(scene.version);
  outdatePixel();
  askForView();
});

// A restarted server may answer at the same address. It knows nothing of this page's camera.
function follow() {
  const events = new EventSource("events");
  let lost = 0;
  events.addEventListener("open", () => {
    clearTimeout(lost);
    lost = 0;
    connection("connected", "connected");
    loadScene();
    sendAgain();
    askForView(true);
  });
  events.addEventListener("scene", event => {
    if (JSON.parse(event.data).version !== sceneVersion) loadScene();
  });
  events.addEventListener("picture", event => {
    const data = JSON.parse(event.data);
    tellPicture(data);
    if (data.camera === viewId()) redrawMask();
  });
  events.addEventListener("error", () => {
    if (byId("connection").dataset.state !== "ended") connection("lost", "connection lost; trying again…");
    lost ||= setTimeout(() => connection("ended", "The server has ended: start fathom view again and open its new " +
      "address. If it answers at this address, the page goes on by itself."), kPatience);
    if (events.readyState !== EventSource.CLOSED) return;
    setTimeout(follow, kRetry);
  });
}

view.onScene(scene => {
  liveFrame = {version: versions.get(scene) ?? 0, time: performance.now()};
});

onPixel((x, y) => {
  showTab("pixel");
  askPixel(x, y);
});
onView(outdatePixel);
onAnswer(answer => { if (answer.line) markLine(answer.line, true); });
for (const wantsLine of [onPixelLine, onProgramLine]) {
  wantsLine(line => {
    showTab("source");
    markLine(line, true);
  });
}
onLine(async line => {
  const {count, cost} = await chooseLine(line), note = byId("source-note");
  if (count === 0) {
    note.textContent = `Line ${line} has no instructions of its own.`;
    return;
  }
  const button = element("button", {type: "button", className: "link"}, "Show them");
  button.addEventListener("click", showProgram);
  const many = count === 1 ? "1 instruction" : `${count} instructions`;
  note.replaceChildren(`Line ${line}: ${many}, ${cost} multiply-adds a point. `, button);
});

connectSlice(view, {axis: byId("slice-axis"), at: byId("slice-at"), place: byId("slice-place"),
                    step: byId("slice-step")});
// Facts for tests.
window.fathomView = {
  get version() { return sceneVersion; },
  get live() { return liveFrame; },
  get picture() { return pictureNumber(); },
  get pictureVersion() { return pictureVersion(); },
  get camera() { return view.camera; },
  get connection() { return byId("connection").dataset.state; },
};
follow();
