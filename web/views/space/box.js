// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The box of a motion in space, the ground below it, and the feet of what stands on the ground.
import { baseOf } from "../../widgets/pieces.js";

const CLEARANCE = 0.12; // of the radius, between the motion and the ground

/**
 * `ground`: its height along the upward axis, whose index is `vertical` [m].
 * @param {import("../../state/types.js").Scene} scene
 */
export function boxOf(scene) {
  const flat = [...(scene.extremes ?? []), ...scene.points];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  flat.forEach((x, i) => {
    if (Number.isFinite(x)) {
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    }
  });
  const radius = Math.max(1e-6, 0.5 * Math.hypot(...low.map((x, k) => high[k] - x)));
  const vertical = scene.view.vertical === "z" ? 2 : 1;
  return { low, high, radius, vertical, ground: low[vertical] - CLEARANCE * radius };
}

/**
 * Returns where the posts of the supports meet the ground.
 * @param {import("../../state/types.js").Scene} scene
 */
export function feetOf(scene) {
  const { vertical, ground } = boxOf(scene);
  return baseOf(scene)
    .marks.filter(({ kind }) => kind !== "guide")
    .map(({ p }) =>
      [...scene.points.slice(3 * p, 3 * p + 3)].map((x, k) => (k === vertical ? ground : x)),
    );
}
