// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Notes beside the comparison: they travel with the link.
import { LONGEST_NOTE } from "../state/link.js";
import { listen } from "../state/store.js";
import { h } from "../widgets/dom.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createNotes(el, store, actions) {
  const data = store.data;
  const text = h("textarea", {
    id: "note",
    rows: 3,
    maxlength: LONGEST_NOTE,
    "aria-describedby": "note-about",
    oninput: () => actions.setNote(text.value),
  });
  el.replaceChildren(
    h("h2", {}, h("label", { for: "note" }, "Notes")),
    text,
    h("p", { id: "note-about", class: "hint" }, "Notes travel with the link (L)."),
  );

  const stop = listen(store, {
    note: () => {
      text.value = data.note;
    },
  });
  return {
    update() {},
    dispose() {
      stop();
      el.replaceChildren();
    },
  };
}
