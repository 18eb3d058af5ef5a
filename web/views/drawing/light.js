// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Lights up what is pointed at elsewhere: bodies and cut joints of the mechanism; and says which
// body is pointed at here.
import { listen } from "../../state/store.js";
import { s, set } from "../../widgets/dom.js";
import * as shapes from "../../widgets/shapes.js";

const REACH = 9; // [px] from the middle line of a bar
const RING = 16; // [px]

/**
 * @param {SVGSVGElement} svg
 * @param {import("../../state/store.js").Store} store
 * @param {import("./stage.js").Stage} stage
 * @param {() => number} shownNow index of the frame shown
 */
export function createLight(svg, store, stage, shownNow) {
  const data = store.data;
  const path = s("path", { class: "lit" });
  svg.append(path);
  let lit = { bodies: /** @type {number[]} */ ([]), tears: /** @type {string[]} */ ([]) };
  let pointed = -1;

  const pointsNow = () => {
    const now = shownNow();
    return now < 0 ? null : data.history.pointsAt(data.view.selected, now);
  };

  function draw() {
    const points = lit.bodies.length || lit.tears.length ? pointsNow() : null;
    if (!points || !stage.pen) {
      set(path, { d: null });
      return;
    }
    const { shapes: all, tears } = data.scene.drawing;
    const outlines = all
      .filter(({ body, kind }) => lit.bodies.includes(body) && kind !== "trace")
      .map((shape) => stage.pen.outline(shape, points));
    const rings = tears
      .filter(({ name }) => lit.tears.includes(name))
      .map(({ p }) => shapes.circle(stage.camera.point(points, p), RING));
    set(path, { d: [...outlines, ...rings].join("") || null });
  }

  /** The body whose bar is under the pointer, or -1. @param {PointerEvent} event */
  function bodyAt(event) {
    const points = pointsNow();
    if (!points || !stage.pen || event.buttons) {
      return -1;
    }
    const box = svg.getBoundingClientRect();
    const at = /** @type {[number, number]} */ ([
      event.clientX - box.left,
      event.clientY - box.top,
    ]);
    const near = data.scene.drawing.shapes.find(
      ({ kind, body, p, q }) =>
        kind === "bar" &&
        body >= 0 &&
        shapes.distanceToBar(at, stage.camera.point(points, p), stage.camera.point(points, q)) <=
          REACH,
    );
    return near?.body ?? -1;
  }

  svg.addEventListener("pointermove", (event) => {
    const body = bodyAt(/** @type {PointerEvent} */ (event));
    if (body !== pointed) {
      pointed = body;
      store.emit("light", {
        bodies: body < 0 ? [] : [body],
        tears: [],
        curves: [],
        from: "drawing",
      });
    }
  });
  const stop = listen(store, {
    light: (what) => {
      // what is pointed at here shows itself only where something answers
      lit = what.from === "drawing" ? { bodies: [], tears: [] } : what;
      draw();
    },
    scene: () => {
      lit = { bodies: [], tears: [] };
      draw();
    },
  });
  return { draw, dispose: stop };
}
