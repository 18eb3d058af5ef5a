// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Step size, tolerance and Baumgarte's constants: a slider and a field for each option that some
// method has.
import { niceAbove, niceBelow, parseQuantity, plain } from "../state/format.js";
import { GAP_LAW, GLOSSARY } from "../state/glossary.js";
import { settingOf } from "../state/spelling.js";
import { listen } from "../state/store.js";
import { createSliderField } from "../widgets/slider-field.js";
import { h } from "../widgets/dom.js";

const MOST_STEPS = 1e7; // of a whole run: more would take minutes

const warnBelowZero = (value) => (value < 0 ? { warning: "pushes the loop apart" } : {});

/** A step that the run can be made of. @param {number} value @param {number} duration [s] */
function checkStep(value, duration) {
  if (!(value > 0)) {
    return { error: "dt must be > 0" };
  }
  if (value > duration) {
    return { error: `dt must be at most ${plain(duration)} s, the duration of the run` };
  }
  const least = duration / MOST_STEPS;
  return value < least
    ? { error: `dt must be at least ${plain(least)} s: the run would take over 10 million steps` }
    : {};
}

/** Options with a control of their own; any other is changed in the method's dialog. */
const CONTROLS = [
  {
    key: "h",
    label: "Step size dt",
    unit: "s",
    scale: "log",
    min: 1e-4,
    max: 0.1,
    tip: `${GLOSSARY.dt.means} It applies to every method with a fixed step.`,
    check: checkStep,
  },
  {
    key: "rtol",
    label: "Tolerance",
    unit: "",
    scale: "log",
    min: 1e-12,
    max: 1e-2,
    tip: GLOSSARY.tolerance.means,
    check: (value) => (value > 0 ? {} : { error: "the tolerance must be > 0" }),
  },
  {
    key: "alpha",
    label: "Baumgarte α",
    unit: "1/s",
    scale: "linear",
    min: -10,
    max: 120,
    step: 1,
    meaning: "damps the gap",
    tip: GLOSSARY.alpha.means,
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
    meaning: "pulls the gap shut",
    tip: GLOSSARY.beta.means,
    check: warnBelowZero,
  },
];

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createControls(el, store, actions) {
  const data = store.data;
  const list = h("div", { class: "settings" });
  const law = h("p", { class: "law", hidden: true }, "the gap φ obeys ", h("b", {}, GAP_LAW));
  el.append(list, law);
  /** @type {Map<string, ReturnType<typeof createSliderField>>} */
  const fields = new Map();
  let scene = "";

  /**
   * The value that the methods share; where they differ, that of most of them, the first of equally
   * many. A method that has a value of its own changes nothing here. @param {string} key
   */
  function heldBy(key) {
    /** @type {Map<number, number>} */
    const counts = new Map();
    for (const { spelling } of data.methods) {
      const found = settingOf(data.catalogue, spelling, key);
      if (found) {
        const value = Number(found.value);
        counts.set(value, (counts.get(value) ?? 0) + 1);
      }
    }
    const most = Math.max(0, ...counts.values());
    return [...counts.keys()].find((value) => counts.get(value) === most) ?? null;
  }

  /**
   * That methods have values of their own, or why the step is not the scene's.
   * @param {string} key @param {number} held
   */
  function hintOf(key, held) {
    const values = data.methods.map(({ spelling }) =>
      Number(settingOf(data.catalogue, spelling, key)?.value ?? held),
    );
    const free = key === "h" ? 0 : held; // a step that the method chooses itself
    if (values.some((value) => value !== held && value !== free)) {
      return "the methods differ: a value set here is for all of them";
    }
    const own = data.scene?.step ?? 0;
    if (key !== "h" || !(own > 0) || held === own) {
      return "";
    }
    return held === 2 * own
      ? `twice the scene's own ${plain(own)} s, so that methods differ`
      : `the scene's own step is ${plain(own)} s`;
  }

  /** Fast scenes need shorter steps and larger constants than the sliders have by themselves. */
  function rangeOf({ key, min, max, scale }, held) {
    if (scale === "log") {
      const shortest = niceBelow((data.scene?.step || 1e-3) / 10);
      return { min: key === "h" ? Math.min(min, shortest) : min, max };
    }
    return { min, max: Math.max(max, niceAbove(1.5 * held)) };
  }

  function makeField(control, held) {
    const range = rangeOf(control, held);
    return createSliderField({
      ...control,
      ...range,
      hint: "",
      step: control.step && range.max > control.max ? range.max / 100 : control.step,
      scale: /** @type {"log" | "linear"} */ (control.scale),
      id: `set-${control.key}`,
      read: (text) => parseQuantity(text, control.unit),
      check: (value) => control.check(value, data.duration),
      commit: (value) => actions.setSetting(control.key, value),
    });
  }

  /** The field of an option, made when a method has it and removed when none has. */
  function fieldFor(control) {
    const held = heldBy(control.key);
    let field = fields.get(control.key);
    if (held === null) {
      field?.dispose();
      fields.delete(control.key);
      return [];
    }
    if (!field) {
      field = makeField(control, held);
      fields.set(control.key, field);
    }
    field.setHint(hintOf(control.key, held));
    field.update(held);
    return [field.el];
  }

  function show() {
    if (scene !== data.scene?.id) {
      scene = data.scene?.id ?? "";
      fields.forEach((field) => field.dispose());
      fields.clear();
    }
    const wanted = CONTROLS.flatMap(fieldFor);
    const same = wanted.every((node, i) => list.children[i] === node);
    if (!same || wanted.length !== list.children.length) {
      list.replaceChildren(...wanted);
    }
    law.hidden = !fields.has("alpha");
  }

  function settle() {
    if (data.stream.state === "live") {
      fields.forEach((field) => field.settle());
    }
  }

  const stop = listen(store, { methods: show, stream: settle });
  const free = actions.withRefusals(
    () => [...fields.values()].filter((field) => field.takeBack()).length > 0,
  );
  return {
    update() {},
    dispose() {
      stop();
      free();
      fields.forEach((field) => field.dispose());
      list.remove();
      law.remove();
    },
  };
}
