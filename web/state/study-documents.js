// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Reads the documents of studies: points, frames, bars, boundaries, as the views draw them.
import { counted, quantity, withPowers } from "./format.js";
import { parseSpelling } from "./spelling.js";
import { steadinessOf } from "./wanted.js";

/** @typedef {{length: number, coordinates: {kind: string}[]}} Measured of a scene */
const shareOfLength = ({ length }) => `share of ${quantity(length, "m")}`;

/**
 * Coordinates are compared in rad, and lengths as shares of the scene's.
 * @param {Measured} scene
 */
function unitOfPosition(scene) {
  const angles = scene.coordinates.filter(({ kind }) => kind === "angle").length;
  if (angles === scene.coordinates.length) {
    return "rad";
  }
  return angles === 0 ? shareOfLength(scene) : `rad, lengths as ${shareOfLength(scene)}`;
}

/** `unit`: what its numbers are in, on this scene. */
export const ERRORS = [
  {
    name: "q",
    word: "position",
    unit: unitOfPosition,
    about: "largest error of a coordinate, angles in rad",
  },
  {
    name: "v",
    word: "velocity",
    unit: () => "share of the fastest velocity",
    about: "largest error of a velocity, relative to the fastest of the motion",
  },
  {
    name: "reaction",
    word: "reactions",
    unit: () => "share of the largest force",
    about: "largest error of a loop's force, relative to the largest of the motion",
  },
  { name: "gap", word: "gap", unit: shareOfLength, about: "largest loop gap" },
  {
    name: "velocity_gap",
    word: "velocity violation",
    unit: () => "share of the fastest velocity",
    about: "largest velocity violation: how fast the loops come apart",
  },
  {
    name: "energy",
    word: "energy",
    unit: () => "share of its range",
    about: "largest error of the energy, relative to its range",
  },
];

export const COSTS = [
  { name: "operations", word: "operations", unit: "op", of: (p) => p.operations },
  { name: "evaluations", word: "evaluations", unit: "", of: (p) => p.evaluations },
  { name: "time", word: "time", unit: "s", of: (p) => p.cpu?.median },
];

/**
 * The entry of a list that has a name.
 * @template {{name: string}} T
 * @param {T[]} list
 * @param {string} wanted one of the names
 * @returns {T}
 */
export function byName(list, wanted) {
  const found = list.find(({ name }) => name === wanted);
  if (!found) {
    throw new Error(`no entry is called ${wanted}`);
  }
  return found;
}

const LEAST = 1e-17;
/** States of points of which nothing is known. */
export const NOT_RUN = ["pending", "skipped", "left out"];

/**
 * @typedef {{m: number, k: number, spelling: string, size: number, sizeName: string, cost: number,
 *   error: number, state: string,
 *   reason: string, bound: boolean, away?: boolean, range?: number[], halves?: number}} Dot
 *   away: its method converges to another motion, and is accurate nowhere;
 *   range: least and largest measured time over the median; halves: how far apart the medians of
 *   the two halves of the samples are, as a ratio; both only where the cost is a time
 */

/**
 * Returns what a point that failed would have cost: as its neighbour, by the ratio of the sizes.
 */
function costOfFailed(points, k, costOf) {
  const done = points.filter((p) => p.state === "done" && costOf(p) > 0);
  const near = done.sort(
    (a, b) =>
      Math.abs(Math.log(a.size / points[k].size)) - Math.abs(Math.log(b.size / points[k].size)),
  )[0];
  return near ? costOf(near) * (near.size / points[k].size) : NaN;
}

/**
 * The points of a study as they are drawn; those that failed have the error Infinity: they stand on
 * the upper edge.
 * @param {any} study
 * @param {string} error
 * @param {string} cost
 * @returns {Dot[][]} by method
 */
export function dotsOf(study, error, cost) {
  const costOf = byName(COSTS, cost).of;
  return study.methods.map((method, m) =>
    method.points.flatMap((p, k) => {
      const shared = {
        m,
        k,
        spelling: p.method,
        size: p.size,
        sizeName: method.size,
        away: method.class?.kind === "elsewhere",
        state: p.state,
      };
      if (p.state === "done") {
        const value = p.worst[error];
        const known = value !== null && costOf(p) > 0;
        return known
          ? [
              {
                ...shared,
                cost: costOf(p),
                error: Math.max(value, LEAST),
                reason: "",
                bound: p.bounds.includes(error),
                ...(cost === "time" ? steadinessOf(p.cpu) : {}),
              },
            ]
          : [];
      }
      return [
        {
          ...shared,
          cost: costOfFailed(method.points, k, costOf),
          error: Infinity,
          reason: p.reason,
          bound: false,
        },
      ];
    }),
  );
}

