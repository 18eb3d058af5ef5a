// @ts-check
// What is happening, in sentences that a screen reader may follow, and the cards that say why.
import { seconds } from "../state/format.js";
import { listen } from "../state/store.js";
import { beforeAndAfter, cardOfMethod, sentences, tryOfRemedy } from "../state/words.js";
import { h, say } from "../widgets/dom.js";

const PAUSE = 2000; // [ms] between two things said
const PAUSE_ENDS = 1400; // [ms] sooner when someone pauses or plays
const MOST_SHOWN = 40;
const NAMES = {
  "near-singular": "close to a singular pose",
  "rank-loss": "constraint rows depend on each other",
  "branch-flip": "jumped to the other way of assembling",
  "gap-open": "the loop has opened",
  "energy-jump": "energy jumped",
  "chart-change": "changed its coordinates",
  "chart-lost": "its coordinates no longer serve",
  "step-limit": "the step is at its limit",
  "projection-failed": "projection did not close the loop",
  diverged: "diverged",
  "step-underflow": "the step became too small",
  budget: "took too long",
  "rank-ahead": "a singular pose lies ahead",
  "ill-conditioned": "digits of the forces are lost",
  "multipliers-grow": "the forces in the loop grow without bound",
  "solver-fallback": "the fast solve gave way to the careful one",
};
const RULES = {
  "near-singular":
    "Near a pose where constraint rows become dependent the multipliers grow without bound and small errors with them.",
  "rank-loss":
    "Where rows of J depend on each other only their sum of forces is determined; the least one is taken and the motion is the same.",
  "branch-flip":
    "The same lengths close in more than one way. A step that is too large can land on another one.",
  "gap-open":
    "A constraint kept only as an acceleration leaves the errors of two integrations unopposed: the gap grows with time squared.",
  "energy-jump":
    "A closed mechanism without loads keeps its energy. A jump means the step misses the motion, closed or not.",
  "chart-change":
    "Minimal coordinates serve one part of the motion. At a turning point of the chosen one another must take over.",
  "chart-lost":
    "Minimal coordinates serve one part of the motion. At a turning point of the chosen one the rest cannot be found from it.",
  "step-limit":
    "A step times the fastest rate must stay within the stability region of the integrator.",
  "projection-failed":
    "Projection looks for the nearest closed pose; from too far away, or where none exists, it does not arrive.",
  diverged: "An explicit step beyond its stability limit multiplies errors at every step.",
  "step-underflow": "The tolerance cannot be met at any step the arithmetic can still tell apart.",
  budget: "One frame may take a bounded time, so that the other methods are not held up.",
  "rank-ahead":
    "The smallest singular value of the scaled J falls to zero like a straight line before a pose where rows depend on each other.",
  "ill-conditioned":
    "Each factor of ten in the condition number of the saddle-point matrix costs one digit of the forces, and some of the accelerations.",
  "multipliers-grow":
    "Near a singular pose small accelerations of the gap need large forces, one over the smallest singular value.",
  "solver-fallback":
    "The order of elimination was fixed beforehand. Where one of its pivots vanishes, a rank-revealing solve answers instead.",
};

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../state/session.js").Session} actions
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
    const lines =
      now === 0 ? ["all methods start from the same closed pose"] : sentences(data, now);
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
    return h(
      "li",
      { class: method ? `slot-${method.slot}` : "" },
      h(
        "details",
        {},
        h(
          "summary",
          {},
          h("span", { class: "number when" }, seconds(incident.t)),
          h(
            "span",
            { class: "what" },
            `${method ? `${method.label}: ` : ""}${NAMES[incident.code] ?? incident.code}`,
          ),
          h("span", { class: "why-word" }, "Why?"),
        ),
        h("p", {}, sentenceOf(incident.message)),
        RULES[incident.code] ? h("p", { class: "rule" }, RULES[incident.code]) : "",
        tryButtons(incident.remedies.map(tryOfRemedy)),
      ),
    );
  }

  function showIncidents() {
    const kept = data.incidents.slice(-MOST_SHOWN);
    list.replaceChildren(...kept.map(incidentItem).reverse());
  }

  function addIncident() {
    list.prepend(incidentItem(data.incidents[data.incidents.length - 1]));
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

/** For the test: every incident code has words. */
export const INCIDENT_CODES = Object.keys(NAMES);
