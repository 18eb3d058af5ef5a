// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Constants of the session that views need as well.
import { niceBelow } from "../state/format.js";

/** Playback speeds, slowest first. */
export const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];
/** [s] A run shorter than this is shown slowly, so that there is something to see. */
export const SHORT = 2;
const SHOWN_FOR = 5; // [s]

/**
 * The part of a run that one press of Play shows when motion is unwelcome [s].
 * @param {number} duration of the run [s]
 */
export const stepSeconds = (duration) => Math.min(0.1, niceBelow(duration / 20 || 0.1));

/**
 * The speed at which a run of this duration is shown first.
 * @param {number} duration [s]
 * @param {number} before [s] of the scene before
 * @param {number} now the present speed
 */
export function firstSpeed(duration, before, now) {
  if (duration >= SHORT) {
    return before < SHORT ? 1 : now;
  }
  const fits = (speed) => speed <= (1.3 * duration) / SHOWN_FOR;
  return [...SPEEDS].reverse().find(fits) ?? SPEEDS[0];
}