/** The size of a point, for people. @param {string} name @param {number} size */
const sizeWords = (name, size) =>
  name === "h" ? `h = ${quantity(size, "s")}` : `rtol = ${Number(size.toPrecision(2))}`;

/**
 * Returns which points were left out, and why; "" where all were run.
 * @param {any} study
 * @param {(m: number) => string} labelOf
 */
export function leftOutOf(study, labelOf) {
  const whose = study.methods.flatMap(({ points, size }, m) => {
    const missing = points.filter(({ state }) => NOT_RUN.includes(state));
    const sizes = missing.map((point) => sizeWords(size, point.size)).join(", ");
    return missing.length ? [`${labelOf(m)} at ${sizes}`] : [];
  });
  const points = study.methods.flatMap((method) => method.points);
  const missing = points.filter(({ state }) => NOT_RUN.includes(state));
  const reason = missing.find((point) => point.reason)?.reason ?? "the study was stopped";
  const were = missing.length === 1 ? "was" : "were";
  return missing.length
    ? `${missing.length} of ${points.length} points ${were} not run: ${reason}. Left out: ${whose.join("; ")}.`
    : "";
}

/**
 * The page's name for a method of a document, which may have others than the page: that of the
 * same formulation and integrator, in the same place where there are several; else its own.
 * @param {any} document
 * @param {{spelling: string, label: string}[]} methods of the page
 * @returns {(m: number) => string}
 */
export function labelsIn(document, methods) {
  const kindOf = (spelling) => {
    const { formulation, integrator } = parseSpelling(spelling);
    return `${formulation.name}@${integrator.name}`;
  };
  return (m) => {
    const { method } = document.methods[m];
    const isSame = (one) => kindOf(one?.spelling ?? "") === kindOf(method);
    return (isSame(methods[m]) ? methods[m] : methods.find(isSame))?.label ?? method;
  };
}

/**
 * Returns what is missing in a document of whatever kind, in a few words; "" where nothing is.
 * @param {any} document
 * @param {(m: number) => string} labelOf
 */
export function missingIn(document, labelOf) {
  const parts = document.methods.flatMap((method, m) => {
    const all = method.points ?? method.rows?.flat() ?? [method];
    const noun = method.points ? "point" : method.rows ? "cell" : "";
    const count = all.filter((one) => NOT_RUN.includes(one.state ?? one.class)).length;
    return count ? [noun ? `${labelOf(m)} ${counted(count, noun)}` : labelOf(m)] : [];
  });
  return parts.join(", ");
}

/**
 * Below it an error is no more than a bound, by what the reference itself may be off; 0: the
 * quantity needs no reference.
 */
export const floorOf = (study, error) =>
  study.wanted.above_reference * (study.reference.error[error] ?? 0);

/**
 * Returns how the points of a study are read for a wanted accuracy.
 * @returns {import("./wanted.js").Rule}
 */
export const ruleOf = (study, error) => ({
  margin: study.wanted.margin,
  floor: floorOf(study, error),
});

const COUNTS = { k: "thousand ", M: "million ", G: "billion ", "": "" };

/** A text for a regular expression. @param {string} text */
const literally = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/**
 * Sentences on who reaches which accuracy for the least.
 * @param {any} study @param {string} error @param {string} cost
 * @param {(m: number) => string} [labelOf] names of the methods in place of their spellings
 * @returns {string[]}
 */
export function sentencesOf(study, error, cost, labelOf = (m) => study.methods[m].method) {
  const found = study.pareto.find((one) => one.error === error && one.cost === cost);
  const named = (study.methods ?? [])
    .map(({ method }, m) => ({ method, m }))
    .sort((a, b) => b.method.length - a.method.length)
    .reduce(
      (words, { method, m }) =>
        words.replace(new RegExp(`(?<![\\w-])${literally(method)}(?![\\w:-])`, "g"), () =>
          labelOf(m),
        ),
      found?.sentences ?? "",
    );
  const text = withPowers(named).replace(
    /(?<=\d )([kMG]?)op\b/g,
    (_, prefix) => `${COUNTS[prefix]}operations`,
  );
  return text.split("\n").filter(Boolean);
}

/**
 * Returns what an error of a position means on this mechanism; "" for other errors, which say it
 * themselves.
 * @param {string} error @param {number} length [m] of the scene
 */
export const meaningOf = (error, length) =>
  error === "q"
    ? `An error of 10⁻³ is 1 mrad of an angle: ${quantity(1e-3 * length, "m")} at the end of a bar of ${quantity(length, "m")}.`
    : "";

