// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Buttons that undo and redo changes of methods, parameters, start and scene.
import { listen } from "../state/store.js";
import { h, set } from "../widgets/dom.js";

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
  const undo = button("Undo", "↶", "", () => actions.undo());
  const redo = button("Redo", "↷", "", () => actions.redo());
  place.prepend(undo, redo);

  function show() {
    const { past, future, undoes, redoes } = data.undo;
    undo.disabled = past === 0;
    redo.disabled = future === 0;
    set(undo, { "data-tip": `undo ${undoes || "the last change"} (Z)` });
    set(redo, { "data-tip": `redo ${redoes || "what was undone"} (Y)` });
  }
  show();
  const stop = listen(store, { undo: show });
  return {
    update() {},
    dispose() {
      stop();
      undo.remove();
      redo.remove();
    },
  };
}
