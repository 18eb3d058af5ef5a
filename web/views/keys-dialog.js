// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The table of keys, and the switch for those that are a single character.
import { KEYS, isCharacter, keyName } from "../state/keys.js";
import { h } from "../widgets/dom.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createKeysDialog(el, store, actions) {
  const letters = h("input", {
    type: "checkbox",
    id: "letters",
    onchange: () => actions.setView({ letters: letters.checked }),
  });
  const row = (key, names, means) =>
    h(
      "tr",
      { class: isCharacter(key) ? "character" : "" },
      h("th", { scope: "row" }, ...names),
      h("td", {}, means),
    );
  const cap = (key) => h("kbd", {}, keyName(key));

  // the keys that select a method share one row
  const selects = KEYS.filter(({ action }) => action === "select");
  const [first, last] = [selects[0], selects[selects.length - 1]];
  const rows = KEYS.flatMap((key) =>
    key === first
      ? [
          row(
            key,
            [cap(first), " to ", cap(last)],
            "select the method with this number in the list",
          ),
        ]
      : key.action === "select"
        ? []
        : [row(key, [cap(key)], key.means)],
  );
  const title = h("h2", { id: "keys-title", tabindex: "-1" }, "Keys");
  const dialog = h(
    "dialog",
    { class: "dialog", "aria-labelledby": "keys-title" },
    title,
    h("table", { class: "keys" }, h("tbody", {}, ...rows)),
    h("p", {}, letters, " ", h("label", { for: "letters" }, "keys of a single character are on")),
    h("form", { method: "dialog", class: "actions" }, h("button", { class: "primary" }, "Close")),
  );
  el.append(dialog);
  return {
    open() {
      letters.checked = store.data.view.letters;
      dialog.showModal();
      title.focus({ preventScroll: true }); // the first thing that takes keys stands at the end
      dialog.scrollTop = 0;
    },
    update() {},
    dispose: () => dialog.remove(),
  };
}
