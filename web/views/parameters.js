// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The scene's parameters (lengths, masses, gravity, start) in a drawer: over the column of methods,
// so that the mechanism stays in sight, or over the lower part of the drawing where there is one
// column. Opening it moves nothing.
import { sentenceOf } from "../api/client.js";
import { parseQuantity, plain, prettyUnit } from "../state/format.js";
import { listen } from "../state/store.js";
import { createSliderField } from "../widgets/slider-field.js";
import { h, set } from "../widgets/dom.js";

const MOST_STARTS = 12; // coordinates that have a field of their own
const FARTHEST = 1e6; // [rad or m, or per s]
const FASTEST = 40; // [rad/s or m/s] of a slider
const WIDE = 1000; // a range over so many times its least value is better shown in decades

/**
 * @param {{wide: HTMLElement, narrow: HTMLElement}} homes what the drawer lies over, by the width
 * @param {HTMLElement} place gets the button that opens it
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createParameters(homes, place, store, actions) {
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
  const columns = matchMedia("(min-width: 1024px)");
  const house = () => (columns.matches ? homes.wide : homes.narrow).append(drawer);
  columns.addEventListener("change", house);
  house();
  place.prepend(button);
  /** @type {Map<string, ReturnType<typeof createSliderField>>} */
  const fields = new Map();
  /** where coordinates start @type {typeof fields} */
  let starts = new Map();
  let scene = "";

  const shut = () => actions.setView({ parameters: false });

  function obey() {
    drawer.hidden = !data.view.parameters;
    set(button, { "aria-expanded": String(data.view.parameters) });
  }

  /** @param {boolean} open by hand: the focus goes along */
  function toggle(open) {
    // a card that says why would lie under the drawer
    actions.setView(open && columns.matches ? { parameters: true, why: -1 } : { parameters: open });
    const first = /** @type {HTMLElement | null} */ (list.querySelector("input[type=text]"));
    (open ? first : button)?.focus({ preventScroll: true });
  }

  /** @param {KeyboardEvent} event */
  function onkeydown(event) {
    if (event.key === "Escape" && !(event.target instanceof HTMLInputElement)) {
      toggle(false);
    }
  }

  /**
   * A coordinate of the start, or its rate: set by number, as by dragging; the others follow.
   * @param {string} name @param {boolean} angle @param {boolean} rate
   */
  function makeStart(name, angle, rate) {
    const most = rate ? FASTEST : Number((angle ? Math.PI : 2 * data.scene.length).toPrecision(3));
    const unit = `${angle ? "rad" : "m"}${rate ? "/s" : ""}`;
    const typed = angle ? "30 deg" : "45 cm";
    return createSliderField({
      id: `start-${name}`,
      label: rate ? `${name}, rate at the start` : `${name}, where the motion starts`,
      unit,
      hint: rate ? "" : `the other coordinates follow; ${typed} is understood`,
      min: -most,
      max: most,
      read: (text) => parseQuantity(text, unit),
      check: (value) => (Math.abs(value) > FARTHEST ? { error: `${name} is too large` } : {}),
      commit: (value) => actions.setStart(name, value),
    });
  }

  /** Fields of the start: of every coordinate, and of the rates that a parameter sets otherwise. */
  function makeStarts() {
    return new Map(
      data.scene.coordinates.slice(0, MOST_STARTS).flatMap((one) => {
        const angle = one.kind === "angle";
        /** @type {[string, ReturnType<typeof createSliderField>][]} */
        const pair = [[one.name, makeStart(one.name, angle, false)]];
        return one.rate_parameter ? [...pair, [one.rate, makeStart(one.rate, angle, true)]] : pair;
      }),
    );
  }

  /**
   * One field for one start: the scene's parameter until the start is moved, from then on the
   * coordinate itself.
   */
  function showStarts() {
    const moved = actions.hasOwnStart();
    for (const one of data.scene.coordinates) {
      const both = [
        { name: one.name, by: one.start_parameter, value: one.value },
        { name: one.rate, by: one.rate_parameter, value: one.rate_value },
      ];
      for (const { name, by, value } of both) {
        const field = starts.get(name);
        const other = fields.get(by ?? "");
        field?.update(value);
        if (field) {
          field.el.hidden = Boolean(other) && !moved;
        }
        if (other) {
          other.el.hidden = Boolean(field) && moved;
        }
      }
    }
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
      starts = makeStarts();
      list.replaceChildren(...[...fields.values(), ...starts.values()].map((field) => field.el));
    }
    data.scene.parameters.forEach(({ name, value }) => fields.get(name)?.update(value));
    showStarts();
  }

  function settle() {
    if (data.stream.state === "live") {
      [...fields.values(), ...starts.values()].forEach((field) => field.settle());
    }
  }

  const free = actions.withRefusals(
    () => [...fields.values(), ...starts.values()].filter((field) => field.takeBack()).length > 0,
  );
  const stop = listen(store, {
    scene: () => {
      if (scene !== data.scene?.id && data.view.parameters) {
        shut(); // it would lie over another mechanism
      }
      show();
    },
    state: () => {
      const moves = data.state === "running" || data.view.replaying;
      if (moves && data.view.parameters && !drawer.contains(document.activeElement)) {
        shut(); // whoever changes numbers in it while the mechanism moves keeps it
      }
    },
    stream: settle,
    view: obey,
  });
  return {
    update() {},
    dispose() {
      stop();
      free();
      columns.removeEventListener("change", house);
      [...fields.values(), ...starts.values()].forEach((field) => field.dispose());
      drawer.remove();
      button.remove();
    },
  };
}
