// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The methods side by side: how each is drawn, the verdict on it, its gap, error, energy and cost.
import { bound, gapWords, plain, quantity, scientific, withPowers } from "../state/format.js";
import { costWords, estimateWords } from "../state/cards.js";
import { errorsOf } from "../state/errors.js";
import { limits } from "../state/catalogue.js";
import { cardOf, parseSpelling, settingOf } from "../state/spelling.js";
import { listen, shownIndex } from "../state/store.js";
import { verdictAt } from "../state/verdict.js";
import { h, icon, s, say, set } from "../widgets/dom.js";
import { paintNoMore, paintSoon } from "../widgets/pace.js";
import { term } from "../widgets/term.js";

/** The options that set the accuracy of a method, and how a row shows them. */
const SIZES = [
  { key: "h", word: "dt", unit: " s" },
  { key: "rtol", word: "tolerance", unit: "" },
];
const MANY = 9999.5; // operations that are counted in thousands
const GREEK = { alpha: "α", beta: "β" };

/** "496/step", "17.2k/step" @param {number} ops of one step */
const perStep = (ops) =>
  `${ops < MANY ? Math.round(ops) : `${Number((ops / 1000).toPrecision(3))}k`}/step`;

/** Index of the last value that is a number, at `now` or before. @param {Float64Array} column */
function lastKnown(column, now) {
  let i = now;
  while (i > 0 && Number.isNaN(column[i])) {
    i--;
  }
  return i;
}

/** "α = 5, β = 5, rk4, h = 0.02 s", for people. @param {string} spelling */
function optionWords(spelling) {
  const { formulation, integrator } = parseSpelling(spelling);
  const words = (list) =>
    list.map(([key, value]) => `${GREEK[key] ?? key} = ${key === "h" ? `${value} s` : value}`);
  return [...words(formulation.settings), integrator.name, ...words(integrator.settings)].join(
    ", ",
  );
}

const ROW = 46; // letters of a verdict that a row of the first screen holds

/**
 * A long verdict in fewer words; the card and the line below have it whole.
 * @param {string} words
 */
const brief = (words) =>
  words.length > ROW ? words.replace(/ from the true motion$/, " off") : words;

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {(m: number) => void} openDialog edits method m, or adds one (m = -1)
 */
