// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The record of incidents, one line for each method and cause with a count, and what to know about
// the scene.
import { incidentOf } from "../state/catalogue.js";
import { groupIncidents, triesOfIncident } from "../state/cards.js";
import { seconds } from "../state/format.js";
import { listen } from "../state/store.js";
import { sentenceCase } from "../state/words.js";
import { h } from "../widgets/dom.js";
import { explained } from "../widgets/term.js";
import { tryButtons } from "../widgets/tries.js";

const REDRAW = 250; // [ms]

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createHappening(el, store, actions) {
  const data = store.data;
  const list = h("ol", { class: "incidents", "aria-labelledby": "happening-title" });
  const none = h("p", { class: "none" }, "nothing so far");
  const about = h("div", { class: "scene-notes" });
  el.replaceChildren(
    h("div", { class: "record" }, h("h2", { id: "happening-title" }, "Incidents"), none, list),
    about,
  );
  let timer = 0;

  /** When, and how often. @param {import("../state/cards.js").Group} group */
  function whenWords({ count, first, last }) {
    const at = seconds(first, data.duration);
    return count > 1 ? `${at} to ${seconds(last, data.duration)}, ${count} times` : at;
  }

  /** @param {import("../state/cards.js").Group} group */
  function makeItem(group) {
    const { newest, count } = group;
    const method = data.methods[newest.method];
    const known = incidentOf(newest.code);
    const what = `${method ? `${method.label}: ` : ""}${known?.name ?? newest.code}`;
    return h(
      "li",
      { class: method ? `slot-${method.slot}` : "", "data-key": group.key },
      h(
        "details",
        {},
        h(
          "summary",
          {},
          h("span", { class: "what" }, what),
          h("span", { class: "number when" }, whenWords(group)),
          h("span", { class: "why-word" }, "Why?"),
        ),
        h(
          "p",
          { class: "message" },
          ...explained(
            `${count > 1 ? `Last at ${seconds(newest.t, data.duration)}: ` : ""}${sentenceCase(newest.message)}`,
          ),
        ),
        known ? h("p", { class: "rule" }, ...explained(known.rule)) : "",
        tryButtons(triesOfIncident(newest), actions.attempt),
      ),
    );
  }

  function show() {
    timer = 0;
    const open = new Set(
      /** @type {HTMLElement[]} */ ([...list.children])
        .filter((item) => item.querySelector("details")?.open)
        .map(({ dataset }) => dataset.key),
    );
    const items = groupIncidents(data.incidents).map(makeItem);
    items.forEach((item) => {
      const details = item.querySelector("details");
      if (details && open.has(item.dataset.key)) {
        details.open = true;
      }
    });
    list.replaceChildren(...items);
    none.hidden = items.length > 0;
  }

  function showSoon() {
    if (!timer) {
      timer = window.setTimeout(show, REDRAW);
    }
  }

  function showNotes() {
    const notes = [
      ["The scene", data.scene?.about],
      ["What to look for", data.scene?.look_for],
      ["Meant to go wrong", data.scene?.exhibit],
    ];
    about.replaceChildren(
      ...notes
        .filter(([, text]) => text)
        .flatMap(([title, text]) => [h("h2", {}, String(title)), h("p", {}, String(text))]),
    );
  }

  const stop = listen(store, {
    methods: () => {
      list.replaceChildren();
      show();
      showNotes();
    },
    incident: showSoon,
  });
  return {
    update() {},
    dispose() {
      stop();
      clearTimeout(timer);
      el.replaceChildren();
    },
  };
}
