// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Finds formulations and integrators that fit, from their cards, and why others do not.
import { parseQuantity, plain, prettyUnit } from "./format.js";
import { ownSteps } from "./program-card.js";
import { cardOf } from "./spelling.js";

/** The problem that each form gives an integrator, as the end of a sentence. */
const FORMS = {
  ode: "an ordinary differential equation",
  index1: "the equations of index 1, multipliers among the unknowns",
  stabilised: "the stabilised equations of index 1, multipliers among the unknowns",
  index2: "the equations of index 2, the loop at velocity level",
  ggl: "the stabilised equations of index 2",
  index3: "the equations of index 3, the loop at position level",
  augmented: "the equations with an augmented Lagrangian",
  program: "a program that makes its own steps",
};
const wordsOf = (form) => FORMS[form] ?? form;

/** @typedef {{formulations: any[], integrators: any[]}} Catalogue */

/**
 * The integrators that serve a formulation, in the order of the catalogue.
 * @param {Catalogue} catalogue
 * @param {string} formulation
 */
export function partnersOf(catalogue, formulation) {
  const names = cardOf(catalogue, "formulation", formulation)?.integrators ?? [];
  const known = catalogue.integrators.filter(({ name }) => names.includes(name));
  return names.includes(ownSteps.name) ? [...known, ownSteps] : known;
}

/** One and another and a third. @param {string[]} list */
function enumerate(list) {
  return list.length < 2
    ? list.join("")
    : `${list.slice(0, -1).join(", ")} or ${list[list.length - 1]}`;
}

/**
 * Why two that are both known do not fit; null when they do, or when one of them is not known.
 * @param {Catalogue} catalogue @param {string} formulation @param {string} integrator
 */
export function misfit(catalogue, formulation, integrator) {
  const card = cardOf(catalogue, "formulation", formulation);
  const stepper = cardOf(catalogue, "integrator", integrator);
  if (!card || !stepper || card.integrators.includes(integrator)) {
    return null;
  }
  const limits = card.limits ? `; ${card.limits}` : "";
  return stepper.forms.includes(card.form)
    ? `${stepper.title} does not fit ${card.title}${limits}`
    : `${stepper.title} takes ${enumerate(stepper.forms.map(wordsOf))}; ` +
        `${card.title} gives ${wordsOf(card.form)}${limits}`;
}

/**
 * The integrators that do not serve a formulation, by what they take instead.
 * @param {Catalogue} catalogue @param {string} formulation
 * @returns {{takes: string, titles: string[]}[]}
 */
export function misfitsOf(catalogue, formulation) {
  /** @type {Map<string, string[]>} */
  const groups = new Map();
  for (const card of catalogue.integrators) {
    const reason = misfit(catalogue, formulation, card.name);
    if (reason) {
      const takes = enumerate(card.forms.map(wordsOf));
      groups.set(takes, [...(groups.get(takes) ?? []), card.title]);
    }
  }
  return [...groups].map(([takes, titles]) => ({ takes, titles }));
}

/**
 * Returns what a formulation hands over, in words.
 * @param {Catalogue} catalogue
 * @param {string} formulation
 */
export const handsOver = (catalogue, formulation) =>
  wordsOf(cardOf(catalogue, "formulation", formulation)?.form ?? "");

/**
 * The integrator for a formulation just chosen: the one at hand, else one that another method of
 * the comparison has, else the one of highest
 * order that steps as the one at hand did.
 * @param {Catalogue} catalogue
 * @param {string} formulation
 * @param {string} before
 * @param {string[]} shared
 */
export function choosePartner(catalogue, formulation, before, shared) {
  const fitting = partnersOf(catalogue, formulation);
  const known = [before, ...shared].find((name) => fitting.some((card) => card.name === name));
  if (known) {
    return known;
  }
  const adaptive = Boolean(cardOf(catalogue, "integrator", before)?.adaptive);
  const alike = fitting.filter((card) => card.adaptive === adaptive);
  const best = (cards) => cards.reduce((a, b) => (b.order > a.order ? b : a)).name;
  return alike.length ? best(alike) : fitting.length ? best(fitting) : "";
}

/**
 * Returns what is wrong with a value written for a setting; "" when nothing.
 * @param {any} setting of a card
 * @param {string} text
 */
export function faultOf(setting, text) {
  if (setting.choices?.length) {
    return setting.choices.includes(text) ? "" : `one of ${setting.choices.join(", ")}`;
  }
  const value = parseQuantity(text, prettyUnit(setting.unit ?? ""));
  const range =
    `${plain(setting.min)} to ${plain(setting.max)} ${prettyUnit(setting.unit ?? "")}`.trim();
  return value >= setting.min && value <= setting.max ? "" : `a number from ${range} is needed`;
}