export function createMethods(el, store, actions, openDialog) {
  const data = store.data;
  const body = h("tbody", { role: "rowgroup" });
  const add = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "aria-label": "add a method",
      onclick: () => openDialog(-1),
    },
    icon("plus"),
    "add",
  );
  const cheapest = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "data-tip": "error against cost of every method, at many step sizes (W)",
      onclick: () => actions.setView({ study: "work-precision" }),
    },
    "cheapest?",
  );
  const map = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "data-tip": "the worst gap over all α and β as a map, with the present values on it (B)",
      onclick: () => actions.setView({ study: "stability", map: "baumgarte" }),
    },
    "α, β map",
  );
  el.replaceChildren(
    h(
      "div",
      { class: "title" },
      h("h2", { id: "methods-title" }, "Methods"),
      h("div", { class: "choices" }, cheapest, map, add),
    ),
    h(
      "div",
      { class: "method-scroll", tabindex: "0", role: "region", "aria-label": "List of methods" },
      h("table", { role: "table", class: "method-table" }, makeHead(), body),
    ),
  );

  /** @type {{row: HTMLElement, parts: Record<string, HTMLElement>}[]} */
  let rows = [];
  let refusals = data.refused;

  function makeHead() {
    const head = (name, ...content) =>
      h("th", { scope: "col", role: "columnheader", class: name }, ...content);
    const unseen = (text) => h("span", { class: "hidden" }, text);
    return h(
      "thead",
      { role: "rowgroup" },
      h(
        "tr",
        { role: "row" },
        head("check", unseen("Drawn")),
        head("who", unseen("Method")),
        head("more", unseen("Why, and change")),
        head("verdict", term("verdict", "worst so far")),
        head("moment", "now"),
        head("gap", term("gap", "gap")),
        head("off", term("error", "error")),
        head("energy", term("energy", "energy")),
        head("cost", term("ops", "operations")),
      ),
    );
  }

  function swatch(method) {
    const look = data.look.slots[method.slot];
    return s(
      "svg",
      { viewBox: "0 0 34 12", class: `swatch slot-${method.slot}`, "aria-hidden": "true" },
      s("path", { d: "M1 6H33", "stroke-dasharray": look.dash.join(" ") || null }),
    );
  }

  /** The method's own step or tolerance, where the methods have several. */
  function ownSize({ spelling }) {
    for (const { key, word, unit } of SIZES) {
      const held = (text) => Number(settingOf(data.catalogue, text, key)?.value ?? 0);
      const own = held(spelling);
      if (own > 0) {
        const differ = data.methods.some((other) => held(other.spelling) !== own);
        return differ ? `${word} ${plain(own)}${unit}` : "";
      }
    }
    return "";
  }

  /** @param {import("../state/store.js").Method} method @param {number} m */
  function makeParts(method, m) {
    const number = () => h("span", { class: "number" });
    const about = `${method.title} (${optionWords(method.spelling)}). ${method.rule}`;
    return {
      check: h("input", {
        type: "checkbox",
        "aria-label": `draw ${method.label}`,
        onchange: (event) => actions.setVisible(m, event.currentTarget.checked),
      }),
      select: h(
        "button",
        {
          type: "button",
          class: "select",
          onclick: () => actions.select(m),
          "data-tip": withPowers(about),
        },
        swatch(method),
        h("span", { class: "name" }, method.label),
      ),
      verdict: h("span", { class: "words" }),
      gap: number(),
      off: number(),
      energy: number(),
      cost: number(),
      why: h(
        "button",
        {
          type: "button",
          class: "quiet why",
          onclick: () => actions.setView({ why: data.view.why === m ? -1 : m }),
          "aria-label": `Why? ${method.label}`,
          "aria-expanded": "false",
        },
        "Why?",
      ),
      edit: h(
        "button",
        {
          type: "button",
          class: "tool small",
          onclick: () => openDialog(m),
          "aria-label": `Change or remove ${method.label}`,
          "data-tip": "change or remove this method",
        },
        icon("edit"),
      ),
    };
  }

  function makeRow(method, m) {
    const parts = makeParts(method, m);
    const cell = (name, ...content) => h("td", { role: "cell", class: name }, ...content);
    const badge = method.model_error
      ? [h("span", { class: "badge" }, "model error: halving h does not help")]
      : [];
    const row = h(
      "tr",
      { role: "row", class: `slot-${method.slot}` },
      cell("check", parts.check),
      cell("who", parts.select),
      cell("more", parts.why, parts.edit),
      cell("verdict", parts.verdict, h("span", { class: "own number" }, ownSize(method)), ...badge),
      h("td", { class: "moment", "aria-hidden": "true" }, "now"),
      cell("gap", parts.gap),
      cell("off", parts.off),
      cell("energy", parts.energy),
      cell("cost", parts.cost),
    );
    return { row, parts };
  }

  /** A method that the scene cannot serve stays in the table, with the reason. */
  function refusedRow({ spelling, reason }) {
    const { formulation } = parseSpelling(spelling);
    const card = cardOf(data.catalogue, "formulation", formulation.name);
    const forget = () =>
      actions.setRefused(data.refused.filter((other) => other.spelling !== spelling));
    return h(
      "tr",
      { role: "row", class: "refused" },
      h("td", { role: "cell", class: "check" }),
      h(
        "td",
        { role: "cell", class: "who" },
        h("span", { class: "name" }, card?.short_name ?? formulation.name),
      ),
      h(
        "td",
        { role: "cell", class: "more" },
        h(
          "button",
          { type: "button", class: "quiet", "aria-label": `Forget ${spelling}`, onclick: forget },
          "forget",
        ),
      ),
      h(
        "td",
        { role: "cell", class: "verdict" },
        h("span", { class: "words" }, `cannot run on this scene: ${reason}`),
      ),
    );
  }

  function rebuild() {
    rows = data.methods.map(makeRow);
    refusals = data.refused;
    body.replaceChildren(...rows.map(({ row }) => row), ...refusals.map(refusedRow));
    const most = limits().methods;
    map.hidden = !data.methods.some(({ spelling }) => settingOf(data.catalogue, spelling, "alpha"));
    add.disabled = data.methods.length >= most;
    set(add, { "data-tip": add.disabled ? `${most} methods at most` : null });
    showView();
  }

  function showView() {
    if (refusals !== data.refused) {
      rebuild();
      return;
    }
    rows.forEach(({ row, parts }, m) => {
      const selected = m === data.view.selected;
      row.classList.toggle("selected", selected);
      row.classList.toggle("off", data.view.hidden.has(m));
      set(parts.select, { "aria-pressed": String(selected) });
      set(parts.why, { "aria-expanded": String(m === data.view.why) });
      /** @type {HTMLInputElement} */ (parts.check).checked = !data.view.hidden.has(m);
    });
    paint();
  }

  /** @param {number} work [J] */
  const workWords = (work) =>
    `Energy error, with the work of drives, dampers and loads taken off; that work is ${quantity(work, "J")} so far.`;

  /** The largest error of all coordinates; it has no unit where these have several. */
  function estimateOf(error) {
    const kinds = new Set(data.scene.coordinates.map(({ kind }) => kind));
    const unit = { angle: "rad", length: "m" }[kinds.size === 1 ? [...kinds][0] : ""];
    return `≈ ${unit ? quantity(error, unit, 1) : scientific(error, 1)}`;
  }

  /** Error of position, as a bound where the reference itself says no more. */
  function errorWords(m, now) {
    const { reference } = data;
    const { off } = errorsOf(data)[m];
    const value = off[lastKnown(off, now)];
    if (Number.isNaN(value) || !reference) {
      const estimate = data.latest?.methods[m]?.error_estimate?.q ?? NaN;
      return Number.isFinite(estimate) ? estimateOf(estimate) : "–";
    }
    return value <= reference.own ? `< ${bound(value, "m")}` : quantity(value, "m", 2);
  }

  function paintRow({ row, parts }, m, now) {
    const column = data.history.columns[m];
    const last = lastKnown(column.steps, now);
    const steps = column.steps[last];
    const verdict = verdictAt(data, m, now);
    say(parts.verdict, brief(verdict.words));
    row.dataset.tone = verdict.tone;
    say(parts.gap, data.scene?.m > 0 ? gapWords(column.gap[last]) : "no loop");
    say(parts.off, errorWords(m, last));
    say(parts.energy, gapWords(column.energy_change[last], "J"));
    const ops = column.ops[last]; // nobody counts those of a program
    say(parts.cost, steps > 0 && ops > 0 ? perStep(ops / steps) : "–");
    set(parts.off, { "data-tip": estimateWords(data, m) || null });
    set(parts.energy, { "data-tip": workWords(column.work[last]) });
    set(parts.cost, { "data-tip": costWords(data, m, last) || null });
  }

  function paint() {
    const history = data.history;
    const now = shownIndex(data);
    if (history && now >= 0 && rows.length === history.nMethods) {
      rows.forEach((row, m) => paintRow(row, m, now));
    }
  }

  // whatever makes the sentences below ask for a beat makes the rows ask for the same one
  const soon = () => paintSoon(paint);
  const stop = listen(store, {
    methods: () => (rebuild(), soon()),
    view: () => (showView(), soon()),
    state: soon,
    reference: soon,
  });
  return {
    update: soon,
    dispose() {
      stop();
      paintNoMore(paint);
      el.replaceChildren();
    },
  };
}
