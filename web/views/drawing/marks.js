// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Marks over the mechanism: open cut joints, arrows of forces, names of points, paths.
import { quantity } from "../../state/format.js";
import { arrowScale, sizeOf, zeroOf } from "../../state/reactions.js";
import { s, say, set } from "../../widgets/dom.js";
import { spread } from "../../widgets/name-places.js";
import { isCrowded } from "../../widgets/pieces.js";
import * as shapes from "../../widgets/shapes.js";

const TRACE_POINTS = 600;
const SHORTEST_ARROW = 3; // [px]
const RING = 14; // [px] radius of the ring round a cut joint
const ROOM = 8; // [px] that names keep from an arrow

const MOST_CUTS = 12; // whose names a drawing has room for

/**
 * Points with a name; where no joint has one, since there are many, the cut joints with theirs.
 * @param {import("../../state/types.js").Scene} scene
 * @returns {{i: number, text: string}[]}
 */
export function namedPoints({ drawing: { labels, tears } }) {
  const named = labels.flatMap((text, i) => (text ? [{ i, text }] : []));
  const cuts = tears.length > MOST_CUTS ? [] : tears;
  return named.length ? named : cuts.map(({ p, name }) => ({ i: p, text: name }));
}

/**
 * @param {{tears: SVGElement, arrows: SVGElement, labels: SVGElement, traces: SVGElement}} layers
 * @param {import("../../state/store.js").Data} data
 * @param {import("./stage.js").Stage} stage
 */
export function createMarks(layers, data, stage) {
  let newton = 1; // [px]
  const halves = s("path", { class: "tear" });
  const rings = s("path", { class: "cut" });
  layers.tears.replaceChildren(halves, rings);
  /** names of points, as many as were ever shown at once @type {SVGElement[]} */
  const names = [];

  /** The two halves of each cut joint, joined by a line, with a ring round them. */
  function drawTears(points) {
    const ends = data.scene.drawing.tears
      .map(({ p, q }) => [stage.camera.point(points, p), stage.camera.point(points, q)])
      .filter(([[x]]) => Number.isFinite(x));
    const lines = ends.map((pair) => shapes.polyline(pair, false));
    const circles = (isCrowded(data.scene) ? [] : ends).map(([a, b]) =>
      shapes.circle([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], RING),
    );
    set(halves, { d: lines.join("") });
    set(rings, { d: circles.join("") });
  }

  /**
   * @param {ArrayLike<number>} points
   * @param {number[][]} arrows names keep clear of them too
   */
  function drawLabels(points, arrows) {
    layers.labels.style.display = data.view.labels ? "" : "none";
    if (!data.view.labels) {
      return;
    }
    const named = namedPoints(data.scene)
      .map(({ i, text }) => ({ i, text, at: stage.camera.point(points, i) }))
      .filter(({ at }) => Number.isFinite(at[0]));
    const obstacles = named.length ? [...stage.pen.obstacles(points), ...arrows] : [];
    const placed = stage.places.place(named, obstacles);
    placed.forEach(({ text, x, y }, k) => {
      names[k] ??= s("text", { "text-anchor": "middle" });
      set(names[k], { x: x.toFixed(1), y: (y + 4.5).toFixed(1) });
      say(names[k], text);
    });
    if (layers.labels.childElementCount !== placed.length) {
      layers.labels.replaceChildren(...names.slice(0, placed.length));
    }
  }

  /**
   * One arrow with its number, from the joint outwards. It moves with the joint until the next
   * answer of the server.
   * @param {import("../../state/reactions.js").Reaction & {point: number}} reaction
   * @param {ArrayLike<number>} points
   * @returns {{
   *   path: SVGElement, number: {x: number, y: number, text: string}, line: number[],
   * } | null} null: too short to be seen
   */
  function makeArrow({ force, place, point }, points) {
    const { camera } = stage;
    const along = (axis) => axis[0] * force[0] + axis[1] * force[1] + axis[2] * force[2];
    const from = point >= 0 ? camera.point(points, point) : camera.point(place, 0);
    const [dx, dy] = [newton * along(camera.look.right), -newton * along(camera.look.up)];
    const length = Math.hypot(dx, dy);
    if (length < SHORTEST_ARROW) {
      return null;
    }
    const away = 1 + 16 / length;
    const tip = [from[0] + away * dx, from[1] + away * dy];
    return {
      path: s("path", { d: shapes.arrow(from, [from[0] + dx, from[1] + dy]) }),
      number: { x: tip[0], y: tip[1] + 4, text: quantity(sizeOf(force), "N", 2) },
      line: [...from, ...tip, ROOM],
    };
  }

  /** The force on each joint's child. @returns {number[][]} where arrows are */
  function drawArrows(points) {
    const { reactions, view, scene } = data;
    if (!view.arrows || !reactions || reactions.method !== view.selected) {
      layers.arrows.replaceChildren();
      return [];
    }
    const zero = zeroOf(reactions.list, scene.length).force;
    const loaded = reactions.list.filter(({ force }) => sizeOf(force) > zero);
    newton = arrowScale(Math.max(0, ...loaded.map(({ force }) => sizeOf(force))), newton);
    const arrows = loaded.flatMap((reaction) => makeArrow(reaction, points) ?? []);
    const numbers = spread(arrows.map(({ number }) => number)).map(({ x, y, text }) =>
      s("text", { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": "middle" }, text),
    );
    layers.arrows.replaceChildren(...arrows.map(({ path }) => path), ...numbers);
    return arrows.map(({ line }) => line);
  }

  /** The way of a point of the selected method until now. @param {number} p @param {number} now */
  function makeTrace(p, now) {
    const m = data.view.selected;
    const step = Math.max(1, Math.ceil(now / TRACE_POINTS));
    const way = [];
    for (let i = 0; i <= now; i += step) {
      const at = stage.camera.point(data.history.pointsAt(m, i), p);
      if (Number.isFinite(at[0])) {
        way.push(at);
      }
    }
    const name = `trace slot-${data.methods[m].slot}`;
    return s("path", { d: shapes.polyline(way, false), class: name });
  }

  function drawTraces(now) {
    const { drawing } = data.scene;
    const traced = drawing.shapes.filter(({ kind }) => kind === "trace");
    const which = (traced.length ? traced : drawing.tears).map(({ p }) => p);
    const traces = data.view.traces ? which.map((p) => makeTrace(p, now)) : [];
    layers.traces.replaceChildren(...traces);
  }

  return {
    /** @param {number} now index of the frame shown */
    draw(now) {
      const points = data.history.pointsAt(data.view.selected, now);
      drawTears(points);
      drawLabels(points, drawArrows(points));
      drawTraces(now);
    },
  };
}
