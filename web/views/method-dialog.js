// @ts-check
// Adds, changes or removes a method: chosen from the catalogue, or typed as a spelling that the server checks.
import { sentenceOf } from "../api/client.js";
import { cardOf, formatSpelling, parseSpelling } from "../state/spelling.js";
import { listen } from "../state/store.js";
import { h, say, set } from "../widgets/dom.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../state/session.js").Session} actions
 */
export function createMethodDialog(el, store, actions) {
  const data = store.data;
  const title = h("h2", { id: "dialog-title" });
  const formulation = h("select", { id: "pick-formulation", onchange: compose });
  const integrator = h("select", { id: "pick-integrator", onchange: compose });
  const about = h("p", { class: "about" });
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
    h("label", { for: "pick-integrator" }, "How time advances"),
    integrator,
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

  function fillLists() {
    const options = (cards) => cards.map((card) => h("option", { value: card.name }, card.title));
    formulation.replaceChildren(...options(data.catalogue.formulations));
    integrator.replaceChildren(...options(data.catalogue.integrators));
  }

  /** Keeps what was set under the same key when the choice changes. */
  function compose() {
    const old = parseSpelling(spelling.value);
    const kept = new Map([...old.formulation.settings, ...old.integrator.settings]);
    const part = (kind, name) => {
      const card = cardOf(data.catalogue, kind, name);
      const list = (card?.settings ?? [])
        .filter((setting) => kept.has(setting.key) || setting.default === null)
        .map(
          (setting) =>
            /** @type {[string, string]} */ ([
              setting.key,
              kept.get(setting.key) ?? defaultOf(setting),
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

  /** A setting without a default takes the step of the scene, or the least that is allowed. */
  function defaultOf(setting) {
    return setting.key === "h" ? String(data.scene?.step || 1e-3) : String(setting.min);
  }

  function onTyped() {
    const parsed = parseSpelling(spelling.value);
    if (cardOf(data.catalogue, "formulation", parsed.formulation.name)) {
      formulation.value = parsed.formulation.name;
    }
    if (cardOf(data.catalogue, "integrator", parsed.integrator.name)) {
      integrator.value = parsed.integrator.name;
    }
    showParts();
  }

  function showParts() {
    tell("");
    const card = cardOf(data.catalogue, "formulation", formulation.value);
    say(about, card ? card.rule : "");
    const parsed = parseSpelling(spelling.value);
    settings.replaceChildren(
      ...["formulation", "integrator"].flatMap((kind) => settingFields(kind, parsed[kind])),
    );
  }

  function settingFields(kind, part) {
    const card = cardOf(data.catalogue, kind, part.name);
    return (card?.settings ?? []).map((setting) => {
      const id = `pick-${kind}-${setting.key}`;
      const written = part.settings.find(([key]) => key === setting.key);
      const value = written ? written[1] : "";
      const input = setting.choices?.length
        ? h(
            "select",
            { id },
            ...setting.choices.map((choice) => h("option", { value: choice }, choice)),
          )
        : h("input", {
            id,
            type: "text",
            inputmode: "decimal",
            autocomplete: "off",
            placeholder: setting.default === null ? "" : String(setting.default),
          });
      input.value = value || (setting.choices?.length ? setting.default : "");
      input.addEventListener("change", () => writeSetting(kind, setting.key, input.value.trim()));
      return h(
        "p",
        { class: "dialog-setting", title: setting.about },
        h("label", { for: id }, setting.key),
        input,
        h("span", { class: "unit" }, setting.unit ?? ""),
      );
    });
  }

  function writeSetting(kind, key, value) {
    const parsed = parseSpelling(spelling.value);
    const part = parsed[kind];
    part.settings = part.settings.filter(([name]) => name !== key);
    if (value) {
      part.settings.push([key, value.replace(",", ".")]);
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

  async function commit(spellings) {
    try {
      await actions.setMethods(spellings);
      dialog.close();
      return true;
    } catch (problem) {
      tell(sentenceOf(problem));
      spelling.focus();
      return false;
    }
  }

  async function onSubmit(event) {
    event.preventDefault();
    const spellings = data.methods.map((method) => method.spelling);
    const at = place < 0 ? spellings.length : place;
    spellings[at] = spelling.value.trim();
    if (await commit(spellings)) {
      actions.select(at);
    }
  }

  async function onRemove() {
    await commit(data.methods.map((method) => method.spelling).filter((_, m) => m !== place));
  }

  const stop = listen(store, { ready: fillLists });
  return {
    /** @param {number} m method to change, or -1 to add one */
    open(m) {
      place = m;
      const model = data.methods[m] ?? data.methods[data.methods.length - 1];
      say(title, m < 0 ? "Add a method" : `Change ${model.label}`);
      say(save, m < 0 ? "Add" : "Change");
      remove.hidden = m < 0 || data.methods.length < 2;
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
