// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The questions of an exercise, and the answers that are handed in.

/**
 * @typedef {{letter: string, text: string}} Option
 * @typedef {{id: string, kind: string, points: number, ask: string, answer_form: string,
 *   figure?: {svg: string, text: string}}} Part a figure is a plot that is to be read
 */

/**
 * The options of a choice, and the reasons to choose from, as the exercise prints them.
 * @param {string} form
 * @returns {{options: Option[], reasons: Option[]}}
 */
export function readChoice(form) {
  const [first, second = ""] = form.split(/^\s*because\s*$/m);
  const read = (text) =>
    [...text.matchAll(/^\s+\(([a-z])\)\s+(.*)$/gm)].map(([, letter, words]) => ({
      letter,
      text: words,
    }));
  return { options: read(first), reasons: read(second) };
}

/**
 * Returns how an answer is written in a field: quotes belong to files of answers. What follows of a
 * choice are its options.
 * @param {Part} part
 */
export const formOf = ({ kind, answer_form: form }) =>
  kind === "choice"
    ? ""
    : form.replaceAll(" in quotes", "").replace(/with its unit: "([^"]*)"/, "with its unit: $1");

/** Typed text as a value: JSON where it is JSON, else the text itself. @param {string} text */
export function readAnswer(text) {
  const plain = text.trim();
  if (/^[[{"]|^[-+\d.]/.test(plain)) {
    try {
      return JSON.parse(plain);
    } catch {
      return plain;
    }
  }
  return plain;
}

/**
 * The matrix that an exercise of entries asks for: its name and how large it is.
 * @param {string} submission as the exercise shows it
 * @returns {{name: string, rows: number, columns: number} | null}
 */
export function matrixOf(submission) {
  try {
    const [[name, rows]] = Object.entries(JSON.parse(submission));
    return Array.isArray(rows) && Array.isArray(rows[0])
      ? { name, rows: rows.length, columns: rows[0].length }
      : null;
  } catch {
    return null;
  }
}

/**
 * Returns how many answers are right, and why there can be more of them than parts.
 * @param {{summary: string, entries: {name: string}[]}} verdict
 */
export const summaryOf = ({ summary, entries }) =>
  entries.some(({ name }) => /\breason$/.test(name))
    ? `${summary} (a choice and its reason are two answers)`
    : summary;

/** A line as long as this was broken because it was full, not because a sentence ended there. */
const FULL = 60; // [characters]

/**
 * A text whose lines were broken for a terminal, as paragraphs that take the width they have.
 * Formulas, which are indented, keep their lines.
 * @param {string} text
 */
export const flowing = (text) =>
  text.replace(/^(\S.*)\n(?=\S)/gm, (whole, line) => (line.length < FULL ? whole : `${line} `));
