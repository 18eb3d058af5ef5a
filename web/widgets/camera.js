// @ts-check
// From metres (y up) to pixels (y down). The view is fitted once to the envelope of the motion and does not move after that.
import { niceBelow } from "../state/format.js";

const MARGIN = { left: 36, right: 36, top: 40, bottom: 56 }; // [px] room for hatching, labels and the scale bar
const SCALE_BAR = 150; // [px] at most

/**
 * @param {number[]} box [xmin, ymin, xmax, ymax] in metres
 * @param {number} width [px] @param {number} height [px]
 */
export function createCamera(box, width, height) {
  const w = Math.max(box[2] - box[0], 1e-9);
  const h = Math.max(box[3] - box[1], 1e-9);
  const room = {
    w: Math.max(40, width - MARGIN.left - MARGIN.right),
    h: Math.max(40, height - MARGIN.top - MARGIN.bottom),
  };
  const scale = Math.min(room.w / w, room.h / h);
  const cx = MARGIN.left + room.w / 2;
  const cy = MARGIN.top + room.h / 2;
  const mx = (box[0] + box[2]) / 2;
  const my = (box[1] + box[3]) / 2;
  const length = niceBelow(SCALE_BAR / scale);
  return {
    scale,
    scaleBar: { metres: length, pixels: length * scale },
    /** @param {ArrayLike<number>} points flat x, y, z @param {number} i @returns {[number, number]} */
    point: (points, i) => [
      cx + (points[3 * i] - mx) * scale,
      cy - (points[3 * i + 1] - my) * scale,
    ],
  };
}

/** The box itself, or one around the points when a scene has no motion to look at. @param {number[] | undefined} box @param {ArrayLike<number>} points */
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
