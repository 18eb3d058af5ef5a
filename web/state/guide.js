// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The first minute, step by step: what to do, what to see, and one question before a run.

/**
 * `done` tells that the step was carried out; `does` carries it out.
 * @typedef {import("./store.js").Data} Data
 * @typedef {{
 *   title: string, text: string, button: string, does: string,
 *   done: (data: Data) => boolean,
 * }} Step
 */

/** A method whose loop has visibly opened. @param {Data} data */
function isOpen({ history, scene }) {
  const last = (history?.count ?? 0) - 1;
  return (
    last > 0 && history.columns.some((column) => column.gap[last] > 0.01 * (scene?.length || 1))
  );
}

/** The scene that the steps are about. */
export const GUIDED = "four-bar";

/** In place of a step while another scene is open. @type {Step} */
export const ELSEWHERE = {
  title: "The first minute is about the four-bar",
  text: "Another scene is open now. The steps, with their numbers and names, belong to the four-bar.",
  button: "open the four-bar",
  does: "open",
  done: () => false,
};

/** @type {Step[]} */
export const STEPS = [
  {
    title: "One mechanism, five methods",
    text: "Five methods compute one four-bar from the same start. Predict: will they stay together? Then press Play.",
    button: "Play",
    does: "toggle",
    done: (data) => (data.latest?.t ?? 0) > 0.5,
  },
  {
    title: "One of them falls apart",
    text: "index-1 opens at the cut joint B; the circle magnifies its gap, which keeps growing. Compare it with the others.",
    button: "let it fall apart",
    does: "fallApart",
    done: isOpen,
  },
  {
    title: "Why?",
    text: "The solver asks only that the acceleration of the gap is zero. Nothing pushes the gap back, so the errors of two integrations add up.",
    button: "Why?",
    does: "askWhy",
    done: (data) => data.view.why >= 0,
  },
  {
    title: "Hold it together",
    text: "Baumgarte pulls the gap back like a spring; projection closes it after every step. Predict: is a closed loop also right? Look at the error.",
    button: "hold it together",
    does: "holdTogether",
    done: (data) => !data.methods.some(({ formulation }) => formulation === "index1"),
  },
  {
    title: "What does accuracy cost?",
    text: "Closed is not right. The studies run every method at many step sizes: which one is accurate for the fewest operations?",
    button: "open the studies",
    does: "study",
    done: (data) => data.view.study !== "",
  },
];
