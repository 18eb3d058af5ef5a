// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The contents of a link to the page, in its fragment (which never reaches a server's log): scene,
// parameters, methods, the frame of the clock, and what is shown. A bare fragment is the id of a
// scene.
import { presets, studyKinds } from "./catalogue.js";
import { QUANTITIES } from "./quantities.js";
import { BUDGETS, PANELS, SHOWN } from "./shown.js";

const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;
const PARAMETER = /^[A-Za-z][\w.-]*$/;
const NAME = /^[\w.-]{1,80}$/;
const LONGEST = 4000; // [characters] that every mail program and browser takes
export const LONGEST_NOTE = 20000; // [characters]
const FARTHEST = 1e12;

/**
 * `look`: azimuth and elevation [rad], or empty; `camera`: half the height that is seen and the
 * middle of it [m], or empty; `upper` and `lower`: a quantity and words on how it is drawn, or
 * empty; `zoom` [s] of the plots, or empty; `why`: the method whose card is open, or -1; `speed`: 0
 * where none is said; `study`, `map`, `panel`, `lesson`: what is open, or ""; `judged`, `until`,
 * `step`: the coordinate whose error the budget splits, or "", its end and its step [s], or 0;
 * `budget`: what of it is shown, or "": the error; `note`: what its author wrote; `pulls`: what a
 * hand did, as the server's log has it.
 * @typedef {{scene: string, settings: Record<string, number>, methods: string[], frame: number,
 *   selected: number, hidden: number[], show: string[], look: number[], camera: number[],
 *   upper: string[], lower: string[], zoom: number[], why: number, speed: number, study: string,
 *   map: string, judged: string, until: number, step: number, budget: string, panel: string,
 *   lesson: string, note: string, build: string, pulls: number[][]}} Linked
 */

/** @param {string} text only what a fragment may not hold is escaped, so that a link can be read */
const escape = (text) => encodeURIComponent(text).replace(/%(3A|2C|40|3D|2F)/g, decodeURIComponent);

const EMPTY = () => ({
  scene: "",
  settings: /** @type {Record<string, number>} */ ({}),
  methods: /** @type {string[]} */ ([]),
  frame: 0,
  selected: 0,
  hidden: /** @type {number[]} */ ([]),
  show: ["labels", "reference"],
  look: /** @type {number[]} */ ([]),
  camera: /** @type {number[]} */ ([]),
  upper: /** @type {string[]} */ ([]),
  lower: /** @type {string[]} */ ([]),
  zoom: /** @type {number[]} */ ([]),
  why: -1,
  speed: 0,
  study: "",
  map: "",
  judged: "",
  until: 0,
  step: 0,
  budget: "",
  panel: "",
  lesson: "",
  note: "",
  build: "",
  pulls: /** @type {number[][]} */ ([]),
});

const ENTRY = 7; // numbers of a pull: frame, point, place, stiffness and damping of the hand
const PLACE = 5; // of them without the spring, which is then that of the entry before

/** @param {number[][]} pulls @returns {string} */
const pullsText = (pulls) =>
  pulls
    .map((entry, i) => {
      const before = pulls[i - 1];
      const same = before && entry.slice(PLACE).every((x, k) => x === before[PLACE + k]);
      return (same ? entry.slice(0, PLACE) : entry).join(",");
    })
    .join("/");

/** @param {string} text @returns {number[][] | null} null: it is no list of pulls */
function readPulls(text) {
  /** @type {number[][]} */
  const pulls = [];
  for (const part of text.split("/")) {
    const entry = part.split(",").map((one) => (NUMBER.test(one) ? Number(one) : NaN));
    const spring = entry.length === PLACE ? (pulls.at(-1) ?? []).slice(PLACE) : [];
    const whole = [...entry, ...spring];
    if (whole.length !== ENTRY || !whole.every(Number.isFinite)) {
      return null;
    }
    pulls.push(whole);
  }
  return pulls;
}

/** Entries that are left out where the page has them by itself, and how each is written. */
const OPTIONAL = /** @type {const} */ ([
  "look",
  "camera",
  "upper",
  "lower",
  "zoom",
  "why",
  "speed",
  "study",
  "map",
  "judged",
  "until",
  "step",
  "budget",
  "panel",
  "lesson",
  "note",
]);

/** @param {Partial<Linked> & {scene: string}} what @returns {string} */
export function encodeLink(what) {
  const empty = EMPTY();
  const link = { ...empty, ...what };
  const pairs = [
    ["scene", link.scene],
    ...Object.entries(link.settings).map(([name, value]) => [`set.${name}`, String(value)]),
    ...link.methods.map((method) => ["method", method]),
    ["frame", String(link.frame)],
    ["selected", String(link.selected)],
    ...link.hidden.map((m) => ["hidden", String(m)]),
    ["show", link.show.join(",")],
    ...OPTIONAL.map((name) => [name, String(link[name])]).filter(
      ([name, text]) => text !== String(empty[name]),
    ),
    ...(link.pulls.length ? [["pulls", pullsText(link.pulls)]] : []),
    ["build", link.build],
  ];
  return pairs.map(([key, value]) => `${escape(key)}=${escape(value)}`).join("&");
}

