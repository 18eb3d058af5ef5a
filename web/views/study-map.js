// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Maps of stability: a cell a trial, its outcome as a letter and a colour, and the boundary that
// was predicted. A cell can be pointed at, and clicked to set what its axes stand for.
import { plain, quantity, withPowers } from "../state/format.js";
import { HEATS, axesWith, heatOf, heatSentences, heatWords } from "../state/heat.js";
import { presetsOf } from "../state/studies.js";
import { CLASSES } from "../state/study-documents.js";
import { parseSpelling, settingOf, withSetting } from "../state/spelling.js";
import { h, s, say } from "../widgets/dom.js";
import { rove } from "../widgets/roving.js";
import {
  SWEET_SPOT,
  drawContours,
  drawLines,
  fillLegend,
  raiseLetters,
  shadeCells,
  titleOf,
  valueOf,
} from "./study-map-parts.js";
import { addPresentPoint } from "./study-map-point.js";

const ROOM = { left: 78, right: 12, top: 8, bottom: 44 };
const HEIGHT = 360;
const TICKS = 6;

/**
 * @param {import("../state/store.js").Store} store
 * @param {{
 *   changePreset: (preset: string) => void, widen: (over: string) => void, preset: () => string,
 *   onPick: (change: {
 *     m: number, spelling: string, parameters: Record<string, number>, words: string,
 *   }) => void,
 * }} actions
 */
