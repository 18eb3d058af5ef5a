// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// What the server's index tells of itself: limits, incidents and kinds of studies. This is the only
// module that knows them; everything else asks here.

/** Kinds of studies, in the order of their tabs. */
export const KINDS = /** @type {const} */ (["work-precision", "stability", "budget"]);

/** Stability maps that the page offers, and the options that each of them varies. */
const PRESETS = [
  { preset: "baumgarte", word: "α and β of Baumgarte", varies: ["alpha", "beta"] },
  { preset: "limits", word: "the step", varies: ["h"] },
  { preset: "stiffness", word: "the step and a stiffness", varies: ["h"] },
  { preset: "mass-ratio", word: "the step and a mass", varies: ["h"] },
];

/** methods: in one comparison; frames: that one request may step. */
let known = { methods: 8, frames: 600 };
/** @type {Map<string, {code: string, name: string, rule: string}>} by code */
let incidents = new Map();

/** Reads the answer of `GET /api/v1/`. @param {any} index */
export function readIndex(index) {
  incidents = new Map(index.incidents.map((one) => [one.code, one]));
  known = { methods: index.limits.methods, frames: index.limits.frames ?? known.frames };
}

/** What the server allows. */
export const limits = () => known;

/**
 * Name and rule of an incident; undefined for a code that is not in the list.
 * @param {string} code of the engine
 * @returns {{name: string, rule: string} | undefined}
 */
export const incidentOf = (code) => incidents.get(code);

/** The stability maps, in the order they are offered. */
export const presets = () => PRESETS;

/**
 * Options that a study varies itself: a change of them makes no other study of it.
 * @param {string} kind
 * @param {string} preset of a stability map
 * @returns {string[]}
 */
export function variedBy(kind, preset) {
  if (kind === "work-precision") {
    return ["h", "rtol"];
  }
  return kind === "stability"
    ? (PRESETS.find((one) => one.preset === preset)?.varies ?? ["h"])
    : [];
}
