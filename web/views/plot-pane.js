// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// One plot with its menu of quantities, the switch between decades and a linear axis, and a table
// of the same numbers.
import { ROUNDING, quantity } from "../state/format.js";
import { thin } from "../state/history.js";
import { QUANTITIES, quantityNamed } from "../state/quantities.js";
import { sentenceCase } from "../state/words.js";
import { shownIndex } from "../state/store.js";
import { h, icon, set } from "../widgets/dom.js";
import { createPhase } from "../widgets/phase.js";
import { createPlot } from "../widgets/plot.js";

const LEAST_BUCKETS = 240; // of two points each; a wider plot has one for each pixel
const PHASE = "phase"; // the choice that is no quantity over time
/** A value of rounding has one digit: more of them mean nothing. */
const cellWords = (value, unit) => quantity(value, unit, Math.abs(value) < ROUNDING ? 1 : 2);
const PHASE_ABOUT =
  "the velocity of one coordinate against the coordinate itself: a motion that repeats is a closed curve";
const KEPT_DASH = [1, 4];
/** Widths of the table [px]. */
const NAME_WIDTH = 92;
const CELL_WIDTH = 74;
const LEAST_TABLE = 320;
const MOST_TIMES = 10;

/**
 * @param {import("../state/store.js").Data} data
 * @param {import("../session/session.js").Session} actions
 * @param {{
 *   id: string, onHover: (t: number | null) => void,
 *   onZoom: (zoom: import("../widgets/plot.js").Zoom) => void,
 * }} how id: its name in the view's plots
 */
