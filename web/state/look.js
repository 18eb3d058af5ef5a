// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Where one looks from: the front for plane mechanisms (x right, y up), any direction for those in
// space.

/**
 * Unit vectors in the world.
 * @typedef {{right: number[], up: number[]}} Look
 */
/** @type {Look} */
export const FRONT = { right: [1, 0, 0], up: [0, 1, 0] };

/** The look in use. @param {any} data of the store @returns {Look} */
export function lookOf(data) {
  return data.view.look ?? data.scene?.view ?? FRONT;
}

/** With z upwards x stays to the right, and y goes away from the viewer. @param {number[]} v */
const zUp = (v) => [v[0], -v[2], v[1]];
/** @param {number[]} v */
const yUp = (v) => [v[0], v[2], -v[1]];

/**
 * The viewer stands `azimuth` round the vertical from the front towards x, `elevation` above the
 * horizontal [rad].
 * @returns {Look}
 */
export function lookFrom(azimuth, elevation, vertical = "y") {
  const [ca, sa] = [Math.cos(azimuth), Math.sin(azimuth)];
  const [ce, se] = [Math.cos(elevation), Math.sin(elevation)];
  const look = { right: [ca, 0, -sa], up: [-se * sa, ce, -se * ca] };
  return vertical === "y" ? look : { right: zUp(look.right), up: zUp(look.up) };
}

/** Azimuth and elevation of a look. @param {Look} look @returns {[number, number]} */
export function anglesOf(look, vertical = "y") {
  const [right, up] = vertical === "y" ? [look.right, look.up] : [yUp(look.right), yUp(look.up)];
  const azimuth = Math.atan2(-right[2], right[0]);
  const back = -(up[0] * Math.sin(azimuth) + up[2] * Math.cos(azimuth));
  return [azimuth, Math.atan2(back, up[1])];
}
