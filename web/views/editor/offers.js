// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The list of what may stand at the caret, under the text: arrows choose, Enter or Tab takes,
// Escape closes.
import { h, set } from "../../widgets/dom.js";

/**
 * @param {HTMLTextAreaElement} field
 * @param {() => import("../../state/completion.js").Offer[]} find
 * @param {(offer: import("../../state/completion.js").Offer) => void} take
 */
export function createOffers(field, find, take) {
  const list = h("ul", {
    class: "offers",
    id: "editor-offers",
    role: "listbox",
    "aria-label": "What may stand here",
    hidden: true,
  });
  /** @type {import("../../state/completion.js").Offer[]} */
  let offers = [];
  let at = 0;
  set(field, {
    "aria-autocomplete": "list",
    "aria-controls": list.id,
  });

  function close() {
    list.hidden = true;
    set(field, { "aria-activedescendant": null });
  }

  /** @param {number} index */
  function mark(index) {
    at = (index + offers.length) % offers.length;
    [...list.children].forEach((node, i) => set(node, { "aria-selected": String(i === at) }));
    list.children[at]?.scrollIntoView({ block: "nearest" });
    set(field, { "aria-activedescendant": `editor-offer-${at}` });
  }

  function open() {
    offers = find();
    if (!offers.length) {
      close();
      return;
    }
    list.replaceChildren(
      ...offers.map(({ text, about }, i) =>
        h(
          "li",
          {
            id: `editor-offer-${i}`,
            role: "option",
            onpointerdown: (event) => {
              event.preventDefault(); // the caret stays in the text
              choose(i);
            },
          },
          h("strong", {}, text),
          h("span", { class: "about" }, about),
        ),
      ),
    );
    list.hidden = false;
    mark(0);
  }

  /** @param {number} index */
  function choose(index) {
    const offer = offers[index];
    close();
    take(offer);
  }

  return {
    list,
    open,
    close,
    /** Takes the keys that belong to the list. @param {KeyboardEvent} event @returns {boolean} */
    takeKey(event) {
      if (event.key === " " && event.ctrlKey) {
        open();
        return true;
      }
      if (list.hidden) {
        return false;
      }
      const moves = { ArrowDown: 1, ArrowUp: -1 };
      if (event.key in moves) {
        mark(at + moves[event.key]);
      } else if (event.key === "Enter" || event.key === "Tab") {
        choose(at);
      } else if (event.key === "Escape") {
        close();
      } else {
        return false;
      }
      return true;
    },
  };
}
