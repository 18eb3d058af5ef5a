// @ts-check
// Data and named events. Views read `store.data`, listen, and never write; actions of state/session.js write.
import { KINDS, noStudy } from "./studies.js";

/**
 * @typedef {{name: string, unit: string, about: string, value: number, initial: number, min: number, max: number, integer: boolean}} Parameter
 * @typedef {{kind: string, p: number, q: number, n: number, width: number, body: number}} Shape
 * @typedef {{points: number, labels: (string | null)[], shapes: Shape[], tears: {p: number, q: number, name: string}[]}} Drawing
 * @typedef {{id: string, title: string, about: string, look_for: string, caption: string, parameters: Parameter[], n: number, m: number,
 *   rank: number, freedoms: number, length: number, drawing: Drawing, coordinates: {name: string, rate: string}[], points: number[], ground_points: number[], envelope: number[], extremes?: number[],
 *   view: {spatial: boolean, vertical: "y" | "z", right: number[], up: number[]}, methods: string[],
 *   duration: number, step: number}} Scene
 * @typedef {{slot: number, short: string, label: string, rule: string, drift: string, model_error: boolean, keeps_gap: boolean, order: number,
 *   spelling: string, formulation: string, integrator: string, title: string}} Method
 * @typedef {{state: string, status: string, reason: string, t: number, points?: number[], q?: number[], v?: number[], gap?: number, velocity_gap?: number,
 *   energy_change?: number, steps: number, rejected: number, evals: number, ops: number, cpu: number, worst_gap: number,
 *   worst_velocity_gap: number, worst_energy_change: number}} MethodFrame
 * @typedef {{generation: number, frame: number, t: number, finished: boolean, methods: MethodFrame[]}} Frame
 * @typedef {{spelling: string, reason: string}} Refused a method that the scene cannot serve
 * @typedef {{id: string, title: string, scenes: string[]}} Lesson
 * @typedef {{method: number, code: string, t: number, quantity: string, value: number, limit: number, message: string, remedies: string[]}} Incident
 */

/** Names of the events, told so that a misspelt one fails at once. */
export const EVENTS = [
  "ready", // look, catalogue and scenes are here
  "scene", // another scene, or another parameter of it
  "methods", // the list of methods changed; also when a run starts anew
  "frame", // a new frame, or another one is shown
  "view", // what is shown of it: selection, hidden methods, labels, traces
  "incident",
  "state", // running, paused, finished, speed
  "stream",
  "reactions", // what the joints carry, as last asked for
  "reference", // the reference solution of the scene, or why there is none
  "study", // a study goes on or has ended; the detail is its kind
  "notice", // a sentence for the status line
  "theme",
];

function initialData() {
  return {
    build: "",
    /** @type {any} */ look: null,
    /** @type {{formulations: any[], integrators: any[]}} */ catalogue: {
      formulations: [],
      integrators: [],
    },
    /** @type {{id: string, title: string, duration: number}[]} */ scenes: [],
    /** @type {Lesson[]} */ lessons: [],
    id: "",
    generation: -1,
    /** counts the starts: no two runs, of whatever comparison, have the same */ run: 0,
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
    history: /** @type {import("./history.js").History} */ (/** @type {any} */ (null)), // likewise
    /** The run before the last change, for "before and after". @type {{methods: Method[], history: import("./history.js").History} | null} */
    before: null,
    /** @type {Incident[]} */ incidents: [],
    /** Forces in the joints of a method at a time; `point`: the drawn point at the joint, or -1; null until they are asked for.
     * @type {{method: number, t: number, list: (import("./reactions.js").Reaction & {point: number})[], mark: string, reason: string} | null} */
    reactions: null,
    /** null until it is asked for @type {import("./reference.js").Reference | null} */ reference: null,
    /** by kind @type {Record<string, import("./studies.js").Study>} */
    studies: Object.fromEntries(KINDS.map((kind) => [kind, noStudy()])),
    stream: { state: "connecting", id: "" },
    notice: "",
    /** @type {"light" | "dark"} */ theme: "light",
    view: {
      selected: 0,
      /** @type {Set<number>} */ hidden: new Set(),
      /** index into the history, or -1: the latest */ shown: -1,
      labels: true,
      traces: false,
      /** the reference solution is drawn */ reference: true,
      /** the table of forces is open */ reactions: false,
      /** forces are drawn */ arrows: false,
      /** where one looks from; null: as the scene is best seen @type {{right: number[], up: number[]} | null} */ look: null,
      /** the study that is open, or "" */ study: "",
      /** what the map of stability is over; "": as the methods suggest */ map: "",
      letters: true,
      stepped: false,
      /** the method whose card is open, or -1 */ why: -1,
    },
  };
}

/** @typedef {ReturnType<typeof createStore>} Store */

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
    /** @param {string} name @param {(detail?: any) => void} listener @returns {() => void} removes the listener */
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

/** Listens to several events; returns what removes all of it. @param {Store} store @param {Record<string, (detail?: any) => void>} table */
export function listen(store, table) {
  const off = Object.entries(table).map(([name, listener]) => store.on(name, listener));
  return () => off.forEach((remove) => remove());
}
