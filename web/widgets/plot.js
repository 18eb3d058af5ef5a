// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// One plot over time: uPlot for curves and axes, drawn over it the time cursor, the names at the
// curves' ends and the places where runs ended. Pointing shows values, dragging zooms.
import uPlot from "uplot";
import { niceAbove, powerOfTen, quantity } from "../state/format.js";
import { h } from "./dom.js";
import { createEndLabels, plotFont } from "./plot-labels.js";
import { FLOOR, decadeTicks, decades, linearTicks } from "./plot-scale.js";

const NARROW = 380; // [px] below it values have less room
const LEAST_DRAG = 6; // [px] a shorter one is a click

/**
 * @typedef {{
 *   label: string, colour: string, dash: number[], width: number, ended: number, present: boolean,
 * }} Series
 * @typedef {{text: string, muted: string, hairline: string, paper: string}} Inks
 * @typedef {[number, number] | null} Zoom part of the time shown [s], or all of it
 */

/**
 * @param {HTMLElement} el
 * @param {{
 *   log: boolean, unit: string, onPick: (t: number) => void, onHover: (t: number | null) => void,
 *   onZoom: (zoom: Zoom) => void,
 * }} options `log` and `unit` may change; the next `setSeries` follows them
 */
export function createPlot(el, options) {
  /** @type {uPlot | null} */
  let plot = null;
  /** @type {Series[]} */
  let series = [];
  /** @type {Inks} */
  let ink = { text: "#000", muted: "#888", hairline: "#ddd", paper: "#fff" };
  let now = 0;
  let span = { x: 1, low: 1e-16, high: 1e-3, least: 0 };
  /** @type {Zoom} */
  let zoom = null;
  const readout = h("div", { class: "readout", hidden: true, "aria-hidden": "true" });
  const line = h("div", { class: "hover-line", hidden: true });
  const labels = createEndLabels();

  const timeRange = () => /** @type {[number, number]} */ (zoom ?? [0, span.x]);
  const valueRange = () =>
    /** @type {[number, number]} */ (
      options.log ? [span.low, span.high] : [span.least, span.high || 1]
    );
  const valueTicks = () => (options.log ? decadeTicks : linearTicks)(...valueRange());
  const valueWords = (v) =>
    options.log ? powerOfTen(Math.round(Math.log10(v))) : quantity(v, options.unit);

  /** The whole run again. */
  function zoomOut() {
    options.onZoom(null);
    return null;
  }

  function makeOptions() {
    /** @type {uPlot.Axis} */
    const shared = {
      stroke: () => ink.muted,
      font: plotFont(),
      grid: { stroke: () => ink.hairline, width: 1 },
      ticks: { show: false },
    };
    const time = {
      ...shared,
      size: 22,
      gap: 2,
      label: "time, s",
      labelSize: 16,
      labelGap: 0,
      labelFont: plotFont(),
      space: 44,
      splits: () => linearTicks(...timeRange()),
      values: (_, ticks) => ticks.map((v) => String(Number(v.toPrecision(4)))),
    };
    const value = {
      ...shared,
      size: el.clientWidth < NARROW ? 46 : 56,
      gap: 4,
      space: 10,
      splits: valueTicks,
      values: (_, ticks) => ticks.map(valueWords),
      filter: (_, ticks) => ticks,
    };
    return /** @type {uPlot.Options} */ ({
      width: Math.max(120, el.clientWidth),
      height: Math.max(80, el.clientHeight),
      padding: [8, 12, 0, 0],
      legend: { show: false },
      cursor: {
        x: false,
        y: false,
        points: { show: false },
        drag: { x: true, y: false, setScale: false, dist: LEAST_DRAG },
        bind: { dblclick: () => zoomOut },
      },
      scales: {
        x: { time: false, range: timeRange },
        y: options.log ? { distr: 3, log: 10, range: valueRange } : { range: valueRange },
      },
      axes: [time, value],
      series: [
        {},
        ...series.map((one) => ({
          stroke: one.colour,
          width: one.width,
          dash: one.dash,
          points: { show: false },
          spanGaps: true,
        })),
      ],
      hooks: { draw: [drawOver], setSelect: [takeSelection] },
    });
  }

  /** @param {uPlot} u */
  function takeSelection(u) {
    const { left, width } = u.select;
    if (width >= LEAST_DRAG) {
      options.onZoom([u.posToVal(left, "x"), u.posToVal(left + width, "x")]);
      u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    }
  }

  /** @param {uPlot} u */
  function drawOver(u) {
    const { ctx } = u;
    const x = u.valToPos(now, "x", true);
    ctx.save();
    if (x >= u.bbox.left && x <= u.bbox.left + u.bbox.width) {
      ctx.setLineDash([]);
      ctx.strokeStyle = ink.text;
      ctx.globalAlpha = 0.55;
      ctx.lineWidth = devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x, u.bbox.top);
      ctx.lineTo(x, u.bbox.top + u.bbox.height);
      ctx.stroke();
    }
    ctx.globalAlpha = 1;
    labels.draw(u, series, { ink, now, log: options.log, range: timeRange() });
    ctx.restore();
  }

  /** A click shows a time; the end of a drag does not. @param {HTMLElement} over */
  function listenTo(over) {
    let downAt = 0;
    over.addEventListener("pointerdown", (event) => {
      downAt = event.clientX;
    });
    over.addEventListener("click", (event) => {
      if (plot && Math.abs(event.clientX - downAt) < LEAST_DRAG) {
        options.onPick(plot.posToVal(event.offsetX, "x"));
      }
    });
    over.addEventListener("pointermove", (event) => {
      if (plot) {
        options.onHover(plot.posToVal(event.offsetX, "x"));
      }
    });
    over.addEventListener("pointerleave", () => options.onHover(null));
  }

  function build() {
    plot?.destroy();
    plot = new uPlot(makeOptions(), /** @type {any} */ ([[], ...series.map(() => [])]), el);
    listenTo(plot.over);
    plot.over.append(line, readout);
  }

  /** Ranges only grow while a run lasts, so that a curve does not breathe. */
  function stretch(columns, last) {
    let low = Infinity;
    let least = 0;
    let high = 0;
    for (const column of columns.slice(1)) {
      for (const value of column) {
        if (value !== null) {
          low = Math.min(low, value);
          least = Math.min(least, value);
          high = Math.max(high, value);
        }
      }
    }
    span.x = Math.max(span.x, last);
    if (options.log) {
      const [a, b] = decades(Math.min(low, span.low), Math.max(high, span.high));
      span.low = a;
      span.high = b;
    } else {
      span.high = high > 0 ? Math.max(span.high, niceAbove(high)) : span.high;
      span.least = least < 0 ? Math.min(span.least, -niceAbove(-least)) : span.least;
    }
  }

  /** The value of a curve nearest to a time. @param {ArrayLike<number | null | undefined>} ys */
  function valueNear(ys, at) {
    for (let d = 0; d < 3; d++) {
      const value = ys[at + d] ?? ys[at - d];
      if (value !== null && value !== undefined) {
        return value;
      }
    }
    return null;
  }

  /** @param {uPlot} u @param {number} t */
  function fillReadout(u, t) {
    const at = u.valToIdx(t);
    const rows = series.flatMap((one, k) => {
      const value = valueNear(u.data[k + 1], at);
      return value === null || (!one.present && !one.label)
        ? []
        : [{ one, value: /** @type {number} */ (value) }];
    });
    rows.sort((a, b) => b.value - a.value);
    readout.replaceChildren(
      h("b", {}, `${t.toFixed(2)} s`),
      ...rows.map(({ one, value }) => {
        const key = h("i", {});
        key.style.borderTopColor = one.colour;
        return h("span", {}, key, `${one.label} `, h("b", {}, quantity(value, options.unit)));
      }),
    );
  }

  const observer = new ResizeObserver(() => {
    const { clientWidth: width, clientHeight: height } = el;
    if (plot && width > 0 && height > 0 && (plot.width !== width || plot.height !== height)) {
      const data = plot.data;
      build(); // the room beside the axes depends on the width
      plot.setData(data);
    }
  });
  observer.observe(el);

  return {
    /** The smallest value that is plotted. */
    floor: FLOOR,
    /** [px] as drawn last: the element itself would have to be laid out to tell; 0 before */
    get width() {
      return plot?.width ?? 0;
    },
    /**
     * New curves: a new comparison, another selection, another theme, another quantity.
     * @param {Series[]} wanted
     * @param {Inks} inks
     * @param {boolean} anew forget the ranges
     * @param {number} end [s] of the run: the axis of time reaches there
     */
    setSeries(wanted, inks, anew, end) {
      series = wanted;
      ink = inks;
      if (anew) {
        span = { x: end, low: 1e-10, high: options.log ? 1e-6 : 0, least: 0 };
      }
      build();
    },
    /** @param {number[]} ended per method, NaN while it runs @param {boolean[]} present */
    setEnded(ended, present) {
      series.forEach((one, k) => {
        one.ended = ended[k];
        one.present = present[k];
      });
    },
    /**
     * @param {(number | null)[][]} columns
     * @param {number} last time received
     * @param {number} t time shown
     */
    draw(columns, last, t) {
      now = t;
      stretch(columns, last);
      plot?.setData(/** @type {any} */ (columns));
    },
    /** @param {Zoom} wanted */
    setZoom(wanted) {
      if (wanted === zoom) {
        return;
      }
      zoom = wanted;
      plot?.setData(plot.data);
    },
    /** Shows the values at a time, or hides them. @param {number | null} t */
    setHover(t) {
      readout.hidden = line.hidden = t === null || !plot || plot.data[0].length === 0;
      if (t === null || !plot || readout.hidden) {
        return;
      }
      const x = plot.valToPos(t, "x");
      line.style.left = `${x}px`;
      fillReadout(plot, t);
      const right = x < plot.over.clientWidth / 2;
      readout.style.left = right ? `${x + 10}px` : "auto";
      readout.style.right = right ? "auto" : `${plot.over.clientWidth - x + 10}px`;
    },
    dispose() {
      observer.disconnect();
      plot?.destroy();
    },
  };
}
