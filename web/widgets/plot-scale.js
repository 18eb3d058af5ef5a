// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Ranges and ticks of plots: whole decades on a log axis, round values on a linear one.
import { niceAbove } from "../state/format.js";

/** [unit] Nothing smaller is drawn; an exact zero has no place on a log axis. */
export const FLOOR = 1e-17;
const DECADES_LEAST = 4;
const MOST_TICKS = 6;

/** Whole decades round two values. @param {number} min @param {number} max */
export function decades(min, max) {
  const low = Math.floor(Math.log10(Math.max(min, FLOOR)) + 1e-9);
  const high = Math.max(Math.ceil(Math.log10(Math.max(max, FLOOR)) - 1e-9), low + DECADES_LEAST);
  return [10 ** low, 10 ** high];
}

/** Powers of ten between two, about six at most. @param {number} min @param {number} max */
export function decadeTicks(min, max) {
  const low = Math.round(Math.log10(min));
  const high = Math.round(Math.log10(max));
  const step = Math.max(1, Math.ceil((high - low) / MOST_TICKS));
  const out = [];
  for (let e = Math.ceil(low / step) * step; e <= high; e += step) {
    out.push(10 ** e);
  }
  return out;
}

/** Round values between two, about six at most. @param {number} min @param {number} max */
export function linearTicks(min, max) {
  const step = niceAbove((max - min) / 5 || 1);
  const out = [];
  for (let i = Math.ceil(min / step - 1e-9); i * step <= max + 1e-9 * step; i++) {
    out.push(Number((i * step).toPrecision(12)));
  }
  return out;
}
