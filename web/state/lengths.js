// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Finds which parameter is the length of which bar, by changing each a little and measuring.

const MOST = 8; // parameters that are tried
const SMALL = 1e-3; // change, in shares of the value
const SAME = 0.02; // a bar whose length follows its parameter one to one, within this

/** @param {ArrayLike<number>} points @param {number} p @param {number} q */
const between = (points, p, q) =>
  Math.hypot(...[0, 1, 2].map((k) => points[3 * p + k] - points[3 * q + k]));

/** Pairs of points whose distance may be a parameter: ends of bars, and fixed pivots. */
function pairsOf(scene) {
  const { shapes } = scene.drawing;
  const bars = shapes.filter(({ kind, q }) => kind === "bar" && q >= 0);
  const fixed = shapes.filter(({ kind }) => kind === "ground").map(({ p }) => p);
  const pivots = fixed.flatMap((p, i) => fixed.slice(i + 1).map((q) => ({ p, q })));
  return [...bars.map(({ p, q }) => ({ p, q })), ...pivots];
}

/**
 * @param {{scene: any, settings: Record<string, number>}} data
 * @param {(settings: Record<string, number>) => Promise<ArrayLike<number> | null>} pointsWith
 *   places of the drawn points with these settings, null where the loops cannot be closed
 * @returns {Promise<{name: string, p: number, q: number}[]>}
 */
export async function lengthsOf({ scene, settings }, pointsWith) {
  const pairs = pairsOf(scene);
  const tried = scene.parameters
    .filter(({ unit, integer, value }) => unit === "m" && !integer && value > 0)
    .slice(0, MOST);
  const before = tried.length && pairs.length ? await pointsWith(settings) : null;
  /** @type {{name: string, p: number, q: number}[]} */
  const found = [];
  for (const { name, value } of before ? tried : []) {
    const change = SMALL * value;
    const after = await pointsWith({ ...settings, [name]: value + change });
    const pair =
      after &&
      pairs.find(({ p, q }) => {
        const grown = between(after, p, q) - between(/** @type {any} */ (before), p, q);
        return (
          Math.abs(grown / change - 1) < SAME && !found.some((one) => one.p === p && one.q === q)
        );
      });
    if (pair) {
      found.push({ name, ...pair });
    }
  }
  return found;
}
