// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A program of one's own as a card of the catalogue: the server lists such programs by name alone.

const PREFIX = "program:";

/** Does the spelling or name of a method begin as that of a program? @param {string} text */
export const isProgram = (text) => text.trim().startsWith(PREFIX);

/** The integrator of programs that make their own steps. */
export const ownSteps = {
  name: "own",
  title: "its own steps",
  about:
    "The program makes the steps: its greeting says that it provides step or solve. " +
    "The workbench asks for the state after each step.",
  adaptive: false,
  order: 1,
  forms: ["program"],
  options: [
    { key: "h", unit: "s", about: "step size", default: 1e-3, min: 1e-12, max: 100, choices: null },
  ],
};

/** Serves an integrator any ordinary differential equation of second order? */
const servesAny = ({ forms }) => forms.includes("ode");

/** Where a refusal of the server says what a program provides. */
const PROVIDES = /^the program provides (accelerations|step|solve)$/;

/**
 * Returns what a program provides, as the server says it where a method does not fit; "" where a
 * refusal is about something else.
 * @param {{detail: string}[]} errors of a problem document
 */
export const providedBy = (errors) => PROVIDES.exec(errors[0]?.detail ?? "")?.[1] ?? "";

/** @param {string} name program:FILE @param {string} provided */
export function providesWords(name, provided) {
  const file = name.trim().slice(PREFIX.length);
  return provided === "accelerations"
    ? `${file} provides accelerations, so an integrator makes its steps`
    : `${file} provides "${provided}", so it makes its own steps`;
}

/**
 * `provided`: by name, as far as a refusal has said it; all integrators are offered before.
 * @param {{integrators: any[], provided?: Record<string, string>}} catalogue
 * @param {string} name program:FILE
 */
export function cardOfProgram(catalogue, name) {
  const file = name.trim().slice(PREFIX.length);
  const provided = catalogue.provided?.[name.trim()] ?? "";
  const steps = provided === "step" || provided === "solve";
  const served = steps ? [] : catalogue.integrators.filter(servesAny).map((card) => card.name);
  return {
    name: name.trim(),
    title: file,
    short_name: file,
    rule:
      "Your program computes the accelerations, and the integrator makes the steps; " +
      "or it makes its own steps.",
    when_not: "comparing computing times, because every answer crosses a pipe",
    drift: "as the equations of the program say",
    form: steps ? "program" : "ode",
    options: [],
    integrators: provided === "accelerations" ? served : [...served, ownSteps.name],
  };
}
