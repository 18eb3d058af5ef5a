// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Building with the mouse: a bar is drawn, a pin, a slider or a motor is put where one clicks.
// Every part is written into the document.
import { createPlaces } from "../../state/places.js";
import { addBar, addMotor, addPin, addSlider } from "../../state/scene-parts.js";
import { shownIndex } from "../../state/store.js";
import { h, s, set } from "../../widgets/dom.js";

const REACH = 18; // [px] to an end or a joint
const BAR_REACH = 8; // [px] to the line between the ends of a bar
const LEAST = 12; // [px] a shorter bar is a slip of the hand
const GRID = 0.1; // of the scale bar
const TOOLS = {
  bar: "press where it is held, on a part or on free ground; let go where it ends: on another part it is pinned there too",
  pin: "click where two parts meet, or where one is held by the ground",
  slider: "click a point of a part: it stays on a horizontal line",
  motor: "click a joint: a torque of 1 N·m turns it",
};

/**
 * @param {import("../../state/store.js").Data} data
 * @param {{stage: import("../drawing/stage.js").Stage, frame: HTMLElement, overlay: SVGElement}} drawing
 * @param {{change: (make: (scene: any) => any) => void, tell: (text: string) => void,
 *   begin: () => void}} editor
 */
export function createEditorTools(data, { stage, frame, overlay }, { change, tell, begin }) {
  let chosen = "";
  /** @type {{places: import("../../state/scene-parts.js").Place[], world: number[], x: number,
   *   y: number} | null} */
  let held = null;
  const line = s("path", { class: "new-part" });
  overlay.append(line);

  const buttons = Object.fromEntries(
    Object.entries(TOOLS).map(([name, tip]) => [
      name,
      h(
        "button",
        {
          type: "button",
          class: "quiet",
          "data-tip": tip,
          "aria-pressed": "false",
          onclick: () => choose(chosen === name ? "" : name),
        },
        name,
      ),
    ]),
  );
  const node = h(
    "div",
    { class: "choices", role: "group", "aria-label": "Add with the mouse" },
    ...Object.values(buttons),
  );

  /** @param {string} name of a tool, or "": none */
  function choose(name) {
    chosen = name;
    Object.entries(buttons).forEach(([key, button]) =>
      set(button, { "aria-pressed": String(key === name) }),
    );
    frame.classList.toggle("builds", name !== "");
    if (name) {
      const late = data.state === "running" || shownIndex(data) > 0;
      begin();
      tell(late ? `the motion is shown at its start again; ${TOOLS[name]}` : TOOLS[name]);
    }
  }

  /** @param {PointerEvent} event */
  function pixelOf(event) {
    const box = frame.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** The place of the world under a pixel; the camera of a plane scene looks from the front. */
  function worldAt(x, y) {
    const { camera } = stage;
    const [ox, oy] = camera.point([0, 0, 0], 0);
    return [(x - ox) / camera.scale, (oy - y) / camera.scale, 0];
  }

  const snapped = (world) => {
    const grid = GRID * stage.camera.scaleBar.metres;
    return world.map((c) => Math.round(c / grid) * grid);
  };

  /** @param {PointerEvent} event */
  function onDown(event) {
    if (!chosen || event.button !== 0 || !data.scene || data.scene.view?.spatial) {
      return;
    }
    if (/** @type {Element} */ (event.target).closest("button, input, a")) {
      return;
    }
    event.stopImmediatePropagation();
    event.preventDefault();
    if (data.state === "running" || shownIndex(data) > 0) {
      begin();
      tell("parts are added at the start of the motion: it is shown now, press again");
      return;
    }
    const [x, y] = pixelOf(event);
    const world = worldAt(x, y);
    if (chosen === "bar") {
      const near = placesAt(world);
      held = { places: near, world: near[0]?.world ?? snapped(world), x, y };
      frame.setPointerCapture(event.pointerId);
    } else {
      put(createPlaces(data.scene).near(world, REACH / stage.camera.scale), world);
    }
  }

  /** Returns where a bar is held: ends and joints first, then whatever place of a bar. */
  function placesAt(world) {
    const places = createPlaces(data.scene);
    return [
      ...places.near(world, REACH / stage.camera.scale),
      ...places.alongBars(world, BAR_REACH / stage.camera.scale),
    ];
  }

  /** A pin, a slider or a motor. @param {import("../../state/scene-parts.js").Place[]} near */
  function put(near, world) {
    const parts = near.filter(({ body }) => body >= 0);
    if (chosen === "motor") {
      const joint = createPlaces(data.scene).jointNear(world, REACH / stage.camera.scale);
      if (joint?.type === "revolute") {
        change((scene) => addMotor(scene, joint.name));
      } else {
        tell("no pin is here: click nearer to one");
      }
    } else if (!parts.length) {
      tell("no end of a part is here: click nearer to one");
    } else if (chosen === "slider") {
      change((scene) => addSlider(scene, parts[0]));
    } else {
      const ground = { body: -1, at: parts[0].world, world: parts[0].world };
      change((scene) => addPin(scene, parts[0], parts[1] ?? ground));
    }
  }

  /** @param {PointerEvent} event */
  function onMove(event) {
    if (held) {
      const [x, y] = pixelOf(event);
      const [ax, ay] = stage.camera.point(held.world, 0);
      set(line, { d: `M${ax.toFixed(1)} ${ay.toFixed(1)}L${x.toFixed(1)} ${y.toFixed(1)}` });
    }
  }

  /** @param {PointerEvent} event */
  function onUp(event) {
    if (!held) {
      return;
    }
    const from = held;
    held = null;
    set(line, { d: null });
    const [x, y] = pixelOf(event);
    if (Math.hypot(x - from.x, y - from.y) < LEAST) {
      tell("a bar is drawn: press where it begins, let go where it ends");
      return;
    }
    const world = worldAt(x, y);
    const places = createPlaces(data.scene);
    const start = from.places[0] ?? { body: -1, at: from.world, world: from.world };
    const end = placesAt(world).find(({ body }) => body !== start.body);
    change((scene) =>
      addBar(scene, start, end ?? null, end?.world ?? snapped(world), places.angleOf(start.body)),
    );
  }

  const cancel = () => {
    held = null;
    set(line, { d: null });
  };
  /** @type {[string, any][]} */
  const events = [
    ["pointerdown", onDown],
    ["pointermove", onMove],
    ["pointerup", onUp],
    ["pointercancel", cancel],
  ];
  events.forEach(([name, act]) => frame.addEventListener(name, act, { capture: true }));

  return {
    node,
    choose,
    dispose() {
      choose("");
      events.forEach(([name, act]) => frame.removeEventListener(name, act, { capture: true }));
      line.remove();
    },
  };
}
