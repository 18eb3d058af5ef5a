// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Where a mechanism is between two frames that were received: on the parabola through them and the
// frame before. A body that turns by an angle d from frame to frame is off by at most d^3 / 15 of
// its radius: 0.1 % at two turns and 50 frames a second.

/**
 * The largest ratio of the second to the first differences, about the turn from frame to frame
 * [rad], of which something between is drawn: beyond it bars would seem to change their length, and
 * a chart of rotations that is left makes a leap.
 */
const MOST_TURN = 0.7;

/**
 * @typedef {{values: Float64Array, width: number, from: number, size: number}} Rows rows of a width
 *   one after the other, of which `size` values are wanted, from `from` on
 */

/** Is the motion about frame i smooth enough? @param {Rows} rows @param {number} at first value */
function isSmooth({ values, width, size }, at) {
  let first = 0;
  let second = 0;
  for (let k = at; k < at + size; k++) {
    const step = values[k + width] - values[k];
    const bend = step - (values[k] - values[k - width]);
    first += step * step;
    second += bend * bend;
  }
  return second <= MOST_TURN * MOST_TURN * first;
}

/**
 * The values of a row; of a place between two rows what lies between, or the earlier row where the
 * motion is too quick.
 * @param {Rows} rows @param {number} place a row's number, or between two rows
 * @param {Float64Array} out of `size`, for what lies between
 * @returns {Float64Array} a view of the row, or `out`
 */
export function rowAt(rows, place, out) {
  const { values, width, from, size } = rows;
  const i = Math.floor(place);
  const part = place - i;
  const at = i * width + from;
  if (part === 0 || (i > 0 && !isSmooth(rows, at))) {
    return values.subarray(at, at + size);
  }
  const bent = i > 0 ? (part * (part - 1)) / 2 : 0;
  for (let k = 0; k < size; k++) {
    const here = values[at + k];
    const step = values[at + k + width] - here;
    const bend = i > 0 ? step - (here - values[at + k - width]) : 0;
    out[k] = here + part * step + bent * bend;
  }
  return out;
}

/**
 * Is every value of one row within a distance of the other's? NaN is near nothing.
 * @param {ArrayLike<number>} a @param {ArrayLike<number>} b @param {number} near
 */
export function coincide(a, b, near) {
  for (let i = 0; i < a.length; i++) {
    if (!(Math.abs(a[i] - b[i]) < near)) {
      return false;
    }
  }
  return true;
}