export function createStudyMap(store, actions) {
  const data = store.data;
  const menu = h("select", { id: "map-over", onchange: () => actions.changePreset(menu.value) });
  const shades = h(
    "div",
    { class: "choices", role: "group", "aria-label": "Colour of the cells" },
    ...[{ name: "", word: "outcome" }, ...HEATS].map(({ name, word }) =>
      h("button", { type: "button", class: "quiet", onclick: () => shade(name) }, word),
    ),
  );
  let heat = ""; // the quantity that colours the cells; "": their outcome
  let chosen = false; // the colour was chosen by hand
  const best = h("ul", { class: "answers" });
  const steps = h("div", { class: "steps", hidden: true });
  const legend = h("ul", { class: "legend" });
  const told = h("p", { class: "told" });
  const fields = h("div", { class: "maps" });
  const el = h(
    "div",
    {},
    h(
      "div",
      { class: "study-bar" },
      h("label", { for: "map-over", class: "word" }, "over"),
      menu,
      shades,
    ),
    fields,
    best,
    told,
    legend,
    steps,
  );

  /**
   * @type {{method: any, picture: SVGSVGElement,
   *   scale: import("./study-map-point.js").Scale}[]}
   */
  let drawn = [];
  const map = () => data.studies.stability.document;
  const placeOf = (spelling) => {
    const wanted = parseSpelling(spelling);
    return data.methods.findIndex(({ spelling: own }) => {
      const mine = parseSpelling(own);
      return (
        mine.formulation.name === wanted.formulation.name &&
        mine.integrator.name === wanted.integrator.name
      );
    });
  };
  const labelOf = (method) => data.methods[placeOf(method.method)]?.label ?? method.method;

  function wordsOf(method, i, j) {
    const cell = method.rows[j][i];
    const { x, y } = map();
    const where = [x && valueOf(x, x.values[i]), valueOf(y, y.values[j])]
      .filter(Boolean)
      .join(", ");
    const outcome = `${CLASSES[cell.class]?.word ?? cell.class}${cell.reason ? `: ${cell.reason}` : ""}`;
    const length = data.scene.length;
    const sizes = HEATS.map((kind) => ({ kind, value: heatOf(kind, cell, length) }))
      .filter(({ value }) => !Number.isNaN(value))
      .map(({ kind, value }) => `${kind.word} ${heatWords(kind, value)}`);
    const figures = sizes.length ? `; ${sizes.join(", ")}` : "";
    const margin = Number.isFinite(cell.margin ?? NaN)
      ? `; the step is ${plain(Number(cell.margin.toPrecision(2)))} of the predicted limit`
      : "";
    return `${labelOf(method)}, ${where}: ${outcome}${figures}${margin}`;
  }

  /** Values on the axes as settings. @param {any} method @param {number} atX @param {number} atY */
  function changeTo(method, atX, atY) {
    const m = placeOf(method.method);
    const { x, y } = map();
    const axes = [
      { axis: x, value: atX },
      { axis: y, value: atY },
    ].filter(({ axis }) => axis);
    let spelling = data.methods[m]?.spelling ?? "";
    /** @type {Record<string, number>} */
    const parameters = {};
    for (const { axis, value } of axes) {
      if (axis.kind === "parameter") {
        parameters[axis.name] = value;
      } else {
        spelling = withSetting(data.catalogue, spelling, axis.name, String(value));
      }
    }
    const words = axes.map(({ axis, value }) => valueOf(axis, value)).join(", ");
    return { m, spelling, parameters, words: `${labelOf(method)}: ${words}` };
  }

  /** Returns what a click on a cell sets. */
  function changeOf(method, i, j) {
    const { x, y } = map();
    const rounded = (axis, at) => Number(axis?.values[at].toPrecision(4));
    return changeTo(method, rounded(x, i), rounded(y, j));
  }

  /** @param {string} name of a quantity, or "" */
  function shade(name) {
    heat = name;
    chosen = true;
    paint();
  }

  /** Where the smallest values are, for every quantity. */
  function showBest() {
    const { x, y, methods } = map();
    const lines = x
      ? methods.flatMap((method) =>
          heatSentences({ x, y }, method, data.scene.length, valueOf).map((text) =>
            h("li", {}, `${labelOf(method)}, ${text}`),
          ),
        )
      : [];
    const isBaumgarte = x?.name === "alpha";
    best.replaceChildren(...(isBaumgarte ? [h("li", {}, SWEET_SPOT)] : []), ...lines);
    shades.hidden = !x;
    [...shades.children].forEach((button, k) =>
      button.setAttribute(
        "aria-pressed",
        String(["", ...HEATS.map((one) => one.name)][k] === heat),
      ),
    );
  }

  /** Shows the findings of the map of steps, by which the server chose this one. */
  function showSteps() {
    const list = map()?.steps ?? [];
    steps.hidden = list.length === 0;
    steps.replaceChildren(
      h("p", { class: "word" }, "The largest step of each method:"),
      h(
        "ul",
        { class: "answers" },
        ...list.map((one) => h("li", {}, `${labelOf(one)}: ${withPowers(one.agreement.text)}`)),
      ),
    );
  }

  function tickList(axis) {
    const every = Math.max(1, Math.ceil(axis.values.length / TICKS));
    return axis.values.map((value, i) => ({ value, i })).filter(({ i }) => i % every === 0);
  }

  const short = (axis, value) =>
    axis.unit === "s" ? quantity(value, "s", 2) : quantity(value, "", 2).trim();

  /** The present value of what an axis stands for. */
  function presentValue(method, axis) {
    const m = placeOf(method.method);
    const value =
      axis?.kind === "parameter"
        ? data.scene.parameters.find(({ name }) => name === axis.name)?.value
        : settingOf(data.catalogue, data.methods[m]?.spelling ?? "", axis?.name)?.value;
    return m < 0 ? NaN : Number(value);
  }

  /** One method; or all of them side by side, where nothing but the step is varied. */
  function drawOne(methods) {
    const { x, y } = map();
    const [nx, ny] = [x ? x.values.length : methods.length, y.values.length];
    const at = (i) => (x ? { method: methods[0], column: i } : { method: methods[i], column: 0 });
    const width = Math.max(280, Math.min(640, fields.clientWidth || 640));
    const w = (width - ROOM.left - ROOM.right) / nx;
    const hgt = (HEIGHT - ROOM.top - ROOM.bottom) / ny;
    const px = (i) => ROOM.left + i * w;
    const py = (j) => HEIGHT - ROOM.bottom - j * hgt;
    const picture = s("svg", {
      class: "map",
      viewBox: `0 0 ${width} ${HEIGHT}`,
      role: "group",
      "aria-label": `Stability of ${methods.map(labelOf).join(", ")}: ${titleOf(y)}${x ? ` against ${titleOf(x)}` : ""}; arrow keys go from cell to cell`,
    });
    for (let j = 0; j < ny; j++) {
      for (let i = 0; i < nx; i++) {
        const { method, column } = at(i);
        const cell = method.rows[j][column];
        picture.append(
          s(
            "g",
            {
              class: `cell ${cell.class}`,
              role: "button",
              tabindex: -1,
              "data-spot": `${i} ${j}`,
              "aria-label": wordsOf(method, column, j),
            },
            s("rect", { x: px(i), y: py(j + 1), width: w, height: hgt }),
            s(
              "text",
              { x: px(i) + w / 2, y: py(j) - hgt / 2 + 4, class: "letter" },
              CLASSES[cell.class]?.letter ?? "",
            ),
          ),
        );
      }
    }
    methods.forEach((method, k) => {
      drawLines(picture, map(), method, { px: (i) => px(k + i), py });
      const scale = {
        px: (i) => px(k + i),
        py,
        iOf: (at) => (at - ROOM.left) / w - k,
        jOf: (at) => (HEIGHT - ROOM.bottom - at) / hgt,
      };
      drawn.push({ method, picture, scale });
      shadeCells(picture, heat, method.rows, data.scene.length, (i) => (x ? i : i === k ? 0 : -1));
      drawContours(picture, x ? heat : "", method.rows, data.scene.length, scale);
    });
    raiseLetters(picture);
    const ticks = tickList(y).map(({ value, i }) =>
      s("text", { x: ROOM.left - 6, y: py(i + 0.5) + 4, class: "tick end" }, short(y, value)),
    );
    if (x) {
      ticks.push(
        ...tickList(x).map(({ value, i }) =>
          s(
            "text",
            { x: px(i + 0.5), y: HEIGHT - ROOM.bottom + 16, class: "tick middle" },
            short(x, value),
          ),
        ),
      );
      ticks.push(
        s(
          "text",
          { x: (ROOM.left + width - ROOM.right) / 2, y: HEIGHT - 8, class: "title middle" },
          titleOf(x),
        ),
      );
    } else {
      ticks.push(
        ...methods.map((method, k) =>
          s(
            "text",
            { x: px(k + 0.5), y: HEIGHT - ROOM.bottom + 16, class: "middle" },
            labelOf(method),
          ),
        ),
      );
    }
    const middle = (ROOM.top + HEIGHT - ROOM.bottom) / 2;
    ticks.push(
      s(
        "text",
        { x: 13, y: middle, class: "title middle", transform: `rotate(-90 13 ${middle})` },
        titleOf(y),
      ),
    );
    picture.append(...ticks);
    const cellAt = (i, j) => picture.querySelector(`[data-spot="${i} ${j}"]`) ?? undefined;
    const placed = (node) =>
      /** @type {string} */ (node.getAttribute("data-spot")).split(" ").map(Number);
    const STEPS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const rover = rove(picture, {
      move: (node, key) => {
        const [i, j] = placed(node);
        return cellAt(i + STEPS[key][0], j + STEPS[key][1]);
      },
      act: (node) => {
        const [i, j] = placed(node);
        actions.onPick(changeOf(at(i).method, at(i).column, j));
      },
      tell: (node) => {
        const [i, j] = node ? placed(node) : [0, 0];
        say(
          told,
          node
            ? `${wordsOf(at(i).method, at(i).column, j)}. Click or press Enter to run the method with these values.`
            : IDLE,
        );
      },
    });
    rover.start(cellAt(0, 0));
    return h(
      "figure",
      {},
      ...methods.map((method) =>
        h(
          "figcaption",
          {},
          h("b", {}, labelOf(method)),
          ` ${runOf(method)} ${method.agreement.text}`,
        ),
      ),
      picture,
    );
  }

  const IDLE =
    "Point at a cell or reach it with the arrow keys; a click runs the method with its values. " +
    "The ring stands for the present values and can be dragged.";

  /** At which step, where no axis is the step, and until when it ran. */
  function runOf(method) {
    const { x, y, time } = map();
    const until = `until ${plain(Number(time.toPrecision(3)))} s`;
    const varied = x?.kind === "step" || y.kind === "step";
    return varied ? `(${until})` : `(h = ${quantity(stepOf(method), "s")}, ${until})`;
  }

  /** Step of the method a map was made for [s]. */
  const stepOf = (method) =>
    Number(settingOf(data.catalogue, method?.method ?? "", "h")?.value ?? NaN);

  function paint() {
    if (!chosen) {
      heat = map()?.x?.name === "alpha" ? HEATS[0].name : "";
    }
    const presets = presetsOf(data);
    const telling = presets.find(({ name }) => name === map()?.preset)?.about;
    menu.replaceChildren(
      h("option", { value: "" }, `the most telling map${telling ? `: ${telling}` : ""}`),
      ...presets.map(({ name, about }) => h("option", { value: name }, about)),
    );
    menu.value = actions.preset();
    showSteps();
    fields.hidden = legend.hidden = told.hidden = !map();
    if (map()) {
      drawn = [];
      fields.replaceChildren(
        ...(map().x ? map().methods.map((method) => drawOne([method])) : [drawOne(map().methods)]),
      );
      showBest();
      mark();
      say(told, IDLE);
    }
  }

  /** Rings where the methods stand now; the cells stay, and with them the one in focus. */
  function mark() {
    fields.querySelectorAll(".here-group").forEach((ring) => ring.remove());
    let outside = false;
    /** present values by axis */
    const present = { x: /** @type {number[]} */ ([]), y: /** @type {number[]} */ ([]) };
    for (const { method, picture, scale } of drawn) {
      const { x, y } = map();
      const now = { x: presentValue(method, x), y: presentValue(method, y) };
      if (Number.isFinite(now.y) && (!x || Number.isFinite(now.x))) {
        const ring = addPresentPoint(picture, { x, y }, scale, now, {
          onMove: (atX, atY) => say(told, `${changeTo(method, atX, atY).words}. Let go to run it.`),
          onDrop: (atX, atY) => actions.onPick(changeTo(method, atX, atY)),
        });
        outside ||= ring.outside;
        present.x.push(now.x);
        present.y.push(now.y);
      }
    }
    if (map()) {
      const here = fields.querySelector(".here-group") ? (outside ? "outside" : "inside") : "";
      const over = axesWith(map(), present);
      fillLegend(legend, map(), {
        heat,
        here,
        step: stepOf(map().methods[0]),
        widen: () => actions.widen(over),
      });
    }
  }

  return { el, paint, mark };
}
