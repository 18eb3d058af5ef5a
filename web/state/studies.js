// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Studies of what is on the page: what accuracy costs, where steps are stable, where the error
// comes from. A study is asked for, looked at while it lasts, and read when it is done; its
// document is that of the command line.
import { Problem, addressOf, api, sentenceOf } from "../api/client.js";
import { mostMethods, presets, variedBy } from "./catalogue.js";
import { budgetOf } from "./shown.js";
import { formatSpelling, parseSpelling, settingOf, withSetting } from "./spelling.js";

/** @typedef {{formulations: any[], integrators: any[]}} Catalogue */

const LOOK_EVERY = 400; // [ms]
const MAP_SIDE = { columns: 16, rows: 14 };
/** Axes of the map over Baumgarte's constants, times the step. */
const LOWEST = 0.05;
const HIGHEST = 5;
const SAMPLES = 4; // of time per point: what is needed to rank
const LEVELS = 6;

/**
 * @typedef {{state: "none" | "running" | "finished" | "stopped" | "failed", progress: number,
 *   elapsed: number, left: number | null, id: string,
 *   reason: string, document: any, asked: string, report: string}} Study id: "" until the server has
 *   it, and when it has forgotten it
 */

/** @returns {Study} */
export const noStudy = () => ({
  state: "none",
  progress: 0,
  elapsed: 0,
  left: null,
  id: "",
  reason: "",
  document: null,
  asked: "",
  report: "",
});

/** Has the method every option that a map varies? */
const hasOptions = (catalogue, spelling, { chooses, stabilised }) =>
  !stabilised || chooses.every((key) => settingOf(catalogue, spelling, key));

/**
 * The maps that the methods and the scene have.
 * @param {{
 *   catalogue: Catalogue, methods: {spelling: string}[], scene?: {parameters?: {unit: string}[]},
 * }} data
 */
export function presetsOf({ catalogue, methods, scene }) {
  const has = ({ units }) =>
    units.length === 0 || (scene?.parameters ?? []).some(({ unit }) => units.includes(unit));
  return presets().filter(
    (preset) =>
      has(preset) && methods.some(({ spelling }) => hasOptions(catalogue, spelling, preset)),
  );
}

/**
 * Axes of a map that hold the present values of its options as well; "" where the server's own do.
 * @param {Catalogue} catalogue
 * @param {string} spelling
 * @param {string[]} keys two options, with the unit 1/s
 */
function widerAxes(catalogue, spelling, keys) {
  const valueOf = (key) => Number(settingOf(catalogue, spelling, key)?.value);
  const h = valueOf("h");
  const values = keys.map(valueOf);
  const [low, high] = [LOWEST / h, HIGHEST / h];
  if (!(h > 0) || values.some((value) => !(value > 0)) || keys.length !== 2) {
    return "";
  }
  const from = Math.min(low, ...values.map((value) => value / 2));
  const to = Math.max(high, ...values.map((value) => 2 * value));
  const round = (value) => Number(value.toPrecision(3));
  return from < low || to > high
    ? keys.map((key) => `${key}=${round(from)}..${round(to)}`).join(",")
    : "";
}

/**
 * Returns what the server is asked.
 * @param {string} kind
 * @param {{
 *   scene: {id: string}, document?: object | null,
 *   settings: Record<string, number>, methods: {spelling: string}[],
 *   catalogue: Catalogue,
 * }} data
 * @param {string} preset of a map; "": the server chooses the most telling one
 * @param {{coordinate: string, time: number, step: number}} [split] whose error a budget splits,
 *   until when [s], and at which step [s]; "" and 0: the study chooses, or they are the methods' own
 */
export function orderOf(
  kind,
  { scene, document, settings, methods, catalogue },
  preset,
  { coordinate, time, step } = { coordinate: "", time: 0, step: 0 },
) {
  const all = methods.map(({ spelling }) => spelling);
  const common = { scene: document ?? scene.id, parameters: settings, kind };
  if (kind === "stability" && !preset) {
    return { ...common, methods: all.slice(0, mostMethods(kind)) };
  }
  if (kind === "stability") {
    const chosen = presets().find(({ name }) => name === preset);
    const fitting = chosen
      ? all.filter((spelling) => hasOptions(catalogue, spelling, chosen))
      : all; // of a name that the server does not know it says so
    const over = chosen?.stabilised ? widerAxes(catalogue, fitting[0] ?? "", chosen.chooses) : "";
    const axes = over ? { over } : { preset };
    return { ...common, methods: fitting.slice(0, mostMethods(kind)), ...axes, ...MAP_SIDE };
  }
  if (kind === "budget") {
    const stepped = (spelling) =>
      step > 0 && settingOf(catalogue, spelling, "h")
        ? withSetting(catalogue, spelling, "h", String(step))
        : spelling;
    return {
      ...common,
      methods: all.map(stepped),
      ...(coordinate ? { coordinate } : {}),
      ...(time > 0 ? { time } : {}),
    };
  }
  return kind === "work-precision"
    ? { ...common, methods: all, samples: SAMPLES, levels: LEVELS }
    : { ...common, methods: all };
}

/**
 * Returns what tells studies apart: the request without what the study chooses itself.
 * @param {{kind: string, methods: string[], preset?: string, over?: string}} order
 */
