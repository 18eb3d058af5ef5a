// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// What is happening, in words: the state of a method, sentences, and the card that says why.
import { ROUNDING, quantity, seconds, withPowers } from "./format.js";
import { cardOf, parseSpelling, settingOf } from "./spelling.js";

/**
 * A gap that more than doubles from the first half of the motion to the second grows: t to t^2 do,
 * an oscillation does not.
 */
const GROWTH = 1.5;
const EARLIEST = 6; // [frames] before it there is nothing to tell

/**
 * @typedef {{word: string, arrow: string, tone: "calm" | "warn" | "bad"}} Trend
 * @param {import("./history.js").History} history
 * @param {number} m
 * @param {number} shown index of the frame shown
 * @returns {Trend}
 */
export function trendOf(history, m, shown) {
  const t = history.t[shown];
  if (history.ended[m] <= t) {
    return { word: `stopped at ${seconds(history.ended[m])}`, arrow: "■", tone: "bad" };
  }
  const half = history.indexAt(t / 2);
  const late = history.worst(m, "gap", half, shown);
  if (!(late > ROUNDING)) {
    return { word: "closed", arrow: "→", tone: "calm" };
  }
  if (shown < EARLIEST) {
    return { word: "just started", arrow: "→", tone: "calm" };
  }
  const early = history.worst(m, "gap", 0, half);
  if (late > GROWTH * early) {
    return { word: "growing", arrow: "↗", tone: "warn" };
  }
  return late < early / GROWTH
    ? { word: "shrinking", arrow: "↘", tone: "calm" }
    : { word: "held", arrow: "→", tone: "calm" };
}

/**
 * At most three sentences about the frame shown, the most telling first.
 * @param {import("./store.js").Store["data"]} data
 * @param {number} shown
 */
export function sentences(data, shown) {
  const { history, methods, view } = data;
  if (!history || shown < 0) {
    return [];
  }
  const loops = (data.scene?.m ?? 0) > 0;
  const rows = methods
    .map((method, m) => ({
      method,
      m,
      trend: trendOf(history, m, shown),
      gap: history.columns[m].gap[shown],
    }))
    .filter(({ m }) => !view.hidden.has(m));
  const out = rows
    .filter(({ trend }) => trend.tone === "bad")
    .map(({ method, trend }) => `${method.label}: ${trend.word}`);
  if (!loops) {
    return out.concat("this mechanism has no loop to close; watch the energy").slice(0, 3);
  }
  rows
    .filter(({ trend }) => trend.tone !== "bad" && trend.word !== "closed")
    .sort((a, b) => b.gap - a.gap)
    .forEach(({ method, trend, gap }) =>
      out.push(`${method.label}: gap ${quantity(gap, "m")} and ${trend.word}`),
    );
  const closed = rows
    .filter(({ trend }) => trend.word === "closed")
    .map(({ method }) => method.label);
  if (closed.length) {
    out.splice(2, Infinity, `closed to rounding: ${closed.join(", ")}`);
  }
  return out.slice(0, 3);
}

const SAID_AFTER = 0.5; // [s] that a pose which was passed is still told: some come quickly
const PASSED = ["near-singular", "rank-loss"];

/** @param {import("./store.js").Store["data"]} data @param {number} now [s] */
function passedAt({ incidents, view, duration }, now) {
  const last = incidents
    .filter(
      ({ code, method, t }) =>
        PASSED.includes(code) && t > 0 && t <= now && !view.hidden.has(method),
    )
    .reduce((latest, { t }) => Math.max(latest, t), -Infinity);
  return now - last < SAID_AFTER ? `a singular pose was passed at ${seconds(last, duration)}` : "";
}

/**
 * What the engine sees coming at the time shown: "J loses rank in 0.31 s (index-1, projection)", ""
 * when nothing is.
 * @param {import("./store.js").Store["data"]} data
 * @param {number} shown
 */
export function predictionAt(data, shown) {
  const { history, incidents, methods, view } = data;
  if (!history || shown < 0) {
    return "";
  }
  const now = history.t[shown];
  /** @type {Map<number, number>} time of the pose by method, as told last */
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
    return passedAt(data, now);
  }
  const drawn = methods.filter((_, m) => !view.hidden.has(m)).length;
  const names = coming.map(([m]) => methods[m].label).join(", ");
  const whose = coming.length < drawn ? ` (${names})` : "";
  return `J loses rank in ${(coming[0][1] - now).toFixed(2)} s${whose}`;
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
  const t = Math.min(history.t[shown], before.history.t[before.history.count - 1]);
  const then = before.history.indexAt(t);
  const now = history.indexAt(t);
  return methods.flatMap((method, m) => {
    const old = before.methods.findIndex((other) => other.formulation === method.formulation);
    if (old < 0 || before.methods[old].spelling === method.spelling) {
      return [];
    }
    const pair = (name) => [
      before.history.worst(old, name, 0, then),
      history.worst(m, name, 0, now),
    ];
    const [gap0, gap1] = pair("gap");
    const [energy0, energy1] = pair("energy_change");
    const energy = `energy change ${quantity(energy0, "J")} before, ${quantity(energy1, "J")} now`;
    const gap = `worst gap ${quantity(gap0, "m")} before, ${quantity(gap1, "m")} now`;
    const closed = gap1 < ROUNDING && gap0 < ROUNDING;
    return [
      `${method.label} until ${seconds(t, data.duration)}: ${closed ? `worst ${energy}` : `${gap}; ${energy}`}`,
    ];
  });
}

