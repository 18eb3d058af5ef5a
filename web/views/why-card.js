// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The card that says why a method behaves as it does. It lies over the column of the methods, under
// the row that it belongs to, and moves nothing.
import { incidentOf } from "../state/catalogue.js";
import { cardOfMethod } from "../state/cards.js";
import { seconds } from "../state/format.js";
import { listen, shownIndex } from "../state/store.js";
import { sentenceCase } from "../state/words.js";
import { h } from "../widgets/dom.js";
import { explained } from "../widgets/term.js";
import { tryButtons } from "../widgets/tries.js";

const EDGE = 8; // [px] between the card and the edges of what it lies in
const LEAST = 200; // [px] of a card that is scrolled
const MOST_GROUPS = 4;

/**
 * Returns what a part that opens is called; times in it may have changed. @param {HTMLElement} fold
 */
const titleOf = (fold) => fold.querySelector("summary")?.textContent?.replace(/ at .*/, "") ?? "";

/**
 * @param {HTMLElement} el the column of the methods
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createWhyCard(el, store, actions) {
  const data = store.data;
  const holder = h("div", { class: "why-card", hidden: true, onkeydown: onKey });
  el.append(holder);
  const { attempt } = actions;
  let cardOf = -1;
  let madeFor = ""; // what the card speaks of

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    if (event.key === "Escape") {
      event.stopPropagation();
      close();
    }
  }

  const buttonOf = (m) => /** @type {HTMLElement[]} */ ([...el.querySelectorAll(".why")])[m];

  function close() {
    const button = buttonOf(data.view.why);
    actions.setView({ why: -1 });
    button?.focus({ preventScroll: true });
  }

  /** Incidents of the method, one line for each cause. */
  function incidentLines(groups) {
    const lines = groups.slice(0, MOST_GROUPS).map(({ count, first, newest }) => {
      const name = incidentOf(newest.code)?.name ?? newest.code;
      const times = count > 1 ? `, ${count} times, first at` : " at";
      return h("li", {}, ...explained(`${name}${times} ${seconds(first, data.duration)}`));
    });
    return lines.length ? [h("ul", { class: "reasons" }, ...lines)] : [];
  }

  /**
   * A part of the card that opens on a click.
   * @param {string} title
   * @param {string} text
   * @param {{open?: boolean, more?: Node | string}} [how]
   */
  function fold(title, text, { open = false, more = "" } = {}) {
    const summary = h("summary", {}, title);
    const words = h("p", {}, ...explained(text));
    const part = h("details", { class: "fold", open }, summary, words, more);
    let wasOpen = open;
    part.addEventListener("toggle", () => {
      if (part.open !== wasOpen) {
        wasOpen = part.open; // one that opens with the card is told as well
        place(data.view.why);
        part.scrollIntoView({ block: "nearest" });
      }
    });
    return part;
  }

  function makeCard(m) {
    const card = cardOfMethod(data, m, shownIndex(data));
    const closeButton = h(
      "button",
      { type: "button", class: "tool small", "aria-label": "Close", onclick: close },
      "×",
    );
    const tries = [...card.remedies, ...card.tries];
    return h(
      "section",
      {
        class: `card slot-${data.methods[m].slot}`,
        tabindex: "-1",
        "aria-label": `Why: ${card.title}`,
      },
      h("div", { class: "card-head" }, h("h3", {}, `${card.label}: why?`), closeButton),
      h("p", { class: "sentence verdict", "data-tone": card.verdict.tone }, card.verdict.words),
      h("p", { class: "happened" }, ...explained(card.happened)),
      card.singular ? h("p", {}, ...explained(card.singular)) : "",
      ...incidentLines(card.groups),
      h("p", { class: "rule" }, ...explained(card.rule)),
      tryButtons(tries, attempt),
      card.deadPoint
        ? fold(`${card.deadPoint.title}: what happens?`, card.deadPoint.words, {
            open: card.deadPoint.isNear,
            more: tryButtons(card.deadPoint.tries, attempt),
          })
        : "",
      card.drift ? fold("How gap and energy drift", sentenceCase(card.drift)) : "",
      card.figures ? fold("Cost of a step, and the error as estimated", card.figures) : "",
    );
  }

  /**
   * Under the row, or above it where more room is there; never beyond the window, nor over the
   * buttons above the list: what is longer is scrolled.
   */
  function place(m) {
    const row = /** @type {HTMLElement} */ (buttonOf(m)?.closest("tr"));
    const home = el.getBoundingClientRect();
    const at = row.getBoundingClientRect();
    const lowest = Math.min(home.bottom, innerHeight - EDGE);
    const highest = el.querySelector(".title")?.getBoundingClientRect().bottom ?? home.top;
    holder.style.maxHeight = `${Math.max(LEAST, lowest - highest)}px`;
    const height = holder.offsetHeight;
    const below = at.bottom + height <= lowest;
    const top = below ? at.bottom : Math.max(highest, lowest - height);
    holder.style.top = `${top - home.top}px`;
  }

  const isMoving = () => data.state === "running" || data.view.replaying;
  const shownNow = () => `${shownIndex(data)} ${data.reference?.state} ${data.incidents.length}`;

  /** The card anew, with what was open and where it was scrolled to; the focus stays in it. */
  function remake() {
    const folds = () =>
      /** @type {HTMLDetailsElement[]} */ ([...holder.querySelectorAll("details")]);
    const open = new Set(folds().flatMap((fold) => (fold.open ? [titleOf(fold)] : [])));
    const { scrollTop } = holder;
    const wasFocused = holder.contains(document.activeElement);
    madeFor = shownNow();
    holder.replaceChildren(makeCard(cardOf));
    folds().forEach((fold) => (fold.open ||= open.has(titleOf(fold))));
    place(cardOf);
    holder.scrollTop = scrollTop;
    if (wasFocused) {
      /** @type {HTMLElement} */ (holder.firstElementChild).focus({ preventScroll: true });
    }
  }

  /** Fits the card to the frame that is shown; while it moves, nobody could read along. */
  function follow() {
    const isOpen = cardOf >= 0 && data.methods[cardOf] && shownIndex(data) >= 0;
    const isUsed = holder.querySelector("button:focus-visible, summary:focus-visible") !== null;
    if (isOpen && !isMoving() && !isUsed && madeFor !== shownNow()) {
      remake();
    }
  }

  function show() {
    const m = data.view.why;
    if (m < 0 || !data.methods[m] || shownIndex(data) < 0) {
      holder.hidden = true;
      holder.replaceChildren();
      cardOf = -1;
      return;
    }
    if (cardOf !== m) {
      cardOf = m;
      madeFor = shownNow();
      holder.replaceChildren(makeCard(m));
      holder.hidden = false;
      buttonOf(m)?.closest("tr")?.scrollIntoView({ block: "nearest" });
      place(m);
      /** @type {HTMLElement} */ (holder.firstElementChild).focus({ preventScroll: true });
    }
  }

  const stop = listen(store, {
    methods: () => {
      cardOf = -1;
      show();
    },
    view: show,
    state: follow,
    reference: follow,
  });
  return {
    update: follow,
    dispose() {
      stop();
      holder.remove();
    },
  };
}