export function signatureOf(order) {
  const over = (order.over ?? "").split(",").map((axis) => axis.split("=")[0]);
  const chosen = order.over ? over : variedBy(order.kind, order.preset ?? "");
  const bare = ({ name, settings }) => ({
    name,
    settings: settings.filter(([key]) => !chosen.includes(key)),
  });
  const methods = order.methods.map((spelling) => {
    const { formulation, integrator } = parseSpelling(spelling);
    return formatSpelling({ formulation: bare(formulation), integrator: bare(integrator) });
  });
  return JSON.stringify({ ...order, methods });
}

/** @param {import("./store.js").Store} store */
export function createStudyFeed(store) {
  const { data } = store;
  /** @type {Map<string, {id: string, timer: number}>} by kind, while they run */
  const running = new Map();

  /** @param {string} kind @param {Partial<Study>} change */
  function put(kind, change) {
    Object.assign(data.studies[kind], change);
    store.emit("study", kind);
  }

  /** @param {string} kind @param {any} answer */
  function take(kind, answer) {
    const runs = answer.state === "running";
    put(kind, {
      state: answer.state,
      progress: answer.progress,
      elapsed: answer.elapsed_s,
      left: answer.time_left_s,
      reason: answer.hint ? `${answer.reason} (${answer.hint})` : answer.reason,
      // while what was left is computed, what was done stays as it is
      document: (runs && data.studies[kind].document) || answer.document,
      id: answer.id,
      report: addressOf(answer.links.report ?? ""),
    });
  }

  /** @param {string} kind @param {unknown} error */
  function fail(kind, error) {
    running.delete(kind);
    put(kind, { state: "failed", reason: sentenceOf(error), left: null });
  }

  /** @param {string} kind @param {string} id */
  async function look(kind, id) {
    try {
      const answer = await api.study(id);
      if (running.get(kind)?.id !== id) {
        return; // another one was asked for meanwhile
      }
      take(kind, answer);
      if (answer.state === "running") {
        lookLater(kind, id);
      } else {
        running.delete(kind);
      }
    } catch (error) {
      if (running.get(kind)?.id === id) {
        fail(kind, error);
      }
    }
  }

  function lookLater(kind, id) {
    running.set(kind, { id, timer: window.setTimeout(() => look(kind, id), LOOK_EVERY) });
  }

  /** Nobody waits for it any more. */
  function forget(kind) {
    const now = running.get(kind);
    running.delete(kind);
    if (now) {
      clearTimeout(now.timer);
      api.abandonStudy(now.id);
    }
  }

  /** The map that is asked for, where this scene has it; else "": the server chooses one. */
  function preset() {
    const names = presetsOf(data).map(({ name }) => name);
    return names.includes(data.view.map) ? data.view.map : "";
  }
  /** The coordinate whose error is split; "": each method's worst. */
  const judged = () => budgetOf(data.view, data.scene).judged;
  /** End and step of the motion whose error is split; 0: its own. */
  const split = () => {
    const { until: time, step } = budgetOf(data.view, data.scene);
    return { time, step };
  };
  const order = (kind) => orderOf(kind, data, preset(), { coordinate: judged(), ...split() });

  /** @param {unknown} error */
  const orBusy = (error) =>
    error instanceof Problem && error.status === 503
      ? new Error("the server is at other studies: try again in a few seconds")
      : error;

  return {
    preset,
    judged,
    split,
    /** Does the document tell of what is on the page now? @param {string} kind */
    isPresent: (kind) => data.studies[kind].asked === signatureOf(order(kind)),
    /** @param {string} kind @param {string} [over] other axes of a map than those asked for */
    async start(kind, over = "") {
      const { preset: _, ...axes } = /** @type {any} */ (order(kind));
      const body = over ? { ...axes, over } : order(kind);
      forget(kind);
      const asked = signatureOf(order(kind));
      put(kind, { ...noStudy(), state: "running", asked });
      try {
        const answer = await api.createStudy(body);
        if (data.studies[kind].asked === asked && !running.has(kind)) {
          take(kind, answer);
          lookLater(kind, answer.id);
        } else {
          api.abandonStudy(answer.id);
        }
      } catch (error) {
        fail(kind, orBusy(error));
      }
    },
    /** Can what is left of it be computed? @param {string} kind */
    canGoOn: (kind) => data.studies[kind].state === "stopped" && data.studies[kind].id !== "",
    /**
     * Computes what a study that was stopped, or whose time was over, has left; what is done stays.
     * @param {string} kind
     */
    async goOn(kind) {
      const { id } = data.studies[kind];
      try {
        const answer = await api.resumeStudy(id);
        if (data.studies[kind].id === id && !running.has(kind)) {
          take(kind, answer);
          lookLater(kind, id);
        }
      } catch (error) {
        const gone = error instanceof Problem && error.status === 404;
        const reason = gone
          ? "the server no longer has this study: run it again"
          : sentenceOf(orBusy(error));
        put(kind, { reason, ...(gone ? { id: "" } : {}) });
      }
    },
    /** Stops a study; its results stay. @param {string} kind */
    stop: (kind) => {
      const now = running.get(kind);
      return now ? api.stopStudy(now.id).catch((error) => fail(kind, error)) : Promise.resolve();
    },
    dispose: () => [...running.keys()].forEach(forget),
  };
}
