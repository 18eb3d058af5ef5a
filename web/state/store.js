// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Data and named events. Views read `store.data` and listen; only the actions of session/ write.

import { firstPlots } from "./shown.js";

/**
 * @typedef {import("./types.js").Parameter} Parameter
 * @typedef {import("./types.js").Shape} Shape
 * @typedef {import("./types.js").Drawing} Drawing
 * @typedef {import("./types.js").Scene} Scene
 * @typedef {import("./types.js").Method} Method
 * @typedef {import("./types.js").MethodFrame} MethodFrame
 * @typedef {import("./types.js").Frame} Frame
 * @typedef {import("./types.js").Refused} Refused
 * @typedef {import("./types.js").Lesson} Lesson
 * @typedef {import("./types.js").Incident} Incident
 * @typedef {import("./history.js").History} History
 */

/** Names of the events. An event with another name throws, so a misspelt one fails at once. */
export const EVENTS = [
  "ready", // look, catalogue and scenes are here
  "scene", // another scene, or another parameter of it
  "methods", // the list of methods changed; also when a run starts anew
  "frame", // a new frame, or another one is shown
  "view", // what is shown of it: selection, hidden methods, labels, traces
  "incident",
  "state", // running, paused, finished, speed
  "stream",
  "reactions", // the forces in the joints, as last asked for
  "reference", // the reference solution of the scene, or why there is none
  "study", // a study goes on or has ended; the detail is its kind
  "notice", // a sentence for the status line
  "hand", // a hand took hold of a point, moved, or let go
  "drag", // the mechanism is dragged, or was let go
  "undo", // how much can be undone and redone
  "file", // something is to be saved: {name, type, text}
  "offer", // the last session can be continued, or no longer
  "note", // the notes were replaced: by a link, or by another session
  "light", // bodies, cut joints and curves that are pointed at; the detail names them
  "theme",
];

/** Returns what is shown, and how. */
function initialView() {
  return {
    selected: 0,
    /** @type {Set<number>} */ hidden: new Set(),
    /** index into the history, or -1: the latest */ shown: -1,
    labels: true,
    traces: false,
    /** handles that change lengths are drawn */ lengths: false,
    /** the reference solution is drawn */ reference: true,
    /** the table of forces is open */ reactions: false,
    /** forces are drawn */ arrows: false,
    /** direction of view; null: the best one for the scene */
    look: /** @type {{right: number[], up: number[]} | null} */ (null),
    /** the study that is open, or "" */ study: "",
    /** axes of the stability map; "": the ones that fit the methods */ map: "",
    /** the coordinate whose error the budget splits; "": of each method the largest */ judged: "",
    /** end [s] and step [s] of the motion whose error is split, of this scene; 0: its own
     * @type {{scene: string, time: number, step: number}} */
    split: { scene: "", time: 0, step: 0 },
    /** what the budget shows, of BUDGETS; "": the first of them */ budget: "",
    letters: true,
    stepped: false,
    /** the recording plays */ replaying: false,
    /** the time that it shows while it plays [s] */ moment: 0,
    /** the recording plays again and again */ loop: false,
    /** the method whose card is open, or -1 */ why: -1,
    /** the drawer of parameters is open */ parameters: false,
    /** the equations are open */ equations: false,
    /** what lies beside the page: "lessons", "editor" or "" */ panel: "",
    /** the lesson that is open or was last, or "" */ lesson: "",
    /** the gallery is open */ gallery: false,
    /** what each plot shows @type {Record<string, import("./shown.js").Plot>} */
    plots: firstPlots(),
    /** the part of the time that the plots show [s], or all of it
     * @type {[number, number] | null} */
    zoom: null,
    /** how space is seen, besides the direction; null: all of the motion
     * @type {import("./shown.js").SpaceView | null} */
    space: null,
  };
}

