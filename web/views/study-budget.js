// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Where the error at the end comes from, and who put energy in: the parts of each method as a bar
// that adds up, and as numbers.
import { partsOfBudget } from "../state/catalogue.js";
import { parseQuantity, plain, quantity, scientific, seconds } from "../state/format.js";
import { BUDGETS } from "../state/shown.js";
import { barsOf } from "../state/study-documents.js";
import { h, s } from "../widgets/dom.js";

const HEIGHT = 30;
const DIGITS = 3; // so that the parts add up as they are printed
const ABSURD = 10; // times the whole: parts that add up to more say nothing
const LETTERED = 16; // [px] a part at least so long has its letter

/** By the names that a link has for them; `order`: their parts, as the server lists them. */
const SHOWS = BUDGETS.map((name) => ({
  name,
  word: name === "error" ? "position error" : "energy",
  get order() {
    return partsOfBudget(name);
  },
}));

/** @param {number | null} value @param {string} unit */
const numberOf = (value, unit) =>
  value === null
    ? "–"
    : Math.abs(value) < 1e-12 && value !== 0
      ? `${scientific(value)} ${unit}`
      : quantity(value, unit, DIGITS);

/** Fields for the end and the step of the motion that is split. */
const FIELDS = /** @type {const} */ ([
  { key: "time", word: "until t =", own: "the end" },
  { key: "step", word: "step h =", own: "its own" },
]);

/**
 * @typedef {{time: number, step: number}} Split end and step [s]; 0: the scene's, the methods'
 * @param {import("../state/store.js").Store} store
 * @param {{
 *   judged: () => string, judge: (coordinate: string) => void, show: (budget: string) => void,
 *   split: () => Split, setSplit: (change: Partial<Split>) => void,
 * }} actions
 */
