// The tabs of the panels, with the keys that tabs have everywhere.
"use strict";

import {byId} from "./server.js";

const tabs = [...byId("tabs").children];
const callbacks = [];

export const openTab = () => tabs.find(tab => tab.ariaSelected === "true").id.slice("tab-".length);
export const onTab = callback => callbacks.push(callback);

export function showTab(name) {
  for (const tab of tabs) {
    const isOpen = tab.id === `tab-${name}`;
    tab.ariaSelected = String(isOpen);
    tab.tabIndex = isOpen ? 0 : -1;
    byId(tab.getAttribute("aria-controls")).hidden = !isOpen;
  }
  for (const callback of callbacks) callback(name);
}

byId("tabs").addEventListener("click", event => {
  const tab = event.target.closest("[role='tab']");
  if (tab) showTab(tab.id.slice("tab-".length));
});

byId("tabs").addEventListener("keydown", event => {
  const at = tabs.indexOf(document.activeElement), last = tabs.length - 1;
  const right = at === last ? 0 : at + 1, left = at === 0 ? last : at - 1;
  const to = {ArrowRight: right, ArrowLeft: left, Home: 0, End: last}[event.key];
  if (to === undefined) return;
  event.preventDefault();
  tabs[to].click();
  tabs[to].focus();
});

showTab("source");
