// The scene's parameters, changed while a slider moves, and written into the scene's file on demand.
"use strict";

import {byId, element, latest, post} from "./server.js";

const form = byId("parameters"), note = byId("parameters-note");
let shape = "";            // names and limits of the parameters that the form has fields for
let changed = {};          // values that differ from the file's
const rows = new Map();    // by name

const say = text => { note.textContent = text; };

const send = latest(async () => {
  try {
    await post("parameters", {values: changed});
    say("");
  } catch (error) {
    say(error.message);
  }
}, 20);

// Returns where the slider begins and ends. A parameter without limits gets a range about its value.
function sliderRange({min, max, value}) {
  const reach = Math.max(1, 2 * Math.abs(value));
  const low = min ?? Math.min(value < 0 ? value - reach : 0, max ?? 0);
  return [low, max ?? Math.max(value, low) + reach];
}

// Returns the slider's step: a whole number if all numbers are, else the round number below a 200th of the range.
function sliderStep(parameter, [low, high]) {
  const isWhole = [parameter.value, low, high].every(Number.isInteger) && high - low >= 10;
  const least = (high - low) / 200 || 1, power = 10 ** Math.floor(Math.log10(least));
  const round = [5, 2, 1].find(digit => digit * power <= least) * power;
  return isWhole ? Math.max(1, Math.round(round)) : round;
}

function change(name, value) {
  if (!Number.isFinite(value)) return;
  changed = {...changed, [name]: value};
  showChanged();
  send();
}

function showChanged() {
  for (const [name, {row}] of rows) row.classList.toggle("changed", Object.hasOwn(changed, name));
  const isSame = Object.keys(changed).length === 0;
  byId("keep").disabled = byId("reset").disabled = isSame;
}

function makeRow(parameter, index) {
  const {name, value, doc, min, max} = parameter, range = sliderRange(parameter), id = `parameter-${index}`;
  const slider = element("input", {type: "range", id, min: range[0], max: range[1], step: "any",
                                   "data-parameter": name});
  slider.step = sliderStep(parameter, range);
  slider.value = value;
  const number = element("input", {type: "number", step: "any", min: min ?? "", max: max ?? "", value,
                                   "aria-label": `${name}, number`, "data-parameter": name});
  if (doc) slider.setAttribute("aria-describedby", `${id}-doc`);
  slider.addEventListener("input", () => {
    number.value = slider.value;
    change(name, Number(slider.value));
  });
  number.addEventListener("input", () => {
    if (number.value === "" || !number.checkValidity()) return;
    slider.value = number.value;
    change(name, Number(number.value));
  });
  const row = element("div", {className: "parameter"}, element("label", {htmlFor: id}, name), slider, number);
  if (doc) row.append(element("small", {id: `${id}-doc`}, doc));
  rows.set(name, {row, slider, number});
  return row;
}

// Shows the values but that of a field in use.
function update(parameter) {
  const {slider, number} = rows.get(parameter.name);
  if (document.activeElement === slider || document.activeElement === number) return;
  slider.value = number.value = parameter.value;
}

export function showParameters(parameters) {
  const now = JSON.stringify(parameters.map(({name, min, max, doc}) => [name, min, max, doc]));
  if (now === shape) {
    parameters.forEach(update);
  } else {
    const names = new Set(parameters.map(({name}) => name));
    const isFirst = shape === "";
    shape = now;
    rows.clear();
    form.replaceChildren(...parameters.map(makeRow));
    if (parameters.length === 0) form.append(element("p", {className: "note"}, "The scene has no parameters."));
    changed = Object.fromEntries(Object.entries(changed).filter(([name]) => names.has(name)));
    for (const {name, value, default: usual} of isFirst ? parameters : []) {
      if (typeof usual === "number" && usual !== value) changed[name] = value;
    }
  }
  showChanged();
}

// Tells a server that may have been started anew what the user has changed.
export function sendAgain() {
  if (Object.keys(changed).length > 0) send();
}

async function keep() {
  try {
    const {written} = await (await post("keep", {values: changed})).json();
    changed = {};
    showChanged();
    say(`written: ${written.join(", ")}`);
    await post("parameters", {values: {}});
  } catch (error) {
    say(error.message);
  }
}

function reset() {
  changed = {};
  document.activeElement?.blur();
  showChanged();
  send();
}

form.addEventListener("submit", event => event.preventDefault());
byId("keep").addEventListener("click", keep);
byId("reset").addEventListener("click", reset);
