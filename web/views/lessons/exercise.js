// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// An exercise inside a lesson: what is asked, fields for the answers, hints one after the other,
// and the check. It is fetched when it is opened.
import { sentenceOf } from "../../api/client.js";
import { documents } from "../../api/documents.js";
import {
  flowing,
  formOf,
  matrixOf,
  readAnswer,
  readChoice,
  summaryOf,
} from "../../state/answers.js";
import { counted } from "../../state/format.js";
import { typeset } from "../../state/typeset.js";
import { h, say } from "../../widgets/dom.js";

/**
 * A field with its value.
 * @typedef {{node: Node, value: () => any}} Field value: undefined where nothing was entered
 */

/** What fills the exercise of each frame, once. @type {WeakMap<Element, () => Promise<void>>} */
const fillers = new WeakMap();

/**
 * Opens all exercises of a text, as paper needs them.
 * @param {Element} text
 * @returns {{filled: Promise<any>, close: () => void}} close: those that were closed before
 */
export function openExercises(text) {
  /** @type {NodeListOf<HTMLDetailsElement>} */
  const found = text.querySelectorAll("details.exercise:not([open])");
  const closed = [...found];
  closed.forEach((one) => (one.open = true));
  return {
    filled: Promise.allSettled(closed.map((one) => fillers.get(one)?.())),
    close: () => closed.forEach((one) => (one.open = false)),
  };
}

/** Text with its indices and powers. @param {string} words @returns {(Node | string)[]} */
const set = (words) => typeset(words).map(({ text, place }) => (place ? h(place, {}, text) : text));

/** @param {string} id @param {string} legend @param {{letter: string, text: string}[]} options */
function radios(id, legend, options) {
  const inputs = options.map(({ letter, text }) => {
    const input = h("input", { type: "radio", name: id, id: `${id}-${letter}`, value: letter });
    return {
      input,
      row: h("li", {}, input, h("label", { for: input.id }, `(${letter}) `, ...set(text))),
    };
  });
  return {
    node: h(
      "fieldset",
      {},
      h("legend", {}, legend),
      h("ul", { class: "choices-list" }, ...inputs.map(({ row }) => row)),
    ),
    value: () => inputs.find(({ input }) => input.checked)?.input.value,
  };
}

/** @param {string} id @param {import("../../state/answers.js").Part} part @returns {Field} */
function choiceField(id, { answer_form: form }) {
  const { options, reasons } = readChoice(form);
  const choice = radios(`${id}-choice`, "Answer", options);
  if (!reasons.length) {
    return choice;
  }
  const reason = radios(`${id}-reason`, "because", reasons);
  return {
    node: h("div", {}, choice.node, reason.node),
    value: () =>
      choice.value() || reason.value()
        ? { choice: choice.value() ?? "", reason: reason.value() ?? "" }
        : undefined,
  };
}

/** @param {string} id @param {import("../../state/answers.js").Part} part @returns {Field} */
function textField(id, part) {
  const field = h("textarea", {
    id,
    rows: part.kind === "number" || part.kind === "matrix" ? "1" : "3",
    spellcheck: "false",
    "aria-describedby": `${id}-form`,
  });
  return {
    node: h(
      "div",
      {},
      h("label", { for: id }, "Answer"),
      field,
      h("pre", { id: `${id}-form`, class: "about answer-form" }, formOf(part)),
    ),
    value: () => (field.value.trim() ? readAnswer(field.value) : undefined),
  };
}

/**
 * The plot that is to be read. It loses its own style, which would be that of the whole page.
 * @param {import("../../state/answers.js").Part} part
 */
function plotOf({ figure }) {
  if (!figure) {
    return "";
  }
  const drawing = figure.svg.replace(/<style>.*?<\/style>/s, "");
  const plot = new DOMParser().parseFromString(drawing, "image/svg+xml").documentElement;
  return h("div", { class: "exercise-plot" }, document.importNode(plot, true));
}

/**
 * A grid of formulas.
 * @param {string} id
 * @param {{name: string, rows: number, columns: number}} matrix
 */
function matrixField(id, { name, rows, columns }) {
  const inputs = Array.from({ length: rows }, (_, i) =>
    Array.from({ length: columns }, (__, k) =>
      h("input", {
        type: "text",
        id: `${id}-${i}-${k}`,
        spellcheck: "false",
        autocomplete: "off",
        "aria-label": `${name}${i + 1}${k + 1}`,
        placeholder: `${name}${i + 1}${k + 1}`,
      }),
    ),
  );
  const grid = h("div", { class: "answer-matrix" }, ...inputs.flat());
  grid.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
  return {
    node: grid,
    value: () => inputs.map((row) => row.map(({ value }) => value.trim())),
  };
}

