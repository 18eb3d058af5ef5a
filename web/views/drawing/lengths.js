// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Handles that change lengths: one in the middle of each bar whose length is a parameter, and
// between fixed pivots. Dragging one along its bar changes the parameter; the server closes the
// loops, and a length that cannot be assembled is held back with the reason.
import { plain } from "../../state/format.js";
import { lengthsOf } from "../../state/lengths.js";
import { shownIndex } from "../../state/store.js";
import { h, s, say, set } from "../../widgets/dom.js";

const SIZE = 6; // [px] half the side of a handle
const GRID = 0.1; // of the scale bar: what Shift snaps to

/** @typedef {{name: string, p: number, q: number, node: SVGElement, word: SVGElement}} Handle */

/**
 * @param {SVGElement} layer
 * @param {import("../../state/store.js").Data} data
 * @param {import("./stage.js").Stage} stage
 * @param {import("../../session/session.js").Session} actions
 */
export function createLengths(layer, data, stage, actions) {
  /** @type {Handle[]} */
  let handles = [];
  let madeFor = "";
  const button = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "aria-pressed": "false",
      "data-tip": "handles that change lengths by dragging; the fields below do the same",
      onclick: () => actions.toggleLengths(),
    },
    "↔ lengths",
  );
  const hint = h("span", { class: "tool-hint", role: "status" });

  const pointsNow = () => {
    const i = shownIndex(data);
    return data.drag?.points.length
      ? data.drag.points
      : i < 0
        ? null
        : data.history.pointsAt(data.view.selected, i);
  };

  /** @param {string} name */
  const parameterNamed = (name) => data.scene.parameters.find((one) => one.name === name);

  /** @param {Handle} handle @param {PointerEvent} down */
  function take(handle, down) {
    actions.show(0); // lengths are those of the start
    const points = pointsNow();
    const parameter = parameterNamed(handle.name);
    if (!points || !parameter || down.button !== 0 || !actions.beginDrag()) {
      return;
    }
    down.stopPropagation();
    down.preventDefault();
    handle.node.setPointerCapture(down.pointerId);
    const [a, b] = [handle.p, handle.q].map((i) => stage.camera.point(points, i));
    const long = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const along = [(b[0] - a[0]) / long, (b[1] - a[1]) / long];
    const { scale, scaleBar } = stage.camera;

    /** @param {PointerEvent} event */
    const move = (event) => {
      const d =
        (event.clientX - down.clientX) * along[0] + (event.clientY - down.clientY) * along[1];
      const wanted = parameter.value + (2 * d) / scale;
      const grid = event.shiftKey ? GRID * scaleBar.metres : 0.001 * scaleBar.metres;
      const value = Number((Math.round(wanted / grid) * grid).toPrecision(6));
      actions.dragParameter(
        handle.name,
        Math.min(parameter.max, Math.max(parameter.min, Math.max(value, grid))),
      );
    };
    const end = () => {
      handle.node.removeEventListener("pointermove", /** @type {any} */ (move));
      actions.endDrag();
    };
    handle.node.addEventListener("pointermove", /** @type {any} */ (move));
    handle.node.addEventListener("pointerup", end, { once: true });
    handle.node.addEventListener("pointercancel", end, { once: true });
  }

  /** @param {{name: string, p: number, q: number}} length @returns {Handle} */
  function makeHandle({ name, p, q }) {
    const word = s("text", { y: -SIZE - 4, "text-anchor": "middle" });
    const box = s("rect", {
      x: -SIZE,
      y: -SIZE,
      width: 2 * SIZE,
      height: 2 * SIZE,
      rx: 2,
    });
    const handle = { name, p, q, word, node: s("g", { class: "length-handle" }, box, word) };
    handle.node.addEventListener("pointerdown", (event) => take(handle, event));
    return handle;
  }

  async function make() {
    const key = `${data.run}`;
    if (madeFor === key || data.drag) {
      return;
    }
    madeFor = key;
    const found = await lengthsOf(data, (parameters) => actions.pointsWith(parameters));
    if (madeFor === key) {
      say(
        hint,
        found.length
          ? "drag a square along its bar"
          : "no bar of this scene has a length of its own to change",
      );
      handles = found.map(makeHandle);
      layer.replaceChildren(...handles.map(({ node }) => node));
      draw();
    }
  }

  function draw() {
    const on = data.view.lengths && !data.scene?.view?.spatial;
    set(button, {
      "aria-pressed": String(Boolean(on)),
      hidden: data.scene?.view?.spatial ?? false,
    });
    layer.style.display = on && data.state !== "running" ? "" : "none";
    hint.hidden = !on;
    const points = pointsNow();
    if (!on || !points || !stage.pen) {
      return;
    }
    make();
    for (const { name, p, q, node, word } of handles) {
      const [[x0, y0], [x1, y1]] = [p, q].map((i) => stage.camera.point(points, i));
      const value = data.drag?.settings[name] ?? parameterNamed(name)?.value ?? 0;
      set(node, { transform: `translate(${(x0 + x1) / 2} ${(y0 + y1) / 2})` });
      say(word, `${name} ${plain(Number(value.toPrecision(3)))} m`);
    }
  }

  return { tools: [button, hint], draw };
}
