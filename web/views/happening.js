// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The record of incidents, one line for each method and cause with a count, the dead points of the
// methods that are right, and what to know about the scene.
import { incidentOf } from "../state/catalogue.js";
import { groupIncidents, triesOfIncident, whenWords } from "../state/cards.js";
import { deadPointLines, noDeadPointWords } from "../state/dead-point.js";
import { seconds } from "../state/format.js";
import { otherSteps } from "../state/own-step.js";
import { listen } from "../state/store.js";
import { sentenceCase } from "../state/words.js";
import { h, say } from "../widgets/dom.js";
import { explained } from "../widgets/term.js";
import { tryButtons } from "../widgets/tries.js";

const REDRAW = 250; // [ms]
const DEAD_POINTS = 1000; // [ms] all frames are looked through for them

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createHappening(el, store, actions) {
  const data = store.data;
  const list = h("ol", { class: "incidents", "aria-labelledby": "happening-title" });
  const none = h("p", { class: "none" }, "nothing so far");
  const noDead = h("p", { class: "about no-dead-point", hidden: true });
  const about = h("div", { class: "scene-notes" });
  el.replaceChildren(
    h(
      "div",
      { class: "record" },
      h("h2", { id: "happening-title" }, "Incidents"),
      none,
      list,
      noDead,
    ),
    about,
  );
  let timer = 0;
  let later = 0;
  /** what the dead points that are shown were found in */
  let searched = "";
  /** @type {ReturnType<typeof deadPointLines>} */
  let dead = [];

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
          h("span", { class: "number when" }, whenWords(group, data.duration)),
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

  /** @param {ReturnType<typeof deadPointLines>[number]} line */
  function makeDeadPoint(line) {
    return h(
      "li",
      { class: "dead-point", "data-key": `dead point ${line.name} ${line.of}` },
      h(
        "details",
        {},
        h(
          "summary",
          {},
          h("span", { class: "what" }, `${line.of && `${line.of}: `}dead point of ${line.name}`),
          h("span", { class: "number when" }, whenWords(line, data.duration)),
          h("span", { class: "why-word" }, "Why?"),
        ),
        h("p", { class: "message" }, ...explained(line.words)),
      ),
    );
  }

  /** Looks for dead points in the frames that have come since the last time. */
  function findDeadPoints() {
    later = 0;
    const { history, reference, run } = data;
    const now = `${run} ${reference?.state} ${history?.count ?? 0} ${history?.stride}`;
    if (now !== searched && data.scene && history?.count > 0) {
      searched = now;
      const found = deadPointLines(data, history.count - 1);
      if (JSON.stringify(found) !== JSON.stringify(dead)) {
        dead = found;
        show();
      }
      sayNoDeadPoint(history.count - 1);
    }
  }

  /** Why no dead point is listed, where none is. @param {number} shown */
  function sayNoDeadPoint(shown) {
    say(noDead, dead.length > 0 ? "" : noDeadPointWords(data, shown));
    noDead.hidden = noDead.textContent === "";
  }

  function show() {
    timer = 0;
    const open = new Set(
      /** @type {HTMLElement[]} */ ([...list.children])
        .filter((item) => item.querySelector("details")?.open)
        .map(({ dataset }) => dataset.key),
    );
    const items = [...groupIncidents(data.incidents).map(makeItem), ...dead.map(makeDeadPoint)];
    items.forEach((item) => {
      const details = item.querySelector("details");
      if (details && open.has(item.dataset.key)) {
        details.open = true;
      }
    });
    const { activeElement: focused } = document;
    const key = list.contains(focused) ? focused?.closest("li")?.dataset.key : undefined;
    list.replaceChildren(...items);
    items
      .find((item) => item.dataset.key === key)
      ?.querySelector("summary")
      ?.focus();
    none.hidden = items.length > 0;
  }

  function findDeadPointsLater() {
    later ||= window.setTimeout(findDeadPoints, DEAD_POINTS);
  }

  function showSoon() {
    if (!timer) {
      timer = window.setTimeout(show, REDRAW);
    }
  }

  function showNotes() {
    const steps = data.scene ? otherSteps(data) : "";
    const notes = [
      ["The scene", data.scene?.about],
      ["What to look for", data.scene?.look_for],
      ["Meant to go wrong", data.scene?.exhibit],
    ];
    about.replaceChildren(
      ...notes
        .filter(([, text]) => text)
        .flatMap(([title, text]) => [h("h2", {}, String(title)), h("p", {}, String(text))]),
      ...(steps ? [h("p", { class: "about" }, steps)] : []),
    );
  }

  const stop = listen(store, {
    methods: () => {
      list.replaceChildren();
      dead = [];
      searched = "";
      sayNoDeadPoint(0);
      show();
      showNotes();
    },
    incident: showSoon,
    reference: findDeadPointsLater,
  });
  return {
    update: findDeadPointsLater,
    dispose() {
      stop();
      clearTimeout(timer);
      clearTimeout(later);
      el.replaceChildren();
    },
  };
}
