// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The clock of the picture. Frames come as the server sends them; while the mechanism moves, the
// picture goes on evenly between them, so that it moves in slow motion too. The picture at rest is
// always a frame.
import { listen, shownIndex } from "../../state/store.js";

const BEHIND = 2; // frames at most that the picture follows the newest one by
const LONGEST = 100; // [ms] between two pictures that count: then nobody saw them

/**
 * @param {import("../../state/store.js").Store} store
 * @param {(place: number) => void} draw place: among the kept frames, with its fraction
 */
export function createMotion(store, draw) {
  const data = store.data;
  let timer = 0;
  let last = 0; // [ms] the picture before
  let time = NaN; // [s] of the picture, while it follows the newest frame

  const follows = () => data.state === "running" && data.view.shown < 0;
  const moves = () => follows() || data.view.replaying;

  /** The time of the next picture, so many milliseconds later. @param {number} spent */
  function goOn(spent) {
    const { t, count } = data.history;
    const newest = t[count - 1];
    const earliest = t[Math.max(0, count - 1 - BEHIND)];
    // it sets out from where it stands, and waits for frames that are late
    const next = Number.isNaN(time) ? newest : time + (spent / 1000) * data.speed;
    time = Math.min(newest, Math.max(earliest, next));
  }

  /** Returns where the picture is among the kept frames. */
  function place() {
    const { history, view } = data;
    const now = shownIndex(data);
    if (now < 0 || !moves()) {
      return now;
    }
    return history.placeAt(
      view.replaying ? view.moment : Number.isNaN(time) ? history.t[now] : time,
    );
  }

  /** @param {number} now [ms] */
  function tick(now) {
    timer = moves() ? requestAnimationFrame(tick) : 0;
    if (follows() && data.history?.count > 0) {
      goOn(Math.min(LONGEST, Math.max(0, now - last)));
    }
    last = now;
    draw(place());
  }

  /** Begins to move, or stops: a picture after it shows the frame that it stands at. */
  function look() {
    time = follows() ? time : NaN;
    if (moves() && !timer) {
      last = performance.now();
      timer = requestAnimationFrame(tick);
    }
  }

  const stop = listen(store, {
    scene: () => {
      time = NaN;
      look();
    },
    state: look,
    frame: look,
  });
  return {
    place,
    /** Does the next picture come by itself? */
    moves: () => timer !== 0 && moves(),
    dispose() {
      stop();
      cancelAnimationFrame(timer);
    },
  };
}
