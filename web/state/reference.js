// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The reference solution of the scene shown: asked for once per scene, parameters and clock. One is
// stored for every scene with its own parameters; for others it is computed when somebody asks for
// that.
import { api, sentenceOf } from "../api/client.js";
import { isStart } from "./start.js";
import { sourceOf } from "./store.js";

const MOST_SAMPLES = 1200;
const MOST_NUMBERS = 300000; // the server's bound is a little above
const PAUSE = 150; // [ms] after the last change, before it is asked for

/**
 * `own`: error of the reference itself [m]; `energyScale`: swing of the energies [J]; `points[k]`
 * and `energy[k]` belong to frame k * stride of the clock.
 * @typedef {{
 *   state: "asked" | "none" | "failed" | "ready", key: string, reason: string, time: number,
 *   digits: number, own: number, energyScale: number, means: string[], stride: number,
 *   points: Float64Array[], energy: number[],
 * }} Reference
 */

/**
 * @param {string} key
 * @param {Reference["state"]} state
 * @param {string} reason
 * @returns {Reference}
 */
const without = (key, state, reason) => ({
  state,
  key,
  reason,
  time: 0,
  digits: 0,
  own: 0,
  energyScale: 0,
  means: [],
  stride: 1,
  points: [],
  energy: [],
});

/**
 * The parameters that are not as the scene has them.
 * @param {any} data
 * @returns {Record<string, number>}
 */
function changedSettings({ scene, settings }) {
  const initial = new Map(scene.parameters.map((one) => [one.name, one.initial]));
  return Object.fromEntries(
    Object.entries(settings).filter(([name, value]) => initial.get(name) !== value),
  );
}

/** Frames of the clock from sample to sample. @param {any} data */
function strideOf({ scene, duration, frameDt }) {
  const perSample = 3 * scene.drawing.points + scene.coordinates.length + 1;
  const samples = Math.min(MOST_SAMPLES, MOST_NUMBERS / perSample);
  return Math.max(1, Math.ceil(Math.max(duration, scene.duration) / frameDt / samples));
}

/** @param {import("./store.js").Store} store */
export function createReferenceFeed(store) {
  const data = store.data;
  let timer = 0;

  const keyOf = () =>
    data.scene
      ? JSON.stringify([
          sourceOf(data),
          changedSettings(data),
          data.frameDt,
          strideOf(data),
          data.pulled,
        ])
      : "";

  /** @param {Reference} reference */
  function tell(reference) {
    data.reference = reference;
    store.emit("reference");
  }

  /** @param {any} answer @param {string} key @param {number} stride @returns {Reference} */
  const read = ({ motion, scales, time, digits, means }, key, stride) => ({
    state: "ready",
    key,
    reason: "",
    time,
    digits,
    own: motion.between * scales.length,
    energyScale: scales.energy,
    means,
    stride,
    points: motion.points.map((row) => Float64Array.from(row)),
    energy: motion.energy,
  });

  /** @param {boolean} compute */
  async function ask(compute) {
    const key = keyOf();
    const stride = strideOf(data);
    tell(without(key, "asked", "asking for the reference solution"));
    try {
      const every = stride * data.frameDt;
      const answer = await api.reference(data.scene.id, changedSettings(data), every, compute);
      if (key === keyOf()) {
        tell(read(answer, key, stride));
      }
    } catch (error) {
      if (key === keyOf()) {
        tell(without(key, "failed", sentenceOf(error)));
      }
    }
  }

  function look() {
    timer = 0;
    const key = keyOf();
    if (!key || key === data.reference?.key) {
      return;
    }
    const changed = Object.keys(changedSettings(data));
    if (data.pulled) {
      tell(without(key, "none", "it is known only for the motion that nobody pulls"));
    } else if (data.document) {
      tell(without(key, "none", "only shipped scenes have one"));
    } else if (changed.length > 0 && changed.every(isStart)) {
      ask(true); // the mechanism is the one that the scene's own reference solution was made for
    } else if (changed.length > 0) {
      tell(without(key, "none", "none is stored for these parameters"));
    } else {
      ask(false);
    }
  }

  const lookSoon = () => {
    if (keyOf() !== data.reference?.key) {
      data.reference = null;
      store.emit("reference");
    }
    clearTimeout(timer);
    timer = window.setTimeout(look, PAUSE);
  };
  const stops = ["scene", "hand"].map((name) => store.on(name, lookSoon));
  return {
    compute: () => ask(true),
    dispose() {
      stops.forEach((stop) => stop());
      clearTimeout(timer);
    },
  };
}

/**
 * The drawn points at a frame, between samples on a straight line; null past its end.
 * @param {Reference | null} reference @param {number} frame @returns {ArrayLike<number> | null} */
export function referenceAt(reference, frame) {
  if (reference?.state !== "ready" || frame < 0) {
    return null;
  }
  const at = frame / reference.stride;
  const low = Math.floor(at);
  const [a, b] = [reference.points[low], reference.points[low + 1]];
  if (!a || at === low) {
    return a ?? null;
  }
  return b ? a.map((x, i) => x + (at - low) * (b[i] - x)) : null;
}

const MOST_POSES = 100;

/**
 * The drawn points at some times of the reference solution, for whoever asks how far the motion
 * goes; none until it is here.
 * @param {Reference | null} reference @returns {Float64Array[]}
 */
export function posesOf(reference) {
  const all = reference?.state === "ready" ? reference.points : [];
  return all.filter((_, i) => i % Math.ceil(all.length / MOST_POSES) === 0);
}

/**
 * Distance of the drawn point that is farthest from the reference [m], never less than the
 * reference's own error; NaN where it is not known.
 * @param {Reference | null} reference @param {number} frame @param {ArrayLike<number>} points */
export function offReference(reference, frame, points) {
  const known =
    reference?.state === "ready" && frame % reference.stride === 0
      ? reference.points[frame / reference.stride]
      : null;
  if (!reference || !known) {
    return NaN;
  }
  let worst = 0;
  for (let i = 0; i < known.length; i += 3) {
    const off = Math.hypot(
      points[i] - known[i],
      points[i + 1] - known[i + 1],
      points[i + 2] - known[i + 2],
    );
    worst = off > worst || Number.isNaN(off) ? off : worst;
  }
  return Math.max(worst, reference.own);
}

/**
 * Columns over a history that only ever grow: what was worked out is kept until the run, or the
 * reference, is another.
 * @param {(m: number, i: number) => number} valueAt
 */
export function createGrowing(valueAt) {
  /** @type {{of: any[], columns: Float64Array[], done: number}} */
  let kept = { of: [], columns: [], done: 0 };
  /** @param {import("./history.js").History} history @param {any} reference */
  return (history, reference) => {
    const of = [history, reference, history.stride];
    if (of.some((one, k) => one !== kept.of[k]) || kept.done > history.count) {
      const columns = Array.from({ length: history.nMethods }, () =>
        new Float64Array(history.t.length).fill(NaN),
      );
      kept = { of, columns, done: 0 };
    }
    for (; kept.done < history.count; kept.done++) {
      kept.columns.forEach((column, m) => {
        column[kept.done] = valueAt(m, kept.done);
      });
    }
    return kept.columns;
  };
}
