// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The received frames, in columns, bounded. When the columns are full every second frame is
// dropped:
// the whole span stays, at half the resolution. A failed method has its last good values at its
// end, NaN in its curves from then on, and keeps its last good points.

import { rowAt } from "./between.js";

const BYTES = 32e6;
const MOST_FRAMES = 8192;
const FEWEST_FRAMES = 256;

/** Quantities kept per method, by their names in a frame. */
export const COLUMNS = /** @type {const} */ ([
  "gap",
  "velocity_gap",
  "energy_change",
  "ops",
  "evals",
  "cpu",
  "steps",
  "pivot_ratio",
  "work",
  "sigma_min",
  "condition",
  "lambda_max",
]);

/** @typedef {ReturnType<typeof createHistory>} History */

/**
 * @param {number} nMethods
 * @param {number} nPoints
 * @param {number} [nCoordinates] of the scene: as many values and rates are kept
 */
export function createHistory(nMethods, nPoints, nCoordinates = 0) {
  const perFrame = 8 * nMethods * (3 * nPoints + 2 * nCoordinates + COLUMNS.length);
  const capacity = Math.max(
    FEWEST_FRAMES,
    Math.min(MOST_FRAMES, 2 * Math.floor(BYTES / perFrame / 2)),
  );
  const t = new Float64Array(capacity);
  const columns = Array.from({ length: nMethods }, () =>
    Object.fromEntries(COLUMNS.map((name) => [name, new Float64Array(capacity)])),
  );
  const points = Array.from({ length: nMethods }, () => new Float64Array(capacity * 3 * nPoints));
  /** q and v of each kept frame */
  const states = Array.from(
    { length: nMethods },
    () => new Float64Array(capacity * 2 * nCoordinates),
  );
  /** what lies between two frames, by method */
  const scratch = Array.from({ length: nMethods }, () => ({
    points: new Float64Array(3 * nPoints),
    q: new Float64Array(nCoordinates),
  }));
  /** time at which a method ended early, or NaN */
  const ended = new Float64Array(nMethods).fill(NaN);
  /** code of what ended a method, or "" @type {string[]} */
  const causes = Array.from({ length: nMethods }, () => "");
  const frames = new Int32Array(capacity);
  /** what a hand did in each kept frame, and its force [N] on each method
   * @type {({point: number, to: number[], stiffness: number, damping: number,
   *   forces: (number[] | undefined)[]} | null)[]} */
  const pulls = [];
  let count = 0;
  let stride = 1;
  let lastFrame = -1;

  function halve() {
    const width = 3 * nPoints;
    const both = 2 * nCoordinates;
    for (let i = 0; i < count / 2; i++) {
      t[i] = t[2 * i];
      frames[i] = frames[2 * i];
      pulls[i] = pulls[2 * i];
      for (let m = 0; m < nMethods; m++) {
        for (const name of COLUMNS) {
          columns[m][name][i] = columns[m][name][2 * i];
        }
        points[m].copyWithin(i * width, 2 * i * width, (2 * i + 1) * width);
        states[m].copyWithin(i * both, 2 * i * both, (2 * i + 1) * both);
      }
    }
    count = Math.ceil(count / 2);
    stride *= 2;
  }

  /** @param {number} m @param {import("./store.js").MethodFrame} method @param {number} now */
  function put(m, method, now) {
    const failed = method.state === "failed";
    const gone = failed && !Number.isNaN(ended[m]); // its last good values stand at its end once
    if (failed && !gone) {
      ended[m] = Number.isFinite(method.t) ? method.t : now;
      causes[m] = method.failure?.code ?? "";
    }
    for (const name of COLUMNS) {
      const value = method[name];
      columns[m][name][count] = gone || value === undefined || value === null ? NaN : value;
    }
    keep(points[m], 3 * nPoints, method.points);
    keep(states[m], 2 * nCoordinates, [...(method.q ?? []), ...(method.v ?? [])]);
  }

  /**
   * Returns what came, or what was there before; NaN where nothing ever came.
   * @param {Float64Array} rows
   * @param {number} width
   * @param {number[] | undefined} values
   */
  function keep(rows, width, values) {
    const from = count * width;
    if (values?.length === width) {
      rows.set(values, from);
    } else if (count > 0) {
      rows.copyWithin(from, from - width, from);
    } else {
      rows.fill(NaN, from, from + width);
    }
  }

  return {
    t,
    columns,
    ended,
    causes,
    nMethods,
    nPoints,
    get count() {
      return count;
    },
    get stride() {
      return stride;
    },
    get lastFrame() {
      return lastFrame;
    },
    /**
     * Takes a frame once; repeats and frames out of order are told by `false`.
     * @param {import("./store.js").Frame} frame
     */
    push(frame) {
      if (frame.frame <= lastFrame) {
        return false;
      }
      lastFrame = frame.frame;
      if (frame.frame % stride !== 0) {
        return true;
      }
      if (count === capacity) {
        halve();
        if (frame.frame % stride !== 0) {
          return true;
        }
      }
      t[count] = frame.t;
      frames[count] = frame.frame;
      pulls[count] = frame.pull
        ? { ...frame.pull, forces: frame.methods.map((method) => method.pull_force) }
        : null;
      frame.methods.forEach((method, m) => put(m, method, frame.t));
      count++;
      return true;
    },
    /**
     * Points of a method in the i-th kept frame (a view, not a copy). With a fraction: between two
     * frames, until the next call.
     * @param {number} m
     * @param {number} i
     */
    pointsAt(m, i) {
      const width = 3 * nPoints;
      return rowAt({ values: points[m], width, from: 0, size: width }, i, scratch[m].points);
    },
    /** Coordinates alone, in the same way. @param {number} m @param {number} i */
    coordinatesAt(m, i) {
      const width = 2 * nCoordinates;
      return rowAt({ values: states[m], width, from: 0, size: nCoordinates }, i, scratch[m].q);
    },
    /** The hand in the i-th kept frame; null: none. @param {number} i */
    pullAt: (i) => pulls[Math.floor(i)] ?? null,
    /**
     * Returns the frame of the clock that the i-th kept one is, or a place between two.
     * @param {number} i
     */
    frameAt(i) {
      const low = Math.floor(i);
      return i === low ? frames[i] : frames[low] + (i - low) * (frames[low + 1] - frames[low]);
    },
    /**
     * Coordinates and rates of a method in the i-th kept frame (views).
     * @param {number} m
     * @param {number} i
     */
    stateAt(m, i) {
      const from = 2 * nCoordinates * i;
      return {
        q: states[m].subarray(from, from + nCoordinates),
        v: states[m].subarray(from + nCoordinates, from + 2 * nCoordinates),
      };
    },
    /** Index of the kept frame nearest to a time. @param {number} time */
    indexAt(time) {
      let low = 0;
      let high = count - 1;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (t[middle] < time) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      return low > 0 && time - t[low - 1] < t[low] - time ? low - 1 : low;
    },
    /**
     * The frames that an axis of time holds, and one more on either side: [from, to).
     * @param {[number, number] | null} zoom [s] null: all of them
     */
    inSight(zoom) {
      const [from, to] = zoom ? zoom.map((time) => this.indexAt(time)) : [1, count];
      return [Math.max(0, from - 1), Math.min(count, to + 2)];
    },
    /** The place of a time among the kept frames, with its fraction. @param {number} time */
    placeAt(time) {
      const near = this.indexAt(time);
      const low = Math.max(0, t[near] > time ? near - 1 : near);
      const step = low + 1 < count ? t[low + 1] - t[low] : 0;
      return step > 0 ? low + Math.min(1, Math.max(0, (time - t[low]) / step)) : low;
    },
    /**
     * Largest magnitude of a quantity up to and including index i.
     * @param {number} m
     * @param {string} name
     * @param {number} from
     * @param {number} to
     */
    worst(m, name, from, to) {
      let worst = NaN;
      const column = columns[m][name];
      for (let i = Math.max(0, from); i <= to && i < count; i++) {
        const value = Math.abs(column[i]);
        if (!Number.isNaN(value) && !(value <= worst)) {
          worst = value;
        }
      }
      return worst;
    },
  };
}

