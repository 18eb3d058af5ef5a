// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The parts of the drawing that can be dragged: joints, links, and the ends of lengths. The dragged
// mechanism is drawn over the others until it is let go.
import { quantity } from "../../state/format.js";
import { snapped } from "../../state/start.js";
import { s, say, h, set } from "../../widgets/dom.js";
import { piecesOf } from "../../widgets/pieces.js";
import { distanceToBar } from "../../widgets/shapes.js";

const REACH = 16; // [px] from a joint
const BAR_REACH = 9; // [px] from the middle line of a link
const LAG = 24; // [px] behind the pointer that need no word: the loops leave one way open
const GRID = 0.1; // of the scale bar: what Shift snaps to
const MOST_SNAPS = 1e4; // farther away a grid means nothing

/**
 * @param {SVGSVGElement} svg
 * @param {SVGElement} layer
 * @param {import("../../state/store.js").Data} data
 * @param {import("./stage.js").Stage} stage
 * @param {import("../../session/session.js").Session} actions
 * @param {{isOpen: () => boolean}} hand
 */
export function createHandles(svg, layer, data, stage, actions, hand) {
  const note = h("p", { class: "drag-note", role: "status", hidden: true });
  /** pulls: the methods run, and a hand pulls them; otherwise the start is dragged
   * @type {{point: number, x: number, y: number, from: number[], target: number[],
   *   pulls: boolean, moved?: boolean} | null} */
  let held = null;
  /** @type {{shapes: any[], path: SVGElement}[]} */
  let pieces = [];
  let madeFor = "";

  const shownPoints = () => {
    const { history, view } = data;
    const last = (history?.count ?? 0) - 1;
    const i = view.shown < 0 ? last : Math.min(view.shown, last);
    return i < 0 ? null : history.pointsAt(view.selected, i);
  };
  const placeOf = (points, i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];

  /** The point that a place of the picture takes hold of, or -1. */
  function pointAt(x, y) {
    const points = shownPoints();
    if (!points || !data.scene || !stage.pen || data.view.hidden.has(data.view.selected)) {
      return -1;
    }
    const still = new Set(data.scene.ground_points);
    const distance = (i) => {
      const [px, py] = stage.camera.point(points, i);
      return Number.isFinite(px) ? Math.hypot(px - x, py - y) : Infinity;
    };
    const nearest = (list) => list.reduce((a, b) => (distance(b) < distance(a) ? b : a));
    const moving = data.scene.drawing.shapes.flatMap(({ kind, p, q, n }) => {
      const all = kind === "polygon" ? Array.from({ length: n }, (_, i) => p + i) : [p, q];
      return kind === "guide" ? [] : all.filter((i) => i >= 0 && !still.has(i));
    });
    if (moving.length === 0) {
      return -1;
    }
    const joint = nearest(moving);
    if (distance(joint) <= REACH) {
      return joint;
    }
    const bars = data.scene.drawing.shapes.filter(
      ({ kind, p, q }) =>
        kind === "bar" &&
        q >= 0 &&
        distanceToBar([x, y], stage.camera.point(points, p), stage.camera.point(points, q)) <=
          BAR_REACH,
    );
    const ends = bars.flatMap(({ p, q }) => [p, q]).filter((i) => !still.has(i));
    return ends.length ? nearest(ends) : -1;
  }

  /** @param {PointerEvent} event */
  function positionOf(event) {
    const box = svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  function take(event) {
    const [x, y] = positionOf(event);
    const point = event.button === 0 ? pointAt(x, y) : -1;
    const points = shownPoints();
    if (point < 0 || !points) {
      return;
    }
    event.stopPropagation(); // it would turn the view
    event.preventDefault();
    const stands = data.state !== "running" || data.view.shown >= 0;
    if (data.view.replaying || (hand.isOpen() && stands && data.state !== "finished")) {
      actions.refusePull();
      return;
    }
    const pulls = data.state === "running" && data.view.shown < 0;
    if (pulls || actions.beginDrag()) {
      const from = placeOf(points, point);
      held = { point, x, y, from, target: from, pulls };
      svg.setPointerCapture(event.pointerId);
    }
  }

  /**
   * Returns where the pointer is in the world: in the plane of the picture through the held point.
   * @param {{x: number, y: number, from: number[]}} held @param {number} x @param {number} y
   * @param {boolean} snap to the grid
   */
  function targetOf(held, x, y, snap) {
    const { look, scale, scaleBar } = stage.camera;
    const [dx, dy] = [(x - held.x) / scale, (held.y - y) / scale];
    const place = held.from.map((c, k) => c + dx * look.right[k] + dy * look.up[k]);
    const grid = GRID * scaleBar.metres;
    const near = place.every((c) => Math.abs(c) < MOST_SNAPS * grid);
    return snap && near ? snapped(place, grid) : place;
  }

  /** @param {PointerEvent} event */
  function move(event) {
    const [x, y] = positionOf(event);
    if (!held) {
      svg.classList.toggle("grabbable", pointAt(x, y) >= 0);
      return;
    }
    held.target = targetOf(held, x, y, event.shiftKey);
    if (held.pulls) {
      held.moved = true;
      actions.pull(held.point, held.target);
      return;
    }
    const flat = !data.scene.view?.spatial;
    actions.dragPoint(held.point, flat ? held.target.slice(0, 2) : held.target);
  }

  function letGo() {
    const { pulls } = held ?? {};
    if (held) {
      held = null;
      (pulls ? actions.letGo : actions.endDrag)();
    }
  }

  /** The hand let go by itself, as for an undo: the pointer holds nothing any more. */
  function loseHand() {
    if (held?.pulls && held.moved && !data.hand) {
      held = null;
    }
  }

  function cancel() {
    const { pulls } = held ?? {};
    if (held) {
      held = null;
      (pulls ? actions.letGo : actions.cancelDrag)();
    }
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    if (event.key === "Escape" && held) {
      event.stopPropagation();
      cancel();
    }
  }

  const events = {
    pointerdown: take,
    pointermove: move,
    pointerup: letGo,
    pointercancel: cancel,
  };
  for (const [name, act] of Object.entries(events)) {
    svg.addEventListener(name, /** @type {EventListener} */ (act));
  }
  addEventListener("keydown", onKey, { capture: true });

  /** A finger on a joint drags it; anywhere else it scrolls the page. @param {TouchEvent} event */
  function keepFromScrolling(event) {
    const box = svg.getBoundingClientRect();
    const { clientX, clientY } = event.touches[0];
    if (event.touches.length === 1 && pointAt(clientX - box.left, clientY - box.top) >= 0) {
      event.preventDefault();
    }
  }
  svg.addEventListener("touchstart", keepFromScrolling, { passive: false });

  function makePieces() {
    const key = `${data.run} ${data.view.selected}`;
    if (madeFor !== key) {
      madeFor = key;
      pieces = piecesOf(data.scene, "together").map((piece) => ({
        ...piece,
        path: s("path", { class: piece.layer }),
      }));
    }
    return pieces;
  }

  /** From the held point to where it was wanted, when it is held back visibly; else null. */
  function lag(points) {
    if (!held || !data.drag?.held) {
      return null;
    }
    const [x0, y0] = stage.camera.point(points, held.point);
    const [x1, y1] = stage.camera.point(held.target, 0);
    return Math.hypot(x1 - x0, y1 - y0) > LAG ? `M${x0} ${y0}L${x1} ${y1}` : null;
  }

  /** Words beside the dragged mechanism. */
  function wordsOf(points) {
    if (data.drag?.held && (!held || lag(points))) {
      return `Held here: ${data.drag.held}`;
    }
    const name = held ? (data.scene.drawing.labels[held.point] ?? "the point") : "";
    const at = held
      ? placeOf(points, held.point)
          .slice(0, data.scene.view?.spatial ? 3 : 2)
          .map((x) => quantity(x, "m"))
      : [];
    return held ? `${name} at ${at.join(", ")}. Let go to start from here.` : "";
  }

  return {
    note,
    loseHand,
    /** The dragged mechanism, as the server closed it last. */
    draw() {
      const { drag } = data;
      svg.classList.toggle("dragging", Boolean(drag));
      note.hidden = !drag;
      if (!drag || drag.points.length === 0) {
        layer.replaceChildren();
        return;
      }
      const slot = data.methods[data.view.selected]?.slot ?? 0;
      const group = s("g", { class: `ghost selected slot-${slot}` });
      for (const { shapes, path } of makePieces()) {
        set(path, { d: shapes.map((shape) => stage.pen.outline(shape, drag.points)).join("") });
        group.append(path);
      }
      const d = lag(drag.points);
      layer.replaceChildren(group, ...(d ? [s("path", { class: "leash", d })] : []));
      say(note, wordsOf(drag.points));
      note.hidden = note.textContent === "";
    },
    dispose() {
      removeEventListener("keydown", onKey, { capture: true });
    },
  };
}
