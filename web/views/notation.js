// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The notation of the usual lesson beside this program's, with the numbers of the state that is
// shown: accelerations, multipliers, rank and condition.
import { sentenceOf } from "../api/client.js";
import { scientific } from "../state/format.js";
import { accelerationsOf } from "../state/formula.js";
import { markWords, namedState } from "../state/reactions.js";
import { shownIndex } from "../state/store.js";
import { h, say } from "../widgets/dom.js";

const PAUSE = 250; // [ms] between an answer and the next question
const MOST = 8; // numbers of a vector
const ROWS = [
  ["M(q)", "M", "mass matrix"],
  ["\\mathbf C\\dot q + g", "Q - f", "velocity forces and gravity"],
  ["S_a^{\\mathsf T}\\tau_a", "Q", "drives and loads"],
  ["J_c", "J", "constraint Jacobian"],
  ["\\dot J_c\\,\\dot q", "\\gamma", "acceleration of the loops at zero acceleration"],
  ["\\ddot q", "a", "accelerations"],
  ["\\lambda", "\\lambda", "multipliers: forces that hold the loops closed; they act as +J'λ"],
];
const UNITS = { angle: "rad/s²", length: "m/s²", other: "" };

/** @param {number} x */
const number = (x) =>
  Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5
    ? String(Number(x.toPrecision(4))).replace("-", "−")
    : x === 0
      ? "0"
      : scientific(x, 3);

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createNotation(store, actions) {
  const data = store.data;
  const numbers = h("td", { class: "number" });
  const meanings = { a: h("td", {}, "accelerations") };
  const multipliers = h("td", { class: "number" });
  const quality = h("p", { class: "about", role: "status" });
  const node = h("div", { class: "notation" });
  let asked = "";
  let busy = false;
  let last = 0;

  /** the equations that the table stands beside */
  let equations = /** @type {any} */ (null);

  /**
   * @param {(latex: string, display: boolean) => Node} formula
   * @param {{coordinates?: {name: string, is: string}[], speeds: string[]}} answer the equations
   */
  function make(formula, answer) {
    equations = answer;
    const value = { a: numbers, "\\lambda": multipliers };
    const heads = ["The lesson's", "Here", "Meaning", "Now"];
    node.replaceChildren(
      h(
        "table",
        { class: "numbers notation-table" },
        h("caption", {}, "Notation"),
        h("thead", {}, h("tr", {}, ...heads.map((one) => h("th", { scope: "col" }, one)))),
        h(
          "tbody",
          {},
          ...ROWS.map(([lesson, ours, meaning]) =>
            h(
              "tr",
              {},
              h("td", {}, formula(lesson, false)),
              h("td", {}, formula(ours, false)),
              meanings[ours] ?? h("td", {}, meaning),
              value[ours] ?? h("td"),
            ),
          ),
        ),
      ),
      quality,
    );
    asked = "";
  }

  /** @param {any} answer */
  function show({ a = [], lambda = [], rank, rows = [], condition, lambda_mark: mark }) {
    const { coordinates } = data.scene;
    // in the velocities of M and J where they follow from those of the coordinates
    const same = accelerationsOf(equations, data.scene, a);
    const names = same ? equations.speeds : coordinates.map(({ rate }) => rate);
    const units = coordinates.map(({ kind }) => UNITS[kind] ?? "");
    const list = (values, unitOf) =>
      values
        .slice(0, MOST)
        .map((x, i) => `${number(x)} ${unitOf(i)}`.trim())
        .join(", ") + (values.length > MOST ? " ..." : "");
    say(
      numbers,
      list(same ?? a, (i) => units[i] ?? ""),
    );
    const order = same ? ", the order of M's rows" : "; M below has other velocities";
    const whose = names.length > MOST ? "the velocities" : names.join(", ");
    say(meanings.a, `accelerations: time derivatives of ${whose}${order}`);
    say(
      multipliers,
      lambda.length
        ? list(lambda, (i) => (data.scene.rows?.[i]?.unit === "m" ? "N" : "N m"))
        : "none",
    );
    const of = rows.length ? `Rank of J: ${rank} of ${rows.length}. ` : "";
    const cond = Number.isFinite(condition)
      ? `Condition of the system: ${number(condition)}. `
      : "";
    say(quality, `${of}${cond}${markWords(mark)}`);
  }

  /** Asks for the terms of the frame shown, one question at a time. */
  async function update() {
    const i = shownIndex(data);
    const key = `${data.run} ${data.view.selected} ${i < 0 ? "" : data.history.frameAt(i)}`;
    if (!node.isConnected || busy || i < 0 || key === asked || performance.now() - last < PAUSE) {
      return;
    }
    busy = true;
    asked = key;
    try {
      const { q, v } = data.history.stateAt(data.view.selected, i);
      show(
        await actions.terms({
          t: data.history.t[i],
          state: namedState(data.scene.coordinates, q, v),
        }),
      );
    } catch (error) {
      say(quality, sentenceOf(error));
    }
    busy = false;
    last = performance.now();
  }

  return { node, make, update };
}