const LESSON = /^\/lessons(?:\/([\w.-]{0,80}))?$/;

/** The address of a lesson, as the fragment of the page's. @param {string} id */
export const lessonAddress = (id) => `/lessons/${id}`;

/** Does a fragment name a lesson and nothing else? @param {string} fragment */
export const isLessonAddress = (fragment) => LESSON.test(fragment);

/** May a link of this length be sent around? @param {string} text */
export const fits = (text) => text.length <= LONGEST;

/** One of some words. @param {string} name of the field @param {() => string[]} words */
const oneOf = (name, words) => (out, value) => {
  const known = words().includes(value);
  out[name] = known ? value : "";
  return known ? "" : `is '${value.slice(0, 40)}'; there are ${words().join(", ")}`;
};

/**
 * So many numbers, separated by commas, within bounds.
 * @param {string} name @param {number} count @param {number} least @param {number} most
 */
const numbers = (name, count, least, most) => (out, value) => {
  const texts = value.split(",");
  const list = texts.map((text) => (NUMBER.test(text) ? Number(text) : NaN));
  const sound = list.length === count && list.every((x) => x >= least && x <= most);
  out[name] = sound ? list : [];
  return sound
    ? ""
    : `is '${value.slice(0, 40)}'; ${count} numbers from ${least} to ${most} are needed`;
};

/** A quantity and how it is drawn. @param {"upper" | "lower"} name */
const plot = (name) => (out, value) => {
  const words = value.split(",");
  const sound =
    (words[0] === "phase" || QUANTITIES.some((one) => one.name === words[0])) &&
    words.slice(1).every((word) => ["turned", "table"].includes(word) || /^of:[\w.-]+$/.test(word));
  out[name] = sound ? words : [];
  return sound ? "" : `is '${value.slice(0, 40)}', which is no quantity of the plots`;
};

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
  why: (out, value) => putNumber(value, (number) => (out.why = Math.round(number)), 0, 7),
  speed: (out, value) => putNumber(value, (number) => (out.speed = number), 1e-3, 1e3),
  show: (out, value) => {
    const words = value.split(",").filter(Boolean);
    out.show = words.filter((word) => SHOWN.some((one) => one === word));
    const other = words.find((word) => !SHOWN.some((one) => one === word));
    return other ? `names '${other}'; there are ${SHOWN.join(", ")}` : "";
  },
  look: numbers("look", 2, -10, 10),
  camera: (out, value) => {
    const fault = numbers("camera", 4, -FARTHEST, FARTHEST)(out, value);
    const sound = out.camera.length === 0 || out.camera[0] > 0;
    out.camera = sound ? out.camera : [];
    return sound ? fault : `is '${value.slice(0, 40)}'; the height that is seen must be > 0`;
  },
  upper: plot("upper"),
  lower: plot("lower"),
  zoom: (out, value) => {
    const fault = numbers("zoom", 2, 0, FARTHEST)(out, value);
    const sound = out.zoom.length === 0 || out.zoom[0] < out.zoom[1];
    out.zoom = sound ? out.zoom : [];
    return sound ? fault : `is '${value}'; the first time must be before the second`;
  },
  study: oneOf("study", () => studyKinds().map(({ name }) => name)),
  map: oneOf("map", () => presets().map(({ name }) => name)),
  judged: (out, value) => {
    out.judged = PARAMETER.test(value) ? value : "";
    return out.judged ? "" : "is no name of a coordinate";
  },
  until: (out, value) => putNumber(value, (number) => (out.until = number), 1e-12, FARTHEST),
  step: (out, value) => putNumber(value, (number) => (out.step = number), 1e-12, FARTHEST),
  budget: oneOf("budget", () => BUDGETS),
  panel: oneOf("panel", () => PANELS),
  lesson: (out, value) => {
    out.lesson = NAME.test(value) ? value : "";
    return out.lesson ? "" : "is no name of a lesson";
  },
  note: (out, value) => {
    out.note = value.slice(0, LONGEST_NOTE);
    return value.length > LONGEST_NOTE
      ? `has ${value.length} characters; ${LONGEST_NOTE} are kept`
      : "";
  },
  pulls: (out, value) => {
    const pulls = readPulls(value);
    out.pulls = pulls ?? [];
    return pulls ? "" : "is no list of pulls: frame,point,x,y,z,stiffness,damping/...";
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
  const lesson = LESSON.exec(fragment);
  if (lesson) {
    link.panel = "lessons";
    link.lesson = lesson[1] ?? "";
    return { link, faults };
  }
  if (!fragment.includes("=")) {
    link.scene = decode(fragment) ?? "";
    return { link, faults };
  }
  for (const item of fragment.split("&").filter(Boolean)) {
    const [key, value] = [item.split("=")[0], item.split("=").slice(1).join("=")].map(decode);
    if (key === null || value === null) {
      faults.push(`'${item.slice(0, 40)}' is cut off`);
    } else if (`${key}${value}`.includes("\0")) {
      faults.push(`'${item.slice(0, 40)}' holds a zero character`); // no request may have one
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
