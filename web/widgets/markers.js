// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Marks of points in a plot, as paths round the origin with a radius of 1: one for each method, a
// cross for a run that failed, a ring for one that was not made.
import { NOT_RUN } from "../state/study-documents.js";

const RING = "M-1 0a1 1 0 1 0 2 0a1 1 0 1 0 -2 0Z";
const FAILED = "M-1-1L1 1M1-1L-1 1";
const MARKERS = {
  disc: RING,
  square: "M-.9-.9H.9V.9H-.9Z",
  triangle: "M0-1.1L1.1.9H-1.1Z",
  diamond: "M0-1.25L1.1 0L0 1.25L-1.1 0Z",
  cross: FAILED,
  ring: RING,
  box: "M-.9-.9H.9V.9H-.9Z",
  plus: "M-1.1 0H1.1M0-1.1V1.1",
};
const OPEN = ["cross", "plus", "ring", "box"];

/** @typedef {{error: number, state: string}} Point error: Infinity where there is none */

/** @param {Point} point @param {string} marker of its method */
export function markerOf({ error, state }, marker) {
  if (error !== Infinity) {
    return MARKERS[marker];
  }
  return NOT_RUN.includes(state) ? RING : FAILED;
}

/** Is the mark drawn as a line, not filled? @param {Point} point @param {string} marker */
export const isOpen = ({ error }, marker) => error === Infinity || OPEN.includes(marker);
