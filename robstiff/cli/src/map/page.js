"use strict";
const map = JSON.parse(document.getElementById("map").textContent);
const figure = document.querySelector("figure.map");
const pictures = figure.querySelectorAll("svg");
const tip = figure.querySelector(".tip");

function coordinate(axis, index) {
  const at = axis.from + (axis.to - axis.from) * index / (axis.count - 1);
  return `${axis.name} = ${Number(at.toPrecision(5))} ${axis.unit}`;
}

function read(event) {
  const svg = event.currentTarget;
  const room = svg.closest(".narrow") ? 1 : 0;
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  for (const { title, frames, values } of map.slices) {
    const [corner, size] = frames[room];
    const i = Math.floor((point.x - corner[0]) / size[0] * map.right.count);
    const j = Math.floor((1 - (point.y - corner[1]) / size[1]) * map.up.count);
    if (i < 0 || j < 0 || i >= map.right.count || j >= map.up.count) continue;
    const value = values[i + map.right.count * j];
    const what = value === null ? "out of reach" : `${map.name} ${value} ${map.unit}`;
    const where = [coordinate(map.right, i), coordinate(map.up, j)].concat(title ? [title] : []);
    tip.textContent = [what, ...where].join("\n");
    tip.hidden = false;
    const frame = figure.getBoundingClientRect();
    const x = event.clientX - frame.left + figure.scrollLeft, y = event.clientY - frame.top;
    tip.style.left = `${x > figure.scrollLeft + frame.width / 2 ? x - tip.offsetWidth - 14 : x + 14}px`;
    tip.style.top = `${y > frame.height / 2 ? y - tip.offsetHeight - 14 : y + 14}px`;
    return;
  }
  tip.hidden = true;
}

for (const svg of pictures) {
  svg.addEventListener("pointermove", read);
  svg.addEventListener("pointerdown", read);
  svg.addEventListener("pointerleave", () => { tip.hidden = true; });
}
