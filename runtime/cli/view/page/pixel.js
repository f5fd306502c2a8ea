// What is known about a pixel: the surface, how the ray came there, and the program at that point.
"use strict";

import {byId, element, get, latest, short} from "./server.js";
import {plotSteps} from "./plot.js";

const panel = byId("pixel");
const lineCallbacks = [], answerCallbacks = [];

// Calls back with the line that the user wants to see.
export const onPixelLine = callback => lineCallbacks.push(callback);
// Calls back with every answer.
export const onAnswer = callback => answerCallbacks.push(callback);

const point = v => v.map(short).join(", ");

function lineLink({line, column}) {
  const button = element("button", {type: "button", className: "link"}, `${line}:${column}`);
  button.addEventListener("click", () => { for (const callback of lineCallbacks) callback(line); });
  return button;
}

function facts(answer) {
  const rows = [
    ["object", answer.object], ["material", answer.material],
    ["source", answer.line ? lineLink(answer) : undefined],
    ["position", answer.position && point(answer.position)], ["normal", answer.normal && point(answer.normal)],
    ["distance", answer.distance], ["slope there", answer.slope], ["known by", answer.certificate],
    ["distances are", answer.exactness], ["Lipschitz constant", answer.lipschitz ?? "unknown"],
    ["evaluations", answer.evaluations], ["instructions", answer.instructions],
    ["ray's origin", answer.origin && point(answer.origin)],
    ["ray's direction", answer.direction && point(answer.direction)],
  ];
  const table = element("table");
  for (const [name, value] of rows) {
    if (value === undefined || value === null || value === "") continue;
    const cell = element("td", {}, value instanceof Node ? value : short(value));
    table.append(element("tr", {}, element("th", {scope: "row"}, name), cell));
  }
  return table;
}

// Returns buttons that show the program at a point.
function listings(at) {
  const text = element("pre", {className: "text", tabIndex: 0, hidden: true, "aria-label": "Listing"});
  const bar = element("div", {className: "bar"});
  const kinds = [["run", "Run the program here"], ["region", "Program of this region"]];
  for (const [kind, label] of kinds) {
    const button = element("button", {type: "button", "data-kind": kind, "aria-pressed": false}, label);
    button.addEventListener("click", async () => {
      for (const other of bar.children) other.ariaPressed = String(other === button);
      text.hidden = false;
      text.textContent = "…";
      try {
        text.textContent = await (await get("listing", {kind, at: at.join()})).text();
      } catch (error) {
        text.textContent = error.message;
      }
    });
    bar.append(button);
  }
  return [bar, text];
}

function show(answer, x, y) {
  const title = answer.hit ? answer.object || "A surface without a name" : "Nothing: the ray meets no surface";
  const place = element("small", {}, `pixel ${Math.floor(x)}, ${Math.floor(y)}`);
  panel.replaceChildren(element("h2", {}, title, " ", place), facts(answer));
  panel.dataset.hit = String(answer.hit);
  panel.classList.remove("old");
  if (answer.steps?.length > 1) panel.append(element("h3", {}, "Field along the ray"), plotSteps(answer.steps));
  if (answer.position) panel.append(...listings(answer.position));
}

const ask = latest(async ([x, y]) => {
  try {
    const answer = await (await get("pixel", {x, y})).json();
    show(answer, x, y);
    for (const callback of answerCallbacks) callback(answer);
  } catch (error) {
    panel.replaceChildren(element("p", {className: "note"}, error.message));
  }
});

// Says that what the panel shows is about a view or a scene of before.
export const outdatePixel = () => panel.classList.add("old");
export const askPixel = (x, y) => ask([x, y]);
