// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Play, pause, step, back to the start, speed, loop, and the time with its scrubber.
import { plain, seconds } from "../state/format.js";
import { SPEEDS, stepSeconds } from "../session/speeds.js";
import { listen, shownIndex } from "../state/store.js";
import { h, icon, say, set } from "../widgets/dom.js";

/** Frames per key on the scrubber: a range whose step is "any" has no useful step of its own. */
const STEPS = {
  ArrowRight: 1,
  ArrowUp: 1,
  ArrowLeft: -1,
  ArrowDown: -1,
  PageUp: 30,
  PageDown: -30,
};

/**
 * The last frame of the run [s]: frames are whole steps apart, so it may lie a little after the
 * duration.
 * @param {import("../state/store.js").Data} data
 */
function endOf({ duration, frameDt }) {
  const frames = Math.ceil(duration / frameDt - 1e-9);
  return frameDt > 0 ? frames * frameDt : duration;
}

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createTransport(el, store, actions) {
  const data = store.data;
  const button = (name, label, action) =>
    h(
      "button",
      { type: "button", class: "tool", "aria-label": label, "data-tip": label, onclick: action },
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
  const loop = h(
    "button",
    {
      type: "button",
      class: "quiet loop",
      "aria-pressed": "false",
      "data-tip": "play the recording again and again",
      onclick: () => actions.toggleLoop(),
    },
    "loop",
  );
  const keep = h(
    "button",
    {
      type: "button",
      class: "quiet loop",
      "aria-pressed": "false",
      "data-tip": "keep this recording: its curves stay, dotted, beside those of the next run (K)",
      onclick: () => actions.toggleKept(),
    },
    "keep",
  );
  const sign = (text, label, action) =>
    h("button", { type: "button", class: "tool", "aria-label": label, onclick: action }, text);
  const slower = sign("−", "Slower (minus)", () => actions.slower());
  const faster = sign("+", "Faster (equals sign)", () => actions.faster());
  const speed = h(
    "select",
    {
      class: "number speed",
      id: "speed",
      "aria-label": "Speed",
      onchange: () => actions.setSpeed(Number(speed.value)),
    },
    ...SPEEDS.map((value) => h("option", { value }, `${plain(value)}×`)),
  );
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
    h("div", { class: "group pace" }, slower, speed, faster, loop, keep),
  );

  /** @param {KeyboardEvent} event */
  function onScrubKey(event) {
    const frames = STEPS[event.key];
    if (frames) {
      event.preventDefault();
      actions.show(shownIndex(data) + frames);
    }
  }

  function animate() {
    actions.setView({ stepped: false });
    actions.play();
    play.focus();
  }

  /** Returns what a press of Play does now. */
  function playWord() {
    if (data.state === "running" || data.view.replaying) {
      return "Pause";
    }
    if (data.view.stepped) {
      return `Step ${plain(stepSeconds(data.duration))} s`;
    }
    const atEnd = data.state === "finished" && data.view.shown < 0;
    return atEnd ? "Replay" : "Play";
  }

  function showState() {
    const word = playWord();
    if (play.dataset.word !== word) {
      play.dataset.word = word;
      play.replaceChildren(icon(word === "Pause" ? "pause" : "play"), h("span", {}, word));
    }
    motion.hidden = !data.view.stepped;
    speed.value = String(data.speed);
    set(loop, { "aria-pressed": String(data.view.loop) });
    set(keep, { "aria-pressed": String(data.kept !== null) });
    document.body.dataset.state = data.state;
  }

  /** The end of the run, to the digits that the time has; 10 s where they are zeros. */
  const endWords = () => `${plain(parseFloat(seconds(endOf(data), data.duration)))} s`;

  function update() {
    const history = data.history;
    if (!history || history.count === 0) {
      return;
    }
    showState();
    const t = history.t[shownIndex(data)];
    // the whole run is on the slider, so that the knob moves evenly
    set(scrub, {
      max: Math.max(history.t[history.count - 1], data.duration, 1e-9),
      "aria-valuetext": seconds(t, data.duration),
    });
    if (Number(scrub.value) !== t) {
      scrub.value = String(t);
    }
    const live = data.view.shown < 0 && data.latest ? data.latest.t : t;
    say(time, `t ${seconds(live, data.duration)} / ${endWords()}`);
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
