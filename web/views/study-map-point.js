// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The ring on a map where a method stands now. It can be dragged; on release the method runs with
// the values under it. It never leaves the axes.
import { placeOnAxis, valueOnAxis } from "../state/heat.js";
import { s } from "../widgets/dom.js";

const REACH = 14; // [px] round the middle that can be taken hold of

/**
 * @typedef {{
 *   px: (i: number) => number, py: (j: number) => number,
 *   iOf: (x: number) => number, jOf: (y: number) => number,
 * }} Scale between pixels of the picture and cells
 */

/** Within the cells of an axis. @param {any} axis @param {number} place */
const inside = (axis, place) => Math.min(axis ? axis.values.length : 1, Math.max(0, place));

/**
 * @param {SVGSVGElement} picture
 * @param {{x: any, y: any}} axes
 * @param {Scale} scale
 * @param {{x: number, y: number}} now the present values
 * @param {{
 *   onMove: (x: number, y: number) => void, onDrop: (x: number, y: number) => void,
 * }} told values on the axes
 * @returns {{outside: boolean}} the present values lie beyond an axis
 */
export function addPresentPoint(picture, { x, y }, scale, now, { onMove, onDrop }) {
  const placeOf = (axis, value) => (axis ? placeOnAxis(axis, value) : 0.5);
  const wanted = [placeOf(x, now.x), placeOf(y, now.y)];
  let [i, j] = [inside(x, wanted[0]), inside(y, wanted[1])];
  const ring = s("circle", { r: 7, class: "here" });
  const handle = s("circle", { r: REACH, class: "here-handle" });
  const group = s("g", { class: "here-group" }, handle, ring);
  picture.append(group);

  function show() {
    group.setAttribute(
      "transform",
      `translate(${scale.px(i).toFixed(1)} ${scale.py(j).toFixed(1)})`,
    );
  }

  /** @param {PointerEvent} event */
  function follow(event) {
    const box = picture.getBoundingClientRect();
    const { width, height } = picture.viewBox.baseVal;
    const at = (client, from, size, whole) => ((client - from) / size) * whole;
    i = x ? inside(x, scale.iOf(at(event.clientX, box.left, box.width, width))) : i;
    j = inside(y, scale.jOf(at(event.clientY, box.top, box.height, height)));
    show();
  }

  const values = () => /** @type {const} */ ([x ? valueOnAxis(x, i) : NaN, valueOnAxis(y, j)]);
  handle.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    event.preventDefault();
    handle.setPointerCapture(event.pointerId);
    group.classList.add("dragged");
  });
  handle.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
    if (group.classList.contains("dragged")) {
      follow(event);
      onMove(...values());
    }
  });
  handle.addEventListener("pointerup", (/** @type {PointerEvent} */ event) => {
    if (group.classList.contains("dragged")) {
      follow(event);
      group.classList.remove("dragged");
      onDrop(...values());
    }
  });
  show();
  return { outside: i !== wanted[0] || j !== wanted[1] };
}
