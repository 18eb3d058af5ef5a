// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Four curves over one clock: loop gap, speed gap or distance from the reference, energy change,
// cost; each with a table as its twin. What the reference solution does, or may itself be off, is
// grey.
import { niceAbove, quantity } from "../state/format.js";
import { thin } from "../state/history.js";
import { createGrowing, offReference } from "../state/reference.js";
import { listen } from "../state/store.js";
import { createPlot } from "../widgets/plot.js";
import { h, icon, say } from "../widgets/dom.js";

const REDRAW = 66; // [ms]
const BUCKETS = 240;
const TABLE_ROWS = 9;
const COSTS = [
  {
    column: "ops",
    word: "ops",
    about: "arithmetic operations so far",
    title: "Cost, ops",
    unit: "",
  },
  {
    column: "evals",
    word: "evals",
    about: "evaluations of the dynamics so far",
    title: "Cost, evals",
    unit: "",
  },
  { column: "cpu", word: "time", about: "processor time so far", title: "Cost, s", unit: "s" },
];
const MOTIONS = [
  {
    column: "velocity_gap",
    word: "‖Jv‖",
    about: "‖Jv‖: how fast the loops come apart",
    title: "Speed gap, m/s",
    unit: "m/s",
    loop: true,
  },
  {
    column: "off",
    word: "error",
    about: "distance of the drawn point that is farthest from the reference solution",
    title: "Off the reference, m",
    unit: "m",
    loop: false,
  },
];
const PLOTS = [
  { column: "gap", title: "Loop gap ‖φ‖, m", unit: "m", log: true, loop: true, choices: [] },
  { ...MOTIONS[0], log: true, choices: MOTIONS },
  { column: "energy_change", title: "Energy change |ΔE|, J", unit: "J", log: true, choices: [] },
  { ...COSTS[0], log: false, choices: COSTS },
];

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createPlots(el, store, actions) {
  const data = store.data;
  const figures = PLOTS.map(makeFigure);
  el.replaceChildren(...figures.map(({ figure }) => figure));
  let painted = 0;
  let timer = 0;
  let run = -1;

  function makeFigure(spec) {
    const kind = { ...spec };
    const canvas = h("div", { class: "curve" });
    const empty = h("p", { class: "no-curve", hidden: true });
    canvas.append(empty);
    const table = h("div", { class: "twin", tabindex: "0", hidden: true });
    const title = h("span", { class: "axis-title" }, kind.title);
    const twin = h(
      "button",
      { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => toggleTwin() },
      icon("table"),
      "table",
    );
    const choices = kind.choices.map((choice) =>
      h(
        "button",
        {
          type: "button",
          class: "quiet",
          "aria-pressed": String(choice.column === kind.column),
          title: choice.about,
          onclick: () => choose(choice),
        },
        choice.word,
      ),
    );
    const figure = h(
      "figure",
      { class: "plot" },
      h("figcaption", {}, title, h("span", { class: "choices" }, ...choices, twin)),
      canvas,
      table,
    );
    const options = { log: kind.log, unit: kind.unit, onPick: (t) => actions.showTime(t) };
    const plot = createPlot(canvas, options);

    function toggleTwin() {
      const on = twin.getAttribute("aria-pressed") !== "true";
      twin.setAttribute("aria-pressed", String(on));
      table.hidden = !on;
      canvas.hidden = on;
      paint();
    }

    function choose(choice) {
      Object.assign(kind, choice);
      options.unit = choice.unit;
      say(title, choice.title);
      choices.forEach((node, i) =>
        node.setAttribute("aria-pressed", String(kind.choices[i] === choice)),
      );
      setSeries(true);
      paint();
    }
    return { kind, canvas, table, figure, plot, empty };
  }

  function inks() {
    const surface = data.look.surfaces[data.theme];
    return {
      text: surface.ink,
      muted: surface.muted,
      hairline: surface.hairline,
      paper: surface.paper,
    };
  }

  /** @param {boolean} anew */
  function setSeries(anew) {
    if (!data.look || !data.history) {
      return;
    }
    const series = data.methods.map((method, m) => {
      const look = data.look.slots[method.slot];
      return {
        label: method.label,
        colour: look[data.theme],
        dash: look.dash,
        width: m === data.view.selected ? 2.5 : 1.5,
        ended: data.history.ended[m],
        present: true,
      };
    });
    figures.forEach(({ kind, plot }) =>
      plot.setSeries(
        [...series.map((one) => ({ ...one })), ...greySeries(kind)],
        inks(),
        anew,
        niceAbove(Math.min(1, data.duration || 1)),
      ),
    );
    figures.forEach(tellEmpty);
    painted = 0;
    update();
  }

  /** The reference among the methods' curves: its energy, or what it may itself be off. */
  function hasGrey(kind) {
    return data.reference?.state === "ready" && ["energy_change", "off"].includes(kind.column);
  }

  function greySeries(kind) {
    const { dash } = data.look.reference;
    const colour = data.look.reference[data.theme];
    const label = kind.column === "off" ? "its own error" : "reference";
    return hasGrey(kind) ? [{ label, colour, dash, width: 1.5, ended: NaN, present: false }] : [];
  }

  /** Its values over the kept frames; none past its end, and none where it is not drawn. */
  function greyColumn(kind) {
    const { history, reference } = data;
    if (!reference) {
      return new Float64Array(history.count).fill(NaN);
    }
    return Float64Array.from({ length: history.count }, (_, i) => {
      const k = history.frameAt(i) / reference.stride;
      const known = Number.isInteger(k) && k < reference.points.length;
      return !known || !data.view.reference
        ? NaN
        : kind.column === "off"
          ? reference.own
          : reference.energy[k] - reference.energy[0];
    });
  }

  /** Why there is no curve, and what gives one. */
  function tellEmpty({ kind, empty }) {
    const { reference } = data;
    const lacks = kind.column === "off" && reference?.state !== "ready";
    const loopless = kind.loop && data.scene?.m === 0;
    empty.hidden = !lacks && !loopless;
    const compute = h(
      "button",
      { type: "button", class: "quiet", onclick: () => actions.computeReference() },
      "compute it",
    );
    empty.replaceChildren(
      lacks
        ? `no reference solution: ${reference?.reason ?? "it is asked for"} `
        : "this mechanism has no loop that could open",
      ...(lacks && reference?.state === "none" ? [compute] : []),
    );
  }

  const offColumns = createGrowing((m, i) =>
    offReference(data.reference, data.history.frameAt(i), data.history.pointsAt(m, i)),
  );

  /** A quantity of every method. @param {string} name @returns {Float64Array[]} */
  function columnsOf(name) {
    return name === "off"
      ? offColumns(data.history, data.reference)
      : data.history.columns.map((column) => column[name]);
  }

  function shown() {
    const last = data.history.count - 1;
    return data.view.shown < 0 ? last : Math.min(data.view.shown, last);
  }

  function paint() {
    painted = performance.now();
    const history = data.history;
    if (!history || history.count === 0 || !data.look || history.nMethods !== data.methods.length) {
      return;
    }
    const now = history.t[shown()];
    const last = history.t[history.count - 1];
    const nothing = new Float64Array(history.count).fill(NaN);
    for (const { kind, plot, table, canvas } of figures) {
      if (canvas.hidden) {
        fillTable(table, kind);
        continue;
      }
      const map = kind.log
        ? (v) => (Number.isNaN(v) || v === 0 ? null : Math.max(Math.abs(v), plot.floor))
        : (v) => (Number.isNaN(v) ? null : v);
      const columns = columnsOf(kind.column).map((column, m) =>
        data.view.hidden.has(m) ? nothing : column,
      );
      const grey = hasGrey(kind);
      if (grey) {
        columns.push(greyColumn(kind));
      }
      plot.setEnded(
        [...history.ended, ...(grey ? [NaN] : [])],
        [
          ...data.methods.map(
            (_, m) =>
              !data.view.hidden.has(m) &&
              !(kind.loop && data.scene.m === 0) &&
              !(kind.column === "off" && !grey),
          ),
          ...(grey ? [false] : []),
        ],
      );
      plot.draw(thin(history.t, columns, history.count, BUCKETS, map), last, now);
    }
  }

  function fillTable(table, kind) {
    const history = data.history;
    const now = shown();
    const rows = [];
    for (let k = 0; k <= TABLE_ROWS; k++) {
      const i = Math.round((now * k) / TABLE_ROWS);
      if (k === 0 || i !== rows[rows.length - 1]) {
        rows.push(i);
      }
    }
    const columns = columnsOf(kind.column);
    const visible = data.methods
      .map((method, m) => ({ method, m }))
      .filter(({ m }) => !data.view.hidden.has(m));
    table.setAttribute("aria-label", kind.title);
    table.replaceChildren(
      h(
        "table",
        { class: "numbers" },
        h("caption", { class: "hidden" }, `${kind.title} over time`),
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            h("th", { scope: "col" }, "t, s"),
            ...visible.map(({ method }) => h("th", { scope: "col" }, method.label)),
          ),
        ),
        h(
          "tbody",
          {},
          ...rows.map((i) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, history.t[i].toFixed(2)),
              ...visible.map(({ m }) => h("td", {}, quantity(columns[m][i], kind.unit))),
            ),
          ),
        ),
      ),
    );
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

  const stop = listen(store, {
    methods: () => {
      setSeries(run !== data.run);
      run = data.run;
    },
    view: () => setSeries(false),
    theme: () => setSeries(false),
    reference: () => setSeries(false),
  });
  return {
    update,
    dispose() {
      stop();
      clearTimeout(timer);
      figures.forEach(({ plot }) => plot.dispose());
      el.replaceChildren();
    },
  };
}
