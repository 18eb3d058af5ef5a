// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A special word that shows its definition on hover, focus and touch.
import { GLOSSARY } from "../state/glossary.js";
import { h } from "./dom.js";

/**
 * @param {string} key of the glossary
 * @param {string} [text] in place of the glossary's word
 */
export function term(key, text) {
  const { word, means } = GLOSSARY[key];
  return h("button", { type: "button", class: "term", "data-tip": means }, text ?? word);
}
