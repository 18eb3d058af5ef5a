// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The first minute as a card above the drawing: five steps, each done by the page's own buttons or
// by the one on the card. It is shown until it is closed, and the browser remembers that.
import { sentenceOf } from "../api/client.js";
import { ELSEWHERE, GUIDED, STEPS } from "../state/guide.js";
import { listen } from "../state/store.js";
import { h, say } from "../widgets/dom.js";

const KEY = "holonom-guide";

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {{openStudy: (kind: string) => void}} open
 */
export function createGuide(store, actions, open) {
  const data = store.data;
  let step = 0;
  const count = h("span", { class: "count" });
  const title = h("h2", {});
  const text = h("p", {});
  const act = h("button", { type: "button", class: "try", onclick: carryOut });
  const back = h("button", { type: "button", class: "quiet", onclick: () => go(step - 1) }, "back");
  const next = h("button", { type: "button", class: "quiet", onclick: () => go(step + 1) });
  const close = h(
    "button",
    { type: "button", class: "tool small", "aria-label": "Close the guide", onclick: hide },
    "×",
  );
  const card = h(
    "section",
    { class: "guide", "aria-label": "First minute", hidden: true },
    h("div", { class: "card-head" }, title, count, close),
    text,
    h("div", { class: "guide-steps" }, act, back, next),
  );

  /** @type {Record<string, () => any>} */
  const DOES = {
    toggle: () => actions.toggle(),
    fallApart: () => actions.fallApart(),
    askWhy: () =>
      actions.setView({
        why: Math.max(
          0,
          data.methods.findIndex(({ formulation }) => formulation === "index1"),
        ),
      }),
    holdTogether: () => actions.holdTogether(),
    study: () => open.openStudy("work-precision"),
    open: () => actions.loadScene(GUIDED).catch((error) => actions.notice(sentenceOf(error))),
  };
  const isElsewhere = () => data.scene?.id !== GUIDED || data.document !== null;
  const present = () => (isElsewhere() ? ELSEWHERE : STEPS[step]);

  function carryOut() {
    DOES[present().does]();
  }

  /** @param {number} wanted */
  function go(wanted) {
    if (wanted >= STEPS.length) {
      hide();
      return;
    }
    step = Math.max(0, wanted);
    show();
  }

  function show() {
    const { title: heading, text: words } = present();
    say(title, heading);
    say(text, words);
    say(count, isElsewhere() ? "" : `${step + 1}/${STEPS.length}`);
    say(next, step === STEPS.length - 1 ? "done" : "next");
    next.hidden = isElsewhere();
    back.hidden = step === 0 || isElsewhere();
    check();
  }

  /** A step that was carried out says so, and what plays can be paused; the reader goes on. */
  function check() {
    const { does, button } = present();
    const plays = data.state === "running" || data.view.replaying;
    say(act, does === "toggle" && plays ? "Pause" : button);
    next.classList.toggle("primary", !card.hidden && present().done(data));
  }

  function hide() {
    card.hidden = true;
    localStorage.setItem(KEY, "closed");
    document.getElementById("play")?.focus({ preventScroll: true });
  }

  listen(store, { frame: check, state: check, view: check, methods: check, scene: show });
  return {
    /** Puts the card where it belongs; it opens by itself only the first time. */
    begin(/** @type {HTMLElement} */ el) {
      el.prepend(card);
      if (localStorage.getItem(KEY) !== "closed" && !isElsewhere()) {
        card.hidden = false;
        show();
      }
    },
    open() {
      card.hidden = false;
      actions.setView({ panel: "" }); // beside it there is no room for the card
      go(0);
      title.tabIndex = -1;
      title.focus({ preventScroll: true });
    },
  };
}