/**
 * @param {{id: string, title?: string, about: Node[], progress: import("../../state/progress.js").Progress,
 *   changed: () => void}} how title: where it is known before the exercise is opened
 */
export function createExercise({ id, title: known, about, progress, changed }) {
  const body = h("div", { class: "exercise-body" });
  const title = h("span", {}, known ? `Exercise ${id}: ${known}` : `Exercise ${id}`);
  const mark = h("span", { class: "about" });
  const details = h(
    "details",
    { class: "live exercise", ontoggle: () => details.open && open() },
    h("summary", {}, title, mark),
    body,
  );
  /** @type {Promise<void> | null} */
  let filled = null;

  function showMark() {
    const best = progress.solved(id);
    say(mark, best ? `${best.score} of ${counted(best.most, "point")}` : "");
  }

  async function fetchAndFill() {
    try {
      fill(await documents.problem(id));
    } catch (error) {
      filled = null;
      body.replaceChildren(h("p", { class: "hint" }, sentenceOf(error)));
    }
  }

  /** Fills it the first time, or again where that failed. */
  function open() {
    filled ??= fetchAndFill();
    return filled;
  }

  /** @param {any} problem */
  function fill(problem) {
    say(title, `Exercise ${id}: ${problem.title}`);
    const key = `exercise-${id}`;
    const matrix = problem.parts ? null : matrixOf(problem.submission ?? "");
    /** @type {{name: string, field: Field, head: (Node | string)[]}[]} */
    const fields = problem.parts
      ? problem.parts.map((part) => ({
          name: part.id,
          field: (part.kind === "choice" ? choiceField : textField)(`${key}-${part.id}`, part),
          head: [
            h("p", { class: "ask" }, `(${part.id}) `, ...set(part.ask)),
            h("p", { class: "about" }, counted(part.points, "point")),
            plotOf(part),
          ],
        }))
      : matrix
        ? [{ name: matrix.name, field: matrixField(key, matrix), head: [] }]
        : [];
    const result = h("div", { class: "verdict-list", role: "status" });
    const hints = h("ol", { class: "hints" });
    const more = h(
      "button",
      { type: "button", class: "plain", hidden: !(problem.hints > 0), onclick: addHint },
      "a hint",
    );

    async function addHint() {
      const number = hints.childElementCount + 1;
      try {
        const { text } = await documents.hint(id, number);
        hints.append(h("li", {}, ...set(text)));
        more.hidden = number >= problem.hints;
        say(more, `another hint (${number} of ${problem.hints} shown)`);
      } catch (error) {
        say(result, sentenceOf(error));
      }
    }

    async function check() {
      const values = fields.map(({ name, field }) => [name, field.value()]);
      const submission = Object.fromEntries(values.filter(([, value]) => value !== undefined));
      try {
        const verdict = await documents.grade(id, submission);
        showVerdict(verdict);
      } catch (error) {
        say(result, sentenceOf(error));
      }
    }

    /** @param {any} verdict */
    function showVerdict(verdict) {
      if (verdict.status !== "graded") {
        say(result, `${verdict.reason ?? verdict.summary}`);
        return;
      }
      const wrong = verdict.entries.filter(({ right }) => !right);
      result.replaceChildren(
        h(
          "p",
          {},
          h("strong", {}, `${verdict.score} of ${counted(verdict.max_score, "point")}. `),
          summaryOf(verdict),
        ),
        h(
          "ul",
          {},
          ...wrong.map(({ name, explanation, given }) =>
            h(
              "li",
              {},
              h("strong", {}, `${name} `),
              explanation || "not right",
              given ? `: ${given}` : "",
            ),
          ),
        ),
      );
      progress.setSolved(id, verdict.score, verdict.max_score);
      showMark();
      changed();
    }

    body.replaceChildren(
      h("pre", { class: "statement", tabindex: "0" }, ...set(flowing(problem.statement))),
      ...fields.flatMap(({ head, field }) => [...head, field.node]),
      problem.names ? h("p", { class: "about" }, `Names: ${problem.names.join(", ")}`) : "",
      h(
        "div",
        { class: "choices" },
        h("button", { type: "button", class: "primary", onclick: check }, "Check"),
        more,
      ),
      hints,
      result,
    );
  }

  showMark();
  fillers.set(details, open);
  return h("div", { class: "live-block" }, ...about, details);
}
