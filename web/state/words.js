// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Sentences about the moment that is shown: a singular configuration ahead, before and after a
// change, the drawing.
import { ROUNDING, gapWords, quantity, seconds } from "./format.js";
import { listed, verdictAt } from "./verdict.js";

const SAID_AFTER = 0.5; // [s] that a passed configuration is still reported: some come quickly
const PASSED = ["near-singular", "rank-loss"];
const CHANGE_POINT = "change point: "; // so the engine names a place where two branches cross

/**
 * Incidents of singular configurations that were passed a moment ago.
 * @param {import("./store.js").Store["data"]} data @param {number} now [s]
 */
const justPassed = ({ incidents, view }, now) =>
  incidents.filter(
    ({ code, method, t }) =>
      PASSED.includes(code) &&
      t > 0 &&
      t <= now &&
      now - t < SAID_AFTER &&
      !view.hidden.has(method),
  );

/**
 * Returns how the runs came through the singular configuration that was passed: "two branches of
 * motion cross there; index-1 and reduced stayed on the smooth path"; "" where the engine does not
 * say.
 * @param {import("./store.js").Store["data"]} data
 * @param {import("./store.js").Incident[]} passed
 */
function passageWords(data, passed) {
  const newest = new Map(passed.map((incident) => [incident.method, incident]));
  /** @type {Map<string, string[]>} labels by what their runs did */
  const fates = new Map();
  let branches = "";
  for (const [m, { message }] of newest) {
    for (const part of message.split("; ")) {
      const fate = /^the run (.+)/.exec(part)?.[1];
      const crossing = part.replace(CHANGE_POINT, "");
      branches = /^(two branches|no motion)/.test(crossing) ? `${crossing} there` : branches;
      if (fate) {
        fates.set(fate, [...(fates.get(fate) ?? []), data.methods[m].label]);
      }
    }
  }
  const drawn = data.methods.length - data.view.hidden.size;
  const runs = [...fates].map(
    ([fate, labels]) => `${labels.length === drawn ? "all methods" : listed(labels)} ${fate}`,
  );
  return [branches, ...runs].filter(Boolean).join("; ");
}

/**
 * The singular configuration that was passed a moment ago, and how the runs came through it; "":
 * there was none.
 * @param {import("./store.js").Store["data"]} data
 * @param {number} shown
 */
export function passedAt(data, shown) {
  const passed = shown < 0 ? [] : justPassed(data, data.history.t[shown]);
  if (passed.length === 0) {
    return "";
  }
  const last = Math.max(...passed.map(({ t }) => t));
  const isChange = passed.some(({ message }) => message.includes(CHANGE_POINT));
  const what = isChange ? "change point" : "singular configuration";
  const where = `the mechanism passed a ${what} at ${seconds(last, data.duration)}`;
  return [where, passageWords(data, passed)].filter(Boolean).join(": ");
}

/**
 * Returns what the engine predicts at the time shown: "singular configuration in 0.31 s: J loses
 * rank (index-1 and projection)", or "".
 * @param {import("./store.js").Store["data"]} data
 * @param {number} shown
 */
export function predictionAt(data, shown) {
  const { history, incidents, methods, view } = data;
  if (!history || shown < 0) {
    return "";
  }
  const now = history.t[shown];
  /** @type {Map<number, number>} time of the configuration by method, as reported last */
  const ahead = new Map();
  for (const { code, method, t, value } of incidents) {
    if (code === "rank-ahead" && t <= now && !(history.ended[method] <= now)) {
      ahead.set(method, t + value);
    }
  }
  const coming = [...ahead]
    .filter(([m, at]) => at > now && !view.hidden.has(m))
    .sort(([, a], [, b]) => a - b);
  if (coming.length === 0) {
    return "";
  }
  const drawn = methods.filter((_, m) => !view.hidden.has(m)).length;
  const names = listed(coming.map(([m]) => methods[m].label));
  const whose = coming.length < drawn ? ` (${names})` : "";
  return `singular configuration in ${(coming[0][1] - now).toFixed(2)} s: J loses rank${whose}`;
}

