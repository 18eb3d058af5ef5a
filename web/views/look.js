// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Buttons that say where a mechanism in space is seen from, turning by dragging the drawing, and a
// triad of the world's axes. Plane mechanisms have no use for any of it.
import { FRONT, anglesOf, lookFrom, lookOf } from "../state/look.js";
import { listen } from "../state/store.js";
import { h, s, set } from "../widgets/dom.js";

const TURN = 0.008; // [rad/px]
const TRIAD = { size: 72, length: 22 }; // [px]
/** @type {[string, (scene: any) => import("../state/look.js").Look][]} */
const NAMED = [
  ["front", (scene) => lookFrom(0, 0, scene?.view?.vertical)],
  ["side", (scene) => lookFrom(Math.PI / 2, 0, scene?.view?.vertical)],
  ["top", (scene) => lookFrom(0, Math.PI / 2, scene?.view?.vertical)],
  ["space", (scene) => scene?.view ?? FRONT],
];

/**
 * @param {HTMLElement} el with a drawing: `.stage` is what is dragged, `.under` takes the buttons
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createLook(el, store, actions) {
  const data = store.data;
  const stage = /** @type {HTMLElement} */ (el.querySelector(".stage"));
  const vertical = () => data.scene?.view?.vertical;
  const isSpatial = () => Boolean(data.scene?.view?.spatial);
  const buttons = NAMED.map(([name, make]) =>
    h(
      "button",
      {
        type: "button",
        class: "quiet",
        onclick: () => actions.setView({ look: make(data.scene) }),
      },
      name,
    ),
  );
  const group = h(
    "div",
    { class: "choices looks", role: "group", "aria-label": "Look from", hidden: true },
    ...buttons,
  );
  const triad = s("svg", {
    class: "triad",
    viewBox: `0 0 ${TRIAD.size} ${TRIAD.size}`,
    "aria-hidden": "true",
  });
  el.querySelector(".under")?.append(group);
  stage.append(triad);

  /** @type {{x: number, y: number, angles: [number, number]} | null} */
  let drag = null;
  const letGo = () => {
    drag = null;
  };

  /** @param {PointerEvent} event */
  function grab(event) {
    if (isSpatial() && event.button === 0) {
      drag = { x: event.clientX, y: event.clientY, angles: anglesOf(lookOf(data), vertical()) };
      stage.setPointerCapture(event.pointerId);
    }
  }

  /** @param {PointerEvent} event */
  function turn(event) {
    if (drag) {
      const azimuth = drag.angles[0] - TURN * (event.clientX - drag.x);
      const elevation = drag.angles[1] + TURN * (event.clientY - drag.y);
      const steepest = Math.PI / 2;
      actions.setView({
        look: lookFrom(azimuth, Math.max(-steepest, Math.min(steepest, elevation)), vertical()),
      });
    }
  }

  const events = { pointerdown: grab, pointermove: turn, pointerup: letGo, pointercancel: letGo };
  for (const [name, act] of Object.entries(events)) {
    stage.addEventListener(name, /** @type {EventListener} */ (act));
  }

  function drawTriad() {
    const { right, up } = lookOf(data);
    const middle = TRIAD.size / 2;
    triad.replaceChildren(
      ...["x", "y", "z"].flatMap((name, i) => {
        const [dx, dy] = [TRIAD.length * right[i], -TRIAD.length * up[i]];
        if (Math.hypot(dx, dy) < 3) {
          return []; // seen end on
        }
        const place = { x: middle + 1.4 * dx, y: middle + 1.4 * dy + 4, "text-anchor": "middle" };
        return [
          s("path", { d: `M${middle} ${middle}l${dx.toFixed(2)} ${dy.toFixed(2)}` }),
          s("text", place, name),
        ];
      }),
    );
  }

  function show() {
    const spatial = isSpatial();
    group.hidden = !spatial;
    triad.style.display = spatial ? "" : "none";
    stage.classList.toggle("turns", spatial);
    if (!spatial) {
      return;
    }
    drawTriad();
    const [azimuth, elevation] = anglesOf(lookOf(data), vertical());
    NAMED.forEach(([, make], i) => {
      const [a, e] = anglesOf(make(data.scene), vertical());
      const pressed = Math.abs(a - azimuth) + Math.abs(e - elevation) < 1e-6;
      set(buttons[i], { "aria-pressed": String(pressed) });
    });
  }

  let id = data.scene?.id;
  const stop = listen(store, {
    scene: () => {
      if (id !== data.scene?.id) {
        id = data.scene?.id;
        actions.setView({ look: null, space: null });
      }
      show();
    },
    view: show,
  });
  return {
    update() {},
    dispose() {
      stop();
      for (const [name, act] of Object.entries(events)) {
        stage.removeEventListener(name, /** @type {EventListener} */ (act));
      }
      group.remove();
      triad.remove();
    },
  };
}
