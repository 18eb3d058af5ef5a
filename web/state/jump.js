// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The moment at which the error of a method jumped, and the reason where the motion shows it: all
// methods with one step err most where the mechanism is fastest.
import { errorsOf } from "./errors.js";
import { quantity, seconds } from "./format.js";
import { settingOf } from "./spelling.js";

const WINDOW = 0.02; // of the duration: growth within it is a jump
const JUMP = 30; // times
const FROM = 1e-7; // of the scene's length: below it errors grow from rounding
const MATTERS = 1e-4; // of the scene's length
const FASTEST = 0.7; // of the greatest velocity so far

/**
 * The largest growth of the error within a window of time; null: there was no jump.
 * @param {ArrayLike<number>} t @param {ArrayLike<number>} worst largest error so far
 * @param {number} shown last index @param {number} window [s] @param {number} length [m]
 * @returns {{from: number, to: number, times: number} | null} indices
 */
export function findJump(t, worst, shown, window, length) {
  /** @type {{from: number, to: number, times: number} | null} */
  let found = null;
  let from = 0;
  for (let to = 0; to <= shown; to++) {
    while (t[to] - t[from] > window || !(worst[from] > FROM * length)) {
      if (from >= to) {
        break;
      }
      from++;
    }
    const times = worst[to] / worst[from];
    if (worst[to] > MATTERS * length && times > JUMP && times > (found?.times ?? 0)) {
      found = { from, to, times };
    }
  }
  return found;
}

/** The greatest angular velocity between two frames [rad/s], 0 without angles, and its frame. */
function fastest({ history, scene }, m, from, to) {
  const angles = scene.coordinates.flatMap(({ kind }, k) => (kind === "angle" ? [k] : []));
  let speed = 0;
  let at = from;
  for (let i = from; i <= to; i++) {
    const { v } = history.stateAt(m, i);
    const most = Math.max(0, ...angles.map((k) => Math.abs(v[k])));
    [speed, at] = most > speed ? [most, i] : [speed, at];
  }
  return { speed, at };
}

/**
 * A sentence on the jump; "" where there was none, or where the motion gives no reason.
 * @param {import("./store.js").Data} data @param {number} m @param {number} shown
 */
export function jumpWords(data, m, shown) {
  const { history, duration, scene, catalogue, methods } = data;
  const worst = errorsOf(data)[m].worstOff;
  const jump = findJump(history.t, worst, shown, WINDOW * duration, scene.length);
  if (!jump) {
    return "";
  }
  const { speed, at } = fastest(data, m, jump.from, jump.to);
  const h = Number(settingOf(catalogue, methods[m].spelling, "h")?.value ?? NaN);
  if (!(speed > 0) || speed < FASTEST * fastest(data, m, 0, shown).speed || !(h > 0)) {
    return "";
  }
  const when = seconds(history.t[at], duration);
  const turn = `${(h * speed).toPrecision(2)} rad`;
  return (
    `Near ${when} the error grew ${Number(jump.times.toPrecision(1))}-fold: the mechanism is fastest ` +
    `there (${speed.toPrecision(2)} rad/s), and one step of ${quantity(h, "s")} turns it by ${turn}. ` +
    "That holds for every method with this step."
  );
}
