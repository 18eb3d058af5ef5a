// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Step size, tolerance and Baumgarte's constants: a slider and a field for each setting that some
// method has; and the scene's parameters.
import { sentenceOf } from "../api/client.js";
import { niceAbove, niceBelow, parseQuantity, plain, prettyUnit } from "../state/format.js";
import { settingOf } from "../state/spelling.js";
import { listen } from "../state/store.js";
import { createSliderField } from "../widgets/slider-field.js";
import { h } from "../widgets/dom.js";

const positive = (name) => (value) => (value > 0 ? {} : { error: `${name} must be > 0` });
const warnBelowZero = (value) => (value < 0 ? { warning: "pushes the loop apart" } : {});

/** Settings with a control of their own; any other is changed in the method's dialog. */
const CONTROLS = [
  {
    key: "h",
    label: "Step size dt",
    unit: "s",
    scale: "log",
    min: 1e-4,
    max: 0.1,
    hint: "of every method with a fixed step",
    check: positive("dt"),
  },
  {
    key: "rtol",
    label: "Tolerance",
    unit: "",
    scale: "log",
    min: 1e-12,
    max: 1e-2,
    hint: "relative, of every method that chooses its step",
    check: positive("the tolerance"),
  },
  {
    key: "alpha",
    label: "Baumgarte α",
    unit: "1/s",
    scale: "linear",
    min: -10,
    max: 120,
    step: 1,
    hint: "pulls the velocity error back",
    check: warnBelowZero,
  },
  {
    key: "beta",
    label: "Baumgarte β",
    unit: "1/s",
    scale: "linear",
    min: -10,
    max: 120,
    step: 1,
    hint: "pulls the gap back",
    check: warnBelowZero,
  },
];

const WIDE = 1000; // a range over so many times its least value is better told in decades

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createControls(el, store, actions) {
  const data = store.data;
  const settings = h("div", { class: "settings" });
  const list = h("div", { class: "parameters" });
  const reset = h(
    "button",
    {
      type: "button",
      class: "quiet",
      onclick: () => actions.resetParameters().catch((e) => actions.notice(sentenceOf(e))),
    },
    "all as the scene has them",
  );
  const summary = h("summary", {}, "Lengths, masses, gravity and start");
  const details = h("details", { class: "scene-parameters" }, summary, list, h("p", {}, reset));
  el.replaceChildren(settings, details);

  /** @type {Map<string, ReturnType<typeof createSliderField>>} */
  const fields = new Map();
  /** @type {Map<string, ReturnType<typeof createSliderField>>} */
  const parameters = new Map();
  let settingsOf = "";
  let parametersOf = "";

  /** The value that the methods share; the first one when they differ. @param {string} key */
  function heldBy(key) {
    for (const { spelling } of data.methods) {
      const found = settingOf(data.catalogue, spelling, key);
      if (found) {
        return Number(found.value);
      }
    }
    return null;
  }

  /** Fast scenes take shorter steps and larger constants than the sliders have by themselves. */
  function rangeOf({ key, min, max, scale }, held) {
    return scale === "log"
      ? { min: key === "h" ? Math.min(min, niceBelow((data.scene?.step || 1e-3) / 10)) : min, max }
      : { min, max: Math.max(max, niceAbove(1.5 * held)) };
  }

  function makeField(control, held) {
    const range = rangeOf(control, held);
    return createSliderField({
      ...control,
      ...range,
      step: control.step && range.max > control.max ? range.max / 100 : control.step,
      scale: /** @type {"log" | "linear"} */ (control.scale),
      id: `set-${control.key}`,
      read: (text) => parseQuantity(text, control.unit),
      commit: (value) => actions.setSetting(control.key, value),
    });
  }

  function showSettings() {
    if (settingsOf !== data.scene?.id) {
      settingsOf = data.scene?.id ?? "";
      fields.forEach((field) => field.dispose());
      fields.clear();
    }
    for (const control of CONTROLS) {
      const held = heldBy(control.key);
      let field = fields.get(control.key);
      if (held === null) {
        field?.dispose();
        fields.delete(control.key);
        continue;
      }
      if (!field) {
        field = makeField(control, held);
        fields.set(control.key, field);
      }
      field.update(held);
    }
    const wanted = CONTROLS.flatMap(({ key }) => fields.get(key)?.el ?? []);
    if (
      wanted.some((node, i) => settings.children[i] !== node) ||
      wanted.length !== settings.children.length
    ) {
      settings.replaceChildren(...wanted);
    }
  }

  /** @param {import("../state/store.js").Parameter} parameter */
  function makeParameter(parameter) {
    const { min, max } = parameter;
    const unit = prettyUnit(parameter.unit);
    const span = Number.isFinite(min) && Number.isFinite(max) && min < max;
    const around = Math.max(1, 2 * Math.abs(parameter.initial));
    const range = span
      ? [min, max]
      : [Math.max(min ?? -around, -around), Math.min(max ?? around, around)];
    const words = `${plain(range[0])} to ${plain(range[1])} ${unit}`.trim();
    return createSliderField({
      id: `parameter-${parameter.name}`,
      label: parameter.about ? `${parameter.name}, ${parameter.about}` : parameter.name,
      unit,
      hint: words,
      scale: span && min > 0 && max / min >= WIDE && !parameter.integer ? "log" : "linear",
      min: range[0],
      max: range[1],
      step: parameter.integer ? 1 : undefined,
      read: (text) => parseQuantity(text, unit),
      check: (value) =>
        value < min || value > max
          ? { error: `${parameter.name} must be within ${words}` }
          : parameter.integer && !Number.isInteger(value)
            ? { error: `${parameter.name} must be a whole number` }
            : {},
      commit: (value) => actions.setParameter(parameter.name, value),
    });
  }

  function showParameters() {
    const scene = data.scene;
    if (!scene) {
      return;
    }
    if (parametersOf !== scene.id) {
      parametersOf = scene.id;
      parameters.clear();
      for (const parameter of scene.parameters) {
        parameters.set(parameter.name, makeParameter(parameter));
      }
      list.replaceChildren(...[...parameters.values()].map((field) => field.el));
      details.hidden = scene.parameters.length === 0;
    }
    scene.parameters.forEach((parameter) =>
      parameters.get(parameter.name)?.update(parameter.value),
    );
  }

  const stop = listen(store, { methods: showSettings, scene: showParameters });
  return {
    update() {},
    dispose() {
      stop();
      [...fields.values(), ...parameters.values()].forEach((field) => field.dispose());
      el.replaceChildren();
    },
  };
}
