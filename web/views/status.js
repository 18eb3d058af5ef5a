// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Words of the page about itself: notices in a note over the transport, the state of the stream
// beside it when it is not live, the rest in the last line of the page.
import { listen } from "../state/store.js";
import { h, say } from "../widgets/dom.js";

const STREAM = {
  connecting: "stream: connecting",
  live: "stream live",
  reconnecting: "connection to the server lost: reconnecting",
  hidden: "stream: paused while hidden",
  ended: "stream: the run is complete",
};
const LOST =
  "The server does not answer. The data received so far stays here; " +
  "the page goes on by itself when the server is back.";
const LOST_AFTER = 700; // [ms] that a short drop is not worth a word
const SHOWN_FOR = 9000; // [ms]

/**
 * @param {HTMLElement} el
 * @param {HTMLElement} body
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createStatus(el, body, store, actions) {
  const data = store.data;
  const run = h("span", { class: "run" });
  const scene = h("span", {});
  const stream = h("span", { class: "stream", role: "status" });
  const id = h("span", { class: "event-id number" }); // outside the status, or it is read out
  const build = h("span", { class: "build" });
  el.replaceChildren(run, scene, h("span", {}, stream, id), build);

  const notice = h("span", { class: "notice", role: "status" });
  const close = h(
    "button",
    { type: "button", class: "tool small", "aria-label": "Dismiss", onclick: hide },
    "×",
  );
  const note = h("div", { class: "note", hidden: true }, notice, close);
  const lost = h("div", { class: "lost", hidden: true }, LOST);
  const offer = h(
    "div",
    { class: "note offer", hidden: true },
    h(
      "button",
      {
        type: "button",
        class: "plain",
        title: "what this browser showed when the page was closed",
        onclick: actions.continueLast,
      },
      "continue the last session",
    ),
    h(
      "button",
      { type: "button", class: "tool small", "aria-label": "Dismiss", onclick: actions.endOffer },
      "×",
    ),
  );
  body.append(
    h("div", { class: "notes", role: "region", "aria-label": "Notices" }, lost, offer, note),
  );
  let timer = 0;
  let lostTimer = 0;

  function hide() {
    clearTimeout(timer);
    note.hidden = true;
  }

  function showNotice() {
    say(notice, data.notice);
    note.hidden = data.notice === "";
    clearTimeout(timer);
    timer = window.setTimeout(hide, SHOWN_FOR);
  }

  function showRun() {
    const n = data.methods.length;
    say(run, `${data.state} · ${n} method${n === 1 ? "" : "s"}`);
  }

  function showScene() {
    const { scene: s } = data;
    if (s) {
      const freedoms = `${s.dof} degree${s.dof === 1 ? "" : "s"} of freedom`;
      say(scene, s.m > 0 ? `${freedoms} (${s.n} − ${s.rank})` : freedoms);
    }
  }

  function showStream() {
    const { state, id: last } = data.stream;
    say(stream, STREAM[state]);
    say(id, last && data.state !== "running" ? `, event ${last}` : "");
    stream.dataset.state = state;
    if (state !== "reconnecting") {
      clearTimeout(lostTimer);
      lostTimer = 0;
      lost.hidden = true;
    } else if (!lostTimer) {
      lostTimer = window.setTimeout(() => (lost.hidden = false), LOST_AFTER);
    }
  }

  const stop = listen(store, {
    ready: () => say(build, data.build ? `build ${data.build}` : ""),
    state: () => {
      showRun();
      showStream();
    },
    methods: showRun,
    scene: showScene,
    stream: showStream,
    notice: showNotice,
    offer: () => (offer.hidden = data.offer === ""),
  });
  return {
    update() {},
    dispose() {
      stop();
      hide();
      el.replaceChildren();
    },
  };
}