/**
 * The same errors as lengths, for the title of the axis; "" where they are none.
 * @param {string} error @param {number} length [m] of the scene
 */
export const lengthsOf = (error, length) =>
  error === "q" || error === "gap" ? ` (10⁻³ is ${quantity(1e-3 * length, "m")})` : "";

/**
 * Whole decades that hold all finite errors and the floor, at least two.
 * @param {Dot[][]} dots
 * @param {number} floor
 */
export function frameOf(dots, floor) {
  const all = dots.flat();
  const errors = all.map(({ error }) => error).filter(Number.isFinite);
  const costs = all.map(({ cost }) => cost).filter((cost) => cost > 0);
  if (errors.length === 0 || costs.length === 0) {
    return null;
  }
  const low = Math.floor(Math.log10(Math.min(...errors)) + 1e-9);
  const high = Math.max(low + 2, Math.min(2, Math.ceil(Math.log10(Math.max(...errors)) - 1e-9)));
  const near = floor > 0 && Math.log10(floor) > low - 2;
  const x0 = Math.log10(Math.min(...costs));
  const x1 = Math.log10(Math.max(...costs));
  const margin = 0.04 * (x1 - x0) + 0.08;
  return {
    x0: x0 - margin,
    x1: x1 + margin,
    y0: near ? Math.min(low, Math.floor(Math.log10(floor))) : low,
    y1: high,
  };
}

/**
 * Returns where the parts of a sum stand on a line: negative ones to the left of 0, positive ones
 * to the right, in shares of the longer side.
 * @param {Record<string, number | null>} parts
 * @param {{name: string}[]} order
 * @returns {{name: string, value: number, from: number, to: number}[]} -1 .. 1
 */
export function barsOf(parts, order) {
  const known = order.filter(
    ({ name }) => Number.isFinite(parts[name] ?? NaN) && parts[name] !== 0,
  );
  const side = (sign) =>
    known.reduce((sum, { name }) => sum + Math.max(0, sign * Number(parts[name])), 0);
  const longest = Math.max(side(1), side(-1)) || 1;
  let right = 0;
  let left = 0;
  return known.map(({ name }) => {
    const value = Number(parts[name]);
    const length = value / longest;
    const from = value > 0 ? right : left + length;
    const to = value > 0 ? right + length : left;
    right += Math.max(0, length);
    left += Math.min(0, length);
    return { name, value, from, to };
  });
}

/** The mark of each outcome of a trial: a letter as well as a colour. */
export const CLASSES = {
  stable: { letter: "s", word: "stable, error below 1 %" },
  inaccurate: { letter: "i", word: "stable, inaccurate" },
  grew: { letter: "g", word: "unstable: the error grew" },
  stopped: { letter: "x", word: "stopped with a reason" },
  refused: { letter: "r", word: "refused" },
  skipped: { letter: "?", word: "not run: time limit reached" },
  pending: { letter: "", word: "not run yet" },
};

/**
 * Returns where the predicted boundary runs, in cells from the lower left corner: lines of points.
 * @param {any} map document @param {any} method of it
 * @returns {[number, number][][]}
 */
export function boundaryOf(map, method) {
  const { values, scale } = map.y;
  const height = (value) => {
    const at = (v) => (scale === "log" ? Math.log(v) : v);
    const share = (at(value) - at(values[0])) / (at(values[values.length - 1]) - at(values[0]));
    return Math.min(values.length, Math.max(0, 0.5 + share * (values.length - 1)));
  };
  if (map.y.kind === "step") {
    const line = /** @type {[number, number][]} */ ([]);
    method.columns.forEach(({ predicted }, i) => {
      if (predicted[0] > 0) {
        line.push([i, height(predicted[0])], [i + 1, height(predicted[0])]);
      }
    });
    return line.length ? [line] : [];
  }
  const beyond = (i, j) => {
    const margin = method.rows[j]?.[i]?.margin;
    return Number.isFinite(margin ?? NaN) ? margin > 1 : null;
  };
  const lines = /** @type {[number, number][][]} */ ([]);
  const differ = (a, b) => a !== null && b !== null && a !== b;
  method.rows.forEach((row, j) =>
    row.forEach((_, i) => {
      if (differ(beyond(i, j), beyond(i + 1, j))) {
        lines.push([
          [i + 1, j],
          [i + 1, j + 1],
        ]);
      }
      if (differ(beyond(i, j), beyond(i, j + 1))) {
        lines.push([
          [i, j + 1],
          [i + 1, j + 1],
        ]);
      }
    }),
  );
  return lines;
}