export function createStudyBudget(store, actions) {
  const data = store.data;
  const menu = h("select", { id: "budget-of", onchange: () => actions.judge(menu.value) });
  const choice = h(
    "span",
    { class: "choices" },
    h("label", { for: "budget-of", class: "word" }, "of"),
    menu,
  );
  const refused = h("p", { class: "hint", role: "status" });
  const fields = FIELDS.map((field) => makeField(field));
  let shown = SHOWS[0];
  const choices = SHOWS.map(({ name, word }) =>
    h("button", { type: "button", class: "quiet", onclick: () => actions.show(name) }, word),
  );
  const about = h("p", { class: "about" });
  const list = h("div", { class: "budgets" });
  const legend = h("ul", { class: "legend" });
  const table = h("div", {
    class: "twin-table",
    tabindex: "0",
    role: "region",
    "aria-label": "Table of the study",
  });
  const el = h(
    "div",
    {},
    h(
      "div",
      { class: "study-bar" },
      h("div", { class: "choices" }, ...choices),
      choice,
      ...fields.map(({ el: one }) => one),
      refused,
    ),
    about,
    list,
    legend,
    table,
  );

  /** @param {typeof FIELDS[number]} field */
  function makeField({ key, word, own }) {
    const input = h("input", {
      type: "text",
      id: `budget-${key}`,
      size: 8,
      inputmode: "decimal",
      autocomplete: "off",
      spellcheck: "false",
      placeholder: own,
      onchange: () => take(key, input),
    });
    const label = h("label", { for: `budget-${key}`, class: "word" }, word);
    return { key, input, el: h("span", { class: "choices" }, label, input) };
  }

  /** Another end or step, where what was typed is one; nothing typed: the motion's own. */
  function take(key, input) {
    const text = input.value.trim();
    const value = text === "" ? 0 : parseQuantity(text, "s");
    const good = text === "" || (value > 0 && Number.isFinite(value));
    refused.textContent = good ? "" : `'${text}' is no time above 0; try 0.5 s or 20 ms`;
    input.setAttribute("aria-invalid", String(!good));
    if (good && value !== actions.split()[key]) {
      actions.setSplit({ [key]: value });
    }
  }

  function fillFields() {
    const now = actions.split();
    for (const { key, input } of fields) {
      if (document.activeElement !== input && input.getAttribute("aria-invalid") !== "true") {
        input.value = now[key] > 0 ? `${plain(now[key])} s` : "";
      }
    }
  }

  const study = () => data.studies.budget.document;
  const labelOf = (m) => data.methods[m]?.label ?? study().methods[m].method;

  /** Returns what is accounted for: the total, its unit and its parts; or why there is nothing. */
  function budgetOf(method) {
    const budget = method[shown.name];
    return budget
      ? shown.name === "error"
        ? {
            total: budget.value,
            unit: budget.unit,
            parts: budget.parts,
            sum: budget.sum,
            holds: budget.holds,
            until: budget.holds_until,
            what: `the error of ${budget.coordinate} at the end is`,
          }
        : {
            total: budget.change,
            unit: "J",
            parts: budget.parts,
            sum: budget.change,
            holds: true,
            until: null,
            what: "energy at the end has changed by",
          }
      : null;
  }

  function bar(m, parts, unit, label) {
    const width = Math.max(240, list.clientWidth);
    const middle = width / 2;
    const picture = s("svg", {
      class: `budget slot-${data.methods[m]?.slot ?? 0}`,
      viewBox: `0 0 ${width} ${HEIGHT}`,
      role: "img",
      "aria-label": label,
    });
    for (const { name, value, from, to } of barsOf(parts, shown.order)) {
      const i = shown.order.findIndex((one) => one.name === name);
      const [x0, x1] = [middle + from * (middle - 4), middle + to * (middle - 4)];
      picture.append(
        s(
          "rect",
          { x: x0, y: 4, width: Math.max(0, x1 - x0), height: HEIGHT - 8, class: `part part-${i}` },
          s("title", {}, `${shown.order[i].about}: ${numberOf(value, unit)}`),
        ),
      );
      if (x1 - x0 >= LETTERED) {
        picture.append(
          s(
            "text",
            { x: (x0 + x1) / 2, y: HEIGHT / 2 + 4.5, class: "letter" },
            shown.order[i].letter,
          ),
        );
      }
    }
    picture.append(s("path", { d: `M${middle} 0V${HEIGHT}`, class: "zero" }));
    return picture;
  }

  function row(method, m) {
    const budget = budgetOf(method);
    const why =
      method.state === "done" ? "there is no reference solution to compare with" : method.reason;
    const partly = method.state === "failed" ? ` (it ended early: ${method.reason})` : "";
    const ended = budget && !budget.holds;
    const agree =
      ended && budget.until !== null
        ? `. Until ${seconds(budget.until)} the parts add up to the error`
        : "";
    const sum =
      ended && Math.abs(budget.sum) <= ABSURD * Math.abs(budget.total)
        ? `: its parts add up to ${numberOf(budget.sum, budget.unit)}`
        : "";
    const warning = ended ? `. It is too large to be split${sum}${agree}` : "";
    const words = budget
      ? `${budget.what} ${numberOf(budget.total, budget.unit)}${warning}${partly}`
      : why;
    // to the digits that the sentence has, and not beyond the time
    const until = ended && budget.until > 0 ? Math.floor(100 * budget.until) / 100 : 0;
    const shorter =
      until > 0
        ? [
            " ",
            h(
              "button",
              { type: "button", class: "try", onclick: () => actions.setSplit({ time: until }) },
              `split it until ${seconds(until)}`,
            ),
          ]
        : [];
    return h(
      "figure",
      {},
      h("figcaption", {}, h("b", {}, labelOf(m)), ` ${words}`, ...shorter),
      ...(budget && !ended
        ? [
            bar(
              m,
              budget.parts,
              budget.unit,
              `${labelOf(m)}: ${words}; the parts are in the table below`,
            ),
          ]
        : []),
    );
  }

  function fillTable() {
    table.replaceChildren(
      h(
        "table",
        { class: "numbers" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("th", { scope: "col" }, "method"),
            h("th", { scope: "col" }, "all"),
            ...shown.order.map(({ word, about: title }) => h("th", { scope: "col", title }, word)),
          ),
        ),
        h(
          "tbody",
          {},
          ...study().methods.map((method, m) => {
            const budget = budgetOf(method);
            return h(
              "tr",
              {},
              h("th", { scope: "row" }, labelOf(m), budget && !budget.holds ? ", not split" : ""),
              ...(budget
                ? [budget.total, ...shown.order.map(({ name }) => budget.parts[name])].map(
                    (value) => h("td", {}, numberOf(value, budget.unit)),
                  )
                : [h("td", { colspan: shown.order.length + 1 }, method.reason || "–")]),
            );
          }),
        ),
      ),
    );
  }

  /** Cut joints carry no coordinate of their own. */
  function fillMenu() {
    const names = (data.scene?.coordinates ?? []).map(({ name }) => name);
    menu.replaceChildren(
      h("option", { value: "" }, "the coordinate with the largest error"),
      ...names.map((name) => h("option", { value: name }, name)),
    );
    menu.value = actions.judged();
    choice.hidden = shown.name !== "error" || names.length < 2;
  }

  function paint() {
    shown = SHOWS.find(({ name }) => name === data.view.budget) ?? SHOWS[0];
    choices.forEach((node, i) => node.setAttribute("aria-pressed", String(SHOWS[i] === shown)));
    fillMenu();
    fillFields();
    if (!study()) {
      return;
    }
    about.textContent =
      shown.name === "error"
        ? "Each bar shows the parts of one method's error as shares: parts that pushed the coordinate forward point right, parts that held it back point left. An error too large to be the sum of its parts has no bar; an earlier end or a smaller step, typed above, has one."
        : "Each bar shows the parts that added energy (right) and removed energy (left) as shares. Their sum is the energy change.";
    const judged = [...new Set(study().methods.flatMap(({ error }) => error?.coordinate ?? []))];
    if (shown.name === "error" && judged.length && !actions.judged()) {
      about.append(
        ` Judged is the coordinate whose error is largest at the end: ${judged.join(", ")}.`,
        judged.length > 1
          ? " It is not the same for all methods, so compare the shares, not the sizes."
          : "",
      );
    }
    list.replaceChildren(...study().methods.map(row));
    legend.replaceChildren(
      ...shown.order.map(({ letter, about: words }, i) =>
        h(
          "li",
          {},
          s(
            "svg",
            { class: "budget key", viewBox: "0 0 18 18", "aria-hidden": "true" },
            s("rect", { width: 18, height: 18, class: `part part-${i}` }),
            s("text", { x: 9, y: 13, class: "letter" }, letter),
          ),
          words,
        ),
      ),
    );
    fillTable();
  }

  return { el, paint };
}
