// Requests to the server, and elements for its answers. All addresses are relative to the page's.
"use strict";

async function failure(response) {
  const text = await response.text();
  try {
    return new Error(JSON.parse(text).error ?? text);
  } catch {
    return new Error(text.trim() || `the server answers ${response.status}`);
  }
}

export async function get(path, values = {}) {
  const query = new URLSearchParams(values).toString();
  const response = await fetch(query ? `${path}?${query}` : path, {cache: "no-store"});
  if (!response.ok) throw await failure(response);
  return response;
}

export async function post(path, value) {
  const headers = {"Content-Type": "application/json"};
  const response = await fetch(path, {method: "POST", headers, body: JSON.stringify(value)});
  if (!response.ok) throw await failure(response);
  return response;
}

// Returns a function that runs `work`, one run at a time, `delay` milliseconds after it is called. Calls in the
// meantime count as one, that of the newest argument.
export function latest(work, delay = 0) {
  let argument, isWanted = false, isBusy = false;
  const run = async () => {
    isBusy = true;
    while (isWanted) {
      await new Promise(done => setTimeout(done, delay));
      isWanted = false;
      try {
        await work(argument);
      } catch (error) {
        console.warn(error);
      }
    }
    isBusy = false;
  };
  return value => {
    argument = value;
    isWanted = true;
    if (!isBusy) run();
  };
}

export const byId = id => document.getElementById(id);

// Returns an element with properties and children. Texts become text nodes, never markup.
export function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes("-") || key === "role") made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children);
  return made;
}

export const short = x => typeof x === "number" ? String(Number(x.toPrecision(6))) : String(x);

// Moves the focus in a list by keys: one row of it is in the order of Tab. `rows` finds all of them.
export function connectRows(list, choose) {
  const focus = row => {
    if (!row) return;
    list.querySelector("[tabindex='0']")?.setAttribute("tabindex", "-1");
    row.tabIndex = 0;
    row.focus();
  };
  list.addEventListener("keydown", event => {
    const row = event.target.closest("[role='option']");
    if (!row) return;
    const keys = {
      ArrowDown: () => focus(row.nextElementSibling), ArrowUp: () => focus(row.previousElementSibling),
      Home: () => focus(list.firstElementChild), End: () => focus(list.lastElementChild),
      Enter: () => choose(row), " ": () => choose(row),
    };
    if (!Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key]();
  });
  list.addEventListener("click", event => {
    const row = event.target.closest("[role='option']");
    if (!row) return;
    focus(row);
    choose(row);
  });
}
