// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Which method reaches a wanted accuracy for the least: between the measured points of a study, by
// straight lines in decades.
import { parseQuantity, quantity, scientific } from "./format.js";

const PLAIN = /^\s*[\d.,]+(e[-+]?\d+)?\s*$/i;
const BY_LENGTH = ["q", "gap"]; // errors that are a length, as a share of the scene's

/**
 * An accuracy as people type it, as an error of the study: "1 mm" at the end of the scene's length,
 * "1 mrad", "0.1 %", or the bare number of the axis.
 * @param {string} text
 * @param {string} error its name
 * @param {number} length [m] of the scene
 * @returns {{value: number, words: string} | null} null: it is none
 */
export function wantedError(text, error, length) {
  const sound = (value, words) => (value > 0 && value < Infinity ? { value, words } : null);
  if (PLAIN.test(text)) {
    const value = parseQuantity(text, "");
    return sound(value, `an error of ${scientific(value)}`);
  }
  const percent = /^(.*)%\s*$/.exec(text);
  if (percent) {
    const value = parseQuantity(percent[1], "") / 100;
    return sound(value, `${text.trim()}, an error of ${scientific(value)}`);
  }
  if (!BY_LENGTH.includes(error)) {
    return null;
  }
  const metres = parseQuantity(text, "m");
  if (metres > 0) {
    const value = metres / length;
    return sound(
      value,
      `${quantity(metres, "m")} at the end of ${quantity(length, "m")}, an error of ${scientific(value)}`,
    );
  }
  const angle = error === "q" ? parseQuantity(text, "rad") : NaN;
  return sound(angle, `an error of ${scientific(angle)}`);
}

/**
 * @typedef {import("./study-documents.js").Dot} Dot
 * @typedef {{m: number, cost: number, size: number, dot: Dot, atMost: boolean}} Reach
 *   atMost: the coarsest run is already accurate enough
 */

/** @param {number} a @param {number} b @param {number} share */
const between = (a, b, share) => Math.exp(Math.log(a) + share * (Math.log(b) - Math.log(a)));

/**
 * The least that one method costs at an accuracy that all its finer runs have too.
 * @param {Dot[]} dots of one method
 * @param {number} wanted
 * @returns {Reach | null}
 */
function reachOf(dots, wanted) {
  const known = dots.filter(({ error, cost }) => Number.isFinite(error) && cost > 0);
  const fine = [...known].sort((a, b) => a.size - b.size);
  const away = fine.findIndex(({ error }) => error > wanted);
  const [first] = fine;
  if (!first || away === 0) {
    return null;
  }
  const last = fine[away < 0 ? fine.length - 1 : away - 1];
  const reach = { m: last.m, cost: last.cost, size: last.size, dot: last, atMost: away < 0 };
  if (away < 0) {
    return reach;
  }
  const coarse = fine[away];
  const share = Math.log(wanted / last.error) / Math.log(coarse.error / last.error);
  return {
    ...reach,
    cost: between(last.cost, coarse.cost, share),
    size: between(last.size, coarse.size, share),
  };
}

/**
 * The step or tolerance that is told and run: of two digits, not larger than what was found.
 * @param {Reach} reach
 */
export const sizeToRun = ({ size, atMost }) =>
  atMost ? size : Number((size * 0.995).toPrecision(2));

/**
 * Who reaches an accuracy, the cheapest first.
 * @param {Dot[][]} dots by method
 * @param {number} wanted
 */
export const cheapestFor = (dots, wanted) =>
  dots.flatMap((list) => reachOf(list, wanted) ?? []).sort((a, b) => a.cost - b.cost);
