// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A slider with a number field beside it: the field takes what people type ("0,02", "2e-2 s"), the
// slider keeps to round values.
import { sentenceOf } from "../api/client.js";
import { plain } from "../state/format.js";
import { h, say, set } from "./dom.js";

const LEADS = [1, 1.5, 2, 3, 4, 5, 6, 8];
const INPUT_PAUSE = 140; // [ms] a dragged slider asks at most this often

/** Round values from min to max, eight a decade. @param {number} min @param {number} max */
function logScale(min, max) {
  const values = [];
  for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); e++) {
    for (const lead of LEADS) {
      const value = Number((lead * 10 ** e).toPrecision(3));
      if (value >= min * (1 - 1e-9) && value <= max * (1 + 1e-9)) {
        values.push(value);
      }
    }
  }
  return {
    attributes: { min: 0, max: values.length - 1, step: 1 },
    to: (value) =>
      values.reduce(
        (best, v, i) =>
          Math.abs(Math.log(v / value)) < Math.abs(Math.log(values[best] / value)) ? i : best,
        0,
      ),
    from: (position) => values[Math.round(position)],
  };
}

/** @param {number} min @param {number} max @param {number} [step] */
function linearScale(min, max, step) {
  const chosen = step ?? Number(((max - min) / 200).toPrecision(1));
  return {
    attributes: { min, max, step: chosen },
    to: (value) => Math.min(max, Math.max(min, value)),
    from: (position) => Number(Number(position).toPrecision(6)),
  };
}

/**
 * `read` gives NaN for a text that is no number; `meaning` stands under the label, `tip` defines
 * it.
 * @param {{
 *   id: string, label: string, unit: string, hint: string, meaning?: string,
 *   tip?: string, scale?: "log" | "linear",
 *   min: number, max: number, step?: number, read: (text: string) => number,
 *   check: (value: number) => {error?: string, warning?: string},
 *   commit: (value: number) => Promise<void>,
 * }} options
 */
export function createSliderField(options) {
  const scale =
    options.scale === "log"
      ? logScale(options.min, options.max)
      : linearScale(options.min, options.max, options.step);
  const hintId = `${options.id}-hint`;
  const range = h("input", {
    type: "range",
    id: `${options.id}-slider`,
    "aria-label": options.label,
    "aria-describedby": hintId,
    "data-tip": options.tip,
    ...scale.attributes,
  });
  const field = h("input", {
    type: "text",
    id: options.id,
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
    "aria-describedby": hintId,
  });
  const hint = h("p", { id: hintId, class: "hint", role: "status" }, options.hint);
  const el = h(
    "div",
    { class: "setting" },
    h(
      "label",
      { for: options.id, "data-tip": options.tip },
      options.label,
      ...(options.meaning ? [" ", h("span", { class: "meaning" }, options.meaning)] : []),
    ),
    range,
    h(
      "span",
      { class: "entry" },
      field,
      h("span", { class: "unit", "aria-hidden": "true" }, options.unit),
    ),
    hint,
  );
  let value = NaN;
  let timer = 0;
  /** the error shown is an answer of the server, or its silence: not a fault of what was typed */
  let refused = false;
  /** while the server has not answered, what was asked is shown and only the latest wish kept */
  let pending = false;
  let next = NaN;

  /** @param {"" | "error" | "warning"} kind @param {string} text */
  function tell(kind, text) {
    el.dataset.kind = kind;
    refused = false;
    set(field, { "aria-invalid": kind === "error" ? "true" : null });
    say(hint, text || options.hint);
  }

  function show() {
    range.value = String(scale.to(value));
    const words = `${plain(value)} ${options.unit}`.trim();
    set(range, { "aria-valuetext": words });
    if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true") {
      field.value = plain(value);
    }
  }

  /** @param {number} wanted */
  async function commit(wanted) {
    const verdict = Number.isNaN(wanted)
      ? {
          error: `type a number${options.unit ? ` in ${options.unit}` : ""}, such as ${plain(value)}`,
        }
      : options.check(wanted);
    if (verdict.error) {
      tell("error", verdict.error);
      return;
    }
    if (pending) {
      next = wanted;
      return;
    }
    if (wanted === value && !refused) {
      // Enter and then leaving the field say the same: it is asked for once
      tell(verdict.warning ? "warning" : "", verdict.warning ?? "");
      show();
      return;
    }
    const before = value;
    value = wanted;
    tell(verdict.warning ? "warning" : "", verdict.warning ?? "");
    show();
    pending = true;
    try {
      await options.commit(wanted);
    } catch (error) {
      value = before;
      tell("error", sentenceOf(error));
      refused = true;
      range.value = String(scale.to(value));
    }
    pending = false;
    if (!Number.isNaN(next)) {
      const latest = next;
      next = NaN;
      await commit(latest);
    }
  }

  set(range, {
    oninput: () => {
      const wanted = scale.from(Number(range.value));
      field.value = plain(wanted);
      set(range, { "aria-valuetext": `${plain(wanted)} ${options.unit}`.trim() });
      clearTimeout(timer);
      timer = window.setTimeout(() => commit(wanted), INPUT_PAUSE);
    },
    onchange: () => {
      clearTimeout(timer);
      commit(scale.from(Number(range.value)));
    },
  });
  set(field, {
    onchange: () => commit(options.read(field.value)),
    onkeydown: (event) => {
      if (event.key === "Enter") {
        commit(options.read(field.value));
      } else if (event.key === "Escape") {
        tell("", "");
        show();
      }
    },
  });

  return {
    el,
    /** Takes over the value that the server holds. @param {number} held */
    update(held) {
      if (!pending && held !== value) {
        value = held;
        const verdict = options.check(held);
        tell(verdict.warning ? "warning" : "", verdict.warning ?? "");
        show();
      }
    },
    /** The line below the field, where there is nothing worse to say. @param {string} text */
    setHint(text) {
      const shown = hint.textContent === options.hint;
      options.hint = text;
      if (shown) {
        say(hint, text);
      }
    },
    /** The server is there again: a refusal is out of date, and the field shows what runs. */
    settle() {
      if (!pending && refused) {
        const verdict = options.check(value);
        tell(verdict.warning ? "warning" : "", verdict.warning ?? "");
        show();
      }
    },
    /** Shows what runs in place of a value in sight that was refused. Returns whether one was. */
    takeBack() {
      if (el.dataset.kind !== "error" || el.offsetParent === null) {
        return false;
      }
      const verdict = options.check(value);
      tell(verdict.warning ? "warning" : "", verdict.warning ?? "");
      show();
      return true;
    },
    dispose() {
      clearTimeout(timer);
      el.remove();
    },
  };
}
