// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Errors of every method over the frames received: distance from the reference solution, error of
// the energy, and the worst of each so far. Every frame is worked out once.
import { offReference } from "./reference.js";

/**
 * `off` [m] is NaN where the reference has no sample, and `worstOff` until its first one. Energy [J]
 * and gap [m] need no reference.
 * @typedef {{
 *   off: Float64Array, energy: Float64Array, worstOff: Float64Array, worstEnergy: Float64Array,
 *   worstGap: Float64Array,
 * }} Errors
 */
const NAMES = /** @type {const} */ (["off", "energy", "worstOff", "worstEnergy", "worstGap"]);

/** @type {WeakMap<object, {reference: any, stride: number, done: number, of: Errors[]}>} */
const kept = new WeakMap();

/** @param {import("./history.js").History} history @param {any} reference */
function begin(history, reference) {
  const column = () => new Float64Array(history.t.length).fill(NaN);
  const of = Array.from({ length: history.nMethods }, () =>
    Object.fromEntries(NAMES.map((name) => [name, column()])),
  );
  return { reference, stride: history.stride, done: 0, of: /** @type {any} */ (of) };
}

/** The larger magnitude, where NaN says nothing. @param {number} before @param {number} value */
function worse(before, value) {
  const size = Math.abs(value);
  return Number.isNaN(size) || size <= before ? before : size;
}

/**
 * The errors of every method up to the newest frame.
 * @param {{history: import("./history.js").History, reference: any}} data
 * @returns {Errors[]} by method
 */
export function errorsOf({ history, reference }) {
  let entry = kept.get(history);
  if (!entry || entry.reference !== reference || entry.stride !== history.stride) {
    entry = begin(history, reference);
    kept.set(history, entry);
  }
  for (; entry.done < history.count; entry.done++) {
    const i = entry.done;
    const frame = history.frameAt(i);
    entry.of.forEach((errors, m) => {
      const before = (name) => (i > 0 ? errors[name][i - 1] : NaN);
      const gap = history.columns[m].gap[i];
      const off = offReference(reference, frame, history.pointsAt(m, i));
      // a method that has ended keeps its last points: they are no error of a later time
      errors.off[i] = history.ended[m] < history.t[i] ? NaN : off;
      // less the work of drives, dampers and loads: zero for the true motion
      errors.energy[i] = history.columns[m].energy_change[i];
      errors.worstOff[i] = worse(before("worstOff"), errors.off[i]);
      errors.worstEnergy[i] = worse(before("worstEnergy"), errors.energy[i]);
      errors.worstGap[i] = worse(before("worstGap"), gap);
    });
  }
  return entry.of;
}
