// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A stability map as heat: the worst gap, the error or the energy error of every cell as a colour,
// and where the smallest of them is.
import { plain, quantity } from "./format.js";

/**
 * `of` gives the value of a cell, NaN where there is none.
 * @typedef {{
 *   name: string, word: string, unit: string, of: (cell: any, length: number) => number,
 * }} Heat
 * @type {Heat[]}
 */
export const HEATS = [
  { name: "gap", word: "worst loop gap", unit: "m", of: (cell, length) => cell.gap * length },
  { name: "error", word: "error of velocity", unit: "", of: (cell) => cell.error },
  { name: "energy", word: "energy gained", unit: "", of: (cell) => cell.energy },
];

const RAN = ["stable", "inaccurate"];
const LEAST = 1e-17; // smaller values are rounding

/** The value of a cell that ran to its end; NaN for any other. */
export function heatOf(heat, cell, length) {
  const value = RAN.includes(cell?.class) ? heat.of(cell, length) : NaN;
  return Number.isFinite(value) ? Math.max(value, LEAST) : NaN;
}

/**
 * Decades that the map covers, and the cell with the smallest value.
 * @param {Heat} heat
 * @param {any[][]} rows cells of one method
 * @param {number} length [m] of the scene
 * @returns {{low: number, high: number, best: {i: number, j: number, value: number} | null}}
 */
export function heatRange(heat, rows, length) {
  let best = null;
  let [low, high] = [Infinity, -Infinity];
  rows.forEach((row, j) =>
    row.forEach((cell, i) => {
      const value = heatOf(heat, cell, length);
      if (Number.isNaN(value)) {
        return;
      }
      low = Math.min(low, Math.log10(value));
      high = Math.max(high, Math.log10(value));
      if (!best || value < best.value) {
        best = { i, j, value };
      }
    }),
  );
  return { low, high, best };
}

/** "2.5 mm", or a share in percent. @param {Heat} heat @param {number} value */
export const heatWords = (heat, value) =>
  heat.unit ? quantity(value, heat.unit) : `${plain(Number((100 * value).toPrecision(2)))} %`;

/**
 * The best value of every quantity and where it is: closing the gap, the right motion and the right
 * energy rarely want the same constants.
 * @param {any} map document
 * @param {any} method of it
 * @param {number} length [m] of the scene
 * @param {(axis: any, value: number) => string} valueOf words for a value on an axis
 * @returns {string[]}
 */
export function heatSentences(map, method, length, valueOf) {
  return HEATS.flatMap((heat) => {
    const { best } = heatRange(heat, method.rows, length);
    if (!best) {
      return [];
    }
    const where = [
      map.x && valueOf(map.x, map.x.values[best.i]),
      valueOf(map.y, map.y.values[best.j]),
    ];
    return [
      `smallest ${heat.word}: ${heatWords(heat, best.value)} at ${where.filter(Boolean).join(", ")}`,
    ];
  });
}

/**
 * Where a map over α and β has critical damping (α = β), in cells from the lower left corner.
 * @param {any} map document
 * @returns {[number, number][] | null} two ends, or null
 */
export function criticalLine({ x, y }) {
  if (x?.name !== "alpha" || y?.name !== "beta") {
    return null;
  }
  const low = Math.max(x.values[0], y.values[0]);
  const high = Math.min(x.values[x.values.length - 1], y.values[y.values.length - 1]);
  const at = (axis, value) => {
    const f = (v) => (axis.scale === "log" ? Math.log(v) : v);
    const n = axis.values.length;
    const share = (f(value) - f(axis.values[0])) / (f(axis.values[n - 1]) - f(axis.values[0]));
    return 0.5 + share * (n - 1);
  };
  return low < high
    ? [
        [at(x, low), at(y, low)],
        [at(x, high), at(y, high)],
      ]
    : null;
}
