// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The keys of the page, as data. `key` is KeyboardEvent.key; a letter (or any single printable
// character) can be switched off.

/**
 * @typedef {{key: string, shift?: boolean, context: "page" | "drawing", action: string, argument?:
 *   number | string, means: string, shown?: string}} Key
 * @type {Key[]}
 */
export const KEYS = [
  { key: " ", context: "page", action: "toggle", means: "play or pause", shown: "Space" },
  {
    key: "ArrowRight",
    context: "page",
    action: "step",
    argument: 1,
    means: "one frame forward",
    shown: "→",
  },
  {
    key: "ArrowLeft",
    context: "page",
    action: "step",
    argument: -1,
    means: "one frame back",
    shown: "←",
  },
  {
    key: "ArrowRight",
    shift: true,
    context: "page",
    action: "step",
    argument: 10,
    means: "ten frames forward",
    shown: "Shift →",
  },
  {
    key: "ArrowLeft",
    shift: true,
    context: "page",
    action: "step",
    argument: -10,
    means: "ten frames back",
    shown: "Shift ←",
  },
  {
    key: "Backspace",
    context: "page",
    action: "reset",
    means: "back to the start of the recording",
  },
  { key: "-", context: "page", action: "slower", means: "slower" },
  { key: "=", context: "page", action: "faster", means: "faster" },
  { key: "l", context: "page", action: "share", means: "a link to what is shown", shown: "L" },
  {
    key: "w",
    context: "page",
    action: "study",
    argument: "work-precision",
    means: "study: what accuracy costs",
    shown: "W",
  },
  {
    key: "b",
    context: "page",
    action: "study",
    argument: "stability",
    means: "study: where steps are stable",
    shown: "B",
  },
  {
    key: "e",
    context: "page",
    action: "study",
    argument: "budget",
    means: "study: where the error comes from",
    shown: "E",
  },
  {
    key: "k",
    context: "page",
    action: "toggleKept",
    means: "keep this recording beside the next ones",
    shown: "K",
  },
  { key: "z", context: "page", action: "undo", means: "undo the last change", shown: "Z" },
  { key: "y", context: "page", action: "redo", means: "redo it", shown: "Y" },
  { key: "F1", context: "page", action: "help", means: "this table" },
  ...Array.from({ length: 8 }, (_, i) => ({
    key: String(i + 1),
    context: /** @type {const} */ ("page"),
    action: "select",
    argument: i,
    means: `select method ${i + 1}`,
  })),
  { key: "9", context: "page", action: "cycle", means: "select the next method" },
];

/** A key that produces a character: these can be switched off (WCAG 2.1.4). @param {Key} key */
export function isCharacter(key) {
  return key.key.length === 1 && key.key !== " ";
}

/** @param {Key} key */
export function keyName(key) {
  return key.shown ?? key.key;
}

/** Returns what tells two bindings apart. @param {Key} key */
export function bindingOf(key) {
  return `${key.context} ${key.shift ? "shift+" : ""}${key.key}`;
}

/**
 * @param {{key: string, shiftKey: boolean, ctrlKey: boolean, altKey: boolean, metaKey: boolean}}
 *   event
 * @param {boolean} letters are single-character keys on
 */
export function findKey(event, letters) {
  if (event.ctrlKey || event.altKey || event.metaKey) {
    return undefined;
  }
  // on many keyboards a digit or a sign needs Shift itself
  return KEYS.find((key) =>
    isCharacter(key)
      ? letters && key.key === event.key
      : key.key === event.key && Boolean(key.shift) === event.shiftKey,
  );
}
