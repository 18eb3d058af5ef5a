// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Quantities that can be plotted over time, one row each.
import { errorsOf } from "./errors.js";
import { GLOSSARY } from "./glossary.js";

/**
 * `loop`: exists only where a loop can open; `reference`: needs the reference solution; `log`: is
 * drawn in decades at first; `grey`: the reference has a curve of its own here.
 * @typedef {{
 *   name: string, title: string, short: string, unit: string, log: boolean, loop: boolean,
 *   reference: boolean, grey: "" | "own", about: string,
 *   columnOf: (data: import("./store.js").Data, m: number) => Float64Array,
 * }} Quantity
 */

/** A column that is kept as it was received. @param {string} name */
const received = (name) => (data, m) => data.history.columns[m][name];

/** One point is drawn for each frame: a dip to 0 between two of them does not show its depth. */
const BETWEEN_FRAMES =
  "The curve has one point for each frame: where it dips, the least value lies between two frames and can be far below what is drawn.";

/** @type {Quantity[]} */
export const QUANTITIES = [
  {
    name: "off",
    title: "Error of position, m",
    short: "error of position",
    unit: "m",
    log: true,
    loop: false,
    reference: true,
    grey: "own",
    about: "distance of the drawn point that is farthest from the reference solution",
    columnOf: (data, m) => errorsOf(data)[m].off,
  },
  {
    name: "gap",
    title: "Loop gap ‖φ‖, m",
    short: "loop gap",
    unit: "m",
    log: true,
    loop: true,
    reference: false,
    grey: "",
    about: "distance between the two halves of the cut joint (constraint violation)",
    columnOf: received("gap"),
  },
  {
    name: "velocity_gap",
    title: "Velocity violation ‖Jv‖, m/s",
    short: "velocity violation",
    unit: "m/s",
    log: true,
    loop: true,
    reference: false,
    grey: "",
    about: "how fast the loops come apart",
    columnOf: received("velocity_gap"),
  },
  {
    name: "energy_change",
    title: "Energy error |ΔE − W|, J",
    short: "energy error",
    unit: "J",
    log: true,
    loop: false,
    reference: false,
    grey: "",
    about: "since the start, less the work of drives, dampers and loads; the true value is zero",
    columnOf: received("energy_change"),
  },
  {
    name: "pivot_ratio",
    title: "Distance from singular (pivot ratio of J)",
    short: "distance from singular",
    unit: "",
    log: false,
    loop: true,
    reference: false,
    grey: "",
    about: `${GLOSSARY.pivot.means} ${BETWEEN_FRAMES}`,
    columnOf: received("pivot_ratio"),
  },
  {
    name: "sigma_min",
    title: "Smallest singular value σ of J",
    short: "smallest singular value",
    unit: "",
    log: false,
    loop: true,
    reference: false,
    grey: "",
    about: `${GLOSSARY.sigma.means} ${BETWEEN_FRAMES}`,
    columnOf: received("sigma_min"),
  },
  {
    name: "condition",
    title: "Condition number of J",
    short: "condition number",
    unit: "",
    log: true,
    loop: true,
    reference: false,
    grey: "",
    about: GLOSSARY.condition.means,
    columnOf: received("condition"),
  },
  {
    name: "lambda_max",
    title: "Largest multiplier |λ|",
    short: "largest multiplier",
    unit: "",
    log: false,
    loop: true,
    reference: false,
    grey: "",
    about: `${GLOSSARY.multipliers.means} Drawn is the largest of them, in N or N m.`,
    columnOf: received("lambda_max"),
  },
  {
    name: "work",
    title: "Work W of drives, dampers, loads, J",
    short: "work",
    unit: "J",
    log: false,
    loop: false,
    reference: false,
    grey: "",
    about: "work since the start of everything that acts from outside",
    columnOf: received("work"),
  },
  {
    name: "ops",
    title: "Cost, operations",
    short: "cost in operations",
    unit: "",
    log: false,
    loop: false,
    reference: false,
    grey: "",
    about: "arithmetic operations so far, counted exactly",
    columnOf: received("ops"),
  },
  {
    name: "evals",
    title: "Cost, evaluations",
    short: "cost in evaluations",
    unit: "",
    log: false,
    loop: false,
    reference: false,
    grey: "",
    about: GLOSSARY.evaluations.means,
    columnOf: received("evals"),
  },
];

/** @param {string} name @returns {Quantity} */
export function quantityNamed(name) {
  const found = QUANTITIES.find((one) => one.name === name);
  if (!found) {
    throw new Error(`no quantity is called ${name}`);
  }
  return found;
}
