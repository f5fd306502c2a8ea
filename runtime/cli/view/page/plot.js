// A plot of the field along a ray, as SVG.
"use strict";

import {short} from "./server.js";

const kWidth = 420, kHeight = 200, kLeft = 56, kRight = 12, kTop = 12, kBottom = 34;

function svg(name, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// Returns round numbers within a range, four at most.
function ticks(low, high) {
  const rough = (high - low) / 4 || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find(digit => digit * power >= rough) * power;
  const found = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) found.push(i * step);
  return found;
}

// Returns a plot of `steps`, pairs of a place on the ray and the field there.
export function plotSteps(steps) {
  const places = steps.map(step => step[0]), fields = steps.map(step => step[1]);
  const x = scale(Math.min(...places), Math.max(...places), kLeft, kWidth - kRight);
  const y = scale(Math.min(0, ...fields), Math.max(0, ...fields), kHeight - kBottom, kTop);
  const plot = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, class: "plot", role: "img",
                           "aria-label": `Field along the ray, ${steps.length} steps`});
  for (const tick of ticks(...x.range)) {
    plot.append(svg("line", {x1: x(tick), x2: x(tick), y1: kTop, y2: kHeight - kBottom, class: "grid"}),
                svg("text", {x: x(tick), y: kHeight - kBottom + 15, "text-anchor": "middle"}, short(tick)));
  }
  for (const tick of ticks(...y.range)) {
    const line = {x1: kLeft, x2: kWidth - kRight, y1: y(tick), y2: y(tick), class: tick === 0 ? "axis" : "grid"};
    plot.append(svg("line", line),
                svg("text", {x: kLeft - 6, y: y(tick) + 4, "text-anchor": "end"}, short(tick)));
  }
  plot.append(svg("text", {x: (kLeft + kWidth) / 2, y: kHeight - 3, "text-anchor": "middle"}, "place on the ray"),
              svg("text", {x: 12, y: (kTop + kHeight - kBottom) / 2, "text-anchor": "middle",
                           transform: `rotate(-90 12 ${(kTop + kHeight - kBottom) / 2})`}, "field"),
              svg("polyline", {points: steps.map(step => `${x(step[0])},${y(step[1])}`).join(" "), class: "curve"}));
  for (const [t, f] of steps) {
    plot.append(svg("circle", {cx: x(t), cy: y(f), r: 3, class: "step"},
                    svg("title", {}, `${short(f)} at ${short(t)}`)));
  }
  return plot;
}

// Returns the map of a range of numbers to one of places.
function scale(low, high, from, to) {
  const size = high - low || 1;
  return Object.assign(number => from + (number - low) / size * (to - from), {range: [low, low + size]});
}
