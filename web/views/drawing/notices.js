// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Sentences over the drawing: its description, and a singular configuration ahead.
import { shownIndex } from "../../state/store.js";
import { describeDrawing, passedAt, predictionAt } from "../../state/words.js";
import { h, say } from "../../widgets/dom.js";

/** @param {import("../../state/store.js").Data} data */
export function createNotices(data) {
  const title = h("p", { id: "drawing-title", class: "hidden" });
  const spoken = h("p", { class: "spoken", role: "status" });
  const ahead = h("p", { class: "ahead", hidden: true });

  /** @param {number} now index of the frame shown */
  function showAhead(now) {
    const text = predictionAt(data, now) || passedAt(data, now).split(":")[0];
    ahead.hidden = text === "";
    say(ahead, text);
  }

  return {
    title,
    spoken,
    ahead,
    /** @param {number} now index of the frame shown */
    update(now) {
      showAhead(now);
    },
    /** Another scene: what was described is gone. */
    clear() {
      title.textContent = data.scene?.title ?? "";
      spoken.textContent = "";
    },
    /** The text that stands for the drawing; read out when somebody asked for it. */
    describe(aloud = false) {
      const sentence = describeDrawing(data, shownIndex(data));
      say(title, sentence);
      if (aloud) {
        say(spoken, sentence);
      }
    },
  };
}
