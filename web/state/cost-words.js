// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The cost of a run, in words.
import { plain, quantity } from "./format.js";
import { COSTS, byName } from "./study-documents.js";

const COUNTS = /** @type {const} */ ([
  [1e9, " billion"],
  [1e6, " million"],
  [1e3, " thousand"],
]);

/**
 * "8.2 million operations", "1.2 ms", "32 evaluations"
 * @param {string} kind @param {number} value
 */
export function costText(kind, value) {
  if (kind === "evaluations") {
    return `${Math.round(value)} evaluations`;
  }
  if (kind !== "operations") {
    return quantity(value, byName(COSTS, kind).unit);
  }
  const [size, word] = COUNTS.find(([least]) => Number(value.toPrecision(2)) >= least) ?? [1, ""];
  return `${plain(Number((value / size).toPrecision(2)))}${word} operations`;
}