/** Indices of the entries of least and largest magnitude in [start, end), in the order of time. */
function extremes(y, start, end) {
  let low = start;
  let high = start;
  for (let i = start + 1; i < end; i++) {
    const size = Math.abs(y[i]);
    low = size < Math.abs(y[low]) || Number.isNaN(y[low]) ? i : low;
    high = size > Math.abs(y[high]) || Number.isNaN(y[high]) ? i : high;
  }
  return low < high ? [low, high] : [high, low];
}

/**
 * Thins columns for a plot to two points (least and largest) per bucket, so that no peak is lost.
 * @param {ArrayLike<number>} t ascending
 * @param {ArrayLike<number>[]} ys
 * @param {number} count
 * @param {number} buckets
 * @param {(value: number) => number | null} map to what is plotted; null is a hole
 * @returns {(number | null)[][]} [t, y1, y2, ...]
 */
export function thin(t, ys, count, buckets, map) {
  const size = Math.ceil(count / buckets);
  if (size <= 2) {
    const first = (y, of) => Array.from({ length: count }, (_, i) => of(y[i]));
    return [first(t, Number), ...ys.map((y) => first(y, map))];
  }
  /** @type {(number | null)[][]} */
  const out = [[], ...ys.map(() => [])];
  for (let start = 0; start < count; start += size) {
    const end = Math.min(count, start + size);
    out[0].push(t[start], t[end - 1]);
    ys.forEach((y, k) => out[k + 1].push(...extremes(y, start, end).map((i) => map(y[i]))));
  }
  return out;
}
