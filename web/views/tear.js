// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The cut joint under a magnifying glass: its two halves, and the gap between them in red with its
// true size.
import { ROUNDING, gapWords, magnification, niceBelow } from "../state/format.js";
import { lookOf } from "../state/look.js";
import { listen, shownIndex } from "../state/store.js";
import { h, s, say, set } from "../widgets/dom.js";
import { paintNoMore, paintSoon } from "../widgets/pace.js";
import { term } from "../widgets/term.js";

const SIZE = 144; // [px] of the drawn square
const FULL = 62; // [px] the longest gap drawn
const LEAST = 14; // [px] below it the glass is changed for a stronger one
const STRONGEST = 1e9;

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("./drawing/stage.js").Stage} stage whose scale is magnification 1
 */
export function createTear(el, store, stage) {
  const data = store.data;
  const segment = s("path", { class: "tear" });
  const first = s("circle", { r: 10, class: "half first" });
  const second = s("circle", { r: 10, class: "half second" });
  const halves = s("g", {}, first, second, segment);
  const glass = s(
    "svg",
    { viewBox: `0 0 ${SIZE} ${SIZE}`, class: "glass", "aria-hidden": "true" },
    s("circle", { cx: SIZE / 2, cy: SIZE / 2, r: SIZE / 2 - 1, class: "rim" }),
    halves,
  );
  const power = term("magnified", "");
  power.classList.add("power");
  const size = h("span", { class: "number" });
  const among = h("span", { hidden: true });
  const name = h("span", {});
  const cut = h("span", {}, ", ", term("cut", "cut"), " ");
  const joint = h("span", {});
  const whose = h("span", { class: "whose" }, name, cut, joint);
  const figure = h(
    "figure",
    { class: "tear-inset" },
    glass,
    h("figcaption", {}, power, size, among, whose),
  );
  el.append(figure);
  let glassPower = STRONGEST;

  /** The cut whose halves are farthest apart. @param {ArrayLike<number>} points */
  function widest(points) {
    let best = null;
    const { right, up } = lookOf(data);
    for (const { p, q, name } of data.scene?.drawing.tears ?? []) {
      const d = [0, 1, 2].map((k) => points[3 * q + k] - points[3 * p + k]);
      const along = (axis) => axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2];
      const gap = Math.hypot(...d);
      if (!best || gap > best.gap) {
        best = { dx: along(right), dy: along(up), gap, name };
      }
    }
    return best;
  }

  /**
   * 1, 2, 5 times a power of ten, changed only when the picture would no longer be good.
   * @param {number} gap
   */
  function choosePower(gap) {
    const { scale } = stage.camera;
    const drawn = gap * scale * glassPower;
    if (drawn > FULL || drawn < LEAST) {
      glassPower = gap > 0 ? Math.min(STRONGEST, niceBelow(FULL / (gap * scale))) : STRONGEST;
    }
  }

  /**
   * The loop gap, as the table has it; with several loops that gap is of all of them together, so
   * the size is that of the cut under the glass.
   * @param {number} here [m] @param {number} gap [m]
   */
  function sizeWords(here, gap) {
    if (data.scene.drawing.tears.length > 1) {
      return gapWords(here);
    }
    if (Number.isNaN(gap)) {
      return `gap ${gapWords(here)}`; // the run has stopped: this is where
    }
    return gap < ROUNDING ? `closed, ${gapWords(gap)}` : `gap ${gapWords(gap)}`;
  }

  function update() {
    const history = data.history;
    const m = data.view.selected;
    const now = shownIndex(data);
    if (!history || now < 0 || !data.methods[m]) {
      return;
    }
    const tear = widest(history.pointsAt(m, now));
    figure.classList.toggle("none", !tear);
    if (!tear || !Number.isFinite(tear.gap)) {
      say(power, "no cut");
      say(size, data.scene?.m ? "the constraints close no joint" : "no loop to close");
      among.hidden = true;
      whose.hidden = true;
      return;
    }
    choosePower(tear.gap);
    const k = stage.camera.scale * glassPower;
    const half = [(tear.dx * k) / 2, (-tear.dy * k) / 2];
    const centre = SIZE / 2;
    set(halves, { class: `slot-${data.methods[m].slot}` });
    set(first, { cx: (centre - half[0]).toFixed(2), cy: (centre - half[1]).toFixed(2) });
    set(second, { cx: (centre + half[0]).toFixed(2), cy: (centre + half[1]).toFixed(2) });
    set(segment, {
      d: `M${(centre - half[0]).toFixed(2)} ${(centre - half[1]).toFixed(2)}L${(centre + half[0]).toFixed(2)} ${(centre + half[1]).toFixed(2)}`,
    });
    paintSoon(paintWords);
  }

  /**
   * Writes the words beside the glass: on the beat of the table, so that both have the same
   * numbers.
   */
  function paintWords() {
    const { history } = data;
    const m = data.view.selected;
    const now = shownIndex(data);
    const tear = now >= 0 && data.methods[m] ? widest(history.pointsAt(m, now)) : null;
    if (!tear || !Number.isFinite(tear.gap)) {
      return;
    }
    say(power, magnification(glassPower));
    say(size, sizeWords(tear.gap, history.columns[m].gap[now]));
    const count = data.scene.drawing.tears.length;
    among.hidden = count < 2;
    say(among, `the widest of ${count} cuts`);
    whose.hidden = false;
    say(name, data.methods[m].label);
    say(joint, tear.name || "joint");
  }

  const stop = listen(store, {
    methods: () => {
      glassPower = STRONGEST;
    },
    view: update,
  });
  return {
    update,
    dispose() {
      stop();
      paintNoMore(paintWords);
      figure.remove();
    },
  };
}
