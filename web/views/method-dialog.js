// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Adds, changes or removes a method: chosen from the catalogue, or typed as a spelling that the
// server checks.
import { Problem, sentenceOf } from "../api/client.js";
import { parseQuantity, plain, prettyUnit, withPowers } from "../state/format.js";
import { capital } from "../state/words.js";
import {
  choosePartner,
  faultOf,
  handsOver,
  misfit,
  misfitsOf,
  partnersOf,
} from "../state/pairs.js";
import { isProgram, providedBy, providesWords } from "../state/program-card.js";
import { cardOf, formatSpelling, parseSpelling, settingOf } from "../state/spelling.js";
import { listen } from "../state/store.js";
import { h, say, set } from "../widgets/dom.js";

const MOST_NAMED = 12; // coordinates in a hint

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createMethodDialog(el, store, actions) {
  const data = store.data;
  const title = h("h2", { id: "dialog-title" });
  const formulation = h("select", { id: "pick-formulation", onchange: onFormulation });
  const integrator = h("select", { id: "pick-integrator", onchange: compose });
  const about = h("p", { class: "about" });
  const limits = h("p", { class: "about" });
  const steps = h("p", { class: "about" });
  const misfits = h("div", {});
  const why = h("summary", {});
  const others = h("details", { class: "misfits" }, why, misfits);
  const settings = h("div", { class: "dialog-settings" });
  const spelling = h("input", {
    id: "pick-spelling",
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    "aria-describedby": "pick-error",
    oninput: onTyped,
  });
  const error = h("p", { id: "pick-error", class: "hint", role: "alert" });
  const remove = h("button", { type: "button", class: "plain", onclick: onRemove }, "Remove");
  const save = h("button", { type: "submit", class: "primary" });
  const form = h(
    "form",
    { method: "dialog", onsubmit: onSubmit },
    title,
    h("label", { for: "pick-formulation" }, "How the constraints enter"),
    formulation,
    about,
    limits,
    h("label", { for: "pick-integrator" }, "How time advances"),
    integrator,
    steps,
    others,
    settings,
    h("label", { for: "pick-spelling" }, "Spelling"),
    spelling,
    error,
    h(
      "div",
      { class: "actions" },
      remove,
      h("span", { class: "spring" }),
      h("button", { type: "button", class: "plain", onclick: () => dialog.close() }, "Cancel"),
      save,
    ),
  );
  const dialog = h("dialog", { "aria-labelledby": "dialog-title", class: "dialog" }, form);
  el.append(dialog);
  let place = -1;

  const option = (card) => h("option", { value: card.name }, card.title);

  /** The catalogue, then the programs of the server's folder and those that run already. */
  function fillLists() {
    const running = data.methods.map((method) => method.formulation).filter(isProgram);
    const names = new Set([...(data.catalogue.programs ?? []), ...running]);
    const cards = [...names].map((name) => cardOf(data.catalogue, "formulation", name));
    formulation.replaceChildren(
      ...data.catalogue.formulations.map(option),
      ...(cards.length
        ? [h("optgroup", { label: "programs of your own" }, ...cards.map(option))]
        : []),
    );
  }

  /** Only what fits the formulation can be chosen; for the rest the reason is told. */
  function fillIntegrators() {
    const fitting = partnersOf(data.catalogue, formulation.value);
    const group = (label, cards) =>
      cards.length ? [h("optgroup", { label }, ...cards.map(option))] : [];
    const chosen = integrator.value;
    integrator.replaceChildren(
      ...group(
        "steps as set",
        fitting.filter((card) => !card.adaptive),
      ),
      ...group(
        "steps chosen from a tolerance",
        fitting.filter((card) => card.adaptive),
      ),
    );
    integrator.value = fitting.some(({ name }) => name === chosen) ? chosen : fitting[0]?.name;
    const unfit = misfitsOf(data.catalogue, formulation.value);
    const count = unfit.reduce((sum, { titles }) => sum + titles.length, 0);
    say(why, `${count} integrators do not fit. Why?`);
    others.hidden = count === 0;
    misfits.replaceChildren(
      h("p", {}, `The integrator gets ${handsOver(data.catalogue, formulation.value)}.`),
      ...unfit.map(({ takes, titles }) => h("p", {}, `${titles.join("; ")}: take ${takes}.`)),
    );
  }

  function onFormulation() {
    const before = parseSpelling(spelling.value).integrator.name;
    const shared = data.methods.map((method) => method.integrator);
    fillIntegrators();
    integrator.value = choosePartner(data.catalogue, formulation.value, before, shared);
    compose();
  }

  /** Keeps what was set under the same key when the choice changes. */
  function compose() {
    const old = parseSpelling(spelling.value);
    const kept = new Map([...old.formulation.settings, ...old.integrator.settings]);
    const part = (kind, name) => {
      const card = cardOf(data.catalogue, kind, name);
      if (kind === "integrator" && card?.adaptive && old.integrator.name !== name) {
        kept.delete("h"); // it chooses its step, unless it is told one
      }
      const list = (card?.options ?? [])
        .filter(
          (setting) => keeps(setting, kept) || setting.default === null || isStep(card, setting),
        )
        .map(
          (setting) =>
            /** @type {[string, string]} */ ([
              setting.key,
              keeps(setting, kept) ? kept.get(setting.key) : firstOf(setting),
            ]),
        );
      return { name, settings: list };
    };
    spelling.value = formatSpelling({
      formulation: part("formulation", formulation.value),
      integrator: part("integrator", integrator.value),
    });
    showParts();
  }

  /** A fixed step is written out, so that it is seen. */
  const isStep = (card, { key }) => key === "h" && !card.adaptive;

  /** A value may be of use to another part too, where it means the same and is allowed. */
  const keeps = (setting, kept) =>
    kept.has(setting.key) && faultOf(setting, kept.get(setting.key)) === "";

  /** The step of the other methods, or of the scene; else the default, or the least allowed. */
  function firstOf(setting) {
    const others = data.methods.map(({ spelling: other }) => settingOf(data.catalogue, other, "h"));
    const step = others.find((other) => other && other.value > 0)?.value;
    return setting.key === "h"
      ? String(step || data.scene?.step || setting.default || 1e-3)
      : String(setting.default ?? setting.min);
  }

  function onTyped() {
    const parsed = parseSpelling(spelling.value);
    const { name } = parsed.formulation;
    if ([...formulation.options].some(({ value }) => value === name)) {
      formulation.value = name;
    }
    fillIntegrators();
    if (cardOf(data.catalogue, "integrator", parsed.integrator.name)) {
      integrator.value = parsed.integrator.name; // none, when the pair does not fit
    }
    showParts();
    const { formulation: f, integrator: i } = parsed;
    tell(misfit(data.catalogue, f.name, i.name) ?? "");
  }

  function showParts() {
    tell("");
    const parsed = parseSpelling(spelling.value);
    const card = cardOf(data.catalogue, "formulation", formulation.value);
    const stepper = cardOf(data.catalogue, "integrator", integrator.value);
    say(about, withPowers(card?.rule ?? ""));
    const notes = [
      card?.when_not && `Not suitable: ${card.when_not}.`,
      card?.limits && `${capital(card.limits)}.`,
      card?.order_note && `Order: ${card.order_note}.`,
    ];
    say(limits, withPowers(notes.filter(Boolean).join(" ")));
    say(steps, stepper ? stepper.about : "");
    settings.replaceChildren(
      ...["formulation", "integrator"].flatMap((kind) => settingFields(kind, parsed[kind])),
    );
  }

  /** The numbers by which an option names coordinates: ", here 1 th1, 2 a2, 3 x". */
  function numbersOfCoordinates() {
    const names = (data.scene?.coordinates ?? []).map(({ name }, k) => `${k + 1} ${name}`);
    const more = names.length > MOST_NAMED ? ", ..." : "";
    return names.length ? `, here ${names.slice(0, MOST_NAMED).join(", ")}${more}` : "";
  }

  /** Returns what may be written, and what it means: "0 to 1, 0.2 if left out: ...". */
  function hintOf(setting) {
    const range = setting.choices?.length
      ? ""
      : `${plain(setting.min)} to ${plain(setting.max)}${setting.unit ? ` ${prettyUnit(setting.unit)}` : ""}; `;
    return `${range}${setting.about.replace(", as inspect lists them", numbersOfCoordinates())}`;
  }

  function settingFields(kind, part) {
    const card = cardOf(data.catalogue, kind, part.name);
    return (card?.options ?? []).map((setting) => {
      const id = `pick-${kind}-${setting.key}`;
      const written = part.settings.find(([key]) => key === setting.key);
      const value = written ? written[1] : "";
      const hint = h("span", { class: "hint", id: `${id}-hint` }, hintOf(setting));
      const input = setting.choices?.length
        ? h(
            "select",
            { id, "aria-describedby": hint.id },
            ...setting.choices.map((choice) => h("option", { value: choice }, choice)),
          )
        : h("input", {
            id,
            type: "text",
            inputmode: "decimal",
            autocomplete: "off",
            "aria-describedby": hint.id,
            placeholder: setting.default === null ? "" : plain(setting.default),
          });
      input.value = value || (setting.choices?.length ? setting.default : "");
      const row = h(
        "p",
        { class: "dialog-setting" },
        h("label", { for: id }, setting.key),
        input,
        h("span", { class: "unit" }, prettyUnit(setting.unit ?? "")),
        hint,
      );
      input.addEventListener("change", () => {
        const text = input.value.trim().replace(",", ".");
        const fault = text ? faultOf(setting, text) : "";
        say(hint, fault || hintOf(setting));
        row.dataset.kind = fault ? "error" : "";
        set(input, { "aria-invalid": fault ? "true" : null });
        if (!fault) {
          const value = parseQuantity(text, prettyUnit(setting.unit ?? ""));
          writeSetting(kind, setting.key, text && !setting.choices?.length ? plain(value) : text);
        }
      });
      return row;
    });
  }

  function writeSetting(kind, key, value) {
    const parsed = parseSpelling(spelling.value);
    const part = parsed[kind];
    part.settings = part.settings.filter(([name]) => name !== key);
    if (value) {
      part.settings.push([key, value]);
    }
    spelling.value = formatSpelling(parsed);
    tell("");
  }

  /** @param {string} text */
  function tell(text) {
    say(error, text);
    set(spelling, { "aria-invalid": text ? "true" : null });
    form.dataset.kind = text ? "error" : "";
  }

  /**
   * The kind of a program is known once the server has started it: a method that does not fit is
   * spelled as the program takes it, and the status line says so.
   * @param {unknown} problem @param {string} wrong
   * @returns {string} "" where this is not what was wrong
   */
  function respell(problem, wrong) {
    const provided = problem instanceof Problem ? providedBy(problem.errors) : "";
    const { name } = parseSpelling(wrong).formulation;
    if (!provided || !isProgram(name) || data.catalogue.provided?.[name] === provided) {
      return "";
    }
    data.catalogue.provided = { ...data.catalogue.provided, [name]: provided };
    onTyped();
    onFormulation();
    return `${providesWords(name, provided)}: it runs as ${spelling.value}`;
  }

  /**
   * @param {string[]} spellings @param {number} [at] the one that was chosen here
   * @param {string} [said] once it is done
   */
  async function commit(spellings, at = -1, said = "") {
    try {
      await actions.setMethods(spellings);
    } catch (problem) {
      const words = at < 0 ? "" : respell(problem, spellings[at]);
      if (words) {
        return commit(spellings.with(at, spelling.value), at, words);
      }
      tell(sentenceOf(problem));
      spelling.focus();
      return false;
    }
    dialog.close();
    if (said) {
      actions.notice(said);
    }
    return true;
  }

  async function onSubmit(event) {
    event.preventDefault();
    const { formulation: f, integrator: i } = parseSpelling(spelling.value);
    const fault = misfit(data.catalogue, f.name, i.name);
    if (fault) {
      tell(fault);
      spelling.focus();
      return;
    }
    const spellings = data.methods.map((method) => method.spelling);
    const at = place < 0 ? spellings.length : place;
    spellings[at] = spelling.value.trim();
    if (await commit(spellings, at)) {
      actions.select(at);
    }
  }

  async function onRemove() {
    await commit(data.methods.map((method) => method.spelling).filter((_, m) => m !== place));
  }

  const stop = listen(store, { ready: fillLists });
  fillLists();
  return {
    /** @param {number} m method to change, or -1 to add one */
    open(m) {
      place = m;
      const model = data.methods[m] ?? data.methods[data.methods.length - 1];
      say(title, m < 0 ? "Add a method" : `Change ${model.label}`);
      say(save, m < 0 ? "Add" : "Change");
      remove.hidden = m < 0 || data.methods.length < 2;
      fillLists();
      spelling.value = model.spelling;
      onTyped();
      dialog.showModal();
      formulation.focus();
    },
    update() {},
    dispose() {
      stop();
      dialog.remove();
    },
  };
}
