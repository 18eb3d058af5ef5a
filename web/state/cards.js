// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The card that says why a method behaves as it does, and incidents grouped by their cause.
import { gapWords, niceBelow, quantity, scientific, seconds, withPowers } from "./format.js";
import { cardOf, parseSpelling, settingOf } from "./spelling.js";
import { deadPointAt, singularWords } from "./dead-point.js";
import { errorsOf } from "./errors.js";
import { jumpWords } from "./jump.js";
import { isProgram } from "./program-card.js";
import { listed, trendOf, verdictAt } from "./verdict.js";
import { stopReason } from "./words.js";

/** Codes that report one cause: the energy is wrong, by a jump or little by little. */
const FAMILY = { "energy-jump": "energy", "energy-drift": "energy" };

/**
 * Incidents of one method and one cause: how many, when, and the newest of them. A run lists the
 * first few of a code, and counts all.
 * @typedef {import("./store.js").Incident} Incident
 * @typedef {{key: string, count: number, listed: number, first: number, last: number,
 *   newest: Incident}} Group
 * @param {Incident[]} incidents in the order of time
 * @returns {Group[]} the newest first
 */
export function groupIncidents(incidents) {
  /** @type {Map<string, Incident[]>} */
  const causes = new Map();
  for (const incident of incidents) {
    const key = `${incident.method} ${FAMILY[incident.code] ?? incident.code}`;
    causes.set(key, [...(causes.get(key) ?? []), incident]);
  }
  const groups = [...causes].map(([key, list]) => {
    const codes = new Set(list.map(({ code }) => code));
    const counts = [...codes].map((code) => {
      const same = list.filter((one) => one.code === code);
      return Math.max(same.length, ...same.map(({ times }) => times ?? 0));
    });
    return {
      key,
      count: counts.reduce((sum, count) => sum + count, 0),
      listed: list.length,
      first: list[0].t,
      last: list[list.length - 1].t,
      newest: list[list.length - 1],
    };
  });
  return groups.sort((a, b) => b.last - a.last);
}

/**
 * "0.4 s", "0.4 s to 2 s, 3 times", "0.4 s to 2 s and later, 12 times"
 * @param {{count: number, listed?: number, first: number, last: number}} group
 * @param {number} duration [s] of the run
 */
export function whenWords({ count, listed: told = count, first, last }, duration) {
  const at = seconds(first, duration);
  const later = count > told ? " and later" : "";
  return count > 1 ? `${at} to ${seconds(last, duration)}${later}, ${count} times` : at;
}

/**
 * Things to try per formulation. `key` names an option and its new value as a share of the present
 * one (`times`); `strong` is a value of Baumgarte's constants, as large as the step allows;
 * `method` is a spelling in which {integrator} and {strong} stand for the present ones.
 */
const STEP = { say: "half the step", key: "h", times: 0.5 };
const PROJECTION = { say: "projection after every step", method: "projection@{integrator}" };
const TRIES = {
  index1: [
    {
      say: "Baumgarte with α = β = {strong}",
      method: "baumgarte:alpha={strong},beta={strong}@{integrator}",
    },
    PROJECTION,
    STEP,
  ],
  baumgarte: [
    { say: "α = β = {strong}", key: "alpha", and: "beta", strong: true },
    PROJECTION,
    STEP,
  ],
  "nullspace-as-printed": [
    { say: "the null-space form with its missing term", method: "nullspace@{integrator}" },
    { say: "half the step: the error stays", key: "h", times: 0.5 },
  ],
};
const TRIES_OTHERWISE = [
  STEP,
  { say: "reduced coordinates, for comparison", method: "reduced@{integrator}" },
];

const MOST_TRIES = 3;
const STRONGEST = 20; // [1/s]
const LARGEST_H_BETA = 0.4; // step times constant: from about 2 on Runge-Kutta 4 becomes unstable

/**
 * `said`: what a trial of it gave.
 * @typedef {{
 *   label: string, key?: string, and?: string, value?: number, method?: string, said?: string,
 * }} Try
 */