function initialData() {
  return {
    build: "",
    /** @type {any} */ look: null,
    /** `provided`: what programs of one's own provide, by name, as far as it is known
     * @type {{formulations: any[], integrators: any[], programs?: string[],
     *   provided?: Record<string, string>}} */
    catalogue: { formulations: [], integrators: [] },
    /** @type {{id: string, title: string, duration: number}[]} */ scenes: [],
    /** @type {Lesson[]} */ lessons: [],
    id: "",
    generation: -1,
    /** counts the starts: no two runs, of whatever comparison, have the same number */ run: 0,
    /** the scene itself, where it is none of the shipped ones; null: it has an id
     * @type {object | null} */
    document: null,
    /** null until the first comparison is there */
    scene: /** @type {Scene} */ (/** @type {any} */ (null)),
    /** @type {Method[]} */ methods: [],
    /** @type {Refused[]} */ refused: [],
    /** @type {Record<string, number>} */ settings: {},
    frameDt: 0,
    duration: 0,
    state: "paused",
    speed: 1,
    /** @type {Frame | null} */ latest: null,
    /** null until the first comparison is there */
    history: /** @type {History} */ (/** @type {any} */ (null)),
    /** the run before the last change @type {{methods: Method[], history: History} | null} */
    before: null,
    /** a recording that others are compared with
     * @type {{scene: string, methods: Method[], history: History} | null} */
    kept: null,
    /** @type {Incident[]} */ incidents: [],
    /** null until they are asked for @type {import("./reactions.js").Reactions | null} */
    reactions: null,
    /** null until it is asked for @type {import("./reference.js").Reference | null} */
    reference: null,
    /** by kind, as the server's index names them
     * @type {Record<string, import("./studies.js").Study>} */
    studies: {},
    stream: { state: "connecting", id: "" },
    /** while the mechanism is dragged @type {import("../session/drag.js").Drag | null} */
    drag: null,
    /** while a hand pulls a point @type {import("./types.js").Hand | null} */ hand: null,
    /** a hand pulls somewhere in this run */ pulled: false,
    /** what hands did in this comparison: [frame, point, x, y, z, stiffness, damping]
     * @type {number[][]} */
    pulls: [],
    /** the end that was asked for in place of the scene's [s]; 0: the scene's */
    askedEnd: 0,
    /** how many changes can be undone and redone, and which comes first, in words */
    undo: { past: 0, future: 0, undoes: "", redoes: "" },
    notice: "",
    /** what was written beside the comparison; it travels with the link */ note: "",
    /** the link to what was shown last in this browser, while it is offered */ offer: "",
    /** @type {"light" | "dark"} */ theme: "light",
    view: initialView(),
  };
}

/** @typedef {ReturnType<typeof createStore>} Store */
/** @typedef {ReturnType<typeof initialData>} Data */

export function createStore() {
  /** @type {Map<string, Set<(detail?: any) => void>>} */
  const listeners = new Map(EVENTS.map((name) => [name, new Set()]));

  /** @param {string} name */
  function listenersOf(name) {
    const set = listeners.get(name);
    if (!set) {
      throw new Error(`no event is called ${name}`);
    }
    return set;
  }

  return {
    data: initialData(),
    /**
     * @param {string} name
     * @param {(detail?: any) => void} listener
     * @returns {() => void} removes the listener
     */
    on(name, listener) {
      listenersOf(name).add(listener);
      return () => listenersOf(name).delete(listener);
    },
    /** @param {string} name @param {any} [detail] */
    emit(name, detail) {
      for (const listener of listenersOf(name)) {
        listener(detail);
      }
    },
  };
}

/** Returns what requests call the scene by: its id, or the whole of it. @param {Data} data */
export const sourceOf = (data) => data.document ?? data.scene?.id ?? "";

/** Returns what makes the present runs again, but for their speed. @param {Data} data */
export const madeOf = (data) => ({
  scene: sourceOf(data),
  settings: data.settings,
  methods: data.methods.map(({ spelling }) => spelling),
  pulls: data.pulls,
  end: data.askedEnd,
});

/**
 * Index of the frame that is shown; -1 when there is none.
 * @param {Data} data
 */
export function shownIndex({ history, view }) {
  const last = (history?.count ?? 0) - 1;
  return view.shown < 0 ? last : Math.min(view.shown, last);
}

/**
 * Listens to several events.
 * @param {Store} store
 * @param {Record<string, (detail?: any) => void>} table
 * @returns {() => void} removes all the listeners
 */
export function listen(store, table) {
  const off = Object.entries(table).map(([name, listener]) => store.on(name, listener));
  return () => off.forEach((remove) => remove());
}
