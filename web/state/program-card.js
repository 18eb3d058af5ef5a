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

/**
 * @param {{integrators: any[]}} catalogue
 * @param {string} name program:FILE
 */
export function cardOfProgram(catalogue, name) {
  const file = name.trim().slice(PREFIX.length);
  return {
    name: name.trim(),
    title: file,
    short_name: file,
    rule:
      "Your program computes the accelerations, and the integrator makes the steps; " +
      "or it makes its own steps.",
    when_not: "comparing computing times, because every answer crosses a pipe",
    drift: "as the equations of the program say",
    form: "ode",
    options: [],
    integrators: [...catalogue.integrators.filter(servesAny).map((card) => card.name), "own"],
  };
}
