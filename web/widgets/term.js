// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A special word that shows its definition on hover, focus and touch.
import { GLOSSARY, termsIn } from "../state/glossary.js";
import { h } from "./dom.js";

/**
 * @param {string} key of the glossary
 * @param {string} [text] in place of the glossary's word
 */
export function term(key, text) {
  const { word, means } = GLOSSARY[key];
  return h("button", { type: "button", class: "term", "data-tip": means }, text ?? word);
}

/**
 * A text whose special words explain themselves, each where it first stands. A punctuation mark
 * stays on the line of the word before it.
 * @param {string} text
 * @returns {(Node | string)[]}
 */
export function explained(text) {
  const parts = termsIn(text);
  return parts.map(({ key, text: part }, i) => {
    if (!key) {
      return parts[i - 1]?.key ? part.slice(markOf(part).length) : part;
    }
    const mark = markOf(parts[i + 1]?.text);
    return mark ? h("span", { class: "whole" }, term(key, part), mark) : term(key, part);
  });
}

/** The punctuation that a text begins with. @param {string} [text] */
const markOf = (text) => /^[.,:;)]+/.exec(text ?? "")?.[0] ?? "";
