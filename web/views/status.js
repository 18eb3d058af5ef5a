// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The last line: what runs, how the scene counts, how the stream fares.
import { listen } from "../state/store.js";
import { h, say } from "../widgets/dom.js";

const STREAM = {
  connecting: "stream: connecting",
  live: "stream live",
  reconnecting: "stream: reconnecting",
  hidden: "stream: paused while hidden",
  ended: "stream: run complete",
};

/** @param {HTMLElement} el @param {import("../state/store.js").Store} store */
export function createStatus(el, store) {
  const data = store.data;
  const run = h("span", { class: "run" });
  const scene = h("span", {});
  const stream = h("span", { class: "stream", role: "status" });
  const id = h("span", { class: "event-id number" }); // apart from the status, or it would be read out
  const notice = h("span", { class: "notice", role: "status" });
  const build = h("span", { class: "build" });
  el.replaceChildren(run, scene, h("span", {}, stream, id), notice, build);

  function showRun() {
    const n = data.methods.length;
    say(run, `${data.state} · ${n} method${n === 1 ? "" : "s"}`);
  }

  function showScene() {
    const { scene: s } = data;
    if (s) {
      const freedoms = `${s.freedoms} freedom${s.freedoms === 1 ? "" : "s"}`;
      say(scene, s.m > 0 ? `${freedoms} (${s.n} − ${s.rank})` : freedoms);
    }
  }

  function showStream() {
    const { state, id: last } = data.stream;
    say(stream, STREAM[state]);
    say(id, last && data.state !== "running" ? `at event ${last}` : "");
    stream.dataset.state = state;
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
    notice: () => say(notice, data.notice),
  });
  return {
    update() {},
    dispose() {
      stop();
      el.replaceChildren();
    },
  };
}
