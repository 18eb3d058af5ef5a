// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A stability map as heat: the worst gap, the error or the energy error of every cell as a colour,
// and where the smallest of them is.
import { plain, quantity, scientific } from "./format.js";

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
const LEAST_PLAIN = 1e-3; // [%] below it a power of ten is easier to read
const LEAST = 1e-17; // smaller values are rounding
const WRONG = 1e-2; // an error of velocity from which on a small gap or energy is no merit

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

/** A share in percent. @param {number} share */
function percents(share) {
  const percent = 100 * share;
  return `${percent < LEAST_PLAIN ? scientific(percent) : plain(Number(percent.toPrecision(2)))} %`;
}

/** "2.5 mm", or a share in percent. @param {Heat} heat @param {number} value */
export const heatWords = (heat, value) =>
  heat.unit ? quantity(value, heat.unit) : percents(value);

/**
 * The best value of every quantity and where it is: closing the gap, the right motion and the right
 * energy rarely want the same constants. A small gap or energy beside a wrong motion is said to be
 * so: energy that crosses zero, or is lost, is not right.
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
    const { error } = method.rows[best.j][best.i];
    const but =
      heat.name !== "error" && error > WRONG
        ? `, where the velocity is ${percents(error)} off`
        : "";
    const value = heatWords(heat, best.value);
    return [`smallest ${heat.word}: ${value} at ${where.filter(Boolean).join(", ")}${but}`];
  });
}

/** A value as it is spaced along its axis. @param {any} axis @param {number} value */
const spaced = (axis, value) => (axis.scale === "log" ? Math.log(value) : value);

/**
 * Returns where a value stands on an axis, in cells from its lower end; beyond it where the axis
 * ends.
 * @param {any} axis @param {number} value
 */
export function placeOnAxis(axis, value) {
  const { values } = axis;
  const [low, high] = [spaced(axis, values[0]), spaced(axis, values[values.length - 1])];
  return 0.5 + ((spaced(axis, value) - low) / (high - low)) * (values.length - 1);
}

/** The value at a place on an axis, to three digits. @param {any} axis @param {number} at */
export function valueOnAxis(axis, at) {
  const { values } = axis;
  const share = Math.min(values.length, Math.max(0, at)) - 0.5;
  const [low, high] = [spaced(axis, values[0]), spaced(axis, values[values.length - 1])];
  const value = low + (share / (values.length - 1)) * (high - low);
  return Number((axis.scale === "log" ? Math.exp(value) : value).toPrecision(3));
}

/**
 * The axes of a map, made wider where present values lie beyond them, as the server is asked for
 * them. An axis of ratios has no place for zero.
 * @param {any} map document @param {{x: number[], y: number[]}} present values, by axis
 */
export function axesWith({ x, y }, present) {
  const widened = (axis, values) => {
    const fit = values.filter((value) => axis.scale !== "log" || value > 0);
    const all = [axis.values[0], axis.values[axis.values.length - 1], ...fit];
    const name = axis.kind === "step" ? "step" : axis.name;
    return `${name}=${Math.min(...all)}..${Math.max(...all)}:${axis.scale === "log" ? "log" : "lin"}`;
  };
  return [...(x ? [widened(x, present.x)] : []), widened(y, present.y)].join(",");
}

/** Is it a map over the two constants of Baumgarte's method? */
const isOfBaumgarte = ({ x, y }) => x?.name === "alpha" && y?.name === "beta";

/**
 * Returns where a map over α and β has critical damping (α = β), in cells from the lower left
 * corner.
 * @param {any} map document
 * @returns {[number, number][] | null} two ends, or null
 */
export function criticalLine({ x, y }) {
  if (!isOfBaumgarte({ x, y })) {
    return null;
  }
  const low = Math.max(x.values[0], y.values[0]);
  const high = Math.min(x.values[x.values.length - 1], y.values[y.values.length - 1]);
  return low < high
    ? [
        [placeOnAxis(x, low), placeOnAxis(y, low)],
        [placeOnAxis(x, high), placeOnAxis(y, high)],
      ]
    : null;
}

/**
 * The limit of h β on α = β that the predicted margins mean. The violation of an overdamped cell
 * decays fastest with α + sqrt(α² - β²); its margin is h times that over the limit.
 * @param {any} map document
 * @param {any} method of it
 * @param {number} h [s]
 * @returns {number} NaN where no cell tells
 */
export function baumgarteLimit({ x, y }, method, h) {
  let [best, limit] = [0, NaN];
  if (!isOfBaumgarte({ x, y }) || !(h > 0)) {
    return limit;
  }
  method.rows.forEach((row, j) =>
    row.forEach(({ margin }, i) => {
      const [alpha, beta] = [x.values[i], y.values[j]];
      if (alpha > beta && margin > best) {
        // the cell with the largest margin is the surest to be decided by α and β alone
        best = margin;
        limit = (h * (alpha + Math.sqrt(alpha * alpha - beta * beta))) / margin;
      }
    }),
  );
  return limit;
}

/**
 * Contour of a quantity at a level: the edges between cells below it and cells not below it, so
 * that no line crosses a number.
 * @param {number[][]} values rows from below; NaN where there is none
 * @param {number} level
 * @returns {[number, number][][]} edges, in cells from the lower left corner
 */
export function contourOf(values, level) {
  const parted = (a, b) => !Number.isNaN(a + b) && a >= level !== b >= level;
  return values.flatMap((row, j) =>
    row.flatMap((value, i) => {
      /** @type {[number, number][][]} */
      const edges = [];
      if (i + 1 < row.length && parted(value, row[i + 1])) {
        edges.push([
          [i + 1, j],
          [i + 1, j + 1],
        ]);
      }
      if (j + 1 < values.length && parted(value, values[j + 1][i])) {
        edges.push([
          [i, j + 1],
          [i + 1, j + 1],
        ]);
      }
      return edges;
    }),
  );
}
