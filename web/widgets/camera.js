// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// From metres to pixels (y down): a parallel view, fitted once to the envelope of the motion; it
// moves only when it is turned.
import { niceBelow } from "../state/format.js";
import { FRONT } from "../state/look.js";

/** @typedef {import("../state/look.js").Look} Look */

/** [px] room for hatching, labels and the scale bar */
const MARGIN = { left: 36, right: 36, top: 32, bottom: 56 };
const MOST_MARGIN = 0.28; // of the height or width
const SCALE_BAR = { most: 150, least: 40 }; // [px] wanted, and where there is hardly room
const BESIDE_SCALE = 304; // [px] of the width are left of the bar, and the lens with its words

const dot = (a, x, y, z) => a[0] * x + a[1] * y + a[2] * z;

/**
 * Box [left, bottom, right, top] around points (flat x, y, z) as they are seen.
 * @param {number[]} points
 * @param {Look} look
 */
export function seenBox(points, look) {
  const out = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i + 2 < points.length; i += 3) {
    [look.right, look.up].forEach((axis, k) => {
      const along = dot(axis, points[i], points[i + 1], points[i + 2]);
      out[k] = Math.min(out[k], along);
      out[k + 2] = Math.max(out[k + 2], along);
    });
  }
  return out;
}

/**
 * A round length for the scale bar, that ends before the words beside the lens begin.
 * @param {number} scale [px/m]
 * @param {number} width [px] of the drawing
 */
export function scaleBarOf(scale, width) {
  const longest = Math.min(SCALE_BAR.most, Math.max(SCALE_BAR.least, width - BESIDE_SCALE));
  const metres = niceBelow(longest / scale);
  return { metres, pixels: metres * scale };
}

/**
 * @param {number[]} box [left, bottom, right, top] in metres, as seen
 * @param {number} width [px]
 * @param {number} height [px]
 * @param {Look} look
 * @param {number} foot [px] room below for what lies over the drawing
 * @param {number} head [px] room above
 */
export function createCamera(
  box,
  width,
  height,
  look = FRONT,
  foot = MARGIN.bottom,
  head = MARGIN.top,
) {
  const w = Math.max(box[2] - box[0], 1e-9);
  const h = Math.max(box[3] - box[1], 1e-9);
  const below = Math.min(foot, MOST_MARGIN * height);
  const above = Math.min(head, MOST_MARGIN * height);
  const room = {
    w: Math.max(40, width - MARGIN.left - MARGIN.right),
    h: Math.max(40, height - above - below),
  };
  const scale = Math.min(room.w / w, room.h / h);
  const cx = MARGIN.left + room.w / 2;
  const cy = above + room.h / 2;
  const mx = (box[0] + box[2]) / 2;
  const my = (box[1] + box[3]) / 2;
  const { right, up } = look;
  return {
    scale,
    look,
    /** unit vector to the viewer */
    toward: [0, 1, 2].map(
      (k) => right[(k + 1) % 3] * up[(k + 2) % 3] - right[(k + 2) % 3] * up[(k + 1) % 3],
    ),
    scaleBar: scaleBarOf(scale, width),
    /**
     * @param {ArrayLike<number>} points flat x, y, z
     * @param {number} i
     * @returns {[number, number]}
     */
    point: (points, i) => {
      const [x, y, z] = [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
      return [cx + (dot(right, x, y, z) - mx) * scale, cy - (dot(up, x, y, z) - my) * scale];
    },
  };
}

/**
 * The box itself, or one around the points when a scene has no motion to look at.
 * @param {number[] | undefined} box
 * @param {ArrayLike<number>} points
 */
export function boxAround(box, points) {
  if (box && box.length === 4 && box.every(Number.isFinite)) {
    return box;
  }
  const out = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i + 2 < points.length; i += 3) {
    out[0] = Math.min(out[0], points[i]);
    out[1] = Math.min(out[1], points[i + 1]);
    out[2] = Math.max(out[2], points[i]);
    out[3] = Math.max(out[3], points[i + 1]);
  }
  return out.every(Number.isFinite) ? out : [-1, -1, 1, 1];
}
