// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Buttons that undo and redo changes of methods, parameters, start and scene.
import { listen } from "../state/store.js";
import { h } from "../widgets/dom.js";

/**
 * @param {HTMLElement} place gets the buttons, over the drawing
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createUndoButtons(place, store, actions) {
  const data = store.data;
  const button = (word, sign, tip, onclick) =>
    h(
      "button",
      {
        type: "button",
        class: "quiet",
        "aria-label": word,
        "data-tip": tip,
        disabled: true,
        onclick,
      },
      sign,
    );
  const undo = button("Undo", "↶", "undo the last change (Z)", () => actions.undo());
  const redo = button("Redo", "↷", "redo it (Y)", () => actions.redo());
  place.prepend(undo, redo);

  const stop = listen(store, {
    undo: () => {
      undo.disabled = data.undo.past === 0;
      redo.disabled = data.undo.future === 0;
    },
  });
  return {
    update() {},
    dispose() {
      stop();
      undo.remove();
      redo.remove();
    },
  };
}
