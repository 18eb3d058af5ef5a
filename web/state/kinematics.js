// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Frames of all bodies at given coordinates: from the ground outwards, through the joints that
// carry coordinates. Cut joints have none and are left out.

/**
 * A rotation: its rows one after the other.
 * @typedef {number[]} Matrix nine numbers
 * @typedef {{origin: number[], turn: Matrix}} Frame of a body, in the world
 * @typedef {import("./types.js").Joint} Joint
 */

const UNIT = [1, 0, 0, 0, 1, 0, 0, 0, 1];

/** @param {number[]} a @param {number[]} b */
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** @param {Matrix} a @param {Matrix} b @returns {Matrix} */
const multiply = (a, b) =>
  Array.from({ length: 9 }, (_, i) => {
    const [row, column] = [3 * Math.floor(i / 3), i % 3];
    return a[row] * b[column] + a[row + 1] * b[column + 3] + a[row + 2] * b[column + 6];
  });
/** @param {Matrix} a @returns {Matrix} */
const transpose = (a) => [a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]];
/** @param {Matrix} a @param {number[]} v */
export const rotate = (a, v) =>
  [0, 3, 6].map((row) => a[row] * v[0] + a[row + 1] * v[1] + a[row + 2] * v[2]);
/** @param {number[]} a @param {number[]} b @param {number} [factor] of b */
const plus = (a, b, factor = 1) => a.map((x, k) => x + factor * b[k]);

/** Turns by the length of a vector, about the vector. @param {number[]} r @returns {Matrix} */
function turnBy(r) {
  const angle = Math.hypot(...r);
  if (angle < 1e-300) {
    return UNIT;
  }
  const [x, y, z] = r.map((part) => part / angle);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const k = 1 - c;
  return [
    c + k * x * x,
    k * x * y - s * z,
    k * x * z + s * y,
    k * x * y + s * z,
    c + k * y * y,
    k * y * z - s * x,
    k * x * z - s * y,
    k * y * z + s * x,
    c + k * z * z,
  ];
}

/** The axes of a joint in a body: x along `ref`, z along `axis`. @returns {Matrix} */
function axesOf(axis, ref) {
  const y = cross(axis, ref);
  return [ref[0], y[0], axis[0], ref[1], y[1], axis[1], ref[2], y[2], axis[2]];
}

const NONE = [0, 0, 0];
/** Shift and turn of the child in the axes of the joint, by type. */
const MOTIONS = {
  revolute: ([a]) => ({ shift: NONE, turn: turnBy([0, 0, a]) }),
  prismatic: ([d]) => ({ shift: [0, 0, d], turn: UNIT }),
  cylindrical: ([a, d]) => ({ shift: [0, 0, d], turn: turnBy([0, 0, a]) }),
  universal: ([a, b]) => ({
    shift: NONE,
    turn: multiply(turnBy([0, 0, a]), turnBy([b, 0, 0])),
  }),
  spherical: (r) => ({ shift: NONE, turn: turnBy(r) }),
  planar: ([x, y, a]) => ({ shift: [x, y, 0], turn: turnBy([0, 0, a]) }),
  fixed: () => ({ shift: NONE, turn: UNIT }),
  free: ([x, y, z, ...r]) => ({ shift: [x, y, z], turn: turnBy(r) }),
};

/** From the parent's frame to the child's. @param {Joint} joint @param {number[]} values */
function relative(joint, values) {
  const { shift, turn } = MOTIONS[joint.type](values);
  const here = axesOf(joint.parent_axis, joint.parent_ref);
  const there = axesOf(joint.child_axis, joint.child_ref);
  const whole = multiply(multiply(here, turn), transpose(there));
  const at = plus(joint.parent_at, rotate(here, shift));
  return { turn: whole, origin: plus(at, rotate(whole, joint.child_at), -1) };
}

/** @param {Frame} a @param {{turn: Matrix, origin: number[]}} b in a @returns {Frame} */
const compose = (a, b) => ({
  turn: multiply(a.turn, b.turn),
  origin: plus(a.origin, rotate(a.turn, b.origin)),
});
/** @param {{turn: Matrix, origin: number[]}} b */
function inverse(b) {
  const turn = transpose(b.turn);
  return { turn, origin: rotate(turn, b.origin).map((x) => -x) };
}

/** @type {Frame} */
export const WORLD = { origin: [0, 0, 0], turn: UNIT };

/**
 * Prepares the chain of a scene once; the function it returns places the bodies.
 * @param {import("./types.js").Scene} scene
 * @returns {(q: ArrayLike<number>) => (Frame | null)[]} one per body, null: not reached
 */
export function createKinematics(scene) {
  const { joints = [], bodies = [], coordinates } = scene;
  const carrying = joints
    .map((joint) => ({
      joint,
      indices: coordinates.flatMap((one, i) => (one.joint === joint.name ? [i] : [])),
    }))
    .filter(({ joint, indices }) => indices.length > 0 || joint.type === "fixed");

  return (q) => {
    /** @type {(Frame | null)[]} */
    const frames = bodies.map(() => null);
    const frameOf = (body) => (body < 0 ? WORLD : frames[body]);
    let left = carrying;
    for (let before = Infinity; left.length > 0 && left.length < before; ) {
      before = left.length;
      left = left.filter(({ joint, indices }) => {
        const [parent, child] = [frameOf(joint.parent), frameOf(joint.child)];
        if (parent && child) {
          return false; // both are placed: this one closes a loop
        }
        if (!parent && !child) {
          return true;
        }
        const values = indices.map((i) => q[i]);
        const step = relative(joint, values);
        if (parent) {
          frames[joint.child] = compose(parent, step);
        } else if (child) {
          frames[joint.parent] = compose(child, inverse(step));
        }
        return false;
      });
    }
    return frames;
  };
}

/**
 * Returns where a joint is and along which axes, seen from one of its bodies.
 * @param {Joint} joint
 * @param {(Frame | null)[]} frames
 * @param {boolean} ofChild
 */
export function jointPlace(joint, frames, ofChild) {
  const body = ofChild ? joint.child : joint.parent;
  const frame = body < 0 ? WORLD : frames[body];
  if (!frame) {
    return null;
  }
  const [at, axis, ref] = ofChild
    ? [joint.child_at, joint.child_axis, joint.child_ref]
    : [joint.parent_at, joint.parent_axis, joint.parent_ref];
  return {
    at: plus(frame.origin, rotate(frame.turn, at)),
    axis: rotate(frame.turn, axis),
    ref: rotate(frame.turn, ref),
  };
}
