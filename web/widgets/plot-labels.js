// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Names beside the last point of each curve, pushed apart where they would touch: to the right of
// it while there is room, from then on to the left, where no curve runs.

const SWATCH = 10; // [px] of a curve before its name
const HEIGHT = 14; // [px] between two names
const AWAY = 6; // [px] of a name from the end of its curve

/** The font of axes and names. */
export const plotFont = (ratio = 1) =>
  `${12.5 * ratio}px ${getComputedStyle(document.body).fontFamily}`;

/** A piece of the curve, so that the name itself can be in ink. */
function drawSample(ctx, x, y, one) {
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

/** A name that curves do not cross: in ink, with the paper round each letter. */
function drawText(ctx, text, x, y, ink) {
  ctx.setLineDash([]);
  ctx.lineJoin = "round";
  ctx.lineWidth = 4 * devicePixelRatio;
  ctx.strokeStyle = ink.paper;
  ctx.strokeText(text, x, y);
  ctx.fillStyle = ink.text;
  ctx.fillText(text, x, y);
}

/** Where a run ended. */
function drawCross(ctx, x, y, colour) {
  const r = 4 * devicePixelRatio;
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

/**
 * The rows of pixels through which curves run between two columns.
 * @param {any} u the plot @param {any[]} series @param {number} from @param {number} to [px]
 * @returns {boolean[]} by row
 */
function rowsOfCurves(u, series, from, to) {
  const taken = Array(Math.ceil(u.bbox.top + u.bbox.height)).fill(false);
  const [times] = u.data;
  const [earliest, latest] = [from, to].map((x) => u.posToVal(x, "x", true));
  const first = Math.max(
    1,
    times.findIndex((t) => t >= earliest),
  );
  series.forEach((_, k) => {
    const values = u.data[k + 1];
    for (let i = first; i < times.length && times[i - 1] <= latest; i++) {
      if (Number.isFinite(values[i - 1] ?? NaN) && Number.isFinite(values[i] ?? NaN)) {
        const ends = [values[i - 1], values[i]].map((value) => u.valToPos(value, "y", true));
        taken.fill(true, Math.floor(Math.min(...ends)), Math.ceil(Math.max(...ends)) + 1);
      }
    }
  });
  return taken;
}

/**
 * Names move to the nearest place where neither a curve nor another name is; those that find none
 * stay.
 * @param {{y: number}[]} names from the top @param {boolean[]} taken rows
 * @param {{low: number, high: number, height: number}} room [px]
 */
export function moveToFreeRows(names, taken, { low, high, height }) {
  const half = Math.ceil(height / 2);
  const rows = taken.slice();
  const isFree = (y) =>
    y >= low && y <= high && !rows.slice(Math.max(0, y - half), y + half).some(Boolean);
  for (const name of names) {
    const wanted = Math.round(name.y);
    for (let away = 0; away <= high - low; away++) {
      const y = [wanted - away, wanted + away].find(isFree);
      if (y !== undefined) {
        name.y = y;
        break;
      }
    }
    for (let row = Math.max(0, Math.round(name.y) - half); row < name.y + half; row++) {
      rows[row] = true;
    }
  }
}

export function createEndLabels() {
  /** Index of the last value at a time or before, -1: none. */
  function lastIndex(times, values, end) {
    for (let i = values.length - 1; i >= 0; i--) {
      if (values[i] !== null && values[i] !== undefined && times[i] <= end) {
        return i;
      }
    }
    return -1;
  }

  /** @param {any} u @param {any[]} series */
  function place(u, series, { now, log, range }) {
    const ratio = devicePixelRatio;
    const bottom = u.bbox.top + u.bbox.height;
    const list = series.flatMap((one, k) => {
      if (!one.label) {
        return [];
      }
      const ys = u.data[k + 1];
      const i = lastIndex(u.data[0], ys, range[1]);
      if (i >= 0) {
        const y = u.valToPos(ys[i], "y", true);
        return [{ one, x: Math.max(u.bbox.left, u.valToPos(u.data[0][i], "x", true)), at: y, y }];
      }
      const isZero = log && one.present && ys.length > 1;
      const zero = { ...one, label: `${one.label}: 0` };
      return isZero ? [{ one: zero, x: u.valToPos(now, "x", true), at: bottom, y: bottom }] : [];
    });

    list.sort((a, b) => a.y - b.y);
    const low = u.bbox.top + 7 * ratio;
    const high = bottom - 7 * ratio;
    list.forEach((item, i) => {
      item.y = Math.max(item.y, i > 0 ? list[i - 1].y + HEIGHT * ratio : low);
    });
    for (let i = list.length - 1; i >= 0; i--) {
      const most = i === list.length - 1 ? high : list[i + 1].y - HEIGHT * ratio;
      list[i].y = Math.min(list[i].y, most);
    }
    return list;
  }

  return {
    /** @param {any} u the plot @param {any[]} series @param {any} how */
    draw(u, series, how) {
      const { ctx } = u;
      const ratio = devicePixelRatio;
      const right = u.bbox.left + u.bbox.width;
      ctx.font = plotFont(ratio);
      ctx.textBaseline = "middle";
      ctx.textAlign = "left";
      const list = place(u, series, how);
      const widest = Math.max(0, ...list.map(({ one }) => ctx.measureText(one.label).width));
      const width = widest + (SWATCH + 3) * ratio;
      const fits = ({ x }) => x + AWAY * ratio + width <= right;
      const leftOf = (x) => Math.max(u.bbox.left, x - AWAY * ratio - width);
      const inside = list.filter((item) => !fits(item));
      if (inside.length) {
        const ends = inside.map(({ x }) => x);
        const rows = rowsOfCurves(u, series, leftOf(Math.min(...ends)), Math.max(...ends));
        const half = (HEIGHT * ratio) / 2;
        const bottom = u.bbox.top + u.bbox.height;
        const room = { low: u.bbox.top + half, high: bottom - half, height: HEIGHT * ratio };
        moveToFreeRows(inside, rows, room);
      }
      for (const item of list) {
        const { one, x: end, y, at } = item;
        const text = Number.isNaN(one.ended) ? one.label : `${one.label} ×`;
        const left = fits(item) ? end + AWAY * ratio : leftOf(end);
        drawSample(ctx, left, y, one);
        drawText(ctx, text, left + (SWATCH + 3) * ratio, y, how.ink);
        if (!Number.isNaN(one.ended)) {
          drawCross(ctx, end, at, one.colour);
        }
      }
    },
  };
}
