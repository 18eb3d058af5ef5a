// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Forces in joints: the forces and moments that the server works out from a state, and what of
// them is drawn.
import { niceBelow } from "./format.js";

const ROUNDING = 1e-11; // of the largest: below it a force is what rounding leaves
const LONGEST = 90; // [px] of an arrow
const SHORTEST_LONGEST = 30; // [px]: the scale changes when the largest arrow gets shorter
const NEAR = 1e-6; // of the scene's length: a drawn point at a joint

/**
 * Force and moment on the child body of a joint.
 * @typedef {{
 *   name: string, kind: string, force: number[], moment: number[], place: number[],
 *   joint_force?: number[], joint_moment?: number[], determined: boolean,
 * }} Reaction
 * @typedef {{
 *   name: string, kind: string, coordinate: string, unit: string, value: number,
 *   determined: boolean,
 * }} Effort what a constraint does along a coordinate
 */
/**
 * Forces in the joints of a method at a time; `point`: the drawn point at the joint, or -1.
 * @typedef {{
 *   method: number, t: number, list: (Reaction & {point: number})[], efforts: Effort[],
 *   mark: string, reason: string,
 * }} Reactions
 */

/**
 * The meaning of the server's mark of multipliers, as a sentence; one that is not here says nothing
 * against them.
 * @type {Record<string, string>}
 */
const MARKS = {
  "one of many":
    "The multipliers are one of many solutions: some constraints are dependent, and only their sum is determined.",
  "no digit left":
    "The multipliers have no correct digit left: the loop constraints are almost dependent here.",
  "no solution": "The equations have no solution here, so there are no multipliers.",
  "of open loops":
    "A loop stands open: these multipliers are forces of a mechanism that has come apart.",
};

/** @param {string} [mark] of the server */
export const markWords = (mark = "") => MARKS[mark] ?? "";

/** @param {number[]} vector */
export const sizeOf = (vector) => Math.hypot(...vector);

/**
 * Below these a number is rounding.
 * @param {Reaction[]} list
 * @param {number} length [m] of the scene
 */
export function zeroOf(list, length) {
  const force = Math.max(0, ...list.map((item) => sizeOf(item.force)));
  const moment = Math.max(0, ...list.map((item) => sizeOf(item.moment)));
  return {
    force: ROUNDING * Math.max(force, moment / length),
    moment: ROUNDING * Math.max(moment, force * length),
  };
}

/**
 * The state as names and values, the way the server asks for it.
 * @param {{name: string, rate: string}[]} coordinates
 * @param {ArrayLike<number>} q
 * @param {ArrayLike<number>} v
 */
export function namedState(coordinates, q, v) {
  return Object.fromEntries(
    coordinates.flatMap(({ name, rate }, i) => [
      [name, q[i]],
      [rate, v[i]],
    ]),
  );
}

/**
 * The drawn point that stands at a joint, so that an arrow moves with it; -1 when none does.
 * @param {ArrayLike<number>} points
 * @param {number[]} place
 * @param {number} length
 */
export function pointAt(points, place, length) {
  for (let i = 0; 3 * i + 2 < points.length; i++) {
    if (place.every((x, k) => Math.abs(points[3 * i + k] - x) < NEAR * length)) {
      return i;
    }
  }
  return -1;
}

/**
 * Pixels per newton: a round number, kept while the largest arrow can be read.
 * @param {number} largest [N]
 * @param {number} before [px/N]
 */
export function arrowScale(largest, before) {
  if (!(largest > 0)) {
    return before;
  }
  const drawn = largest * before;
  return drawn <= LONGEST && drawn >= SHORTEST_LONGEST ? before : niceBelow(LONGEST / largest);
}
