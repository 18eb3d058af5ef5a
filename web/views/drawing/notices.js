// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Sentences over the drawing: methods that have stopped, and a singular configuration ahead.
import { shownIndex } from "../../state/store.js";
import { describeDrawing, predictionAt } from "../../state/words.js";
import { h, say } from "../../widgets/dom.js";

/** @param {import("../../state/store.js").Data} data */
export function createNotices(data) {
  const title = h("p", { id: "drawing-title", class: "hidden" });
  const spoken = h("p", { class: "spoken", role: "status" });
  const banner = h("div", { class: "banner", role: "alert", hidden: true });
  const ahead = h("p", { class: "ahead", hidden: true });

  /** @param {number} now index of the frame shown */
  function showFailures(now) {
    const lines = data.methods.flatMap((method, m) => {
      const end = data.history.ended[m];
      const reason = data.latest?.methods[m]?.reason;
      return end <= data.history.t[now]
        ? [`${method.label} stopped at ${end.toFixed(3)} s${reason ? `: ${reason}` : ""}`]
        : [];
    });
    banner.hidden = lines.length === 0;
    if (lines.join("\n") !== banner.dataset.text) {
      banner.dataset.text = lines.join("\n");
      banner.replaceChildren(...lines.map((line) => h("p", {}, line)));
    }
  }

  /** @param {number} now index of the frame shown */
  function showAhead(now) {
    const text = predictionAt(data, now);
    ahead.hidden = text === "";
    say(ahead, text);
  }

  return {
    title,
    spoken,
    banner,
    ahead,
    /** @param {number} now index of the frame shown */
    update(now) {
      showAhead(now);
      showFailures(now);
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