/**
 * Things to try per formulation. `set` names a control and its value as a share of the present one
 * (`times`) or outright (`to`);
 * `method` is a spelling in which {integrator} stands for the present one.
 */
const TRIES = {
  index1: [
    { say: "Baumgarte with α = β = 20", method: "baumgarte:alpha=20,beta=20@{integrator}" },
    { say: "projection after every step", method: "projection@{integrator}" },
    { say: "a step of one half", key: "h", times: 0.5 },
  ],
  baumgarte: [
    { say: "α = β = 20", key: "alpha", and: "beta", to: 20 },
    { say: "projection after every step", method: "projection@{integrator}" },
    { say: "a step of one half", key: "h", times: 0.5 },
  ],
  "nullspace-as-printed": [
    { say: "the null-space form with its missing term", method: "nullspace@{integrator}" },
    { say: "a step of one half: the error stays", key: "h", times: 0.5 },
  ],
};
const TRIES_OTHERWISE = [
  { say: "a step of one half", key: "h", times: 0.5 },
  { say: "the reduced coordinates beside it", method: "reduced@{integrator}" },
];

/** @typedef {{label: string, key?: string, and?: string, value?: number, method?: string}} Try */

/** @param {import("./store.js").Store["data"]} data @param {number} m @returns {Try[]} */
function triesOf(data, m) {
  const { spelling, formulation } = data.methods[m];
  const integrator = spelling.slice(spelling.indexOf("@") + 1);
  return (TRIES[formulation] ?? TRIES_OTHERWISE).flatMap((item) => {
    if (item.method) {
      const wanted = item.method.replace("{integrator}", integrator);
      const known = cardOf(data.catalogue, "formulation", parseSpelling(wanted).formulation.name);
      return known && !data.methods.some((method) => method.spelling === wanted)
        ? [{ label: item.say, method: wanted }]
        : [];
    }
    const now = settingOf(data.catalogue, spelling, item.key);
    const value = item.to ?? (now && Number((now.value * item.times).toPrecision(6)));
    return now && value !== now.value
      ? [{ label: item.say, key: item.key, and: item.and, value }]
      : [];
  });
}

/**
 * A remedy as the engine words it: a spelling and "key=value" can be clicked, anything else is
 * read.
 * @returns {Try}
 */
export function tryOfRemedy(text) {
  const setting = /^(\w+)\s*=\s*([-+.\deE]+)$/.exec(text.trim());
  if (setting) {
    return { label: `${setting[1]} = ${setting[2]}`, key: setting[1], value: Number(setting[2]) };
  }
  return /^[\w-]+(:[^@\s]*)?@\S+$/.test(text.trim())
    ? { label: text.trim(), method: text.trim() }
    : { label: text.trim() };
}

/**
 * The card of a method: what happened on this run, the rule behind it, what to try.
 * @param {import("./store.js").Store["data"]} data
 * @param {number} m
 * @param {number} shown
 */
export function cardOfMethod(data, m, shown) {
  const method = data.methods[m];
  const history = data.history;
  const value = (name) => history.columns[m][name][shown];
  const trend = trendOf(history, m, shown);
  const reason = data.latest?.methods[m]?.reason;
  const happened =
    trend.tone === "bad"
      ? `It ${trend.word}${reason ? `: ${reason}` : ""}.`
      : `After ${seconds(history.t[shown], data.duration)} the loop gap is ${quantity(value("gap"), "m")} (${trend.word}), the energy has changed by ` +
        `${quantity(value("energy_change"), "J")}.`;
  return {
    title: `${method.title}`,
    happened,
    rule: withPowers(method.rule),
    drift: withPowers(method.drift ?? ""),
    tries: triesOf(data, m),
  };
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
    ? `, loop gap ${quantity(history.columns[view.selected].gap[shown], "m")}`
    : "";
  return (
    `${scene.title} at ${seconds(history.t[shown], data.duration)}, drawn by ${drawn.join(", ") || "no method"}; ` +
    `${method.label}${places.length ? `: ${places.join(", ")}` : ""}${gap}.`
  );
}
