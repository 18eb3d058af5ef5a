// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Places of a plane mechanism that a part can be joined to: ends of bars and joints, or any place
// along a bar, each on its body, at the start of the motion.
import { WORLD, createKinematics, jointPlace } from "./kinematics.js";

/** @typedef {import("./scene-parts.js").Place} Place */

/** A place in the world, in the frame of a body. */
function localOf({ origin, turn }, world) {
  const d = world.map((x, k) => x - origin[k]);
  return [0, 1, 2].map((k) => turn[k] * d[0] + turn[k + 3] * d[1] + turn[k + 6] * d[2]);
}

/**
 * The place between two ends that is nearest to another place of the plane.
 * @param {number[][]} ends @param {number[]} world
 */
function nearestOf(ends, [x, y]) {
  const [p, q] = ends;
  const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
  const share = ((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy || 1);
  const at = Math.min(1, Math.max(0, share));
  return p.map((c, k) => c + at * (q[k] - c));
}

/** @param {import("./types.js").Scene} scene */
export function createPlaces(scene) {
  const frames = createKinematics(scene)(scene.coordinates.map(({ value }) => value ?? 0));
  const frameOf = (body) => (body < 0 ? WORLD : frames[body]);
  /** @type {Place[]} */
  const all = [];
  /** @type {{body: number, ends: number[][]}[]} */
  const bars = [];
  const placeOn = (body, world) => {
    const frame = frameOf(body);
    return frame && world.every(Number.isFinite)
      ? [{ body, at: localOf(frame, world), world }]
      : [];
  };
  const add = (body, world) => all.push(...placeOn(body, world));
  for (const { kind, p, q, body } of scene.drawing.shapes) {
    if (kind === "bar" && body >= 0) {
      const ends = [p, q].map((i) => scene.points.slice(3 * i, 3 * i + 3));
      ends.forEach((end) => add(body, end));
      bars.push({ body, ends });
    }
  }
  for (const joint of scene.joints) {
    const [parent, child] = [jointPlace(joint, frames, false), jointPlace(joint, frames, true)];
    if (parent) {
      add(joint.parent, parent.at);
    }
    if (child) {
      add(joint.child, child.at);
    }
  }

  /** @param {Place} place @param {number[]} world */
  const distance = (place, [x, y]) => Math.hypot(place.world[0] - x, place.world[1] - y);
  return {
    /** Angle of a body in the world [rad]. @param {number} body */
    angleOf(body) {
      const { turn } = frameOf(body) ?? WORLD;
      return Math.atan2(turn[3], turn[0]);
    },
    /**
     * The nearest place on each body within reach, the nearest first.
     * @param {number[]} world @param {number} reach [m]
     * @returns {Place[]}
     */
    near(world, reach) {
      const found = all
        .filter((place) => distance(place, world) <= reach)
        .sort((a, b) => distance(a, world) - distance(b, world) || b.body - a.body);
      const seen = new Set();
      return found.filter(({ body }) => !seen.has(body) && seen.add(body));
    },
    /**
     * The nearest place along each bar within reach, the nearest first.
     * @param {number[]} world @param {number} reach [m]
     * @returns {Place[]}
     */
    alongBars(world, reach) {
      return bars
        .flatMap(({ body, ends }) => placeOn(body, nearestOf(ends, world)))
        .filter((place) => distance(place, world) <= reach)
        .sort((a, b) => distance(a, world) - distance(b, world));
    },
    /** The joint that is nearest within reach, by name, or null. */
    jointNear(world, reach) {
      const places = scene.joints.flatMap((joint) => {
        const place = jointPlace(joint, frames, false);
        return place
          ? [{ joint, away: Math.hypot(place.at[0] - world[0], place.at[1] - world[1]) }]
          : [];
      });
      places.sort((a, b) => a.away - b.away);
      return places.length && places[0].away <= reach ? places[0].joint : null;
    },
  };
}
