// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A mechanism in pieces: which shapes share an outline, and what covers what. In the plane kinds
// lie one over the other; in space what is nearer covers what is farther.
import * as shapes from "./shapes.js";

const CROWDED = 60; // shapes: a long chain is drawn with thinner bars
const BEYOND = 14; // [px] that a guide in space reaches past the motion
const LEAST_DISC = 8; // corners from which a regular polygon stands for a circle

/** order: what lies beneath in the plane; layer: how it is drawn */
const KINDS = {
  polygon: { order: 0, layer: "outline" },
  guide: { order: 0, layer: "lines" },
  spring: { order: 1, layer: "lines" },
  damper: { order: 1, layer: "lines" },
  slider: { order: 2, layer: "outline" },
  bar: { order: 3, layer: "outline" },
  arrow: { order: 4, layer: "lines" },
  pivot: { order: 5, layer: "pins" },
  ground: { order: 5, layer: "pins" },
};
const SOLID = ["bar", "polygon", "slider"];

/**
 * @typedef {import("../state/store.js").Shape} Shape
 * @typedef {import("../state/store.js").Scene} Scene
 * @typedef {{layer: string, shapes: Shape[]}} Piece
 */

/** A long chain is drawn with thinner bars and without rings at its cuts. @param {Scene} scene */
export const isCrowded = (scene) => scene.drawing.shapes.length > CROWDED;

/** @param {Shape} shape @returns {number[]} its points */
function pointsOf({ kind, p, q, n }) {
  return kind === "polygon" ? Array.from({ length: n }, (_, i) => p + i) : q >= 0 ? [p, q] : [p];
}

/** Points that are drawn, without those that only give a direction. @param {Scene} scene */
export function drawnPoints(scene) {
  const used = scene.drawing.shapes.flatMap((shape) =>
    shape.kind === "guide" || shape.kind === "slider" ? [shape.p] : pointsOf(shape),
  );
  return [...new Set([...used, ...scene.drawing.tears.flatMap(({ p, q }) => [p, q])])];
}

/** Stands on the ground: drawn once, whatever the methods do. @param {Scene} scene */
export function baseOf(scene) {
  const still = new Set(scene.ground_points);
  const stands = (shape) =>
    SOLID.includes(shape.kind) && pointsOf(shape).every((i) => still.has(i));
  return {
    solid: scene.drawing.shapes.filter(stands),
    marks: scene.drawing.shapes.filter(
      ({ kind, body }) => kind === "ground" || (kind === "guide" && body < 0),
    ),
  };
}

/**
 * The moving shapes, in pieces from the lowest to the topmost of a plane mechanism; in space and in
 * crowds see `alone` and `together`.
 * @param {Scene} scene
 * @param {"alone" | "bodies" | "together"} how each shape, each body, or each layer is a piece
 * @returns {Piece[]}
 */
export function piecesOf(scene, how) {
  const { solid, marks } = baseOf(scene);
  const base = new Set([...solid, ...marks.filter(({ kind }) => kind === "guide")]);
  /** @type {Map<string, Piece & {order: number}>} */
  const pieces = new Map();
  scene.drawing.shapes.forEach((shape, i) => {
    const kind = KINDS[shape.kind];
    if (!kind || base.has(shape)) {
      return;
    }
    const own = shape.kind === "polygon" || (kind.layer === "outline" && shape.body < 0);
    const key =
      how === "together"
        ? kind.layer
        : how === "alone" || own
          ? String(i)
          : `${kind.order} ${kind.layer === "outline" ? shape.body : kind.layer}`;
    /** @type {Piece & {order: number}} */
    const piece = pieces.get(key) ?? { layer: kind.layer, order: kind.order, shapes: [] };
    piece.shapes.push(shape);
    pieces.set(key, piece);
  });
  return [...pieces.values()].sort((a, b) => a.order - b.order);
}

/**
 * Regular polygons of many corners stand for circles.
 * @param {ArrayLike<number>} points
 * @param {Shape} shape
 */
function isDisc(points, { kind, p, n }) {
  if (kind !== "polygon" || n < LEAST_DISC) {
    return false;
  }
  const at = (i) => [0, 1, 2].map((k) => points[3 * (p + (i % n)) + k]);
  const side = (i) => Math.hypot(...at(i).map((x, k) => x - at(i + 1)[k]));
  const middle = [0, 1, 2].map(
    (k) => Array.from({ length: n }, (_, i) => at(i)[k]).reduce((a, b) => a + b) / n,
  );
  const radius = (i) => Math.hypot(...at(i).map((x, k) => x - middle[k]));
  return Array.from({ length: n }, (_, i) => i).every(
    (i) =>
      Math.abs(side(i) - side(0)) < 1e-2 * radius(0) &&
      Math.abs(radius(i) - radius(0)) < 1e-2 * radius(0),
  );
}

/**
 * Draws shapes of one scene as one camera sees them.
 * @param {Scene} scene
 * @param {ReturnType<typeof import("./camera.js").createCamera>} camera
 * @param {{width: number, height: number}} size [px]
 */
