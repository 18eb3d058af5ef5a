// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Finds the method that reaches a wanted accuracy for the least: between the measured points of a
// study, by straight lines in decades, with the margin that the study names. The engine's
// session/precision/wanted.c answers in the terminal by the same rule.
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
      `an error of ${quantity(metres, "m")} at the end of a bar of ${quantity(length, "m")} (${scientific(value)} of its length)`,
    );
  }
  const angle = error === "q" ? parseQuantity(text, "rad") : NaN;
  return sound(angle, `an error of ${scientific(angle)}`);
}

/**
 * The rule by which a study's points are read: `margin`: the size is read off for this share of the
 * error that is wanted; `floor`: errors below it are no more than bounds, and count as it.
 * @typedef {{margin: number, floor: number}} Rule
 * @typedef {import("./study-documents.js").Dot} Dot
 * @typedef {{
 *   m: number, cost: number, size: number, dot: Dot, atMost: boolean, measured: boolean,
 *   coarser?: Dot,
 * }} Reach
 *   atMost: no coarser run was accurate enough or tried, so that a larger size may do as well;
 *   measured: it is the size of a run
 */

/** @param {number} a @param {number} b @param {number} share */
const between = (a, b, share) => (share > 0 ? a * (b / a) ** share : a);

/**
 * Returns where one method reaches an accuracy at the least cost, as the engine finds it
 * (hn_wp_reach).
 * @param {Dot[]} dots of one method, the coarsest first
 * @param {number} wanted
 * @param {(dot: Dot) => number} claimed
 */
function placeOf(dots, wanted, claimed) {
  const known = dots.filter(({ error, cost, away }) => !away && Number.isFinite(error) && cost > 0);
  /** @type {{dot: Dot, from: Dot | null, cost: number} | null} */
  let best = null;
  for (const [i, dot] of known.entries()) {
    const error = claimed(dot);
    if (error > wanted) {
      continue;
    }
    const before = known[i - 1];
    const reads = before && error < wanted && claimed(before) > wanted && before.cost < dot.cost;
    const share = reads ? Math.log(wanted / error) / Math.log(claimed(before) / error) : 0;
    const cost = reads ? between(dot.cost, before.cost, share) : dot.cost;
    if (!best || cost < best.cost) {
      best = { dot, from: reads ? before : null, cost };
    }
  }
  return best;
}

/**
 * The size with which one method is run for an accuracy, and what that costs.
 * @param {Dot[]} dots of one method, the coarsest first
 * @param {number} wanted
 * @param {Rule} rule
 * @returns {Reach[]} none, where it reaches the accuracy nowhere
 */
function reachOf(dots, wanted, { margin, floor }) {
  const claimed = ({ error }) => Math.max(error, floor);
  const place = placeOf(dots, wanted, claimed);
  if (!place) {
    return [];
  }
  const { dot, from } = place;
  const reach = { m: dot.m, cost: dot.cost, size: dot.size, dot, atMost: !from, measured: true };
  if (!from) {
    return [reach];
  }
  const least = claimed(dot);
  const share = Math.max(0, Math.log((margin * wanted) / least) / Math.log(claimed(from) / least));
  return [
    {
      ...reach,
      measured: share === 0,
      coarser: from,
      cost: between(dot.cost, from.cost, share),
      size: between(dot.size, from.size, share),
    },
  ];
}

/**
 * The step or tolerance that is told and run: of two digits, not larger than what was found.
 * @param {Reach} reach
 */
export function sizeToRun({ size, measured }) {
  const digit = 10 ** (Math.floor(Math.log10(size)) - 1);
  return measured ? size : Number((Math.floor(size / digit) * digit).toPrecision(2));
}

/**
 * Returns who reaches an accuracy, the cheapest first.
 * @param {Dot[][]} dots by method
 * @param {number} wanted
 * @param {Rule} rule
 */
export const cheapestFor = (dots, wanted, rule) =>
  dots.flatMap((list) => reachOf(list, wanted, rule)).sort((a, b) => a.cost - b.cost);

/**
 * Returns how steady the time of a point was measured, as the engine's own ranking reads it:
 * quartiles and medians of the halves count.
 * @param {{median: number, low: number, high: number, halves: number[]}} cpu
 */
export const steadinessOf = ({ median, low, high, halves }) => ({
  range: [Math.min(low, ...halves) / median, Math.max(high, ...halves) / median],
  halves: Math.max(...halves) / Math.min(...halves),
});

/** Returns whether costs of this kind are ranked at all: times of hurried runs are not. */
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
