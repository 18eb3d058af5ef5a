// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The contents of the server's index: limits, incidents and kinds of studies. This is the only
// module that knows them; everything else asks here.

/**
 * `chooses`: options that the study varies itself; `stabilised`: for methods that have those
 * options; `units`: the scene needs a parameter in one of them, where there are any.
 * @typedef {{
 *   name: string, about: string, chooses: string[], stabilised: boolean, units: string[],
 * }} Preset
 * `parts`: what the parts of its numbers are called, by the member of the document that has them.
 * @typedef {{name: string, letter: string, word: string, about: string}} Part
 * @typedef {{
 *   name: string, title: string, about: string, chooses: string[], presets: Preset[],
 *   fields: {name: string, max?: number}[], parts?: Record<string, Part[]>,
 * }} StudyKind
 * @typedef {{code: string, name: string, rule: string}} IncidentKind
 */

let known = {
  methods: 0,
  /** @type {Map<string, IncidentKind>} by code */ incidents: new Map(),
  /** @type {Map<string, StudyKind>} by name */ studies: new Map(),
};

/** Reads the answer of `GET /api/v1/`. @param {any} index */
export function readIndex(index) {
  known = {
    methods: index.limits.methods,
    incidents: new Map(index.incidents.map((one) => [one.code, one])),
    studies: new Map(index.studies.map((one) => [one.name, one])),
  };
}

/** Returns what the server allows. @returns {{methods: number}} */
export const limits = () => known;

/**
 * Name and rule of an incident; undefined for a code that is not in the list.
 * @param {string} code of the engine
 */
export const incidentOf = (code) => known.incidents.get(code);

/** Kinds of studies that the server makes, in its order: name, title and what each shows. */
export const studyKinds = () => [...known.studies.values()];

/** @param {string} kind */
const studyOf = (kind) => known.studies.get(kind);

/** The stability maps; those of a method's own options come first. */
export function presets() {
  const list = studyOf("stability")?.presets ?? [];
  return [...list].sort((a, b) => Number(b.stabilised) - Number(a.stabilised));
}

/** Parts of a budget, in the server's order. @param {string} of "error" or "energy" */
export const partsOfBudget = (of) => studyOf("budget")?.parts?.[of] ?? [];

/**
 * Returns how many methods a study takes at most.
 * @param {string} kind
 */
export const mostMethods = (kind) =>
  studyOf(kind)?.fields.find(({ name }) => name === "methods")?.max ?? Infinity;

/**
 * Options that a study varies itself: a change of them makes no other study of it.
 * @param {string} kind
 * @param {string} preset of a stability map; "": one that the server chooses
 * @returns {string[]}
 */
export function variedBy(kind, preset) {
  const study = studyOf(kind);
  const chosen = study?.presets.find(({ name }) => name === preset);
  const any = (study?.presets ?? []).flatMap(({ chooses }) => chooses);
  return chosen?.chooses ?? [...(study?.chooses ?? []), ...any];
}
