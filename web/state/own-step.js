// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Texts of a scene tell of its own step: a run at another one is another run.
import { plain } from "./format.js";
import { settingOf } from "./spelling.js";
import { listed } from "./verdict.js";

/**
 * Returns which methods run at other steps than the one that the scene's texts tell of; "" where
 * none does.
 * @param {Pick<import("./store.js").Data, "scene" | "methods" | "catalogue">} data
 */
export function otherSteps({ scene, methods, catalogue }) {
  const own = scene.step ?? 0;
  /** @type {Map<number, string[]>} the labels of the methods, by their step [s] */
  const others = new Map();
  for (const { spelling, label } of own > 0 ? methods : []) {
    const step = Number(settingOf(catalogue, spelling, "h")?.value ?? 0);
    if (step > 0 && step !== own) {
      others.set(step, [...(others.get(step) ?? []), label]);
    }
  }
  if (others.size === 0) {
    return "";
  }
  const groups = [...others].map(([step, labels]) => {
    const all = labels.length === methods.length && labels.length > 1;
    const verb = labels.length > 1 ? "run" : "runs";
    return `${all ? "the methods" : listed(labels)} ${verb} at ${plain(step)} s`;
  });
  return (
    `The figures in these texts hold for the scene's own step of ${plain(own)} s; ` +
    `${listed(groups)} now, so theirs differ.`
  );
}
