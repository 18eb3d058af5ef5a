// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The equations that this scene runs, as the engine prints them, with the numbers of the state that
// is shown. Both they and the library that sets them are fetched when the panel is opened.
import { sentenceOf } from "../api/client.js";
import { plain } from "../state/format.js";
import { partsOf } from "../state/belongs.js";
import { evaluate, valuesAt } from "../state/formula.js";
import { listen, shownIndex } from "../state/store.js";
import { h, say } from "../widgets/dom.js";
import { createNotation } from "./notation.js";
import { createReduced } from "./reduced.js";

const REDRAW = 200; // [ms] between two sets of numbers
const MOST_ENTRIES = 40; // beyond it a large scene would only fill the page
/** [characters of TeX] Nobody reads a longer formula, and setting it takes a browser seconds. */
const LONGEST = 600;

const SYSTEM = String.raw`\begin{bmatrix} M & J^{\mathsf T} \\ J & 0 \end{bmatrix}\begin{bmatrix} a \\ -\lambda \end{bmatrix} = \begin{bmatrix} f \\ -\gamma \end{bmatrix}, \qquad \varphi(q, t) = 0`;
const FREE = String.raw`M\,a = f`;
const PRINTED = {
  nullspace: String.raw`N^{\mathsf T} M N\,\dot u = N^{\mathsf T}\bigl(f - M \dot N u\bigr), \qquad v = N u`,
  "nullspace-as-printed": String.raw`N^{\mathsf T} M N\,\dot u = N^{\mathsf T} f \qquad \text{missing: } {\color{#cf4436} N^{\mathsf T} M \dot N u}`,
};

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createEquations(el, store, actions) {
  const data = store.data;
  const body = h("div", {
    class: "equation-body",
    tabindex: "0",
    role: "region",
    "aria-label": "Equations of this scene",
  });
  const summary = h("summary", {}, h("h2", { id: "equations-title" }, "Equations"));
  const details = h("details", { class: "fold equation-panel" }, summary, body);
  el.replaceChildren(details);
  const notation = createNotation(store, actions);
  const reduced = createReduced(store, actions, { formula, line: entryLine });
  let shownFor = "";
  /** the library that sets formulas, once it is here */
  let katex = /** @type {import("katex").default | any} */ (null);
  /** the entries on the page, and the answer that they come from */
  let printed = { answer: /** @type {any} */ (null), nodes: /** @type {any[]} */ ([]) };
  let timer = 0;

  /** A long subscript has its parts apart: e_{0,top} for e_{0\\_top}. @param {string} latex */
  const tidy = (latex) =>
    latex
      .replace(/_\{(\w+)\\_([^{}]+)\}/g, (_, first, rest) => `_{${first},\\mathrm{${rest}}}`)
      .replace(/_\{([A-Za-z]{2,})\}/g, (_, word) => `_{\\mathrm{${word}}}`);

  /** @param {string} latex @param {boolean} display */
  function formula(latex, display) {
    const node = h("div", { class: display ? "display" : "line" });
    katex.render(tidy(latex), node, {
      displayMode: display,
      throwOnError: false,
      output: "htmlAndMathml",
      strict: false,
    });
    return node;
  }

  function special() {
    const method = data.methods[data.view.selected];
    return method && PRINTED[method.formulation]
      ? [h("p", { class: "about" }, method.title), formula(PRINTED[method.formulation], true)]
      : [];
  }

  async function show() {
    const key = JSON.stringify([data.scene?.id, data.methods[data.view.selected]?.formulation]);
    if (!details.open || !data.scene || key === shownFor) {
      return;
    }
    shownFor = key;
    let answer;
    try {
      const [library, equations] = await Promise.all([import("katex"), actions.equations()]);
      katex = library.default;
      answer = equations;
    } catch (error) {
      shownFor = "";
      body.replaceChildren(h("p", { class: "hint" }, sentenceOf(error)));
      return;
    }
    if (key !== shownFor) {
      return;
    }
    printed = { answer, nodes: [] };
    const constrained = data.scene.m > 0;
    const terms = answer.terms.map((term) => ({
      ...term,
      entries: answer.entries.filter((entry) => entry.term === term.name),
    }));
    body.replaceChildren(
      formula(constrained ? SYSTEM : FREE, true),
      notation.node,
      ...special(),
      h(
        "p",
        { class: "about" },
        `Velocities, in the order of rows and columns: ${answer.speeds.join(", ")}. Entries that are not listed are zero. Point at an entry: what it belongs to lights up; point at a link: its entries do. Numbers belong to the time shown, in SI units.`,
      ),
      ...(answer.coordinates ?? [])
        .filter(({ name, is }) => name !== is)
        .map(({ name, is }) => h("p", { class: "about" }, `${name} = ${is}`)),
      h("div", { class: "terms" }, ...terms.filter(({ entries }) => entries.length).map(termBlock)),
      reduced.node,
    );
    notation.make(formula, answer);
    reduced.give(answer.position);
    showNumbers();
  }

  /** The value of every entry at the frame shown; nothing where the page cannot work it out. */
  function showNumbers() {
    timer = 0;
    const i = shownIndex(data);
    const { answer, nodes } = printed;
    if (!details.open || !answer || i < 0) {
      return;
    }
    notation.update();
    const state = { t: data.history.t[i], ...data.history.stateAt(data.view.selected, i) };
    const values = valuesAt(answer, data.scene, state);
    for (const { text, node } of nodes) {
      const value = evaluate(text, values);
      say(
        node,
        Number.isFinite(value) ? `= ${plain(Number(value.toPrecision(4))).replace(/-/g, "−")}` : "",
      );
    }
  }

  /** An entry lights up what it belongs to, and is lit by it. @param {HTMLElement} line */
  function connect(line, entry) {
    const parts = partsOf(entry, printed.answer.speeds, data.scene);
    const tell = (on) => store.emit("light", on ? parts : { bodies: [], tears: [], curves: [] });
    line.tabIndex = 0;
    line.dataset.bodies = parts.bodies.join(" ");
    for (const name of ["pointerenter", "focus"]) {
      line.addEventListener(name, () => tell(true));
    }
    for (const name of ["pointerleave", "blur"]) {
      line.addEventListener(name, () => tell(false));
    }
    return line;
  }

  /** Entries of bodies that are pointed at in the drawing; curves of what is pointed at here. */
  function showLight({ bodies, curves, from }) {
    body.querySelectorAll("[data-bodies]").forEach((line) => {
      const own = (line.getAttribute("data-bodies") ?? "").split(" ").filter(Boolean).map(Number);
      line.classList.toggle("lit", from === "drawing" && own.some((one) => bodies.includes(one)));
    });
    document.querySelectorAll("figure.plot").forEach((figure) => {
      const shown = figure.querySelector("select")?.value ?? "";
      figure.classList.toggle("lit", curves.includes(shown));
    });
  }

  function showNumbersSoon() {
    if (details.open && !timer) {
      timer = window.setTimeout(showNumbers, REDRAW);
    }
  }

  function entryLine(entry) {
    if (entry.latex.length <= LONGEST) {
      const mirrored = entry.column && entry.column !== entry.row && /^M/.test(entry.term);
      const twin = mirrored ? ` = ${entry.term}_{${entry.column}${entry.row}}` : "";
      const whole = connect(formula(`${entry.name_latex}${twin} = ${entry.latex}`, false), entry);
      if (entry.text) {
        const node = h("span", { class: "number value" });
        whole.append(node);
        printed.nodes.push({ text: entry.text, node });
      }
      return whole;
    }
    const line = formula(`${entry.name_latex} = \\ldots`, false);
    const size = `${Math.round(entry.latex.length / 100) / 10} thousand characters`;
    line.append(h("span", { class: "about" }, ` ${size}: "holonom equations" prints it`));
    return line;
  }

  function termBlock(term) {
    const most = term.entries.slice(0, MOST_ENTRIES);
    const more = term.entries.length - most.length;
    return h(
      "section",
      { class: "term-block" },
      h("h3", {}, `${term.meaning}`),
      ...most.map(entryLine),
      more > 0 ? h("p", { class: "about" }, `and ${more} more entries`) : "",
    );
  }

  details.addEventListener("toggle", () => {
    if (details.open !== data.view.equations) {
      actions.setView({ equations: details.open });
    }
    show();
  });
  let wasOpen = data.view.equations;
  /** Opened by a link, or by hand: then the store follows. */
  function obey() {
    if (wasOpen !== data.view.equations) {
      wasOpen = data.view.equations;
      details.open = wasOpen;
    }
  }
  const stop = listen(store, {
    scene: show,
    light: showLight,
    view: () => {
      obey();
      show();
      showNumbersSoon();
    },
    methods: show,
  });
  return {
    update: showNumbersSoon,
    dispose() {
      stop();
      clearTimeout(timer);
      reduced.dispose();
      el.replaceChildren();
    },
  };
}
