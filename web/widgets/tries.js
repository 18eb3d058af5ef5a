// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Suggestions as buttons; those that nobody can carry out by a click stay text.
import { h } from "./dom.js";

/**
 * @param {import("../state/cards.js").Try[]} tries
 * @param {(item: import("../state/cards.js").Try) => void} attempt
 */
export function tryButtons(tries, attempt) {
  const nodes = tries.flatMap((item) => [
    item.key || item.method
      ? h("button", { type: "button", class: "try", onclick: () => attempt(item) }, item.label)
      : h("span", { class: "remedy" }, item.label),
    ...(item.said ? [h("span", { class: "said" }, item.said)] : []),
  ]);
  return nodes.length
    ? h("p", { class: "tries" }, h("span", { class: "word" }, "Try"), ...nodes)
    : h("span", { class: "none" });
}
