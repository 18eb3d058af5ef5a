// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// What a link to the page holds, in its fragment (which never reaches a server's log): scene,
// parameters, methods, the frame of the clock, and what is shown. A bare fragment is the id of a
// scene.
import { KINDS } from "./catalogue.js";

const SHOWN = ["labels", "traces", "reference", "arrows", "reactions"];
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;
const PARAMETER = /^[A-Za-z][\w.-]*$/;
const LONGEST = 4000; // [characters] that every mail program and browser takes
export const LONGEST_NOTE = 20000; // [characters]

/**
 * @typedef {{scene: string, settings: Record<string, number>, methods: string[], frame: number,
 *   selected: number, hidden: number[],
 *   show: string[], study: string, note: string, build: string}} Linked study: the one that is
 *   open, or ""; note: what its author wrote
 */

/** @param {string} text only what a fragment may not hold is escaped, so that a link can be read */
const escape = (text) => encodeURIComponent(text).replace(/%(3A|2C|40|3D|2F)/g, decodeURIComponent);

/** @param {Linked} what @returns {string} */
export function encodeLink({
  scene,
  settings,
  methods,
  frame,
  selected,
  hidden,
  show,
  study,
  note,
  build,
}) {
  const pairs = [
    ["scene", scene],
    ...Object.entries(settings).map(([name, value]) => [`set.${name}`, String(value)]),
    ...methods.map((method) => ["method", method]),
    ["frame", String(frame)],
    ["selected", String(selected)],
    ...hidden.map((m) => ["hidden", String(m)]),
    ["show", show.join(",")],
    ...(study ? [["study", study]] : []),
    ...(note ? [["note", note]] : []),
    ["build", build],
  ];
  return pairs.map(([key, value]) => `${escape(key)}=${escape(value)}`).join("&");
}

/** May a link of this length be sent around? @param {string} text */
export const fits = (text) => text.length <= LONGEST;

const EMPTY = () => ({
  scene: "",
  settings: /** @type {Record<string, number>} */ ({}),
  methods: /** @type {string[]} */ ([]),
  frame: 0,
  selected: 0,
  hidden: /** @type {number[]} */ ([]),
  show: ["labels", "reference"],
  study: "",
  note: "",
  build: "",
});

/**
 * @type {Record<string, (out: Linked, value: string) => string>} each puts a value and says what is
 *   wrong with it
 */
const FIELDS = {
  scene: (out, value) => {
    out.scene = value;
    return value ? "" : "is empty";
  },
  method: (out, value) => {
    out.methods.push(value);
    return value.includes("@") ? "" : "has no @ between formulation and integrator";
  },
  frame: (out, value) => putNumber(value, (number) => (out.frame = Math.round(number)), 0, 1e6),
  selected: (out, value) => putNumber(value, (number) => (out.selected = Math.round(number)), 0, 7),
  hidden: (out, value) => putNumber(value, (number) => out.hidden.push(Math.round(number)), 0, 7),
  show: (out, value) => {
    const words = value.split(",").filter(Boolean);
    out.show = words.filter((word) => SHOWN.includes(word));
    const other = words.find((word) => !SHOWN.includes(word));
    return other ? `names '${other}'; there are ${SHOWN.join(", ")}` : "";
  },
  study: (out, value) => {
    out.study = KINDS.some((kind) => kind === value) ? value : "";
    return out.study ? "" : `is '${value.slice(0, 40)}'; there are ${KINDS.join(", ")}`;
  },
  note: (out, value) => {
    out.note = value.slice(0, LONGEST_NOTE);
    return value.length > LONGEST_NOTE
      ? `has ${value.length} characters; ${LONGEST_NOTE} are kept`
      : "";
  },
  build: (out, value) => {
    out.build = value;
    return "";
  },
};

function putNumber(text, put, least, most) {
  const value = NUMBER.test(text) ? Number(text) : NaN;
  if (!(value >= least && value <= most)) {
    return `is '${text}'; a number from ${least} to ${most} is needed`;
  }
  put(value);
  return "";
}

/** @param {Linked} link @param {string} name @param {string} value */
const putParameter = (link, name, value) =>
  PARAMETER.test(name)
    ? putNumber(value, (number) => (link.settings[name] = number), -1e12, 1e12)
    : "is no name of a parameter";

/**
 * @param {string} fragment without its #
 * @returns {{link: Linked, faults: string[]}} what could be read, and what could not, by field
 */
export function decodeLink(fragment) {
  const link = EMPTY();
  /** @type {string[]} */
  const faults = [];
  if (!fragment.includes("=")) {
    link.scene = decode(fragment) ?? "";
    return { link, faults };
  }
  for (const item of fragment.split("&").filter(Boolean)) {
    const [key, value] = [item.split("=")[0], item.split("=").slice(1).join("=")].map(decode);
    if (key === null || value === null) {
      faults.push(`'${item.slice(0, 40)}' is cut off`);
    } else if (key.startsWith("set.")) {
      const fault = putParameter(link, key.slice(4), value);
      faults.push(...(fault ? [`${key.slice(4)} ${fault}`] : []));
    } else if (!Object.hasOwn(FIELDS, key)) {
      faults.push(`no field is called '${key.slice(0, 40)}'`);
    } else {
      const fault = FIELDS[key](link, value);
      faults.push(...(fault ? [`${key} ${fault}`] : []));
    }
  }
  link.methods = link.methods.filter((method) => method.includes("@"));
  return { link, faults };
}

/** @param {string} text @returns {string | null} null: an escape is cut off */
function decode(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return null;
  }
}