/** @param {import("./store.js").Data} data @param {number} m @returns {Try[]} */
function triesOf(data, m) {
  const { spelling, formulation } = data.methods[m];
  const integrator = spelling.slice(spelling.indexOf("@") + 1);
  const step = Number(settingOf(data.catalogue, spelling, "h")?.value ?? 0);
  const strong = step > 0 ? niceBelow(Math.min(STRONGEST, LARGEST_H_BETA / step)) : STRONGEST;
  const fill = (text) => text.replaceAll("{integrator}", integrator).replaceAll("{strong}", strong);

  return (TRIES[formulation] ?? TRIES_OTHERWISE).flatMap((item) => {
    if (item.method) {
      const wanted = fill(item.method);
      const known = cardOf(data.catalogue, "formulation", parseSpelling(wanted).formulation.name);
      const there = data.methods.some((method) => method.spelling === wanted);
      return known && !there ? [{ label: fill(item.say), method: wanted }] : [];
    }
    const now = settingOf(data.catalogue, spelling, item.key);
    const value = item.strong ? strong : now && Number((now.value * item.times).toPrecision(6));
    return now && value !== now.value
      ? [{ label: fill(item.say), key: item.key, and: item.and, value }]
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
    ? { label: text.trim().replace(/e-0(?=\d)/g, "e-"), method: text.trim() }
    : { label: text.trim() };
}

/**
 * The remedies of an incident, with what each gave where the engine has tried it.
 * @param {Incident} incident
 * @returns {Try[]}
 */
export const triesOfIncident = ({ remedies, tried }) =>
  remedies.map((text, i) => ({ ...tryOfRemedy(text), said: tried?.[i] ?? "" }));

/**
 * Returns what a step costs: operations, exactly, and the computing time of the latest frames with
 * the range of its middle half.
 * @param {import("./store.js").Data} data @param {number} m @param {number} shown
 */
export function costWords(data, m, shown) {
  const { ops, steps } = data.history.columns[m];
  const { median, low, high } = data.latest?.methods[m]?.step_cpu ?? {};
  if (!(steps[shown] > 0)) {
    return "";
  }
  const count =
    ops[shown] > 0
      ? `A step costs ${Math.round(ops[shown] / steps[shown])} operations`
      : "A step of this program costs operations that are not counted";
  return median
    ? `${count}, ${quantity(median, "s", 2)} of computing (${quantity(Number(low), "s", 2)} to ${quantity(Number(high), "s", 2)} in the middle half of the frames).`
    : `${count}.`;
}

/**
 * The error of a run as the engine estimates it while it goes on; "" where it says nothing.
 * @param {import("./store.js").Data} data @param {number} m
 */
export function estimateWords(data, m) {
  const { q, v, reaction, coordinate, off, unit, t, reason } =
    data.latest?.methods[m]?.error_estimate ?? {};
  if (!Number.isFinite(q ?? NaN)) {
    return reason ? `The error is not estimated: ${reason}.` : "";
  }
  const sizes = [
    `${unit === "m" ? quantity(Number(off), unit, 2) : `${scientific(Number(off))} ${unit === "rad" ? unit : ""}`.trim()} in ${coordinate}`,
    `${scientific(Number(v))} of the fastest velocity`,
    Number.isFinite(reaction ?? NaN) ? `${scientific(Number(reaction))} of the largest force` : "",
  ];
  const ended = reason ? ` It ended there: ${reason}.` : "";
  return `Largest error until ${seconds(Number(t), data.duration)}, estimated by a pilot run at tight tolerance: ${listed(sizes.filter(Boolean))}.${ended}`;
}

/** Returns what happened to a method until the frame shown, with numbers. */
function happenedWords(data, m, shown) {
  const { history, latest } = data;
  const trend = trendOf(history, m, shown);
  const reason = latest?.methods[m]?.reason;
  if (trend.tone === "bad") {
    const end = history.ended[m];
    return `It ${trend.word}${reason ? `: ${stopReason(reason, end, data.duration)}` : ""}.`;
  }
  const { off } = errorsOf(data)[m];
  let at = shown; // the reference may have no sample at the very frame shown
  while (at > 0 && Number.isNaN(off[at])) {
    at--;
  }
  const parts = [
    data.scene?.m > 0
      ? `the loop gap is ${gapWords(history.columns[m].gap[shown])} (${trend.word})`
      : "",
    Number.isNaN(off[at])
      ? ""
      : `the point farthest from the reference solution is ${quantity(off[at], "m")} off now`,
    `the energy has changed by ${quantity(history.columns[m].energy_change[shown], "J")}`,
  ];
  return `After ${seconds(history.t[shown], data.duration)} ${listed(parts.filter(Boolean))}.`;
}

/**
 * Is it a method that is there already and has stopped as well?
 * @param {import("./store.js").Data} data
 * @param {Try} item
 */
const hasFailed = ({ history, methods }, { method }) =>
  methods.some(({ spelling }, m) => spelling === method && !Number.isNaN(history.ended[m]));

/** Do two suggestions do the same? @param {Try} a @param {Try} b */
const sameTry = (a, b) => a.method === b.method && a.key === b.key && a.value === b.value;

/**
 * The card of a method: the verdict, what happened on this run, the rule behind it, what to try.
 * Remedies that the engine found for this run come before those that hold in general.
 * @param {import("./store.js").Data} data
 * @param {number} m
 * @param {number} shown
 */
export function cardOfMethod(data, m, shown) {
  const method = data.methods[m];
  const incidents = data.incidents.filter((one) => one.method === m);
  const remedies = incidents
    .slice(-1)
    .flatMap(triesOfIncident)
    .filter(({ label }, i, all) => all.findIndex((other) => other.label === label) === i)
    .filter((item) => !hasFailed(data, item))
    .slice(0, MOST_TRIES);
  const stopped = data.history.ended[m] <= data.history.t[shown];
  return {
    title: method.title,
    label: method.label,
    verdict: verdictAt(data, m, shown),
    happened: [happenedWords(data, m, shown), jumpWords(data, m, shown)].filter(Boolean).join(" "),
    figures: [stopped ? "" : costWords(data, m, shown), estimateWords(data, m)]
      .filter(Boolean)
      .join(" "),
    singular: withPowers(singularWords(data, m, shown)),
    deadPoint: deadPointAt(data, m, shown),
    groups: groupIncidents(incidents),
    rule: withPowers(method.rule),
    drift: withPowers(method.drift ?? ""),
    remedies,
    // of a run that has stopped the engine knows what helps; the general list is a guess, and for
    // a program that broke a rule none helps
    tries:
      stopped && (remedies.length > 0 || isProgram(method.formulation))
        ? []
        : triesOf(data, m)
            .filter((item) => !remedies.some((other) => sameTry(item, other)))
            .slice(0, MOST_TRIES - remedies.length),
  };
}
