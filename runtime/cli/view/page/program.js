// The program as a list of instructions, and listings of how it came about.
"use strict";

import {byId, connectRows, element, get, short} from "./server.js";
import {showMask} from "./mask.js";
import {markLine, textOfLine} from "./source.js";
import {onTab, openTab, showTab} from "./tabs.js";

const kChunk = 500;  // rows that are made at once

const list = byId("program"), kind = byId("program-kind"), text = byId("passes"), note = byId("program-note");
const lineButton = byId("program-line");
let version = 0, asked = 0, code = [], highest = 1;
let loading = Promise.resolve();
let pinned = [];      // instructions that the user has chosen
let lineShown = 0;
const lineCallbacks = [];

// Calls back with the line that the user wants to see.
export const onProgramLine = callback => lineCallbacks.push(callback);

const rowOf = instruction => list.querySelector(`[data-offset="${instruction.offset}"]`);
const instructionOf = row => code[Number(row.dataset.index)];

// Returns the instruction's line in the scene's own file, or 0: symbols of imported files name them.
const ownLine = each => /" in [^"]+$|^[^"]* in [^"]+$/.test(each.symbol ?? "") ? 0 : each.source?.line ?? 0;

function makeRow(instruction, index) {
  const {offset, op, operand, immediates, cost, symbol} = instruction;
  const numbers = Object.entries(immediates).map(([name, value]) => `${name} ${short(value)}`);
  if (operand !== undefined) numbers.unshift(String(operand));
  const bar = element("span", {className: "cost", title: `${cost} multiply-adds`}, String(cost));
  bar.style.setProperty("--share", `${100 * cost / highest}%`);
  return element("div", {role: "option", tabIndex: index === 0 ? 0 : -1, "data-offset": offset, "data-index": index,
                         "aria-selected": false},
                 element("span", {className: "offset"}, String(offset)), element("b", {}, op), bar,
                 element("span", {className: "operands"}, numbers.join("  ")),
                 element("span", {className: "symbol"}, symbol ?? ""));
}

// Makes the rows up to an index, and a few more.
function makeRows(upTo) {
  const from = list.children.length, to = Math.min(code.length, Math.max(upTo + 1, from + kChunk));
  list.append(...code.slice(from, to).map((each, i) => makeRow(each, from + i)));
}

async function load() {
  const wanted = version;
  try {
    const program = await (await get("program")).json();
    code = program.code;
    highest = Math.max(1, ...code.map(each => each.cost));
    asked = wanted;
    pinned = [];
    list.replaceChildren();
    makeRows(0);
    note.textContent = `${program.instructions} instructions, about ${program.cost} multiply-adds a point`;
  } catch (error) {
    note.textContent = error.message;
  }
}

function ready() {
  if (asked !== version) loading = loading.then(() => asked === version ? undefined : load());
  return loading;
}

async function showKind() {
  const wanted = kind.value;
  list.hidden = wanted !== "";
  text.hidden = wanted === "";
  lineButton.hidden = wanted !== "" || lineShown === 0;
  if (wanted === "") return ready();
  text.textContent = "…";
  let found;
  try {
    found = await (await get("listing", {kind: wanted})).text();
  } catch (error) {
    found = error.message;
  }
  if (kind.value === wanted) text.textContent = found;
}

export function setVersion(number) {
  version = number;
  showMask([]);
  if (openTab() === "program") showKind();
}

function showLine(line) {
  lineShown = line;
  lineButton.hidden = line === 0;
  if (line === 0) return;
  markLine(line);
  lineButton.textContent = `${line}: ${textOfLine(line)}`;
}

// Lights up where an instruction matters, and marks its line.
function look(row) {
  const instruction = instructionOf(row);
  showMask([instruction]);
  showLine(ownLine(instruction));
}

function mark(instructions) {
  for (const row of list.querySelectorAll("[aria-selected='true']")) row.ariaSelected = "false";
  for (const each of instructions) {
    const row = rowOf(each);
    if (row) row.ariaSelected = "true";
  }
  pinned = instructions;
}

function lookBack() {
  showMask(pinned);
  if (pinned.length > 0) showLine(ownLine(pinned[0]));
}

// Marks the instructions of a line, lights up where they matter, and returns how many there are.
export async function chooseLine(line) {
  await ready();
  const found = code.filter(each => ownLine(each) === line);
  if (found.length > 0) makeRows(code.indexOf(found.at(-1)));
  mark(found);
  showMask(found);
  showLine(found.length > 0 ? line : 0);
  if (found.length > 0) rowOf(found[0]).scrollIntoView({block: "nearest"});
  return {count: found.length, cost: found.reduce((sum, each) => sum + each.cost, 0)};
}

connectRows(list, row => mark([instructionOf(row)]));
list.addEventListener("pointerover", event => {
  const row = event.target.closest("[role='option']");
  if (row) look(row);
});
list.addEventListener("focusin", event => look(event.target));
list.addEventListener("pointerleave", lookBack);
list.addEventListener("scroll", () => {
  const isNearEnd = list.scrollTop + 2 * list.clientHeight > list.scrollHeight;
  if (isNearEnd && list.children.length < code.length) makeRows(0);
});
lineButton.addEventListener("click", () => { for (const callback of lineCallbacks) callback(lineShown); });
kind.addEventListener("change", showKind);
document.addEventListener("keydown", event => {
  if (event.key !== "Escape") return;
  mark([]);
  showMask([]);
});
onTab(name => {
  if (name !== "program") return;
  showKind();
  if (pinned.length > 0) rowOf(pinned[0])?.scrollIntoView({block: "center"});
});
export const showProgram = () => showTab("program");
