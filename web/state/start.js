// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The start of a run as settings: "start.th1" is where the coordinate th1 starts, "start.w1" its
// rate. Beside parameters they make up what is changed of a scene.

const PREFIX = "start.";

/** Is it a setting of the start, not a parameter? @param {string} name */
export const isStart = (name) => name.startsWith(PREFIX);

/** @param {Record<string, number>} settings */
const withoutStart = (settings) =>
  Object.fromEntries(Object.entries(settings).filter(([name]) => !isStart(name)));

/**
 * Settings with another start.
 * @param {Record<string, number>} settings
 * @param {Record<string, number> | null} state coordinates and rates by name; null: the scene's own
 */
export const settingsWithStart = (settings, state) => ({
  ...withoutStart(settings),
  ...Object.fromEntries(
    Object.entries(state ?? {}).map(([name, value]) => [`${PREFIX}${name}`, value]),
  ),
});

/**
 * A place on a grid.
 * @param {number[]} place [m]
 * @param {number} grid [m]
 */
export const snapped = (place, grid) =>
  place.map((x) => Number((Math.round(x / grid) * grid).toPrecision(12)));

/**
 * Returns what holds a dragged mechanism back, or where the dragged point is.
 * @param {{reached: boolean, reason: string | null}} answer
 */
export const isHeld = ({ reached, reason }) => !reached && Boolean(reason);
