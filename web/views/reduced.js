// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The equations left on the free motion, inside the panel of equations: which coordinates are
// independent, how the pose follows from them, and the reduced terms in numbers for the selected
// method at the time shown. Asked for while it is unfolded, one question at a time.
import { sentenceOf } from "../api/client.js";
import { seconds } from "../state/format.js";
import { namedState } from "../state/reactions.js";
import { listen } from "../state/store.js";
import { h, say } from "../widgets/dom.js";

const PAUSE = 250; // [ms] between an answer and the next question while the mechanism moves
const DIGITS = 4;
const MOST = 12; // freedoms of which matrices are shown

const REST = String.raw`v = \Phi\,v_r, \qquad M_r\,a_r + C_r\,v_r + g_r = \tau_r`;
const MOVED = String.raw`v = \Phi\,v_r + s, \qquad M_r\,a_r + C_r\,v_r + d_r + g_r = \tau_r`;

/** @param {number} x */
const number = (x) => Number(x.toPrecision(DIGITS)).toString().replace("-", "−");

/** A letter with the index r, and what it is. @param {string} letter @param {string} meaning */
const term = (letter, meaning) => h("span", {}, letter, h("sub", {}, "r"), ` ${meaning}`);

/**
 * @param {Node | string} caption
 * @param {string[]} columns
 * @param {(Node | string)[]} rows
 * @param {number[][]} values
 */
function table(caption, columns, rows, values) {
  return h(
    "table",
    { class: "numbers" },
    h("caption", {}, caption),
    h("thead", {}, h("tr", {}, h("td"), ...columns.map((name) => h("th", { scope: "col" }, name)))),
    h(
      "tbody",
      {},
      ...values.map((row, i) =>
        h("tr", {}, h("th", { scope: "row" }, rows[i]), ...row.map((x) => h("td", {}, number(x)))),
      ),
    ),
  );
}

/** A row for each vector, a column for each freedom. */
function vectors(reduced) {
  const rows = [
    [term("v", "rates"), reduced.v_r],
    [term("a", "accelerations"), reduced.a_r],
    [term("g", "gravity and springs"), reduced.g_r],
    [term("τ", "motors and other loads"), reduced.tau_r],
    ...(reduced.d_r ? [[term("d", "closures that move"), reduced.d_r]] : []),
  ];
  return table(
    "Vectors",
    reduced.independent,
    rows.map(([name]) => name),
    rows.map(([, values]) => values),
  );
}

/** @param {any} reduced @param {string[]} names of all coordinates */
function tables(reduced, names) {
  const { independent, rates } = reduced;
  if (independent.length > MOST) {
    const text = `${independent.length} degrees of freedom: "holonom terms" prints their matrices.`;
    return [h("p", { class: "about" }, text)];
  }
  return [
    vectors(reduced),
    table(term("M", "mass"), independent, independent, reduced.M_r),
    table(term("C", "speeds squared"), rates, independent, reduced.C_r),
    table("Φ: velocity of each coordinate per independent velocity", rates, names, reduced.Phi),
  ];
}

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {{formula: (latex: string, display: boolean) => HTMLElement, line: (entry: any) =>
 *   HTMLElement}} set
 */
export function createReduced(store, actions, set) {
  const data = store.data;
  const about = h("p", { class: "about" });
  const rule = h("div", {});
  const numbers = h("div", { class: "reduced-tables" });
  const pose = h("div", {});
  const node = h(
    "details",
    { class: "fold reduced-panel" },
    h("summary", {}, h("h3", {}, "Reduced to independent coordinates")),
    rule,
    about,
    numbers,
    pose,
  );
  let asking = false;
  let timer = 0;
  let answered = "";
  let ruled = "";

  function wanted() {
    const { history, view, scene } = data;
    const last = (history?.count ?? 0) - 1;
    const index = view.shown < 0 ? last : Math.min(view.shown, last);
    const m = view.selected;
    const key = `${data.run} ${m} ${history?.lastFrame} ${index}`;
    const visible = node.open && node.isConnected && scene && index >= 0 && data.methods[m];
    return visible && key !== answered ? { m, index, key } : null;
  }

  /** @param {any} reduced @param {number} m @param {number} t */
  function show(reduced, m, t) {
    if (!reduced.exists) {
      rule.replaceChildren();
      numbers.replaceChildren();
      say(about, `No independent coordinates exist here: ${reduced.why}.`);
      return;
    }
    const latex = reduced.d_r ? MOVED : REST;
    if (ruled !== latex || !rule.hasChildNodes()) {
      ruled = latex;
      rule.replaceChildren(set.formula(latex, true));
    }
    const names = data.scene.coordinates.map(({ name }) => name);
    say(
      about,
      `Independent: ${reduced.independent.join(", ")} (${reduced.chosen_by}). SI units; ` +
        `${data.methods[m].label} at ${seconds(t, data.duration)}.`,
    );
    numbers.replaceChildren(...tables(reduced, names));
  }

  async function look() {
    timer = 0;
    const what = asking ? null : wanted();
    if (!what) {
      return;
    }
    asking = true;
    const { run, history, scene } = data;
    const { q, v } = history.stateAt(what.m, what.index);
    const t = history.t[what.index];
    try {
      const { reduced } = await actions.terms({ t, state: namedState(scene.coordinates, q, v) });
      if (run === data.run) {
        answered = what.key;
        show(reduced, what.m, t);
      }
    } catch (error) {
      answered = what.key;
      numbers.replaceChildren();
      say(about, sentenceOf(error));
    }
    asking = false;
    timer = window.setTimeout(look, PAUSE);
  }

  function poke() {
    if (!timer && !asking) {
      look();
    }
  }

  /** @param {any} step */
  function stepLines(step) {
    const sign = step.sign
      ? `, ${step.sign.name} = ${step.sign.value > 0 ? "+1" : step.sign.value < 0 ? "−1" : "±1"} as it is assembled`
      : "";
    const text = `${step.kind}, ${step.meets}, from ${step.rows.join(" and ")}${sign}`;
    return h(
      "section",
      { class: "term-block" },
      h("h3", {}, text),
      ...[...step.parts, ...step.unknowns].map(set.line),
    );
  }

  node.addEventListener("toggle", poke);
  const stop = listen(store, { frame: poke, view: poke, methods: poke, scene: poke });
  return {
    node,
    /** @param {any} position of the equations' answer */
    give(position) {
      answered = "";
      const { independent, steps, answers } = position;
      pose.replaceChildren(
        independent.length && answers !== "none: there are no loops to close"
          ? h(
              "p",
              { class: "about" },
              `The configuration follows from ${independent.join(", ")}: ${answers}.`,
            )
          : "",
        ...steps.map(stepLines),
      );
      poke();
    },
    dispose() {
      clearTimeout(timer);
      stop();
    },
  };
}
