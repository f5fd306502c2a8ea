// The pixels in which instructions matter, lit up over the pictures.
"use strict";

import {byId, get, latest} from "./server.js";
import {onView} from "./picture.js";

const kMost = 12;  // masks of one line
const canvas = byId("mask");
let wanted = [];

const draw = latest(async () => {
  const offsets = wanted;
  if (offsets.length === 0) return;
  const images = [];
  for (const offset of offsets) {
    if (offsets !== wanted) return;
    images.push(await createImageBitmap(await (await get("pixels", {offset})).blob()));
  }
  if (offsets !== wanted) return;
  canvas.width = images[0].width, canvas.height = images[0].height;
  const context = canvas.getContext("2d");
  context.globalCompositeOperation = "lighten";
  for (const image of images) context.drawImage(image, 0, 0);
  canvas.dataset.offsets = offsets.join();
  canvas.hidden = false;
}, 60);

// Darkens all pixels but those in which one of the instructions matters: the costliest of many. `instructions` is a
// part of the program's list.
export function showMask(instructions) {
  const costly = [...instructions].sort((a, b) => b.cost - a.cost).slice(0, kMost);
  wanted = costly.map(each => each.offset);
  if (wanted.length === 0) canvas.hidden = true;
  else draw();
}

// The mask of another camera comes when the server has drawn a picture of it.
onView(() => { canvas.hidden = true; });
export const redrawMask = () => { if (canvas.hidden && wanted.length > 0) draw(); };
