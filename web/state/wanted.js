// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Which method reaches a wanted accuracy for the least: between the measured points of a study, by
// straight lines in decades. Between two points an error does not follow such a line: it was up to
// 1.6 times as large (the engine's session/precision/wanted.c does the same).
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
 * @typedef {{
 *   m: number, cost: number, size: number, dot: Dot, atMost: boolean, measured: boolean,
 *   coarser?: Dot,
 * }} Reach
 *   atMost: the coarsest run is already accurate enough; measured: it is the size of a run
 */

/** The step or tolerance is read off for this share of the error that is wanted. */
const MARGIN = 0.5;

/** @param {number} a @param {number} b @param {number} share */
const between = (a, b, share) => (share > 0 ? a * (b / a) ** share : a);

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
  const reach = {
    m: last.m,
    cost: last.cost,
    size: last.size,
    dot: last,
    atMost: away < 0,
    measured: true,
  };
  if (away < 0) {
    return reach;
  }
  const coarse = fine[away];
  const share = Math.max(
    0,
    Math.log((MARGIN * wanted) / last.error) / Math.log(coarse.error / last.error),
  );
  return {
    ...reach,
    measured: share === 0,
    coarser: coarse,
    cost: between(last.cost, coarse.cost, share),
    size: between(last.size, coarse.size, share),
  };
}

/**
 * The step or tolerance that is told and run: of two digits, not larger than what was found.
 * @param {Reach} reach
 */
export const sizeToRun = ({ size, measured }) =>
  measured ? size : Number((size * 0.995).toPrecision(2));

/**
 * Who reaches an accuracy, the cheapest first.
 * @param {Dot[][]} dots by method
 * @param {number} wanted
 */
export const cheapestFor = (dots, wanted) =>
  dots.flatMap((list) => reachOf(list, wanted) ?? []).sort((a, b) => a.cost - b.cost);

/**
 * How steady the time of a point was measured, as the engine's own ranking reads it: quartiles and
 * medians of the halves count.
 * @param {{median: number, low: number, high: number, halves: number[]}} cpu
 */
export const steadinessOf = ({ median, low, high, halves }) => ({
  range: [Math.min(low, ...halves) / median, Math.max(high, ...halves) / median],
  halves: Math.max(...halves) / Math.min(...halves),
});

/** Whether costs of this kind are ranked at all: times of hurried runs are not. */
export const isRanked = (study, error, cost) =>
  cost !== "time" ||
  (study.pareto.find((one) => one.error === error && one.cost === cost)?.ranked ?? true);

/** Times this close, or whose halves are this far apart, are not ranked: as in the engine. */
const CLOSE = 1.1;

/** The range of a time, from the one or two points that it comes from. @param {Reach} reach */
function rangeOf({ dot, coarser, cost }) {
  const ranges = [dot, coarser].flatMap((one) => (one?.range ? [one.range] : []));
  return [
    cost * Math.min(1, ...ranges.map(([low]) => low)),
    cost * Math.max(1, ...ranges.map(([, high]) => high)),
  ];
}

/**
 * Those that share the first place, because their times cannot be told apart: by the rule of the
 * engine's sentences. Counts are exact, so that one of them is the first.
 * @param {Reach[]} list the cheapest first
 * @returns {{close: Reach[], unsteady: boolean}} close: with the first; unsteady: the two halves of
 *   a timing of the first or the next disagree
 */
export function rankingOf(list) {
  const [first, ...others] = list;
  if (!first?.dot.range) {
    return { close: list.slice(0, 1), unsteady: false };
  }
  const [, high] = rangeOf(first);
  const close = others.filter((one) => one.cost < CLOSE * first.cost || rangeOf(one)[0] <= high);
  const apart = list
    .slice(0, 2)
    .flatMap(({ dot, coarser }) => [dot.halves ?? 1, coarser?.halves ?? 1]);
  return { close: [first, ...close], unsteady: !close.length && !(Math.max(...apart) <= CLOSE) };
}
