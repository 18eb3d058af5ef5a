// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The methods side by side: what is drawn how, its gap, its energy change, its cost, and its state
// in words.
import { bound, quantity, withPowers } from "../state/format.js";
import { offReference } from "../state/reference.js";
import { limits } from "../state/catalogue.js";
import { cardOf, parseSpelling } from "../state/spelling.js";
import { listen } from "../state/store.js";
import { trendOf } from "../state/words.js";
import { h, icon, s, say, set } from "../widgets/dom.js";

const GREEK = { alpha: "α", beta: "β" };
const REDRAW = 120; // [ms] numbers that change faster cannot be read

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {(m: number) => void} openDialog edits method m, or adds one (m = -1)
 * @param {(kind: string) => void} openStudy
 */
export function createMethods(el, store, actions, openDialog, openStudy) {
  const data = store.data;
  const body = h("tbody", { role: "rowgroup" });
  const add = h(
    "button",
    { type: "button", class: "quiet", onclick: () => openDialog(-1) },
    icon("plus"),
    "add a method",
  );
  const studies = h(
    "button",
    {
      type: "button",
      class: "quiet",
      title: "what accuracy costs (W), where steps are stable (B), where the error comes from (E)",
      onclick: () => openStudy("work-precision"),
    },
    "studies",
  );
  const head = (text, title) => h("th", { scope: "col", role: "columnheader", title }, text);
  const table = h(
    "table",
    { role: "table", class: "method-table" },
    h(
      "thead",
      { role: "rowgroup" },
      h(
        "tr",
        { role: "row" },
        h("th", { scope: "col", role: "columnheader" }, h("span", { class: "hidden" }, "Shown")),
        head("Method", "formulation, integrator and step; click to draw it opaque"),
        head("Loop gap", "‖φ‖: how far the cut joint has come apart"),
        head(
          "Energy change",
          "since the start; in this motion energy should stay unless a load or damper works",
        ),
        head("Cost per step", "processor time and arithmetic operations"),
        h("th", { scope: "col", role: "columnheader" }, h("span", { class: "hidden" }, "More")),
      ),
    ),
    body,
  );
  el.replaceChildren(
    h(
      "div",
      { class: "title" },
      h("h2", { id: "methods-title" }, "Methods"),
      h("div", { class: "choices" }, studies, add),
    ),
    table,
  );

  /** @type {{row: HTMLElement, parts: Record<string, HTMLElement>}[]} */
  let rows = [];
  let refusals = data.refused;
  let timer = 0;
  let painted = 0;

  function swatch(method) {
    const look = data.look.slots[method.slot];
    return s(
      "svg",
      { viewBox: "0 0 34 12", class: `swatch slot-${method.slot}`, "aria-hidden": "true" },
      s("path", { d: "M1 6H33", "stroke-dasharray": look.dash.join(" ") || null }),
    );
  }

  /** "α = 5, β = 5, rk4, h = 1 ms": no line breaks within a setting. */
  function settingWords(method) {
    const { formulation, integrator } = parseSpelling(method.spelling);
    const words = (list) =>
      list.map(([key, value]) => `${GREEK[key] ?? key} = ${key === "h" ? `${value} s` : value}`);
    return [...words(formulation.settings), integrator.name, ...words(integrator.settings)]
      .map((word) => word.replaceAll(" ", "\u00a0"))
      .join(", ");
  }

  function makeRow(method, m) {
    const parts = {
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
          title: withPowers(`${method.title}: ${method.rule}`),
        },
        swatch(method),
        h("span", { class: "name" }, method.label),
      ),
      gap: h("span", { class: "number" }),
      trend: h("span", { class: "trend" }),
      energy: h("span", { class: "number" }),
      off: h("span", {
        class: "sub number",
        title: "distance of the drawn point that is farthest from the reference solution",
      }),
      cost: h("span", { class: "number" }),
      ops: h("span", { class: "sub number" }),
      why: h(
        "button",
        {
          type: "button",
          class: "quiet why",
          onclick: () => actions.setView({ why: m }),
          "aria-label": `Why? ${method.label}`,
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
          title: "change or remove",
        },
        icon("edit"),
      ),
    };
    const name = h(
      "td",
      { role: "cell", class: "who" },
      parts.select,
      h("span", { class: "sub" }, settingWords(method)),
    );
    if (method.model_error) {
      name.append(h("span", { class: "badge" }, "model error: halving h does not help"));
    }
    const row = h(
      "tr",
      { role: "row" },
      h("td", { role: "cell", class: "check" }, parts.check),
      name,
      h("td", { role: "cell", "data-label": "gap" }, parts.gap, parts.trend),
      h("td", { role: "cell", "data-label": "energy change" }, parts.energy, parts.off),
      h("td", { role: "cell", "data-label": "cost per step" }, parts.cost, parts.ops),
      h("td", { role: "cell", class: "more" }, parts.why, parts.edit),
    );
    return { row, parts };
  }

  /** A method that the scene cannot serve stays in the table, with the reason. */
  function refusedRow({ spelling, reason }) {
    const { formulation } = parseSpelling(spelling);
    const card = cardOf(data.catalogue, "formulation", formulation.name);
    const text = `does not serve this scene: ${reason}`;
    return h(
      "tr",
      { role: "row", class: "refused" },
      h("td", { role: "cell", class: "check" }),
      h(
        "td",
        { role: "cell", class: "who", colspan: 4 },
        h("span", { class: "name" }, card?.short_name ?? formulation.name),
        h("span", { class: "sub" }, spelling),
        h("span", { class: "refusal" }, text),
      ),
      h(
        "td",
        { role: "cell", class: "more" },
        h(
          "button",
          {
            type: "button",
            class: "quiet",
            "aria-label": `Forget ${spelling}`,
            onclick: () =>
              actions.setRefused(data.refused.filter((other) => other.spelling !== spelling)),
          },
          "forget",
        ),
      ),
    );
  }

  function rebuild() {
    rows = data.methods.map(makeRow);
    refusals = data.refused;
    body.replaceChildren(...rows.map(({ row }) => row), ...refusals.map(refusedRow));
    add.disabled = data.methods.length >= limits().methods;
    add.title = add.disabled ? `${limits().methods} methods at most` : "";
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
      /** @type {HTMLInputElement} */ (parts.check).checked = !data.view.hidden.has(m);
    });
    paint();
  }

  /**
   * A failed method keeps the numbers of its last good frame.
   * @param {Float64Array} column
   * @param {number} now
   */
  function lastGood(column, now) {
    let i = now;
    while (i > 0 && Number.isNaN(column[i])) {
      i--;
    }
    return i;
  }

  /**
   * Between samples, and past the reference's end, there is nothing to say.
   * @param {number} m
   * @param {number} i
   */
  function offWords(m, i) {
    const { history, reference } = data;
    const off = offReference(reference, history.frameAt(i), history.pointsAt(m, i));
    return Number.isNaN(off) || !reference
      ? ""
      : `off ${off <= reference.own ? `< ${bound(off, "m")}` : quantity(off, "m", 2)}`;
  }

  function paint() {
    const history = data.history;
    const now = data.view.shown < 0 ? (history?.count ?? 0) - 1 : data.view.shown;
    painted = performance.now();
    if (!history || now < 0 || rows.length !== history.nMethods) {
      return;
    }
    const loops = (data.scene?.m ?? 0) > 0;
    rows.forEach(({ row, parts }, m) => {
      const column = history.columns[m];
      const last = lastGood(column.steps, now);
      const trend = trendOf(history, m, now);
      const steps = column.steps[last];
      say(parts.gap, loops ? quantity(column.gap[last], "m") : "no loop");
      say(parts.trend, loops || trend.tone === "bad" ? `${trend.arrow} ${trend.word}` : "");
      row.dataset.tone = trend.tone;
      say(parts.energy, quantity(column.energy_change[last], "J"));
      say(parts.off, offWords(m, last));
      say(parts.cost, steps > 0 ? `${quantity(column.cpu[last] / steps, "s")}` : "–");
      say(parts.ops, steps > 0 ? `${Math.round(column.ops[last] / steps)} ops` : "");
    });
  }

  function update() {
    const wait = REDRAW - (performance.now() - painted);
    if (wait <= 0) {
      paint();
    } else if (!timer) {
      timer = window.setTimeout(() => {
        timer = 0;
        paint();
      }, wait);
    }
  }

  const stop = listen(store, { methods: rebuild, view: showView, reference: paint });
  return {
    update,
    dispose() {
      stop();
      clearTimeout(timer);
      el.replaceChildren();
    },
  };
}
