// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Moving through space: wheel and pinch zoom, the right button, Shift or two fingers
// move, keys do all of it; buttons for perspective, frames and following. Turning by dragging is
// the drawing's own.
import { anglesOf, lookFrom, lookOf } from "../../state/look.js";
import { h, set } from "../../widgets/dom.js";

const WHEEL = 0.0015; // [1/px]
const TURN = Math.PI / 24; // [rad] a key
const STEP = 30; // [px] a key
const CLOSER = 1.2; // a key
const STEEPEST = Math.PI / 2;
const KEYS =
  "arrow keys turn, Shift with arrows moves, plus and minus zoom, 0 fits, P perspective, F follows";

/**
 * @param {HTMLElement} frame
 * @param {import("./rig.js").Rig} rig
 * @param {import("../../state/store.js").Data} data
 * @param {import("../../session/session.js").Session} actions
 * @param {{refit: () => void, frames: () => boolean, showFrames: (on: boolean) => void}} view
 */
export function createTools(frame, rig, data, actions, { refit, frames, showFrames }) {
  const vertical = () => data.scene?.view?.vertical;

  const toggles = {
    perspective: make("perspective", "nearer things look larger (P)", () => setPerspective()),
    frames: make("frames", "the axes of every body: x red, y green, z blue", () => {
      showFrames(!frames());
    }),
    follow: make("follow", "keeps the traced point at its place in the picture (F)", () => {
      rig.setFollow(!rig.follow);
    }),
  };
  const fit = h(
    "button",
    { type: "button", class: "quiet", "data-tip": "all of the motion (0)", onclick: fitAgain },
    "fit",
  );
  const bar = h(
    "div",
    { class: "choices space-tools", role: "group", "aria-label": "View in space" },
    ...Object.values(toggles),
    fit,
  );
  frame.append(bar);
  frame.tabIndex = 0;
  set(frame, { role: "group", "aria-label": `Mechanism in space: ${KEYS}` });

  function make(word, tip, act) {
    return h(
      "button",
      {
        type: "button",
        class: "quiet",
        "data-tip": tip,
        "aria-pressed": "false",
        onclick: () => {
          act();
          update();
          refit();
        },
      },
      word,
    );
  }

  function update() {
    set(toggles.perspective, { "aria-pressed": String(rig.perspective) });
    set(toggles.frames, { "aria-pressed": String(frames()) });
    set(toggles.follow, { "aria-pressed": String(rig.follow) });
  }

  function setPerspective() {
    rig.setPerspective(!rig.perspective);
  }

  function fitAgain() {
    rig.fit();
    refit();
  }

  /** @param {number} azimuth [rad] @param {number} elevation [rad] */
  function turn(azimuth, elevation) {
    const [a, e] = anglesOf(lookOf(data), vertical());
    const steep = Math.max(-STEEPEST, Math.min(STEEPEST, e + elevation));
    actions.setView({ look: lookFrom(a + azimuth, steep, vertical()) });
  }

  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const others = {
    "+": () => rig.zoomBy(CLOSER),
    "=": () => rig.zoomBy(CLOSER),
    "-": () => rig.zoomBy(1 / CLOSER),
    0: () => rig.fit(),
    p: setPerspective,
    f: () => rig.setFollow(!rig.follow),
  };

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    const arrow = arrows[event.key];
    const other = others[event.key.toLowerCase()];
    const own = event.target === frame && !event.ctrlKey && !event.metaKey && !event.altKey;
    if (!own || bar.hidden || (!arrow && !other)) {
      return;
    }
    event.preventDefault();
    if (other) {
      other();
    } else if (event.shiftKey) {
      rig.pan(STEP * arrow[0], -STEP * arrow[1]);
    } else {
      turn(TURN * arrow[0], TURN * arrow[1]);
    }
    update();
    refit();
  }

  /** @param {WheelEvent} event */
  function onWheel(event) {
    if (!bar.hidden) {
      event.preventDefault();
      rig.zoomBy(Math.exp(-WHEEL * event.deltaY));
      refit();
    }
  }

  /** Fingers and buttons that are down, by id. @type {Map<number, {x: number, y: number}>} */
  const down = new Map();
  let moves = false;
  const spread = () => {
    const [a, b] = [...down.values()];
    return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  const middle = () => {
    const all = [...down.values()];
    return {
      x: all.reduce((sum, { x }) => sum + x, 0) / all.length,
      y: all.reduce((sum, { y }) => sum + y, 0) / all.length,
    };
  };

  /** @param {PointerEvent} event */
  function onDown(event) {
    if (bar.hidden || /** @type {Element} */ (event.target).closest("button, input")) {
      return;
    }
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    moves = event.button === 2 || event.shiftKey || down.size === 2;
    if (moves) {
      event.stopImmediatePropagation();
      event.preventDefault();
      frame.setPointerCapture(event.pointerId);
    }
  }

  /** @param {PointerEvent} event */
  function onMove(event) {
    if (!moves || !down.has(event.pointerId)) {
      return;
    }
    event.stopImmediatePropagation();
    const [before, wide] = [middle(), spread()];
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const after = middle();
    rig.pan(after.x - before.x, after.y - before.y);
    if (wide > 0) {
      rig.zoomBy(spread() / wide);
    }
    refit();
  }

  /** @param {PointerEvent} event */
  function onUp(event) {
    down.delete(event.pointerId);
    moves &&= down.size > 0;
  }

  const noMenu = (event) => !bar.hidden && event.preventDefault();
  /** @type {[string, any, AddEventListenerOptions][]} */
  const events = [
    ["keydown", onKey, {}],
    ["wheel", onWheel, { passive: false }],
    ["pointerdown", onDown, { capture: true }],
    ["pointermove", onMove, { capture: true }],
    ["pointerup", onUp, { capture: true }],
    ["pointercancel", onUp, { capture: true }],
    ["contextmenu", noMenu, {}],
  ];
  events.forEach(([name, act, how]) => frame.addEventListener(name, act, how));
  update();

  return {
    update,
    /** @param {boolean} on */
    show(on) {
      bar.hidden = !on;
      frame.tabIndex = on ? 0 : -1;
      set(frame, {
        role: on ? "group" : null,
        "aria-label": on ? `Mechanism in space: ${KEYS}` : null,
      });
    },
    dispose() {
      events.forEach(([name, act, how]) => frame.removeEventListener(name, act, how));
      bar.remove();
    },
  };
}
