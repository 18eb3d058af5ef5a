// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Actions of the clock: play, pause, step, scrub, speed. What was received once is a recording: it
// is played again from where the scrubber stands, and nothing is computed a second time.
import { SPEEDS, stepSeconds } from "./speeds.js";

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 */
export function createPlayback(store, exchange) {
  const data = store.data;
  /** the speed that was asked for and not answered yet, or 0: quick presses count from it */
  let asked = 0;
  /** the recording while it plays: time shown [s], and when that was [ms] */
  let replay = { t: 0, at: 0, timer: 0 };
  const wantedSpeed = () => asked || data.speed;
  const lastIndex = () => (data.history?.count ?? 0) - 1;
  const shownNow = () => (data.view.shown < 0 ? lastIndex() : data.view.shown);
  const framesOf = (seconds) => Math.max(1, Math.round(seconds / data.frameDt));

  /** @param {boolean} on */
  function setReplaying(on) {
    cancelAnimationFrame(replay.timer);
    if (data.view.replaying !== on) {
      data.view.replaying = on;
      store.emit("state");
    }
  }

  /** Handles that change the start would lie over a mechanism that moves. */
  function putHandlesAway() {
    if (data.view.lengths) {
      data.view.lengths = false;
      store.emit("view");
    }
  }

  /** Plays the recording from an index. @param {number} from */
  function startReplay(from) {
    data.view.shown = from;
    replay.t = data.history.t[from];
    replay.at = performance.now();
    data.view.moment = replay.t;
    setReplaying(true);
    replay.timer = requestAnimationFrame(tick);
    store.emit("frame");
  }

  /** The end of the recording: again from the start, or on with the computation, or a stop. */
  function endReplay() {
    if (data.view.loop && data.state === "finished") {
      startReplay(0);
      return;
    }
    data.view.shown = -1;
    setReplaying(false);
    store.emit("frame");
    if (data.state === "paused" && !data.view.stepped) {
      exchange.changeOrReport({ state: "running" });
    }
  }

  /** @param {number} time [ms] */
  function tick(time) {
    const { history, view } = data;
    if (!view.replaying) {
      return;
    }
    replay.t += (Math.max(0, time - replay.at) / 1000) * wantedSpeed();
    replay.at = time;
    view.moment = replay.t;
    const last = lastIndex();
    if (replay.t >= history.t[last]) {
      endReplay();
      return;
    }
    const index = history.indexAt(replay.t);
    if (index !== view.shown) {
      view.shown = Math.min(index, last);
      store.emit("frame");
    }
    replay.timer = requestAnimationFrame(tick);
  }

  const actions = {
    /** Plays from the frame shown: first the recording, then what is computed from then on. */
    play() {
      putHandlesAway();
      const finished = data.state === "finished";
      const behind = data.view.shown >= 0 && data.view.shown < lastIndex();
      if (data.view.stepped && finished && !behind) {
        actions.show(0);
        return Promise.resolve();
      }
      if (data.view.stepped) {
        return actions.step(framesOf(stepSeconds(data.duration)));
      }
      if (behind || finished) {
        startReplay(behind ? data.view.shown : 0);
        return Promise.resolve();
      }
      return exchange.changeOrReport({ state: "running" });
    },
    pause() {
      setReplaying(false);
      return data.state === "running"
        ? exchange.changeOrReport({ state: "paused" })
        : Promise.resolve();
    },
    toggle: () =>
      data.state === "running" || data.view.replaying ? actions.pause() : actions.play(),
    /**
     * Moves through the frames that were received, then asks for more.
     * @param {number} frames
     */
    step(frames) {
      const shown = shownNow();
      if (data.state === "running" || data.view.replaying) {
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
      replay.t = data.history?.t[shownNow()] ?? 0;
      store.emit("frame");
    },
    /** Shows the kept frame nearest to a time. @param {number} t [s] */
    async showTime(t) {
      if (data.state === "running" || data.view.replaying) {
        await actions.pause();
      }
      if (data.history) {
        actions.show(data.history.indexAt(t));
      }
    },
    /** Back to the start of the recording. */
    async reset() {
      await actions.pause();
      actions.show(0);
    },
    /** Handles that change lengths: lengths are those of the start, so that is shown. */
    async toggleLengths() {
      const lengths = !data.view.lengths;
      if (lengths) {
        await actions.reset();
      }
      data.view.lengths = lengths;
      store.emit("view");
    },
    /** Plays the recording again and again. */
    toggleLoop() {
      data.view.loop = !data.view.loop;
      store.emit("state");
    },
    /** Keeps this recording beside the next ones, or lets the kept one go. */
    toggleKept() {
      const { kept, scene, methods, history } = data;
      data.kept = kept || !scene ? null : { scene: scene.id, methods, history };
      store.emit("view");
      store.emit("state");
    },
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
    /** The recording that played belongs to another run. */
    stopReplay: () => setReplaying(false),
  };

  store.on("scene", actions.stopReplay);
  return actions;
}
