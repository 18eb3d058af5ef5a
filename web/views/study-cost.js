// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The cost of accuracy: error against cost, both by decades; a point can be pointed at, and clicked
// to give its method this step.
import { costText } from "../state/cost-words.js";
import { plain, powerOfTen, quantity, scientific } from "../state/format.js";
import {
  COSTS,
  ERRORS,
  byName,
  dotsOf,
  floorOf,
  frameOf,
  leftOutOf,
  lengthsOf,
  meaningOf,
  ruleOf,
  sentencesOf,
} from "../state/study-documents.js";
import { isRanked } from "../state/wanted.js";
import { h, s, say } from "../widgets/dom.js";
import { isOpen, markerOf } from "../widgets/markers.js";
import { explained } from "../widgets/term.js";
import { rove } from "../widgets/roving.js";
import { createWanted } from "./study-wanted.js";

const ROOM = { left: 54, top: 44, bottom: 44 };
const LABEL = 15; // [px] between two names
const HEIGHT = 380;
const NARROW = 560; // [px] below which there is less room for names

/** @param {import("../state/study-documents.js").Dot} dot */
const sizeText = (dot) =>
  dot.sizeName === "h"
    ? `h = ${quantity(dot.size, "s")}`
    : `rtol = ${plain(Number(dot.size.toPrecision(2)))}`;

/**
 * @param {import("../state/store.js").Store} store
 * @param {(m: number, spelling: string, words: string) => void} onPick a method is given a step
 */