/**
 * "until 5 s Baumgarte: worst gap 0.42 m before, 0.66 mm now; energy change 1 J before, 0.7 J now",
 * over the time both runs cover.
 * @param {import("./store.js").Store["data"]} data
 * @param {number} shown
 */
export function beforeAndAfter(data, shown) {
  const { before, history, methods } = data;
  if (!before || before.history.count < 2 || shown < 1) {
    return [];
  }
  const both = Math.min(history.t[shown], before.history.t[before.history.count - 1]);
  return methods.flatMap((method, m) => {
    const old = before.methods.findIndex((other) => other.formulation === method.formulation);
    if (old < 0 || before.methods[old].spelling === method.spelling) {
      return [];
    }
    // a run that has stopped has no worst value after it
    const ends = [history.ended[m], before.history.ended[old]].filter((end) => end < both);
    const t = Math.min(both, ...ends);
    const then = before.history.indexAt(t);
    const now = history.indexAt(t);
    const where = ends.length
      ? `${seconds(t, data.duration)}, where it stopped`
      : seconds(t, data.duration);
    const pair = (name) => [
      before.history.worst(old, name, 0, then),
      history.worst(m, name, 0, now),
    ];
    const [gap0, gap1] = pair("gap");
    const [energy0, energy1] = pair("energy_change");
    const energy = `energy change ${quantity(energy0, "J")} before, ${quantity(energy1, "J")} now`;
    const gap = `worst gap ${quantity(gap0, "m")} before, ${quantity(gap1, "m")} now`;
    const closed = gap1 < ROUNDING && gap0 < ROUNDING;
    return [`${method.label} until ${where}: ${closed ? `worst ${energy}` : `${gap}; ${energy}`}`];
  });
}

/**
 * Why a run stopped, without a second time for the same event: a step that could not be finished is
 * named by its end.
 * @param {string} reason as the engine words it
 * @param {number} end [s] of the run: its last good configuration
 * @param {number} duration [s]
 */
export function stopReason(reason, end, duration) {
  const found = /(?:^|\s)at t = ([-+.\de]+) s:?\s*/.exec(reason);
  if (!found) {
    return reason;
  }
  const [before, after] = [
    reason.slice(0, found.index),
    reason.slice(found.index + found[0].length),
  ];
  const words = [before, after].filter(Boolean).join(": ");
  const later = Number(found[1]) > end * (1 + 1e-9);
  return later ? `in the step to ${seconds(Number(found[1]), duration)}, ${words}` : words;
}

/** One sentence that stands for the drawing. */
export function describeDrawing(data, shown) {
  const { scene, methods, view, history } = data;
  if (!scene || !history || history.count === 0) {
    return "Nothing is drawn yet.";
  }
  const method = methods[view.selected];
  const drawn = methods.filter((_, m) => !view.hidden.has(m)).map(({ label }) => label);
  const points = history.pointsAt(view.selected, shown);
  const dimensions = scene.view?.spatial ? 3 : 2;
  const places = scene.drawing.labels
    .map((label, i) =>
      label
        ? `${label} at (${Array.from(points.slice(3 * i, 3 * i + dimensions), (x) => x.toFixed(2)).join(", ")}) m`
        : "",
    )
    .filter(Boolean)
    .slice(0, 8);
  const gap = scene.drawing.tears.length
    ? `; loop gap ${gapWords(history.columns[view.selected].gap[shown])}`
    : "";
  const verdict = verdictAt(data, view.selected, shown).words;
  return (
    `${scene.title} at ${seconds(history.t[shown], data.duration)}, drawn by ${drawn.join(", ") || "no method"}; ` +
    `${method.label} (${verdict})${places.length ? `: ${places.join(", ")}` : ""}${gap}.`
  );
}

/** A text with a capital letter. @param {string} text */
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** A text as a sentence: with a capital letter and a full stop. @param {string} text */
export function sentenceCase(text) {
  const upper = capital(text);
  return /[.!?]$/.test(upper) ? upper : `${upper}.`;
}
