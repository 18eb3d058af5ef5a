// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Parts of a stability map: cells coloured by a quantity, and the legend.
import {
  HEATS,
  baumgarteLimit,
  contourOf,
  criticalLine,
  heatOf,
  heatRange,
} from "../state/heat.js";
import { plain, powerOfTen, prettyUnit, quantity } from "../state/format.js";
import { GAP_LAW } from "../state/glossary.js";
import { CLASSES, boundaryOf } from "../state/study-documents.js";
import { h, s } from "../widgets/dom.js";

const WHOLE = 34; // [px] of a cell that holds 10⁻³
const EXPONENT = 22; // [px] of one that holds the exponent
/** [%] of the colour beyond which black letters, in the dark theme, or white ones, in the light
 * theme, are the easier to read: either has at least 4.5 to 1 there. */
const LETTERS = { dark: 61, light: 75 };

/** The sentence about a map over Baumgarte's constants. */
export const SWEET_SPOT =
  "Small α and β let the gap grow; near the boundary every step overshoots. The best place lies " +
  "between, and it is another one for the gap, the motion and the energy.";
const GREEK = { alpha: "α", beta: "β" };

/** Returns what an axis is called. @param {{name: string, unit: string}} axis */
export const titleOf = (axis) =>
  `${GREEK[axis.name] ?? axis.name}${axis.unit ? `, ${prettyUnit(axis.unit)}` : ""}`;
/** A value on it. @param {{name: string, unit: string}} axis @param {number} value */
export const valueOf = (axis, value) =>
  `${GREEK[axis.name] ?? axis.name} = ${axis.unit === "s" ? quantity(value, "s") : `${plain(Number(value.toPrecision(3)))}${axis.unit ? ` ${prettyUnit(axis.unit)}` : ""}`}`;

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
    letter.textContent = powerWords(Math.floor(Math.log10(value)), cell.width.baseVal.value);
    node.classList.add("heat");
    node.classList.toggle("mid", strength > LETTERS.dark && strength <= LETTERS.light);
    node.classList.toggle("deep", strength > LETTERS.light);
    node.classList.toggle("best", best?.i === columnOf(i) && best?.j === j);
  }
}

/**
 * @param {{px: (i: number) => number, py: (j: number) => number}} scale
 * @param {[number, number][]} line in cells
 */
const pathOf = ({ px, py }, line) =>
  line.map(([i, j], n) => `${n ? "L" : "M"}${px(i).toFixed(1)} ${py(j).toFixed(1)}`).join("");

/**
 * Critical damping and the predicted boundary of one method.
 * @param {SVGElement} picture
 * @param {any} map document
 * @param {any} method of it
 * @param {{px: (i: number) => number, py: (j: number) => number}} scale
 */
export function drawLines(picture, map, method, scale) {
  const critical = criticalLine(map);
  if (critical) {
    picture.append(s("path", { d: pathOf(scale, critical), class: "critical" }));
  }
  for (const line of boundaryOf(map, method)) {
    const d = pathOf(scale, line);
    picture.append(s("path", { d, class: "boundary under" }), s("path", { d, class: "boundary" }));
  }
}

/**
 * Contours of a quantity, one for each power of ten.
 * @param {SVGElement} picture
 * @param {string} name of the quantity
 * @param {any[][]} rows cells of the method
 * @param {number} length [m] of the scene
 * @param {{px: (i: number) => number, py: (j: number) => number}} scale
 */
export function drawContours(picture, name, rows, length, scale) {
  const kind = HEATS.find((one) => one.name === name);
  if (!kind) {
    return;
  }
  const { low, high } = heatRange(kind, rows, length);
  const powers = rows.map((row) => row.map((cell) => Math.log10(heatOf(kind, cell, length))));
  for (let level = Math.ceil(low); level <= high; level++) {
    const d = contourOf(powers, level)
      .map((piece) => pathOf(scale, piece))
      .join("");
    picture.append(s("path", { d, class: "contour", "data-level": level }));
  }
}

/**
 * Puts what is written in the cells above the lines, on a ground of the cell's colour.
 * @param {SVGElement} picture with the cells and lines
 */
export function raiseLetters(picture) {
  const cells = [.../** @type {NodeListOf<SVGElement>} */ (picture.querySelectorAll(".cell"))];
  const letters = cells.map((cell) => {
    const [rect, letter] = /** @type {any} */ (cell.children);
    letter.setAttribute("class", cell.getAttribute("class")?.replace("cell", "letter") ?? "letter");
    letter.style.stroke = rect.style.fill;
    return letter;
  });
  picture.append(s("g", { class: "letters" }, ...letters));
}

/** A power of ten for a cell: all of it, its exponent, or nothing where neither has room. */
const powerWords = (power, width) =>
  width >= WHOLE ? powerOfTen(power) : width >= EXPONENT ? powerOfTen(power).slice(2) : "";

/** A small picture and its words. */
function entry(className, content, words) {
  const key = s("svg", { class: "map key", viewBox: "0 0 18 18", "aria-hidden": "true" }, content);
  return h("li", { class: className }, key, words);
}

const lineEntry = (name, words) => entry("", s("path", { d: "M0 9H18", class: name }), words);

/**
 * @param {HTMLElement} legend
 * @param {any} map document
 * @param {{heat: string, here: "" | "inside" | "outside", step: number, widen: () => void}} shown
 *   here: where the present values are; step: of the map's first method [s]; widen: makes the map
 *   again with axes that hold them
 */
export function fillLegend(legend, map, { heat, here, step, widen }) {
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
  const limit = baumgarteLimit(map, map.methods[0], step);
  const limitWords = limit > 0 ? `: h β = ${plain(Number(limit.toPrecision(3)))} on α = β` : "";
  const inUnit = kind?.unit ? ` in ${kind.unit}` : "";
  legend.replaceChildren(
    ...(kind
      ? [
          h(
            "li",
            {},
            `in the cells: ${kind.word}${inUnit}, as a power of ten; the fainter the smaller; framed: the least`,
          ),
        ]
      : []),
    ...outcomes,
    lineEntry("boundary", `predicted boundary${limitWords}`),
    ...(kind ? [lineEntry("contour", "contours, one for each power of ten")] : []),
    ...(criticalLine(map)
      ? [lineEntry("critical", `critical damping, ζ = α/β = 1, of ${GAP_LAW}`)]
      : []),
    ...(here
      ? [
          entry(
            "",
            s("circle", { cx: 9, cy: 9, r: 6, class: "here" }),
            here === "inside"
              ? "present values: drag the ring"
              : "present values lie beyond the axes:",
          ),
        ]
      : []),
    ...(here === "outside"
      ? [
          h(
            "li",
            {},
            h("button", { type: "button", class: "try", onclick: widen }, "widen the axes"),
          ),
        ]
      : []),
  );
}
