// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The meaning of the thin parts of joints in space, in words.

/** Joints that are drawn with their axis. */
const WITH_AXIS = ["revolute", "prismatic", "cylindrical", "universal", "planar"];
/** Joints whose drive is drawn as a ring. */
const TURNED = ["revolute", "cylindrical", "universal", "spherical", "planar"];

/**
 * "thin rod: axis of a joint · cone: sliding drive"; "" where no joint is drawn.
 * @param {import("./types.js").Scene | null} scene
 */
export function glyphWords(scene) {
  const joints = scene?.joints ?? [];
  const driven = new Set(
    (scene?.coordinates ?? []).filter(({ actuated }) => actuated).map(({ joint }) => joint),
  );
  const has = (types) => joints.some(({ type }) => types.includes(type));
  const drives = (types) =>
    joints.some(({ type, name }) => types.includes(type) && driven.has(name));
  return [
    has(WITH_AXIS) ? "thin rod: axis of a joint" : "",
    drives(["prismatic"]) ? "cone: sliding drive" : "",
    drives(TURNED) ? "ring: turning drive" : "",
  ]
    .filter(Boolean)
    .join(" · ");
}
