// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// One plot: uPlot for curves and axes, drawn over it the time cursor, the names at the curves' ends
// and where a run ended.
import uPlot from "uplot";
import { niceAbove, powerOfTen, quantity } from "../state/format.js";

const FLOOR = 1e-17; // [unit] nothing smaller is drawn; an exact zero has no place on a log axis
const SWATCH = 12; // [px] of a curve before its name
const LABEL_ROOM = 13; // [px] between two names
const DECADES_LEAST = 4;

/** @param {number} min @param {number} max @returns {[number, number]} whole decades */
function decades(min, max) {
  const low = Math.floor(Math.log10(Math.max(min, FLOOR)) + 1e-9);
  const high = Math.max(Math.ceil(Math.log10(Math.max(max, FLOOR)) - 1e-9), low + DECADES_LEAST);
  return [10 ** low, 10 ** high];
}

/** Powers of ten between two, at most about six. @param {number} min @param {number} max */
function decadeTicks(min, max) {
  const low = Math.round(Math.log10(min));
  const high = Math.round(Math.log10(max));
  const step = Math.max(1, Math.ceil((high - low) / 6));
  const out = [];
  for (let e = Math.ceil(low / step) * step; e <= high; e += step) {
    out.push(10 ** e);
  }
  return out;
}

/** @param {number} max @returns {number[]} round values from 0, at most six */
function linearTicks(max) {
  const step = niceAbove(max / 5);
  const out = [];
  for (let i = 0; i * step <= max * (1 + 1e-9); i++) {
    out.push(i * step);
  }
  return out;
}

/**
 * @param {HTMLElement} el
 * @param {{log: boolean, unit: string, onPick: (t: number) => void}} options
 */
