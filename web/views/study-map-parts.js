// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Parts of a stability map: cells coloured by a quantity, and the legend.
import { HEATS, criticalLine, heatOf, heatRange } from "../state/heat.js";
import { CLASSES } from "../state/study-documents.js";
import { h, s } from "../widgets/dom.js";

const DEEP = 56; // [%] of the colour: beyond it letters are in the colour of the paper

/**
 * Colours the cells of one method by a quantity and prints its power of ten into them.
 * @param {SVGElement} picture with the cells
 * @param {string} name of the quantity; "": the cells keep the colour of their outcome
 * @param {any[][]} rows cells of the method
 * @param {number} length [m] of the scene
 * @param {(i: number) => number} columnOf the method's column for a cell of the picture, or -1
 */
export function shadeCells(picture, name, rows, length, columnOf) {
  const kind = HEATS.find((one) => one.name === name);
  if (!kind) {
    return;
  }
  const { low, high, best } = heatRange(kind, rows, length);
  for (const node of /** @type {NodeListOf<SVGElement>} */ (
    picture.querySelectorAll("[data-spot]")
  )) {
    const [i, j] = (node.dataset.spot ?? "").split(" ").map(Number);
    const value = heatOf(kind, rows[j]?.[columnOf(i)], length);
    if (Number.isNaN(value)) {
      continue;
    }
    const share = high > low ? (Math.log10(value) - low) / (high - low) : 0;
    const strength = Math.round(6 + 84 * share);
    const [cell, letter] = /** @type {any} */ (node.children);
    cell.style.fill = `color-mix(in oklab, var(--heat) ${strength}%, var(--paper))`;
    letter.textContent = String(Math.floor(Math.log10(value)));
    node.classList.add("heat");
    node.classList.toggle("deep", strength > DEEP);
    node.classList.toggle("best", best?.i === columnOf(i) && best?.j === j);
  }
}

/** A small picture and its words. */
function entry(className, content, words) {
  const key = s("svg", { class: "map key", viewBox: "0 0 18 18", "aria-hidden": "true" }, content);
  return h("li", { class: className }, key, words);
}

const lineEntry = (name, words) => entry("", s("path", { d: "M0 9H18", class: name }), words);

/**
 * @param {HTMLElement} legend
 * @param {any} map document
 * @param {{heat: string, here: boolean}} shown here: the present values are on the map
 */
export function fillLegend(legend, map, { heat, here }) {
  const used = new Set(map.methods.flatMap(({ rows }) => rows.flat().map((cell) => cell.class)));
  const kind = HEATS.find(({ name }) => name === heat);
  const ran = ["stable", "inaccurate"];
  const outcomes = Object.entries(CLASSES)
    .filter(([name]) => used.has(name) && !(kind && ran.includes(name)))
    .map(([name, { letter, word }]) =>
      entry(
        "",
        s(
          "g",
          { class: `cell ${name}` },
          s("rect", { width: 18, height: 18 }),
          s("text", { x: 9, y: 13, class: "letter" }, letter),
        ),
        word,
      ),
    );
  const unit = kind?.unit ? ` ${kind.unit}` : "";
  legend.replaceChildren(
    ...(kind
      ? [h("li", {}, `numbers: ${kind.word} as a power of ten${unit}; framed: the least`)]
      : []),
    ...outcomes,
    lineEntry("boundary", "predicted boundary"),
    ...(criticalLine(map) ? [lineEntry("critical", "critical damping, α = β")] : []),
    ...(here
      ? [entry("", s("circle", { cx: 9, cy: 9, r: 6, class: "here" }), "present values")]
      : []),
  );
}