export function createPlotPane(data, actions, { id, onHover, onZoom }) {
  const wanted = () => data.view.plots[id];
  let obeyed = JSON.stringify(wanted());
  let kind = quantityNamed(wanted().of);
  const options = {
    log: kind.log,
    unit: kind.unit,
    onPick: (t) => actions.showTime(t),
    onHover,
    onZoom,
  };

  const menu = h(
    "select",
    { id: `plot-${id}`, class: "axis-title", "aria-label": "Quantity of the plot" },
    ...QUANTITIES.map(({ name, title }) => h("option", { value: name }, title)),
    h("option", { value: PHASE }, "Phase plot: velocity against coordinate"),
  );
  menu.value = wanted().of;
  menu.addEventListener("change", () => ask({ of: menu.value, turned: false, coordinate: "" }));
  const which = h("select", {
    class: "axis-title",
    "aria-label": "Coordinate of the phase plot",
    hidden: true,
    onchange: () => ask({ coordinate: which.value }),
  });
  let isPhase = false;
  const what = h("button", { type: "button", class: "term what" }, "?");
  const log = h(
    "button",
    { type: "button", class: "quiet", onclick: () => ask({ turned: !wanted().turned }) },
    "log",
  );
  const twin = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "aria-pressed": "false",
      onclick: () => ask({ table: !wanted().table }),
    },
    icon("table"),
    "table",
  );
  const whole = h(
    "button",
    { type: "button", class: "quiet", hidden: true, onclick: () => onZoom(null) },
    "whole run",
  );
  const empty = h("p", { class: "no-curve", hidden: true });
  const canvas = h("div", { class: "curve" }, empty);
  const table = h("div", { class: "twin", tabindex: "0", role: "region", hidden: true });
  const figure = h(
    "figure",
    { class: "plot" },
    h("figcaption", {}, menu, what, which, h("span", { class: "choices" }, whole, log, twin)),
    canvas,
    table,
  );
  const plot = createPlot(canvas, options);
  const phase = createPhase(canvas);

  /** @param {string} about @param {string} name of what is drawn */
  function explain(about, name) {
    set(what, { "data-tip": sentenceCase(about), "aria-label": `What is this: ${name}` });
  }

  /** @param {Partial<import("../state/shown.js").Plot>} change of what this plot shows */
  function ask(change) {
    actions.setView({ plots: { ...data.view.plots, [id]: { ...wanted(), ...change } } });
  }

  /** Shows what the view asks for, where it is something else than before. */
  function obey() {
    const now = JSON.stringify(wanted());
    plot.setZoom(data.view.zoom);
    whole.hidden = data.view.zoom === null;
    if (now === obeyed) {
      return;
    }
    obeyed = now;
    const { of, turned, table: on } = wanted();
    set(twin, { "aria-pressed": String(on) });
    table.hidden = !on;
    canvas.hidden = on;
    choose(of, turned);
  }

  /** @param {string} name of a quantity @param {boolean} turned */
  function choose(name, turned) {
    isPhase = name === PHASE;
    menu.value = name;
    phase.show(isPhase);
    canvas.classList.toggle("of-phase", isPhase);
    which.hidden = !isPhase;
    log.hidden = twin.hidden = isPhase;
    if (isPhase) {
      explain(PHASE_ABOUT, "phase plot");
      fillCoordinates();
      empty.hidden = true;
      paint();
      return;
    }
    kind = quantityNamed(name);
    options.log = kind.log !== turned;
    options.unit = kind.unit;
    setSeries(true);
    paint();
  }

  /** The coordinates of the scene, as choices for the phase plot. */
  function fillCoordinates() {
    const names = data.scene?.coordinates.map(({ name }) => name) ?? [];
    if (names.join() !== [...which.options].map(({ value }) => value).join()) {
      which.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
    }
    if (names.includes(wanted().coordinate)) {
      which.value = wanted().coordinate;
    }
  }

  function paintPhase() {
    fillCoordinates();
    const k = Math.max(0, which.selectedIndex);
    const { history, methods, view, scene } = data;
    const column = (m, part) =>
      Float64Array.from({ length: history.count }, (_, i) => history.stateAt(m, i)[part][k]);
    const orbits = methods.flatMap((method, m) =>
      view.hidden.has(m) ? [] : [{ ...styleOf(method, m), x: column(m, "q"), y: column(m, "v") }],
    );
    const coordinate = scene.coordinates[k];
    phase.draw(orbits, shownIndex(data), { x: coordinate.name, y: coordinate.rate });
  }

  /** Returns how a method is drawn. */
  const styleOf = (method, m) => ({
    label: method.label,
    colour: data.look.slots[method.slot][data.theme],
    dash: data.look.slots[method.slot].dash,
    width: m === data.view.selected ? 2.5 : 1.5,
  });

  /** The reference among the methods' curves: its own error. */
  const hasGrey = () => data.reference?.state === "ready" && kind.grey !== "";

  /** Is there anything to draw for a method? @param {number} m */
  const isPresent = (m) =>
    !data.view.hidden.has(m) &&
    !(kind.loop && data.scene?.m === 0) &&
    !(kind.reference && data.reference?.state !== "ready");

  /** Its values over the kept frames; none past its end, and none where it is not drawn. */
  function greyColumn() {
    const { history, reference } = data;
    const column = new Float64Array(history.count).fill(NaN);
    if (reference && data.view.reference) {
      column.forEach((_, i) => {
        const k = history.frameAt(i) / reference.stride;
        const known = Number.isInteger(k) && k < reference.points.length;
        column[i] = known ? reference.own : NaN;
      });
    }
    return column;
  }

  /** A recording of this scene that was kept. */
  const keptRun = () => (data.kept?.scene === data.scene?.id ? data.kept : null);

  /** Values of a kept method at the times of the present run; none past its end. */
  function keptColumn(kept, m) {
    const { history } = data;
    const column = kind.columnOf({ ...data, history: kept.history, methods: kept.methods }, m);
    const last = kept.history.t[kept.history.count - 1];
    return Float64Array.from({ length: history.count }, (_, i) =>
      history.t[i] <= last ? column[kept.history.indexAt(history.t[i])] : NaN,
    );
  }

  /** @param {import("../state/store.js").Method} method @param {number} m */
  const keptSeries = (method, m) => ({
    ...styleOf(method, m),
    label: m === data.view.selected ? `${method.label}, kept` : "",
    width: 1.2,
    dash: KEPT_DASH,
    ended: NaN,
    present: false,
  });

  function inks() {
    const { ink, muted, hairline, paper } = data.look.surfaces[data.theme];
    return { text: ink, muted, hairline, paper };
  }

  /** @param {boolean} anew forget the ranges */
  function setSeries(anew) {
    if (!data.look || !data.history) {
      return;
    }
    const series = data.methods.map((method, m) => ({
      ...styleOf(method, m),
      ended: data.history.ended[m],
      present: true,
    }));
    if (hasGrey()) {
      const label = "reference";
      const { dash, [data.theme]: colour } = data.look.reference;
      series.push({ label, colour, dash, width: 1.5, ended: NaN, present: false });
    }
    series.push(...(keptRun()?.methods ?? []).map(keptSeries));
    set(log, { "aria-pressed": String(options.log) });
    set(menu, { "data-tip": kind.about });
    explain(kind.about, kind.short);
    plot.setSeries(series, inks(), anew, data.duration || 1);
    showEmpty();
  }

  /** Why there is no curve, and what gives one. */
  function showEmpty() {
    const { reference } = data;
    const lacks = kind.reference && reference?.state !== "ready";
    const loopless = kind.loop && data.scene?.m === 0;
    empty.hidden = isPhase || (!lacks && !loopless);
    const compute = h(
      "button",
      { type: "button", class: "quiet", onclick: () => actions.computeReference() },
      "compute it",
    );
    empty.replaceChildren(
      lacks
        ? `no reference solution: ${reference?.reason || "it is being asked for"} `
        : "this mechanism has no loop that could open",
      ...(lacks && reference?.state === "none" && !data.pulled ? [compute] : []),
    );
  }

  function paint() {
    const { history } = data;
    if (!history || history.count === 0 || !data.look || history.nMethods !== data.methods.length) {
      return;
    }
    if (canvas.hidden) {
      fillTable();
      return;
    }
    if (isPhase) {
      paintPhase();
      return;
    }
    const nothing = new Float64Array(history.count).fill(NaN);
    const columns = data.methods.map((_, m) => (isPresent(m) ? kind.columnOf(data, m) : nothing));
    const grey = hasGrey();
    if (grey) {
      columns.push(greyColumn());
    }
    const kept = keptRun();
    columns.push(...(kept?.methods ?? []).map((_, m) => keptColumn(kept, m)));
    const others = columns.length - data.methods.length;
    plot.setEnded(
      [...history.ended, ...Array(others).fill(NaN)],
      [...data.methods.map((_, m) => isPresent(m)), ...Array(others).fill(false)],
    );
    const map = options.log
      ? (v) => (Number.isNaN(v) || v === 0 ? null : Math.max(Math.abs(v), plot.floor))
      : (v) => (Number.isNaN(v) ? null : v);
    const last = history.t[history.count - 1];
    const [from, to] = history.inSight(data.view.zoom);
    const seen = (column) => column.subarray(from, to);
    const buckets = Math.max(LEAST_BUCKETS, plot.width);
    const thinned = thin(seen(history.t), columns.map(seen), to - from, buckets, map);
    plot.draw(thinned, last, history.t[shownIndex(data)]);
  }

  /** Indices of the frames in the table: as many as fit side by side, evenly spread until now. */
  function tableFrames() {
    const now = shownIndex(data);
    const room = (table.clientWidth || LEAST_TABLE) - NAME_WIDTH;
    const most = Math.max(2, Math.min(MOST_TIMES, Math.floor(room / CELL_WIDTH)));
    const chosen = Array.from({ length: most }, (_, k) => Math.round((now * k) / (most - 1)));
    return [...new Set(chosen)];
  }

  /** A row per method and a column per time, so that nothing is cut off. */
  function fillTable() {
    const { history } = data;
    const frames = tableFrames();
    const drawn = data.methods.map((_, m) => m).filter((m) => !data.view.hidden.has(m));
    const head = frames.map((i) => h("th", { scope: "col" }, `${history.t[i].toFixed(2)} s`));
    const rows = drawn.map((m) => {
      const column = kind.columnOf(data, m);
      const cells = frames.map((i) => h("td", {}, cellWords(column[i], kind.unit)));
      return h("tr", {}, h("th", { scope: "row" }, data.methods[m].label), ...cells);
    });
    set(table, { "aria-label": kind.title });
    table.replaceChildren(
      h(
        "table",
        { class: "numbers" },
        h("caption", { class: "hidden" }, `${kind.title} over time`),
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "method"), ...head)),
        h("tbody", {}, ...rows),
      ),
    );
  }

  return {
    figure,
    setSeries,
    paint,
    obey,
    setHover: (t) => plot.setHover(t),
    dispose: () => plot.dispose(),
  };
}
