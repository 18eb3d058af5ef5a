// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Actions of the clock: play, pause, step, scrub, speed.
import { SPEEDS, stepSeconds } from "./speeds.js";

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 */
export function createPlayback(store, exchange) {
  const data = store.data;
  /** the speed that was asked for and not answered yet, or 0: quick presses count from it */
  let asked = 0;
  const wantedSpeed = () => asked || data.speed;
  const lastIndex = () => (data.history?.count ?? 0) - 1;

  const actions = {
    play() {
      data.view.shown = -1;
      if (data.view.stepped && data.state !== "finished") {
        return actions.step(Math.max(1, Math.round(stepSeconds(data.duration) / data.frameDt)));
      }
      return exchange.changeOrReport(
        data.state === "finished"
          ? { reset: true, state: data.view.stepped ? "paused" : "running" }
          : { state: "running" },
      );
    },
    pause: () => exchange.changeOrReport({ state: "paused" }),
    toggle: () => (data.state === "running" ? actions.pause() : actions.play()),
    /**
     * Moves through the frames that were received, then asks for more.
     * @param {number} frames
     */
    step(frames) {
      const shown = data.view.shown < 0 ? lastIndex() : data.view.shown;
      if (data.state === "running") {
        return actions.pause();
      }
      if (frames < 0 || shown < lastIndex()) {
        actions.show(shown + frames);
        return Promise.resolve();
      }
      return data.state === "finished"
        ? Promise.resolve()
        : exchange.changeOrReport({ step: frames });
    },
    /** Shows a kept frame. @param {number} index */
    show(index) {
      data.view.shown = index >= lastIndex() ? -1 : Math.max(0, index);
      store.emit("frame");
    },
    /** Shows the kept frame nearest to a time. @param {number} t [s] */
    async showTime(t) {
      if (data.state === "running") {
        await actions.pause();
      }
      if (data.history) {
        actions.show(data.history.indexAt(t));
      }
    },
    reset: () => exchange.changeOrReport({ reset: true, state: "paused" }),
    slower: () =>
      actions.setSpeed([...SPEEDS].reverse().find((speed) => speed < wantedSpeed()) ?? SPEEDS[0]),
    faster: () =>
      actions.setSpeed(SPEEDS.find((speed) => speed > wantedSpeed()) ?? SPEEDS[SPEEDS.length - 1]),
    /** @param {number} speed */
    async setSpeed(speed) {
      asked = speed;
      await exchange.changeOrReport({ speed });
      asked = asked === speed ? 0 : asked;
    },
  };
  return actions;
}