export function createPen(scene, camera, size) {
  const crowded = isCrowded(scene);
  const discs = new Set(scene.drawing.shapes.filter((shape) => isDisc(scene.points, shape)));

  /** @param {Shape} shape half its width [px] */
  function radius(shape) {
    const width = shape.width > 0 ? shape.width : 0.045 * scene.length;
    return Math.min(11, Math.max(crowded ? 1.5 : 4.5, 0.5 * width * camera.scale));
  }

  /**
   * Returns how far along d from p something may be: the picture, and in space no farther than the
   * motion.
   */
  function reachOf(p, d) {
    const within = (component, low, high, from) =>
      Math.abs(component) < 1e-9
        ? [-Infinity, Infinity]
        : [(low - from) / component, (high - from) / component].sort((a, b) => a - b);
    const [ax, bx] = within(d[0], 12, size.width - 12, p[0]);
    const [ay, by] = within(d[1], 12, size.height - 12, p[1]);
    let [a, b] = [Math.max(ax, ay), Math.min(bx, by)];
    const extremes = scene.extremes ?? [];
    if (extremes.length) {
      const along = Array.from({ length: extremes.length / 3 }, (_, i) => {
        const [x, y] = camera.point(extremes, i);
        return (x - p[0]) * d[0] + (y - p[1]) * d[1];
      });
      a = Math.max(a, Math.min(...along) - BEYOND);
      b = Math.min(b, Math.max(...along) + BEYOND);
    }
    return [a, b];
  }

  /** @returns {[[number, number], [number, number]]} */
  function guideEnds(p, q) {
    const length = Math.hypot(q[0] - p[0], q[1] - p[1]);
    if (length < 1e-6) {
      return [p, p]; // seen end on
    }
    const d = [(q[0] - p[0]) / length, (q[1] - p[1]) / length];
    const place = (along) =>
      /** @type {[number, number]} */ ([p[0] + along * d[0], p[1] + along * d[1]]);
    const [a, b] = reachOf(p, d);
    return [place(a), place(b)];
  }

  /**
   * @param {Shape} shape
   * @param {ArrayLike<number>} points
   * @returns {string} path data, "" where a point is not known
   */
  function outline(shape, points) {
    if (Number.isNaN(points[3 * shape.p])) {
      return "";
    }
    const place = (i) => camera.point(points, i);
    const p = place(shape.p);
    const r = radius(shape);
    const q = shape.q >= 0 && shape.kind !== "polygon" ? place(shape.q) : p;
    switch (shape.kind) {
      case "bar":
        return shapes.bar(p, q, r);
      case "slider":
        return shapes.slider(p, q, r + 4);
      case "polygon":
        return (discs.has(shape) ? shapes.disc : shapes.polygon)(pointsOf(shape).map(place));
      case "pivot":
      case "ground":
        return shapes.circle(p, Math.max(crowded ? 1 : 2.5, 0.55 * r));
      case "spring":
        return shapes.spring(p, q, r + 2);
      case "guide":
        return shapes.guide(...guideEnds(p, q), r + 5);
      case "damper":
        return shapes.damper(p, q, r + 1);
      case "arrow":
        return shapes.load(p, 1.5 * r);
      default:
        return "";
    }
  }

  /** @param {ArrayLike<number>} points @param {number} i towards the viewer [m] */
  const depthAt = (points, i) =>
    [0, 1, 2].reduce((sum, k) => sum + camera.toward[k] * points[3 * i + k], 0);

  /**
   * Returns the depth of the middle of a shape.
   * @param {Shape} shape @param {ArrayLike<number>} points
   */
  function middleDepth(shape, points) {
    const all = pointsOf(shape);
    return all.reduce((sum, i) => sum + depthAt(points, i), 0) / all.length;
  }

  const bars = scene.drawing.shapes.filter(({ kind }) => kind === "bar");
  const near = 1e-3 * camera.scaleBar.metres;

  /**
   * A pin is seen before every bar that it holds.
   * @param {Shape} pin
   * @param {ArrayLike<number>} points
   */
  function pinDepth(pin, points) {
    const same = (i) =>
      [0, 1, 2].every((k) => Math.abs(points[3 * i + k] - points[3 * pin.p + k]) < near);
    return (
      bars
        .filter(({ p, q }) => same(p) || same(q))
        .reduce((most, bar) => Math.max(most, middleDepth(bar, points)), depthAt(points, pin.p)) +
      near
    );
  }

  /**
   * Lines of the picture that a name should keep clear of: [x, y, x, y, half a width].
   * @returns {number[][]}
   */
  function obstacles(points) {
    return scene.drawing.shapes.flatMap((shape) => {
      const place = (i) => camera.point(points, i);
      const all = pointsOf(shape).map(place);
      const r = radius(shape);
      const [p, q] = [all[0], all[all.length - 1]];
      switch (shape.kind) {
        case "polygon":
          return all.map((from, i) => [...from, ...all[(i + 1) % all.length], 1]);
        case "guide": {
          const [from, to] = guideEnds(p, q);
          return [[...from, ...to, r + 8]];
        }
        case "ground":
          return [[p[0] - 12, p[1] + 18, p[0] + 12, p[1] + 18, 6]];
        case "slider":
          return [[...p, ...p, r + 8]];
        case "trace":
          return [];
        default:
          return [[...p, ...q, r]];
      }
    });
  }

  return {
    radius,
    outline,
    obstacles,
    /** Towards the viewer. @param {Piece} piece of one shape @param {ArrayLike<number>} points */
    depth: ({ layer, shapes: [shape] }, points) =>
      layer === "pins" ? pinDepth(shape, points) : middleDepth(shape, points),
    /**
     * @param {Shape} shape what stands on the ground and is a mark
     * @param {ArrayLike<number>} points
     */
    mark: (shape, points) =>
      shape.kind === "ground"
        ? shapes.ground(camera.point(points, shape.p), crowded ? 4 : 11)
        : outline(shape, points),
  };
}
