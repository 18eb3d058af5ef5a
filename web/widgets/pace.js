// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// One beat for everything that shows numbers: what is painted on the same beat is of one frame.

const BEAT = 120; // [ms] numbers that change faster cannot be read

/** @type {Set<() => void>} who wants to paint on the next beat */
const waiting = new Set();
let last = -BEAT;
let timer = 0;

function beat() {
  timer = 0;
  last = performance.now();
  const painters = [...waiting];
  waiting.clear();
  painters.forEach((paint) => paint());
}

/**
 * Paints on the next beat, once.
 * @param {() => void} paint
 */
export function paintSoon(paint) {
  waiting.add(paint);
  timer ||= window.setTimeout(beat, Math.max(0, BEAT - (performance.now() - last)));
}

/** Takes back what was asked for. @param {() => void} paint */
export const paintNoMore = (paint) => waiting.delete(paint);
