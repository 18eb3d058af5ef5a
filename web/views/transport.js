// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Play, pause, step, back to the start, speed, and the time with its scrubber.
import { plain, seconds } from "../state/format.js";
import { stepSeconds } from "../session/speeds.js";
import { listen } from "../state/store.js";
import { h, icon, say, set } from "../widgets/dom.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createTransport(el, store, actions) {
  const data = store.data;
  const button = (name, label, action, kind = "tool") =>
    h(
      "button",
      { type: "button", class: kind, "aria-label": label, title: label, onclick: action },
      icon(name),
    );
  const start = button("start", "Back to the start (Backspace)", () => actions.reset());
  const back = button("back", "One frame back (left arrow)", () => actions.step(-1));
  const play = h("button", {
    type: "button",
    id: "play",
    class: "play",
    onclick: () => actions.toggle(),
  });
  const forward = button("forward", "One frame on (right arrow)", () => actions.step(1));
  const slower = h(
    "button",
    {
      type: "button",
      class: "tool",
      "aria-label": "Slower (minus)",
      onclick: () => actions.slower(),
    },
    "−",
  );
  const faster = h(
    "button",
    {
      type: "button",
      class: "tool",
      "aria-label": "Faster (equals sign)",
      onclick: () => actions.faster(),
    },
    "+",
  );
  const speed = h("output", { class: "number speed", "aria-label": "Speed" });
  const time = h("output", { class: "number time", "aria-label": "Time" });
  const scrub = h("input", {
    type: "range",
    id: "scrub",
    min: 0,
    max: 1,
    step: "any",
    value: 0,
    "aria-label": "Time shown",
    oninput: () => actions.showTime(Number(scrub.value)),
    // a range whose step is "any" has no useful arrow step of its own
    onkeydown: onScrubKey,
  });
  const motion = h(
    "button",
    { type: "button", class: "quiet motion", hidden: true, onclick: animate },
    "animate",
  );
  el.replaceChildren(
    h("div", { class: "group" }, start, back, play, forward, motion),
    h("div", { class: "group scrubber" }, scrub, time),
    h("div", { class: "group" }, h("span", { class: "word" }, "speed"), slower, speed, faster),
  );

  const STEPS = {
    ArrowRight: 1,
    ArrowUp: 1,
    ArrowLeft: -1,
    ArrowDown: -1,
    PageUp: 30,
    PageDown: -30,
  };

  /** @param {KeyboardEvent} event */
  function onScrubKey(event) {
    const frames = STEPS[event.key];
    if (frames) {
      event.preventDefault();
      const last = (data.history?.count ?? 1) - 1;
      actions.show((data.view.shown < 0 ? last : data.view.shown) + frames);
    }
  }

  function animate() {
    actions.setView({ stepped: false });
    actions.play();
    play.focus();
  }

  function showState() {
    const running = data.state === "running";
    const word = running
      ? "Pause"
      : data.state === "finished"
        ? "Again"
        : data.view.stepped
          ? `Step ${plain(stepSeconds(data.duration))} s`
          : "Play";
    if (play.dataset.word !== word) {
      play.dataset.word = word;
      play.replaceChildren(icon(running ? "pause" : "play"), h("span", {}, word));
    }
    motion.hidden = !data.view.stepped;
    say(speed, `${plain(data.speed)}×`);
    document.body.dataset.state = data.state;
  }

  function update() {
    const history = data.history;
    if (!history || history.count === 0) {
      return;
    }
    const last = history.count - 1;
    const shown = data.view.shown < 0 ? last : Math.min(data.view.shown, last);
    set(scrub, {
      max: Math.max(history.t[last], 1e-9),
      "aria-valuetext": seconds(history.t[shown], data.duration),
    });
    if (
      document.activeElement !== scrub ||
      data.state === "running" ||
      Number(scrub.value) !== history.t[shown]
    ) {
      scrub.value = String(history.t[shown]);
    }
    say(
      time,
      `t ${seconds(data.view.shown < 0 && data.latest ? data.latest.t : history.t[shown], data.duration)}`,
    );
  }

  const stop = listen(store, { state: showState, view: showState, scene: update });
  showState();
  return {
    update,
    dispose() {
      stop();
      el.replaceChildren();
    },
  };
}
