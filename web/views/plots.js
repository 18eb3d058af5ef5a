// @ts-check
// Four curves over one clock: loop gap, velocity error, energy change, cost; each with a table as its twin.
import { niceAbove, quantity } from "../state/format.js";
import { thin } from "../state/history.js";
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
const PLOTS = [
  { column: "gap", title: "Loop gap ‖φ‖, m", unit: "m", log: true, loop: true },
  { column: "velocity_gap", title: "Velocity error ‖Jv‖, m/s", unit: "m/s", log: true, loop: true },
  { column: "energy_change", title: "Energy change |ΔE|, J", unit: "J", log: true },
  { ...COSTS[0], log: false, costs: true },
];

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../state/session.js").Session} actions
 */
export function createPlots(el, store, actions) {
  const data = store.data;
  const figures = PLOTS.map(makeFigure);
  el.replaceChildren(...figures.map(({ figure }) => figure));
  let painted = 0;
  let timer = 0;
  let generation = -1;

  function makeFigure(spec) {
    const kind = { ...spec };
    const canvas = h("div", { class: "curve" });
    const empty = h(
      "p",
      { class: "no-curve", hidden: true },
      "this mechanism has no loop that could open",
    );
    canvas.append(empty);
    const table = h("div", { class: "twin", tabindex: "0", hidden: true });
    const title = h("span", { class: "axis-title" }, kind.title);
    const twin = h(
      "button",
      { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => toggleTwin() },
      icon("table"),
      "table",
    );
    const choices = kind.costs
      ? COSTS.map((cost) =>
          h(
            "button",
            {
              type: "button",
              class: "quiet",
              "aria-pressed": String(cost.column === kind.column),
              title: cost.about,
              onclick: () => chooseCost(cost),
            },
            cost.word,
          ),
        )
      : [];
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

    function chooseCost(cost) {
      Object.assign(kind, cost);
      options.unit = cost.unit;
      say(title, cost.title);
      choices.forEach((node, i) => node.setAttribute("aria-pressed", String(COSTS[i] === cost)));
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
    figures.forEach(({ plot }) =>
      plot.setSeries(
        series.map((one) => ({ ...one })),
        inks(),
        anew,
        niceAbove(Math.min(1, data.duration || 1)),
      ),
    );
    figures.forEach(({ kind, empty }) => (empty.hidden = !(kind.loop && data.scene?.m === 0)));
    painted = 0;
    update();
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
    for (const { kind, plot, table, canvas } of figures) {
      if (canvas.hidden) {
        fillTable(table, kind);
        continue;
      }
      const map = kind.log
        ? (v) => (Number.isNaN(v) || v === 0 ? null : Math.max(Math.abs(v), plot.floor))
        : (v) => (Number.isNaN(v) ? null : v);
      const empty = new Float64Array(history.count).fill(NaN);
      const columns = history.columns.map((column, m) =>
        data.view.hidden.has(m) ? empty : column[kind.column],
      );
      plot.setEnded(
        [...history.ended],
        data.methods.map((_, m) => !data.view.hidden.has(m) && !(kind.loop && data.scene.m === 0)),
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
              ...visible.map(({ m }) =>
                h("td", {}, quantity(history.columns[m][kind.column][i], kind.unit)),
              ),
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
      setSeries(generation !== data.generation);
      generation = data.generation;
    },
    view: () => setSeries(false),
    theme: () => setSeries(false),
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