export function createStudyCost(store, onPick) {
  const data = store.data;
  const view = { error: "q", cost: "operations" };
  const told = h("p", { class: "told" });
  const picture = s("svg", { class: "scatter", role: "group" });
  const frame = h("div", { class: "study-picture" }, picture);
  const sentences = h("ul", { class: "answers" });
  const meaning = h("p", { class: "told" });
  const leftOut = h("p", { class: "told" });
  const classes = h("ul", { class: "answers" });
  const table = h("div", {
    class: "twin-table",
    tabindex: "0",
    role: "region",
    "aria-label": "Table of the study",
  });
  const choice = (list, key, label) =>
    h(
      "div",
      { class: "choices", role: "group", "aria-label": label },
      h("span", { class: "word" }, label),
      ...list.map((item) =>
        h(
          "button",
          {
            type: "button",
            class: "quiet",
            title: item.about,
            "data-choice": `${key} ${item.name}`,
            onclick: () => {
              view[key] = item.name;
              paint();
            },
          },
          item.word,
        ),
      ),
    );
  const bar = h(
    "div",
    { class: "study-bar" },
    choice(ERRORS, "error", "error of"),
    choice(COSTS, "cost", "cost in"),
  );
  const wanted = createWanted(data, {
    labelOf: (m) => labelOf(m),
    costText: (value) => costText(view.cost, value),
    onPick,
  });
  const el = h(
    "div",
    {},
    bar,
    frame,
    told,
    h("h3", {}, "Cheapest of these methods for an accuracy"),
    wanted.el,
    sentences,
    meaning,
    leftOut,
    h("h3", {}, "What each converges to"),
    classes,
    h("details", { class: "fold" }, h("summary", {}, "All points as a table"), table),
  );
  const rover = rove(picture, { move, act, tell });
  /** @type {import("../state/study-documents.js").Dot[][]} */
  let dots = [];

  const study = () => data.studies["work-precision"].document;
  const labelOf = (m) => data.methods[m]?.label ?? study().methods[m].method;
  const slotOf = (m) => data.methods[m]?.slot ?? study().methods[m].slot;
  const dotOf = (node) =>
    dots[Number(node.getAttribute("data-m"))]?.find(
      ({ k }) => k === Number(node.getAttribute("data-spot")),
    );

  /** @param {import("../state/study-documents.js").Dot} dot */
  function wordsOf(dot) {
    const name = `${labelOf(dot.m)}, ${sizeText(dot)}`;
    if (dot.error === Infinity) {
      return `${name}: ${dot.state}: ${dot.reason}`;
    }
    const value = dot.bound
      ? `at most ${scientific(floorOf(study(), view.error))}, the resolution of the reference`
      : scientific(dot.error);
    return `${name}: error ${value}, ${costText(view.cost, dot.cost)}`;
  }

  function tell(node) {
    const dot = node && dotOf(node);
    say(
      told,
      dot
        ? `${wordsOf(dot)}. Click or press Enter to run the method with this step.`
        : "Point at a mark or reach it with the arrow keys. A click runs the method with this step.",
    );
  }

  function act(node) {
    const dot = dotOf(node);
    if (dot) {
      onPick(dot.m, dot.spelling, `${labelOf(dot.m)} runs with ${sizeText(dot)}`);
    }
  }

  function move(node, key) {
    const m = Number(node.getAttribute("data-m"));
    const k = Number(node.getAttribute("data-spot"));
    const spots = [...picture.querySelectorAll("[data-spot]")];
    const at = (mm, kk) =>
      spots.find(
        (one) =>
          Number(one.getAttribute("data-m")) === mm && Number(one.getAttribute("data-spot")) === kk,
      );
    if (key === "ArrowRight" || key === "ArrowLeft") {
      const list = dots[m].map((dot) => dot.k);
      return at(m, list[list.indexOf(k) + (key === "ArrowRight" ? 1 : -1)]);
    }
    const by = key === "ArrowDown" ? 1 : -1;
    for (let other = m + by; other >= 0 && other < dots.length; other += by) {
      const near = [...dots[other]].sort((a, b) => Math.abs(a.k - k) - Math.abs(b.k - k))[0];
      if (near) {
        return at(other, near.k);
      }
    }
    return undefined;
  }

  function decadesOf(low, high, most) {
    const step = Math.max(1, Math.ceil((high - low) / most));
    const out = [];
    for (let e = Math.ceil(low - 1e-9); e <= high + 1e-9; e++) {
      if (e % step === 0) {
        out.push(e);
      }
    }
    return out;
  }

  /** Names at the finest points, pushed apart. */
  function namesAt(ends, low, high) {
    ends.sort((a, b) => a.y - b.y);
    ends.forEach((one, i) => (one.y = Math.max(one.y, i ? ends[i - 1].y + LABEL : low)));
    for (let i = ends.length - 1; i >= 0; i--) {
      ends[i].y = Math.min(ends[i].y, i === ends.length - 1 ? high : ends[i + 1].y - LABEL);
    }
    return ends;
  }

  function draw() {
    const width = Math.max(280, frame.clientWidth);
    const right = width < NARROW ? 92 : 168;
    const error = byName(ERRORS, view.error);
    const cost = byName(COSTS, view.cost);
    dots = dotsOf(study(), view.error, view.cost);
    const floor = floorOf(study(), view.error);
    const box = frameOf(dots, floor);
    picture.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    picture.setAttribute(
      "aria-label",
      `Error of ${error.word} against ${cost.word}, by method; arrow keys go from point to point`,
    );
    if (!box) {
      picture.replaceChildren(s("text", { x: 12, y: 40, class: "note" }, "no run has finished"));
      return;
    }
    const inner = { w: width - ROOM.left - right, h: HEIGHT - ROOM.top - ROOM.bottom };
    const x = (value) => ROOM.left + (inner.w * (Math.log10(value) - box.x0)) / (box.x1 - box.x0);
    const y = (value) =>
      value === Infinity
        ? ROOM.top - 13
        : ROOM.top +
          (inner.h * Math.min(box.y1 - box.y0, Math.max(0, box.y1 - Math.log10(value)))) /
            (box.y1 - box.y0);
    const bottom = ROOM.top + inner.h;
    const parts = [];
    if (floor > 0 && Math.log10(floor) > box.y0) {
      parts.push(
        s("rect", {
          x: ROOM.left,
          y: y(floor),
          width: inner.w,
          height: bottom - y(floor),
          class: "band",
        }),
        s(
          "text",
          { x: ROOM.left + 6, y: Math.min(bottom - 5, y(floor) + 14), class: "note" },
          "error of the reference itself",
        ),
      );
    }
    for (const e of decadesOf(box.y0, box.y1, 9)) {
      const at = y(10 ** e);
      parts.push(
        s("path", { d: `M${ROOM.left} ${at}H${ROOM.left + inner.w}`, class: "grid" }),
        s("text", { x: ROOM.left - 6, y: at + 4, class: "tick end" }, powerOfTen(e)),
      );
    }
    for (const e of decadesOf(box.x0, box.x1, width < NARROW ? 4 : 8)) {
      const at = x(10 ** e);
      parts.push(
        s("path", { d: `M${at} ${ROOM.top}V${bottom}`, class: "grid" }),
        s("text", { x: at, y: bottom + 16, class: "tick middle" }, powerOfTen(e)),
      );
    }
    const unit = cost.unit === "s" ? "processor time of the run, s" : `${cost.word} of the run`;
    parts.push(
      s("text", { x: ROOM.left + inner.w / 2, y: bottom + 36, class: "title middle" }, unit),
      s(
        "text",
        { x: ROOM.left - 46, y: 12, class: "title" },
        `largest error of ${error.word}, ${error.unit(data.scene)}${lengthsOf(view.error, data.scene.length)}`,
      ),
    );
    const ends = [];
    const groups = dots.map((list, m) => {
      const look = data.look.slots[slotOf(m)];
      const sound = list.filter((dot) => dot.error !== Infinity);
      const group = s("g", {
        class: `slot-${slotOf(m)} dots`,
        role: "group",
        "aria-label": labelOf(m),
      });
      const path = sound
        .map((dot, i) => `${i ? "L" : "M"}${x(dot.cost).toFixed(1)} ${y(dot.error).toFixed(1)}`)
        .join("");
      if (path) {
        group.append(
          s("path", { d: path, class: "curve", "stroke-dasharray": look.dash.join(" ") || null }),
        );
        const last = sound[sound.length - 1];
        ends.push({ m, x: x(last.cost), y: y(last.error), from: y(last.error) });
      }
      for (const dot of list) {
        const failed = dot.error === Infinity;
        const px = Number.isFinite(dot.cost)
          ? Math.min(ROOM.left + inner.w, Math.max(ROOM.left, x(dot.cost)))
          : ROOM.left + inner.w;
        const open = dot.bound || isOpen(dot, look.marker);
        group.append(
          s(
            "g",
            {
              transform: `translate(${px.toFixed(1)} ${y(dot.error).toFixed(1)})`,
              class: `spot ${failed ? "failed" : ""}`,
              role: "button",
              tabindex: -1,
              "data-m": m,
              "data-spot": dot.k,
              "aria-label": wordsOf(dot),
            },
            s("circle", { r: 12, class: "target" }),
            s("path", {
              d: markerOf(dot, look.marker),
              transform: "scale(4.4)",
              class: open ? "open" : "solid",
            }),
          ),
        );
      }
      return group;
    });
    const names = namesAt(ends, ROOM.top + 6, bottom - 4).flatMap((end) => {
      const at = ROOM.left + inner.w + 10;
      return [
        s("path", {
          d: `M${(end.x + 7).toFixed(1)} ${end.from.toFixed(1)}L${at - 3} ${end.y.toFixed(1)}`,
          class: "leader",
        }),
        s("text", { x: at, y: end.y + 4, class: "name" }, labelOf(end.m)),
      ];
    });
    picture.replaceChildren(...parts, ...names, ...groups);
    rover.start(picture.querySelector("[data-spot]"));
  }

  function fillTable() {
    const head = ["method", "step or tolerance", "error", "cost", "outcome"];
    table.replaceChildren(
      h(
        "table",
        { class: "numbers" },
        h("thead", {}, h("tr", {}, ...head.map((text) => h("th", { scope: "col" }, text)))),
        h(
          "tbody",
          {},
          ...dots
            .flat()
            .map((dot) =>
              h(
                "tr",
                {},
                h("th", { scope: "row" }, labelOf(dot.m)),
                h("td", {}, sizeText(dot)),
                h(
                  "td",
                  {},
                  dot.error === Infinity
                    ? "–"
                    : `${dot.bound ? "≤ " : ""}${scientific(dot.bound ? floorOf(study(), view.error) : dot.error)}`,
                ),
                h("td", {}, dot.error === Infinity ? "–" : costText(view.cost, dot.cost)),
                h("td", {}, dot.error === Infinity ? `${dot.state}: ${dot.reason}` : "done"),
              ),
            ),
        ),
      ),
    );
  }

  function paint() {
    if (!study() || !data.look) {
      return;
    }
    bar.querySelectorAll("[data-choice]").forEach((node) => {
      const [key, name] = /** @type {string} */ (node.getAttribute("data-choice")).split(" ");
      node.setAttribute("aria-pressed", String(view[key] === name));
    });
    draw();
    fillTable();
    const { error, cost } = view;
    wanted.show(dots, error, isRanked(study(), error, cost), ruleOf(study(), error));
    const lines = sentencesOf(study(), error, cost, labelOf);
    say(meaning, meaningOf(error, data.scene.length));
    say(leftOut, leftOutOf(study(), labelOf));
    sentences.replaceChildren(
      ...(lines.length
        ? lines
        : ["Methods are ranked for errors of position, velocity and reactions."]
      ).map((line) => h("li", {}, ...explained(line))),
    );
    classes.replaceChildren(
      ...study().methods.map((method, m) =>
        h(
          "li",
          { class: method.class.kind === "elsewhere" ? "wrong" : "" },
          `${labelOf(m)}: ${method.class.text}`,
        ),
      ),
    );
    tell(null);
  }

  return { el, paint };
}
