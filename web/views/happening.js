// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// What is happening, in sentences that a screen reader may follow, and the cards that say why.
import { seconds } from "../state/format.js";
import { incidentOf } from "../state/catalogue.js";
import { listen } from "../state/store.js";
import {
  beforeAndAfter,
  cardOfMethod,
  predictionAt,
  sentences,
  tryOfRemedy,
} from "../state/words.js";
import { h, say } from "../widgets/dom.js";

const PAUSE = 2000; // [ms] between two things said
const PAUSE_ENDS = 1400; // [ms] sooner when someone pauses or plays
const MOST_SHOWN = 40;

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createHappening(el, store, actions) {
  const data = store.data;
  const live = h("div", { class: "live", "aria-live": "polite", "aria-atomic": "true" });
  const why = h("div", { class: "why-card" });
  const list = h("ol", { class: "incidents", "aria-label": "Incidents" });
  const about = h("div", { class: "scene-notes" });
  const scroll = h(
    "div",
    { class: "scroll", tabindex: "0", role: "region", "aria-labelledby": "happening-title" },
    live,
    why,
    list,
    about,
  );
  el.replaceChildren(
    h("div", { class: "title" }, h("h2", { id: "happening-title" }, "What is happening")),
    scroll,
  );
  let saidAt = -PAUSE;
  let timer = 0;
  let cardOf = -1;

  function shown() {
    const last = (data.history?.count ?? 0) - 1;
    return data.view.shown < 0 ? last : Math.min(data.view.shown, last);
  }

  function speak() {
    timer = 0;
    saidAt = performance.now();
    const now = shown();
    if (now < 0) {
      return;
    }
    const ahead = predictionAt(data, now);
    const state =
      now === 0 ? ["all methods start from the same closed pose"] : sentences(data, now);
    const lines = ahead ? [ahead, ...state] : state;
    const changes = beforeAndAfter(data, now);
    const text = [...changes, ...lines];
    if (live.dataset.text !== text.join("\n")) {
      live.dataset.text = text.join("\n");
      live.replaceChildren(
        ...changes.map((line) => h("p", { class: "change" }, line)),
        ...lines.map((line) => h("p", {}, line)),
      );
    }
  }

  /** @param {import("../state/words.js").Try[]} tries */
  function tryButtons(tries) {
    const nodes = tries.map((item) =>
      item.key || item.method
        ? h(
            "button",
            { type: "button", class: "try", onclick: () => actions.attempt(item) },
            item.label,
          )
        : h("span", { class: "remedy" }, item.label),
    );
    return nodes.length
      ? h("p", { class: "tries" }, h("span", { class: "word" }, "Try"), ...nodes)
      : h("span", { class: "none" });
  }

  function showCard() {
    const m = data.view.why;
    if (m < 0 || !data.methods[m] || shown() < 0) {
      why.replaceChildren();
      cardOf = -1;
      return;
    }
    if (cardOf === m) {
      return;
    }
    cardOf = m;
    const card = cardOfMethod(data, m, shown());
    why.replaceChildren(
      h(
        "section",
        {
          class: `card slot-${data.methods[m].slot}`,
          tabindex: "-1",
          "aria-label": `Why: ${card.title}`,
        },
        h(
          "div",
          { class: "card-head" },
          h("h3", {}, card.title),
          h(
            "button",
            { type: "button", class: "quiet", onclick: () => actions.setView({ why: -1 }) },
            "close",
          ),
        ),
        h("p", {}, card.happened),
        h(
          "p",
          { class: "rule" },
          card.rule,
          card.drift && !card.rule.includes(card.drift) ? ` ${sentenceOf(card.drift)}` : "",
        ),
        tryButtons(card.tries),
      ),
    );
    scroll.scrollTop = 0;
    /** @type {HTMLElement} */ (why.firstElementChild).focus({
      preventScroll: window.innerWidth >= 1024,
    });
  }

  /** The engine's words as a sentence. @param {string} text */
  function sentenceOf(text) {
    const upper = text.charAt(0).toUpperCase() + text.slice(1);
    return /[.!?]$/.test(upper) ? upper : `${upper}.`;
  }

  /** @param {import("../state/store.js").Incident} incident */
  function incidentItem(incident) {
    const method = data.methods[incident.method];
    const words = incidentOf(incident.code);
    return h(
      "li",
      { class: method ? `slot-${method.slot}` : "", "data-key": keyOf(incident) },
      h(
        "details",
        {},
        h(
          "summary",
          {},
          h("span", { class: "number when" }, seconds(incident.t, data.duration)),
          h(
            "span",
            { class: "what" },
            `${method ? `${method.label}: ` : ""}${words?.name ?? incident.code}`,
          ),
          h("span", { class: "why-word" }, "Why?"),
        ),
        h("p", { class: "message" }, sentenceOf(incident.message)),
        words ? h("p", { class: "rule" }, words.rule) : "",
        tryButtons(incident.remedies.map(tryOfRemedy)),
      ),
    );
  }

  function showIncidents() {
    const kept = data.incidents.slice(-MOST_SHOWN);
    list.replaceChildren(...kept.map(incidentItem).reverse());
  }

  /** @param {import("../state/store.js").Incident} incident what tells it from others */
  const keyOf = ({ method, code, t }) => `${method} ${code} ${t}`;

  /** @param {{incident: import("../state/store.js").Incident, again: boolean}} told */
  function addIncident({ incident, again }) {
    if (again) {
      const items = /** @type {HTMLElement[]} */ ([...list.children]);
      const item = items.find(({ dataset }) => dataset.key === keyOf(incident));
      const message = item?.querySelector(".message");
      if (message) {
        say(message, sentenceOf(incident.message));
      }
      return;
    }
    list.prepend(incidentItem(incident));
    while (list.children.length > MOST_SHOWN) {
      list.lastElementChild?.remove();
    }
    update();
  }

  function showNotes() {
    const notes = [
      ["The scene", data.scene?.about],
      ["What to look for", data.scene?.look_for],
    ];
    about.replaceChildren(
      ...notes
        .filter(([, text]) => text)
        .flatMap(([title, text]) => [h("h3", {}, String(title)), h("p", {}, String(text))]),
    );
  }

  function update() {
    if (!timer) {
      timer = window.setTimeout(speak, Math.max(0, PAUSE - (performance.now() - saidAt)));
    }
  }

  const stop = listen(store, {
    methods: () => {
      cardOf = -1;
      showIncidents();
      showCard();
      showNotes();
      clearTimeout(timer);
      timer = 0;
      saidAt = -PAUSE;
      update();
    },
    incident: addIncident,
    view: showCard,
    state: () => {
      clearTimeout(timer);
      timer = 0;
      saidAt -= PAUSE_ENDS;
      update();
    },
  });
  return {
    update,
    dispose() {
      stop();
      clearTimeout(timer);
      el.replaceChildren();
    },
  };
}
