// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The view of a comparison, as a link holds it: buttons that are pressed, plots, zoom, camera,
// the panels that are open.
import { anglesOf, lookFrom } from "./look.js";

/**
 * @typedef {{
 *   of: string, turned: boolean, table: boolean, coordinate: string,
 * }} Plot of: name of a quantity, or "phase"; turned: the other axis than the quantity has by
 *   itself, decades or linear; coordinate: of the phase plot, or ""
 * @typedef {{
 *   camera: number[], perspective: boolean, follow: boolean, frames: boolean,
 * }} SpaceView camera: half the height that is seen and the middle of it [m], or empty: as it fits
 */

/** Returns what the plots show at first. @returns {Record<string, Plot>} */
export const firstPlots = () => ({
  upper: { of: "off", turned: false, table: false, coordinate: "" },
  lower: { of: "gap", turned: false, table: false, coordinate: "" },
});

/** @returns {SpaceView} */
export const firstSpace = () => ({
  camera: [],
  perspective: true,
  follow: false,
  frames: false,
});

/** Switches of the view, by the word that a link has for each. */
const SWITCHES = /** @type {const} */ ([
  "labels",
  "traces",
  "reference",
  "arrows",
  "reactions",
  "equations",
  "parameters",
  "lengths",
  "loop",
]);
/** Those of a view in space; "flat" is the one without perspective. */
const SPACE = /** @type {const} */ (["follow", "frames"]);
const FLAT = "flat";

/** All words that say in a link what is shown. */
export const SHOWN = [...SWITCHES, ...SPACE, FLAT];
/** Panels that a link may open. */
export const PANELS = ["lessons", "editor"];
/** The views of an error budget, the first by itself. */
export const BUDGETS = ["error", "energy"];

/** A number of a camera: more digits than can be seen. @param {number} x */
const short = (x) => Number(x.toPrecision(5));

/** @param {Plot} plot @returns {string[]} */
const plotWords = ({ of, turned, table, coordinate }) => [
  of,
  ...(turned ? ["turned"] : []),
  ...(table ? ["table"] : []),
  ...(coordinate ? [`of:${coordinate}`] : []),
];

/** @param {string[]} words @returns {Plot} */
const plotOf = ([of, ...rest]) => ({
  of,
  turned: rest.includes("turned"),
  table: rest.includes("table"),
  coordinate: rest.find((word) => word.startsWith("of:"))?.slice(3) ?? "",
});

/** @param {import("./types.js").Scene} scene @param {string} name */
const hasCoordinate = (scene, name) => scene?.coordinates?.some((one) => one.name === name);

/**
 * Returns what was asked for of the error budget of the scene that is open: the coordinate, or "",
 * the end and the step [s], or 0.
 * @param {import("./store.js").Data["view"]} view
 * @param {import("./types.js").Scene} scene
 */
export const budgetOf = ({ judged, split: { scene: id, time, step } }, scene) => ({
  judged: hasCoordinate(scene, judged) ? judged : "",
  ...(id === scene?.id ? { until: time, step } : { until: 0, step: 0 }),
});

/**
 * The fields of a link that say what is shown.
 * @param {import("./store.js").Data} data
 */
export function shownOf({ view, scene, speed }) {
  const { space, look, plots } = view;
  const flags = space ? [...SPACE.filter((name) => space[name])] : [];
  const first = firstPlots();
  const words = (id) =>
    JSON.stringify(plots[id]) === JSON.stringify(first[id]) ? [] : plotWords(plots[id]);
  return {
    show: [
      ...SWITCHES.filter((name) => view[name]),
      ...flags,
      ...(space && !space.perspective ? [FLAT] : []),
    ],
    look: look ? anglesOf(look, scene?.view?.vertical).map(short) : [],
    camera: space ? space.camera.map(short) : [],
    upper: words("upper"),
    lower: words("lower"),
    zoom: view.zoom ? view.zoom.map(short) : [],
    why: view.why,
    speed,
    study: view.study,
    map: view.map,
    ...budgetOf(view, scene),
    budget: view.budget,
    panel: view.panel,
    lesson: view.panel === "lessons" ? view.lesson : "",
  };
}

/** @param {import("./link.js").Linked} link @returns {SpaceView | null} null: as it fits */
function spaceOf({ show, camera }) {
  const flags = [...SPACE, FLAT].some((word) => show.includes(word));
  if (!flags && camera.length === 0) {
    return null;
  }
  return {
    camera,
    perspective: !show.includes(FLAT),
    follow: show.includes("follow"),
    frames: show.includes("frames"),
  };
}

/**
 * A lesson by its id, its number, or its id without the number; undefined where there is none.
 * @param {import("./store.js").Data["lessons"]} lessons @param {string} name
 */
const lessonNamed = (lessons, name) =>
  lessons.find(({ id }) => id === name) ??
  lessons[/^\d+$/.test(name) ? Number(name) - 1 : -1] ??
  lessons.find(({ id }) => id.replace(/^\d+-/, "") === name);

/** The lesson that is read, or would be: the one chosen last, else that of the scene.
 * @param {import("./store.js").Data} data */
export const lessonOf = ({ view, lessons, scene }) =>
  view.lesson || (lessons.find(({ scenes }) => scenes.includes(scene?.id)) ?? lessons[0])?.id || "";

/**
 * Opens the lesson that a link names.
 * @param {import("./store.js").Data} data @param {string} name "": the one chosen last
 * @returns {string[]} a sentence where there is no such lesson
 */
export function showLesson({ view, lessons }, name) {
  const lesson = lessonNamed(lessons, name);
  if (name && !lesson) {
    const known = lessons.length ? `; there are 1 to ${lessons.length}` : "";
    return [`no lesson is called '${name}'${known}`];
  }
  view.lesson = lesson?.id ?? view.lesson;
  return [];
}

/**
 * Puts what a link says of the view into the data, once its scene is there.
 * @param {import("./store.js").Data} data
 * @param {import("./link.js").Linked} link
 * @returns {string[]} a sentence for what this scene does not have
 */
export function showLinked(data, link) {
  const { view, scene } = data;
  const faults = [];
  Object.assign(view, Object.fromEntries(SWITCHES.map((name) => [name, link.show.includes(name)])));
  const spatial = Boolean(scene.view?.spatial);
  const [azimuth, elevation] = link.look;
  view.look =
    link.look.length && spatial ? lookFrom(azimuth, elevation, scene.view?.vertical) : null;
  view.space = spatial ? spaceOf(link) : null;
  const first = firstPlots();
  view.plots = {
    upper: link.upper.length ? plotOf(link.upper) : first.upper,
    lower: link.lower.length ? plotOf(link.lower) : first.lower,
  };
  view.zoom = link.zoom.length ? [link.zoom[0], link.zoom[1]] : null;
  view.why = link.why < data.methods.length ? link.why : -1;
  view.study = link.study;
  view.map = link.map;
  view.judged = hasCoordinate(scene, link.judged) ? link.judged : "";
  if (link.judged && !view.judged) {
    faults.push(`no coordinate is called '${link.judged}'`);
  }
  view.budget = link.budget;
  view.split = { scene: scene.id, time: link.until, step: link.step };
  view.panel = link.panel;
  faults.push(...showLesson(data, link.lesson));
  return faults;
}