export function createPlot(el, options) {
  /** @type {uPlot | null} */
  let plot = null;
  /**
   * @type {{label: string, colour: string, dash: number[], width: number, ended: number, present:
   *   boolean}[]}
   */
  let series = [];
  let ink = { text: "#000", muted: "#888", hairline: "#ddd", paper: "#fff" };
  let now = 0;
  let span = { x: 1, low: 1e-16, high: 1e-3 };

  const font = () => `11.5px ${getComputedStyle(document.body).fontFamily}`;

  /** Beside the axes there is room for the longest name, so that no name lies on a curve. */
  function labelRoom() {
    const context = document.createElement("canvas").getContext("2d");
    if (!context) {
      return 80;
    }
    context.font = font();
    return Math.min(
      120,
      Math.max(14, ...series.map((one) => context.measureText(one.label).width + SWATCH + 14)),
    );
  }

  function makeOptions() {
    /** @type {uPlot.Axis} */
    const shared = {
      stroke: () => ink.muted,
      font: font(),
      grid: { stroke: () => ink.hairline, width: 1 },
      ticks: { show: false },
    };
    return /** @type {uPlot.Options} */ ({
      width: Math.max(120, el.clientWidth),
      height: Math.max(100, el.clientHeight),
      padding: [8, labelRoom(), 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, range: () => [0, span.x] },
        y: options.log
          ? { distr: 3, log: 10, range: () => [span.low, span.high] }
          : { range: () => [0, span.high || 1] },
      },
      axes: [
        {
          ...shared,
          size: 22,
          gap: 2,
          label: "time, s",
          labelSize: 16,
          labelGap: 0,
          labelFont: font(),
          space: 44,
          splits: () => linearTicks(span.x),
          values: (_, ticks) => ticks.map((v) => String(Number(v.toPrecision(4)))),
        },
        {
          ...shared,
          size: options.log ? 44 : 62,
          gap: 4,
          space: 10,
          splits: () =>
            options.log ? decadeTicks(span.low, span.high) : linearTicks(span.high || 1),
          values: (_, ticks) =>
            ticks.map((v) =>
              options.log ? powerOfTen(Math.round(Math.log10(v))) : quantity(v, options.unit),
            ),
          filter: (_, ticks) => ticks,
        },
      ],
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
      hooks: { draw: [drawOver] },
    });
  }

  /**
   * Names beside the last point of each curve, pushed apart where they would touch.
   * @param {uPlot} u
   */
  function endLabels(u) {
    const ratio = devicePixelRatio;
    const list = series.flatMap((one, k) => {
      const ys = u.data[k + 1];
      for (let i = ys.length - 1; i >= 0; i--) {
        const y = ys[i];
        if (y !== null && y !== undefined) {
          return [
            {
              one,
              x: u.valToPos(u.data[0][i], "x", true),
              at: u.valToPos(y, "y", true),
              y: u.valToPos(y, "y", true),
            },
          ];
        }
      }
      const zero = options.log && one.present && ys.length > 1 ? u.bbox.top + u.bbox.height : NaN;
      return Number.isNaN(zero)
        ? []
        : [
            {
              one: { ...one, label: `${one.label}: 0` },
              x: u.valToPos(now, "x", true),
              at: zero,
              y: zero,
            },
          ];
    });
    list.sort((a, b) => a.y - b.y);
    const low = u.bbox.top + 7 * ratio;
    const high = u.bbox.top + u.bbox.height - 7 * ratio;
    list.forEach((item, i) => {
      item.y = Math.max(item.y, i > 0 ? list[i - 1].y + LABEL_ROOM * ratio : low);
    });
    for (let i = list.length - 1; i >= 0; i--) {
      const most = i === list.length - 1 ? high : list[i + 1].y - LABEL_ROOM * ratio;
      list[i].y = Math.min(list[i].y, most);
    }
    return list;
  }

  /** @param {uPlot} u */
  function drawOver(u) {
    const { ctx } = u;
    const ratio = devicePixelRatio;
    const right = u.bbox.left + u.bbox.width;
    ctx.save();
    const x = u.valToPos(now, "x", true);
    ctx.setLineDash([]);
    ctx.strokeStyle = ink.text;
    ctx.globalAlpha = 0.55;
    ctx.lineWidth = ratio;
    ctx.beginPath();
    ctx.moveTo(x, u.bbox.top);
    ctx.lineTo(x, u.bbox.top + u.bbox.height);
    ctx.stroke();
    ctx.globalAlpha = 1;
    ctx.font = `${11.5 * ratio}px ${getComputedStyle(document.body).fontFamily}`;
    ctx.textBaseline = "middle";
    ctx.textAlign = "left";
    for (const { one, x: end, y, at } of endLabels(u)) {
      const text = Number.isNaN(one.ended) ? one.label : `${one.label} ×`;
      const width = ctx.measureText(text).width;
      const left = Math.min(end, right) + 6 * ratio;
      const name = left + (SWATCH + 3) * ratio;
      ctx.fillStyle = ink.paper;
      ctx.globalAlpha = 0.82;
      ctx.fillRect(
        left - 2 * ratio,
        y - 6.5 * ratio,
        name - left + width + 4 * ratio,
        LABEL_ROOM * ratio,
      );
      ctx.globalAlpha = 1;
      sample(ctx, left, y, one);
      ctx.fillStyle = ink.text;
      ctx.fillText(text, name, y);
      if (!Number.isNaN(one.ended)) {
        cross(ctx, end, at, 4 * ratio, one.colour);
      }
    }
    ctx.restore();
  }

  /** A piece of the curve, so that the name itself can be in ink. */
  function sample(ctx, x, y, one) {
    const ratio = devicePixelRatio;
    ctx.setLineDash(one.dash.map((length) => (length * ratio) / 2));
    ctx.strokeStyle = one.colour;
    ctx.lineWidth = 2.5 * ratio;
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(x + SWATCH * ratio, y);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  function cross(ctx, x, y, r, colour) {
    ctx.setLineDash([]);
    ctx.strokeStyle = colour;
    ctx.lineWidth = 2 * devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x - r, y - r);
    ctx.lineTo(x + r, y + r);
    ctx.moveTo(x - r, y + r);
    ctx.lineTo(x + r, y - r);
    ctx.stroke();
  }

  function build() {
    plot?.destroy();
    plot = new uPlot(makeOptions(), /** @type {any} */ ([[], ...series.map(() => [])]), el);
    plot.over.addEventListener("click", (event) => {
      if (plot) {
        options.onPick(plot.posToVal(event.offsetX, "x"));
      }
    });
  }

  /**
   * Ranges only grow while a run lasts, so that a curve does not breathe.
   * @param {(number | null)[][]} columns
   * @param {number} last
   */
  function stretch(columns, last) {
    let low = Infinity;
    let high = 0;
    for (const column of columns.slice(1)) {
      for (const value of column) {
        if (value !== null) {
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
      }
    }
    span.x = Math.max(span.x, niceAbove(Math.max(last, 1e-6)));
    if (options.log) {
      const [a, b] = decades(Math.min(low, span.low), Math.max(high, span.high));
      span.low = a;
      span.high = b;
    } else {
      span.high = high > 0 ? Math.max(span.high, niceAbove(high)) : span.high;
    }
  }

  const observer = new ResizeObserver(() => {
    if (
      plot &&
      el.clientWidth > 0 &&
      (plot.width !== el.clientWidth || plot.height !== el.clientHeight)
    ) {
      plot.setSize({ width: el.clientWidth, height: el.clientHeight });
    }
  });
  observer.observe(el);

  return {
    /** The smallest value that is plotted. */
    floor: FLOOR,
    /**
     * New curves: a new comparison, another selection, another theme.
     * @param {typeof series} wanted
     * @param {typeof ink} inks
     * @param {boolean} anew
     * @param {number} first [s] that the axis of time has at least
     */
    setSeries(wanted, inks, anew, first) {
      series = wanted;
      ink = inks;
      if (anew) {
        span = { x: first, low: 1e-10, high: options.log ? 1e-6 : 0 };
      }
      build();
    },
    /**
     * @param {number[]} ended per method, NaN while it runs
     * @param {boolean[]} present has a curve here
     */
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
    dispose() {
      observer.disconnect();
      plot?.destroy();
    },
  };
}
