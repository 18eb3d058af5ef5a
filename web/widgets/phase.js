// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A phase plot: one curve per method in the plane of a coordinate and its velocity.
import { h, s } from "./dom.js";
import { linearTicks } from "./plot-scale.js";

const ROOM = { left: 52, right: 12, top: 8, bottom: 40 };
const MOST_POINTS = 1200;

/**
 * @typedef {{label: string, colour: string, dash: number[], width: number, x: Float64Array,
 *   y: Float64Array}} Orbit
 */

/** Smallest and largest of some values, with a margin. @param {number[]} values */
function range(values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const margin = 0.05 * (high - low) || 1;
  return Number.isFinite(low) ? [low - margin, high + margin] : [-1, 1];
}

/** Indices of at most so many points. @param {number} count */
function chosen(count) {
  const step = Math.max(1, Math.ceil(count / MOST_POINTS));
  return Array.from({ length: Math.ceil(count / step) }, (_, k) => k * step);
}

/** @param {HTMLElement} el */
export function createPhase(el) {
  const svg = s("svg", { class: "phase", role: "img" });
  const home = h("div", { class: "phase-home", hidden: true }, svg);
  el.append(home);

  return {
    /** @param {boolean} on */
    show(on) {
      home.hidden = !on;
    },
    /**
     * @param {Orbit[]} orbits
     * @param {number} now index of the frame shown
     * @param {{x: string, y: string}} titles
     */
    draw(orbits, now, titles) {
      const width = Math.max(160, home.clientWidth);
      const height = Math.max(100, home.clientHeight);
      const points = orbits.map(({ x, y }) =>
        chosen(now + 1)
          .map((i) => [x[i], y[i]])
          .filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b)),
      );
      const flat = points.flat();
      const [x0, x1] = range(flat.map(([a]) => a));
      const [y0, y1] = range(flat.map(([, b]) => b));
      const px = (a) => ROOM.left + ((a - x0) / (x1 - x0)) * (width - ROOM.left - ROOM.right);
      const py = (b) =>
        height - ROOM.bottom - ((b - y0) / (y1 - y0)) * (height - ROOM.top - ROOM.bottom);
      const bottom = height - ROOM.bottom;
      const text = (name, x, y, words) => s("text", { class: name, x, y }, words);

      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      svg.setAttribute("aria-label", `${titles.y} against ${titles.x}`);
      svg.replaceChildren(
        ...linearTicks(x0, x1).flatMap((a) => [
          s("path", { class: "grid", d: `M${px(a)} ${ROOM.top}V${bottom}` }),
          text("tick middle", px(a), bottom + 16, String(a)),
        ]),
        ...linearTicks(y0, y1).flatMap((b) => [
          s("path", { class: "grid", d: `M${ROOM.left} ${py(b)}H${width - ROOM.right}` }),
          text("tick end", ROOM.left - 6, py(b) + 4, String(b)),
        ]),
        text("title middle", (ROOM.left + width - ROOM.right) / 2, height - 6, titles.x),
        text("title", 4, ROOM.top + 10, titles.y),
        ...orbits.flatMap(({ colour, dash, width: stroke }, k) => {
          const way = points[k].map(([a, b]) => `${px(a).toFixed(1)} ${py(b).toFixed(1)}`);
          const curve = s("path", { class: "orbit", d: way.length ? `M${way.join("L")}` : "" });
          curve.style.stroke = colour;
          curve.style.strokeWidth = String(stroke);
          curve.setAttribute("stroke-dasharray", dash.join(" "));
          const end = points[k][points[k].length - 1];
          const dot = end ? s("circle", { cx: px(end[0]), cy: py(end[1]), r: 4 }) : null;
          if (dot) {
            dot.style.fill = colour;
          }
          return dot ? [curve, dot] : [curve];
        }),
      );
    },
  };
}
