// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// JSON text as a person writes it: where each value stands, where it is wrong, and what the caret
// is in.

/**
 * @typedef {{key: boolean, path: string[], typed: string, from: number, inside: string[]}} Caret
 *   key: a name is expected, else a value; path: of the object or list around the caret, or of the
 *   value; typed: what stands of the string; from: where it begins; inside: names that are taken
 */

/**
 * Reads text up to an end. It keeps what it has found even when the text is broken.
 * @param {string} text
 * @param {number} end
 */
function walk(text, end) {
  /** start of each value by its pointer @type {Map<string, number>} */
  const places = new Map();
  /** @type {{list: boolean, key: string, index: number, names: string[], wantsKey: boolean}[]} */
  const open = [];
  let at = 0;
  let string = { from: -1, typed: "" };
  const pathOf = () => open.map(({ list, key, index }) => (list ? String(index) : key));
  const note = () => {
    const path = pathOf().map((part) => `/${part.replaceAll("~", "~0").replaceAll("/", "~1")}`);
    if (!places.has(path.join(""))) {
      places.set(path.join(""), at);
    }
  };

  while (at < end) {
    const c = text[at];
    const top = open[open.length - 1];
    if (c === '"') {
      const from = at + 1;
      let typed = "";
      const isKey = Boolean(top && !top.list && top.wantsKey);
      if (!isKey) {
        note();
      }
      for (at++; at < end && text[at] !== '"' && text[at] !== "\n"; at++) {
        if (text[at] === "\\") {
          at++;
        }
        typed += text[at] ?? "";
      }
      if (at >= end) {
        string = { from, typed };
        break;
      }
      if (isKey && top) {
        top.key = typed;
        top.names.push(typed);
      }
      at++;
    } else if (c === "{" || c === "[") {
      note();
      open.push({ list: c === "[", key: "", index: 0, names: [], wantsKey: c === "{" });
      at++;
    } else if (c === "}" || c === "]") {
      open.pop();
      at++;
    } else if (c === ":") {
      if (top) {
        top.wantsKey = false;
      }
      at++;
    } else if (c === ",") {
      if (top) {
        top.index++;
        top.wantsKey = !top.list;
        top.key = top.list ? top.key : "";
      }
      at++;
    } else if (/\s/.test(c)) {
      at++;
    } else {
      note();
      while (at < end && /[^\s,\]}:"]/.test(text[at])) {
        at++;
      }
    }
  }
  return { places, open, string, path: pathOf() };
}

/** Returns where each value begins, by its pointer. @param {string} text */
export const placesOf = (text) => walk(text, text.length).places;

/** @param {string} text @param {number} caret @returns {Caret} */
export function caretIn(text, caret) {
  const { open, string, path } = walk(text, caret);
  const top = open[open.length - 1];
  const key = Boolean(top && !top.list && top.wantsKey);
  const typed =
    string.from >= 0 ? string.typed : (/[\w.+-]*$/.exec(text.slice(0, caret))?.[0] ?? "");
  return {
    key,
    path: key ? path.slice(0, -1) : path,
    typed,
    from: caret - typed.length,
    inside: top?.names ?? [],
  };
}

/** The line and column of an offset, from 1. @param {string} text @param {number} offset */
export function lineOf(text, offset) {
  const before = text.slice(0, offset).split("\n");
  return { line: before.length, column: before[before.length - 1].length + 1 };
}

/** The nearest place that a pointer names: of the value, or of what should hold it. */
export function placeOf(places, pointer) {
  for (let at = pointer; at !== ""; at = at.slice(0, at.lastIndexOf("/"))) {
    if (places.has(at)) {
      return places.get(at) ?? 0;
    }
  }
  return 0;
}

/**
 * @param {string} text
 * @returns {{value: any, fault: {message: string, offset: number} | null}}
 */
export function parseText(text) {
  try {
    return { value: JSON.parse(text), fault: null };
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    const offset = Number(/position (\d+)/.exec(message)?.[1] ?? text.length);
    const found =
      text[offset] === undefined
        ? "the text ends too early"
        : `'${text[offset]}' is not expected here`;
    return { value: null, fault: { message: `not JSON: ${found}`, offset } };
  }
}
