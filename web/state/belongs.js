// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Finds the bodies, cut joints and curves that an entry of the equations belongs to.

/** Curves that show a term, by its name. */
const CURVES = { phi: ["gap"], gamma: ["velocity_gap"], J: ["sigma_min"], lambda: ["lambda_max"] };

/** The body that moves with a velocity of the equations: -1 where there is none. */
function bodyOf(speed, scene) {
  const named = /^omega_(.*)$/.exec(speed)?.[1];
  const byName = scene.bodies?.findIndex(({ name }) => name === named) ?? -1;
  if (named && byName >= 0) {
    return byName;
  }
  const coordinate = scene.coordinates.find(({ rate }) => rate === speed);
  const joint = scene.joints?.find(({ name }) => name === coordinate?.joint);
  return joint ? joint.child : -1;
}

/**
 * @param {{term: string, row: number, column?: number}} entry rows and columns count from 1
 * @param {string[]} speeds of the equations, in their order
 * @param {any} scene
 * @returns {{bodies: number[], tears: string[], curves: string[]}}
 */
export function partsOf({ term, row, column }, speeds, scene) {
  if (!term) {
    return { bodies: [], tears: [], curves: [] };
  }
  const ofLoop = term === "phi" || term === "J" || term === "gamma";
  const loop = ofLoop ? scene.rows?.[row - 1]?.loop : null;
  const which = term === "J" ? [column] : ofLoop ? [] : [row, column];
  const bodies = which
    .flatMap((k) => (k ? [bodyOf(speeds[k - 1] ?? "", scene)] : []))
    .filter((body) => body >= 0);
  return {
    bodies: [...new Set(bodies)],
    tears: loop ? [loop] : [],
    curves: CURVES[term] ?? [],
  };
}
