// The scene's text with numbered lines, and the compiler's messages.
"use strict";

import {byId, connectRows, element} from "./server.js";

const list = byId("source");
const callbacks = [];
let text = null, hidden = "";

export const onLine = callback => callbacks.push(callback);
export const textOfLine = line => list.children[line - 1]?.lastChild.textContent.trim() ?? "";

function makeRow(line, index) {
  const number = element("span", {className: "number"}, String(index + 1));
  return element("div", {role: "option", tabIndex: index === 0 ? 0 : -1, "data-line": index + 1,
                         "aria-selected": false}, number, element("code", {}, line));
}

export function showSource(scene) {
  if (scene.text !== text) {
    text = scene.text;
    list.replaceChildren(...text.replace(/\n$/, "").split("\n").map(makeRow));
  }
  showMessages(scene);
}

// Lines of errors stand after an arrow, as in `--> name:12:3`.
function faultyLines({messages, name, path}) {
  const places = [...messages.matchAll(/--> (.*):(\d+):\d+/g)];
  return new Set(places.filter(place => place[1] === name || place[1] === path).map(place => Number(place[2])));
}

function showMessages(scene) {
  const {messages, good} = scene, box = byId("problem"), faulty = faultyLines(scene);
  byId("messages").textContent = messages;
  const loss = scene.live ? "The pictures are of the last version without errors." : "There is no picture yet.";
  byId("problem-title").textContent = good ? "The scene has warnings." : `The scene has errors. ${loss}`;
  box.dataset.good = String(good);
  box.hidden = messages === "" ? good : good && messages === hidden;
  for (const row of list.children) row.classList.toggle("faulty", faulty.has(Number(row.dataset.line)));
}

// Marks a line, and scrolls to it if asked.
export function markLine(line, isSought = false) {
  for (const row of list.querySelectorAll("[aria-selected='true']")) row.ariaSelected = "false";
  const row = list.children[line - 1];
  if (!row) return;
  row.ariaSelected = "true";
  if (isSought) row.scrollIntoView({block: "center"});
}

byId("problem-hide").addEventListener("click", () => {
  hidden = byId("messages").textContent;
  byId("problem").hidden = true;
});
connectRows(list, row => {
  const line = Number(row.dataset.line);
  markLine(line);
  for (const callback of callbacks) callback(line);
});
