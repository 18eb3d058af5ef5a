// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Finds the scenes of the gallery that fit a search and its filters. A scene is known by what the
// list of scenes says, and better once its own document is here.

/**
 * @typedef {{id: string, title: string, about?: string, look_for?: string}} Entry
 * @typedef {import("./types.js").Scene} Scene
 */

const text = ({ title, about = "", look_for: look = "" }) => `${title} ${about} ${look}`;

/** Filters, by the word on their button. */
export const FILTERS = {
  plane: {
    tip: "the mechanism stays in one plane",
    /** @param {Entry} _entry @param {Scene | undefined} scene */
    fits: (_entry, scene) => Boolean(scene && !scene.view?.spatial),
  },
  space: {
    tip: "the mechanism moves in space",
    fits: (_entry, scene) => Boolean(scene?.view?.spatial),
  },
  "several loops": {
    tip: "two closed loops or more",
    fits: (_entry, scene) => Number(scene?.loops) > 1,
  },
  stiff: {
    tip: "its description names stiffness: fast vibrations beside slow motion",
    fits: (entry) => /\bstiff/i.test(text(entry)),
  },
  singular: {
    tip: "its description names a singular configuration: a change point, a dead point, lost rank",
    fits: (entry) => /singular|change.point|dead point|rank|collinear|redundant/i.test(text(entry)),
  },
  actuated: {
    tip: "a joint is driven, or can be",
    fits: (_entry, scene) => Boolean(scene?.coordinates.some(({ actuated }) => actuated)),
  },
};

/** Filters that exclude each other. */
export const EITHER = [["plane", "space"]];

/**
 * @param {Entry} entry
 * @param {Scene | undefined} scene
 * @param {{words: string, chosen: Set<string>}} search
 */
export function fitsSearch(entry, scene, { words, chosen }) {
  const all = `${entry.id} ${text(entry)}`.toLowerCase();
  const found = words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => all.includes(word));
  return found && [...chosen].every((name) => FILTERS[name].fits(entry, scene));
}
