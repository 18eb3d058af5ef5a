// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The scene's parameters (lengths, masses, gravity, start) in a drawer over the lower part of the
// drawing. Opening it moves nothing.
import { sentenceOf } from "../api/client.js";
import { parseQuantity, plain, prettyUnit } from "../state/format.js";
import { listen } from "../state/store.js";
import { createSliderField } from "../widgets/slider-field.js";
import { h, set } from "../widgets/dom.js";

const MOST_STARTS = 12; // coordinates that have a field of their own
const FARTHEST = 1e6; // [rad or m]
const WIDE = 1000; // a range over so many times its least value is better shown in decades

/**
 * @param {HTMLElement} el what the drawer lies over
 * @param {HTMLElement} place gets the button that opens it
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createParameters(el, place, store, actions) {
  const data = store.data;
  const list = h("div", { class: "parameters" });
  const reset = h(
    "button",
    {
      type: "button",
      class: "quiet",
      onclick: () => actions.resetParameters().catch((e) => actions.notice(sentenceOf(e))),
    },
    "reset all",
  );
  const close = h(
    "button",
    { type: "button", class: "tool small", "aria-label": "Close", onclick: () => toggle(false) },
    "×",
  );
  const drawer = h(
    "section",
    { class: "drawer", id: "parameters", "aria-label": "Parameters", hidden: true, onkeydown },
    h("div", { class: "card-head" }, h("h2", {}, "Parameters of the scene"), reset, close),
    list,
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "quiet open-parameters",
      "aria-expanded": "false",
      "aria-controls": "parameters",
      onclick: () => toggle(drawer.hidden),
    },
    "lengths, masses, start",
  );
  el.append(drawer);
  place.prepend(button);
  /** @type {Map<string, ReturnType<typeof createSliderField>>} */
  const fields = new Map();
  /** where coordinates start @type {typeof fields} */
  let starts = new Map();
  let scene = "";

  /** @param {boolean} open */
  function toggle(open) {
    drawer.hidden = !open;
    set(button, { "aria-expanded": String(open) });
    const first = /** @type {HTMLElement | null} */ (list.querySelector("input[type=text]"));
    (open ? first : button)?.focus({ preventScroll: true });
  }

  /** @param {KeyboardEvent} event */
  function onkeydown(event) {
    if (event.key === "Escape" && !(event.target instanceof HTMLInputElement)) {
      toggle(false);
    }
  }

  /** A coordinate of the start: set by number, as by dragging; the others follow. */
  function makeStart({ name, kind }) {
    const angle = kind === "angle";
    const most = Number((angle ? Math.PI : 2 * data.scene.length).toPrecision(3));
    const unit = angle ? "rad" : "m";
    return createSliderField({
      id: `start-${name}`,
      label: `${name}, where the motion starts`,
      unit,
      hint: `the other coordinates follow; ${angle ? "30 deg" : "45 cm"} is understood`,
      min: -most,
      max: most,
      read: (text) => parseQuantity(text, unit),
      check: (value) => (Math.abs(value) > FARTHEST ? { error: `${name} is too large` } : {}),
      commit: (value) => actions.setStart(name, value),
    });
  }

  /** The range of a parameter's slider; what has no bounds gets one round its value. */
  function rangeOf({ min, max, initial }) {
    const around = Math.max(1, 2 * Math.abs(initial));
    return Number.isFinite(min) && Number.isFinite(max) && min < max
      ? [min, max]
      : [Math.max(min ?? -around, -around), Math.min(max ?? around, around)];
  }

  /** @param {import("../state/store.js").Parameter} parameter */
  function makeField(parameter) {
    const { name, min, max, integer, about } = parameter;
    const unit = prettyUnit(parameter.unit);
    const [low, high] = rangeOf(parameter);
    const words = `${plain(low)} to ${plain(high)} ${unit}`.trim();
    const check = (value) => {
      if (value < min || value > max) {
        return { error: `${name} must be within ${words}` };
      }
      return integer && !Number.isInteger(value) ? { error: `${name} must be a whole number` } : {};
    };
    return createSliderField({
      id: `parameter-${name}`,
      label: about ? `${name}, ${about}` : name,
      unit,
      hint: words,
      scale: low > 0 && high / low >= WIDE && !integer ? "log" : "linear",
      min: low,
      max: high,
      step: integer ? 1 : undefined,
      read: (text) => parseQuantity(text, unit),
      check,
      commit: (value) => actions.setParameter(name, value),
    });
  }

  function show() {
    if (!data.scene) {
      return;
    }
    if (scene !== data.scene.id) {
      scene = data.scene.id;
      fields.forEach((field) => field.dispose());
      fields.clear();
      data.scene.parameters.forEach((one) => fields.set(one.name, makeField(one)));
      starts.forEach((field) => field.dispose());
      starts = new Map(
        data.scene.coordinates.slice(0, MOST_STARTS).map((one) => [one.name, makeStart(one)]),
      );
      list.replaceChildren(...[...fields.values(), ...starts.values()].map((field) => field.el));
    }
    data.scene.parameters.forEach(({ name, value }) => fields.get(name)?.update(value));
    data.scene.coordinates.forEach(({ name, value }) => starts.get(name)?.update(value));
  }

  const stop = listen(store, { scene: show });
  return {
    update() {},
    dispose() {
      stop();
      [...fields.values(), ...starts.values()].forEach((field) => field.dispose());
      drawer.remove();
      button.remove();
    },
  };
}
