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
 * A text whose special words explain themselves, each where it first stands.
 * @param {string} text
 * @returns {(Node | string)[]}
 */
export const explained = (text) =>
  termsIn(text).map(({ key, text: part }) => (key ? term(key, part) : part));
