// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Adds parts to a scene document: bars, pins, sliders, motors. Places are in the world, at the
// start; every function returns a new document.

/** A document with one bar, to begin with. */
export const NEW_SCENE = `{
  "holonom": 1,
  "name": "mine",
  "title": "My mechanism",
  "parameters": {},
  "gravity": [0, -9.81],
  "bodies": [
    {"name": "bar1", "mass": 1, "com": [0.5, 0], "inertia": {"zz": 0.0833}, "draw": [{"bar": [[0, 0], [1, 0]]}]}
  ],
  "joints": [
    {"name": "P1", "type": "revolute", "parent": {"body": "ground", "at": [0, 0]}, "child": {"body": "bar1"}, "coordinate": "th1", "rate": "w1"}
  ],
  "start": {"positions": {"th1": 0.3}},
  "duration": 10
}
`;

/**
 * A place on the mechanism: on which body (-1: the ground), where in its frame, and where in the
 * world.
 * @typedef {{body: number, at: number[], world: number[]}} Place
 */

const DENSITY = 1; // [kg/m] of a new bar
const round = (x) => Number(x.toPrecision(4)) || 0;
const copy = (scene) => JSON.parse(JSON.stringify(scene));

/** A name that is not taken: bar1, bar2 ... @param {string} word @param {string[]} taken */
function newName(word, taken) {
  for (let i = 1; ; i++) {
    if (!taken.includes(`${word}${i}`)) {
      return `${word}${i}`;
    }
  }
}

/** All names of a document: of bodies, joints, coordinates, rates and parameters. */
const namesOf = (scene) => [
  ...Object.keys(scene.parameters ?? {}),
  ...(scene.bodies ?? []).map(({ name }) => name),
  ...(scene.joints ?? []).flatMap(({ name, coordinate, rate }) => [name, coordinate, rate]),
  ...(scene.loads ?? []).map(({ name }) => name),
];

/** @param {any} scene @param {Place} place of a joint or point */
const side = (scene, { body, at }) => ({
  body: body < 0 ? "ground" : scene.bodies[body].name,
  at: at.slice(0, 2).map(round),
});

/**
 * A rod from a to b, held by a pin at a; where b lies on another body, a second pin closes a loop.
 * @param {any} scene
 * @param {Place} a
 * @param {Place | null} b null: `end` is free
 * @param {number[]} end [m] in the world
 * @param {number} angle [rad] of the body that holds it, in the world
 */
export function addBar(scene, a, b, end, angle) {
  const made = copy(scene);
  made.bodies ??= [];
  made.joints ??= [];
  const [dx, dy] = [end[0] - a.world[0], end[1] - a.world[1]];
  const length = round(Math.hypot(dx, dy));
  const name = newName("bar", namesOf(made));
  const mass = round(DENSITY * length);
  made.bodies.push({
    name,
    mass,
    com: [round(length / 2), 0],
    inertia: { zz: round((mass * length ** 2) / 12) },
    draw: [
      {
        bar: [
          [0, 0],
          [length, 0],
        ],
      },
    ],
  });
  const coordinate = newName("th", namesOf(made));
  made.joints.push({
    name: newName("P", namesOf(made)),
    type: "revolute",
    parent: side(made, a),
    child: { body: name },
    coordinate,
    rate: newName("w", namesOf(made)),
  });
  made.start ??= {};
  made.start.positions ??= {};
  const start = round(Math.atan2(dy, dx) - angle);
  made.start.positions[coordinate] = b ? { guess: start } : start;
  return b
    ? addPin(made, { body: made.bodies.length - 1, at: [length, 0], world: b.world }, b)
    : made;
}

/** A pin that holds two bodies, or a body and the ground, together. @param {any} scene */
export function addPin(scene, a, b) {
  const made = copy(scene);
  made.joints.push({
    name: newName("P", namesOf(made)),
    type: "revolute",
    parent: side(made, b),
    child: side(made, a),
    coordinate: newName("th", namesOf(made)),
    rate: newName("w", namesOf(made)),
    cut: true,
  });
  return loosen(made);
}

/** A pin of a body slides along a horizontal line through its place. @param {any} scene */
export function addSlider(scene, a) {
  const made = copy(scene);
  made.constraints ??= [];
  made.constraints.push({
    name: newName("slider", [...namesOf(made), ...made.constraints.map(({ name }) => name)]),
    line: { point: side(made, a), through: a.world.slice(0, 2).map(round), direction: [1, 0] },
  });
  return loosen(made);
}

/** A motor that turns a joint with a constant torque. @param {any} scene @param {string} joint */
export function addMotor(scene, joint) {
  const made = copy(scene);
  made.loads ??= [];
  made.loads.push({
    name: newName("motor", namesOf(made)),
    torque: { joint, value: 1 },
  });
  made.joints.find(({ name }) => name === joint).actuated = true;
  return made;
}

/** With a new loop, the positions given for the start are where assembly begins. */
function loosen(scene) {
  const positions = scene.start?.positions ?? {};
  let kept = 0;
  for (const [name, value] of Object.entries(positions)) {
    const isGuess = typeof value === "object" && value !== null && "guess" in value;
    if (!isGuess && typeof value !== "object" && kept++ > 0) {
      positions[name] = { guess: value };
    }
  }
  delete scene.start?.rates;
  return scene;
}

/** The document as people write it: short objects and lists in one line. @param {any} value */
export function writeScene(value, indent = "") {
  const flat = JSON.stringify(value);
  if (typeof value !== "object" || value === null || (indent && flat.length < 88 - indent.length)) {
    return typeof value === "object" && value !== null
      ? flat.replace(/("(?:[^"\\]|\\.)*")|([:,])/g, (_, text, mark) => text ?? `${mark} `)
      : flat;
  }
  const inner = `${indent}  `;
  const parts = Array.isArray(value)
    ? value.map((one) => inner + writeScene(one, inner))
    : Object.entries(value).map(
        ([key, one]) => `${inner}${JSON.stringify(key)}: ${writeScene(one, inner)}`,
      );
  const [open, close] = Array.isArray(value) ? ["[", "]"] : ["{", "}"];
  return `${open}\n${parts.join(",\n")}\n${indent}${close}`;
}
