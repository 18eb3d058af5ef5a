// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Outlines of what a mechanism is made of, as SVG path data in pixels (y down). Points are [x, y].

/** @typedef {[number, number]} Point */

const f = (x) => x.toFixed(2);
/** @param {Point} p */
const at = ([x, y]) => `${f(x)} ${f(y)}`;

/**
 * Unit direction from p to q and its left normal; along x when they coincide.
 * @param {Point} p
 * @param {Point} q
 */
function frame(p, q) {
  const dx = q[0] - p[0];
  const dy = q[1] - p[1];
  const length = Math.hypot(dx, dy);
  const d = /** @type {Point} */ (length > 1e-9 ? [dx / length, dy / length] : [1, 0]);
  return { d, n: /** @type {Point} */ ([-d[1], d[0]]), length };
}

/** p + a d + b n @returns {Point} */
function offset(p, d, a, n, b) {
  return [p[0] + a * d[0] + b * n[0], p[1] + a * d[1] + b * n[1]];
}

/** A bar with round ends. @param {Point} p @param {Point} q @param {number} r half its width */
export function bar(p, q, r) {
  const { d, n } = frame(p, q);
  const arc = `A${f(r)} ${f(r)} 0 0 0 `;
  return (
    `M${at(offset(p, d, 0, n, r))}L${at(offset(q, d, 0, n, r))}${arc}${at(offset(q, d, 0, n, -r))}` +
    `L${at(offset(p, d, 0, n, -r))}${arc}${at(offset(p, d, 0, n, r))}Z`
  );
}

/** @param {Point} p @param {number} r */
export function circle([x, y], r) {
  return `M${f(x - r)} ${f(y)}a${f(r)} ${f(r)} 0 1 0 ${f(2 * r)} 0a${f(r)} ${f(r)} 0 1 0 ${f(-2 * r)} 0Z`;
}

/** Triangle under a pivot, its base hatched. @param {Point} p @param {number} r half the base */
export function ground([x, y], r) {
  const base = y + 1.6 * r;
  let d = `M${f(x)} ${f(y)}L${f(x - r)} ${f(base)}L${f(x + r)} ${f(base)}ZM${f(x - 1.5 * r)} ${f(base)}L${f(x + 1.5 * r)} ${f(base)}`;
  for (let i = -2; i <= 3; i++) {
    const from = x + 0.5 * r * i;
    d += `M${f(from)} ${f(base)}L${f(from - 0.5 * r)} ${f(base + 0.55 * r)}`;
  }
  return d;
}

/** A box at p along p..q. @param {Point} p @param {Point} q @param {number} r half its height */
export function slider(p, q, r) {
  const { d, n } = frame(p, q);
  const a = 1.5 * r;
  return `M${at(offset(p, d, -a, n, -r))}L${at(offset(p, d, a, n, -r))}L${at(offset(p, d, a, n, r))}L${at(offset(p, d, -a, n, r))}Z`;
}

/**
 * Two rails from p to q, the lower one hatched.
 * @param {Point} p
 * @param {Point} q
 * @param {number} r half their distance
 */
export function guide(p, q, r) {
  const { d, n, length } = frame(p, q);
  const below = n[1] >= 0 ? 1 : -1;
  let path = `M${at(offset(p, d, 0, n, r))}L${at(offset(q, d, 0, n, r))}M${at(offset(p, d, 0, n, -r))}L${at(offset(q, d, 0, n, -r))}`;
  for (let a = 6; a < length; a += 9) {
    path += `M${at(offset(p, d, a, n, below * r))}L${at(offset(p, d, a - 5, n, below * (r + 6)))}`;
  }
  return path;
}

const TEETH = 8;

/** A zigzag from p to q. @param {Point} p @param {Point} q @param {number} r half its width */
export function spring(p, q, r) {
  const { d, n, length } = frame(p, q);
  const lead = Math.min(12, 0.15 * length);
  const pitch = (length - 2 * lead) / TEETH;
  let path = `M${at(p)}L${at(offset(p, d, lead, n, 0))}`;
  for (let i = 0; i < TEETH; i++) {
    path += `L${at(offset(p, d, lead + (i + 0.5) * pitch, n, i % 2 ? -r : r))}`;
  }
  return `${path}L${at(offset(q, d, -lead, n, 0))}L${at(q)}`;
}

/**
 * A pot with its piston, from p to q.
 * @param {Point} p
 * @param {Point} q
 * @param {number} r half its width
 */
export function damper(p, q, r) {
  const { d, n, length } = frame(p, q);
  const a = 0.35 * length;
  const b = 0.65 * length;
  const piston = 0.5 * length;
  return (
    `M${at(p)}L${at(offset(p, d, a, n, 0))}M${at(offset(p, d, b, n, r))}L${at(offset(p, d, a, n, r))}` +
    `L${at(offset(p, d, a, n, -r))}L${at(offset(p, d, b, n, -r))}M${at(offset(p, d, piston, n, 0.7 * r))}` +
    `L${at(offset(p, d, piston, n, -0.7 * r))}M${at(offset(p, d, piston, n, 0))}L${at(q)}`
  );
}

/** Where a load acts; its direction is not part of a drawing. @param {Point} p @param {number} r */
export function load([x, y], r) {
  return `M${f(x)} ${f(y - r)}L${f(x + r)} ${f(y)}L${f(x)} ${f(y + r)}L${f(x - r)} ${f(y)}Z`;
}

/** @param {Point[]} points @param {boolean} closed */
export function polyline(points, closed) {
  return points.length ? `M${points.map(at).join("L")}${closed ? "Z" : ""}` : "";
}

/** @param {Point[]} points */
export const polygon = (points) => polyline(points, true);

/**
 * The circle through the corners of a regular polygon, or the ellipse as which it is seen.
 * @param {Point[]} points
 */
export function disc(points) {
  const n = points.length;
  const corner = (i) => points[(i + n) % n];
  const turn = (2 * Math.PI) / n;
  // the cubic's handle on a circle, as a part of the chord between the neighbours: the same from
  // wherever one looks
  const share = ((4 / 3) * Math.tan(turn / 4)) / (2 * Math.sin(turn));
  const handle = (i, sign) => {
    const [[x, y], [ax, ay], [bx, by]] = [corner(i), corner(i - 1), corner(i + 1)];
    return at([x + sign * share * (bx - ax), y + sign * share * (by - ay)]);
  };
  const arcs = points.map((_, i) => `C${handle(i, 1)} ${handle(i + 1, -1)} ${at(corner(i + 1))}`);
  return `M${at(points[0])}${arcs.join("")}Z`;
}

/** An arrow from p to q. @param {Point} p @param {Point} q */
export function arrow(p, q) {
  const { d, n, length } = frame(p, q);
  const head = Math.min(9, 0.5 * length);
  const barb = (side) => at(offset(q, d, -head, n, side * 0.45 * head));
  return `M${at(p)}L${at(q)}M${barb(1)}L${at(q)}L${barb(-1)}`;
}

/**
 * Distance of a place from the straight line between two others.
 * @param {number[]} at @param {number[]} a @param {number[]} b
 */
export function distanceToBar([x, y], [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
  const f = Math.min(1, Math.max(0, share));
  return Math.hypot(x - ax - f * dx, y - ay - f * dy);
}
