// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The verdict on a method: one phrase from its loop gap, its error against the reference solution
// and its energy. Table, sentence, drawing and live region all use these words, and so does the
// terminal (core/session/verdict): tests/support/verdicts.json holds cases that both tests read.
import { incidentOf } from "./catalogue.js";
import { ROUNDING, gapWords, quantity, seconds } from "./format.js";
import { errorsOf } from "./errors.js";

/** A gap grows whose worst of the second half of the motion is so many times that of the first. */
const GROWTH = 1.5;
/** One that has fallen below this share of the largest so far does not grow any more. */
const FALLEN = 0.9;
/** A last quarter of the motion so many times worse than the third one is a jump. */
const JUMP = 10;
const EARLIEST = 6; // [frames] before it there is nothing to judge
const OPEN = 1e-2; // of the scene's length: a gap that is the first thing to say
const VISIBLE = 1e-3; // of the scene's length: a gap or a distance that can be seen
const WRONG = 1e-2; // of the scene's length or energy: one digit is right at most
const CLOSED = 1e-12; // of the scene's length: rounding
const MOST_DIGITS = 15;

/**
 * Returns whether the gap is large by one rise at the end of the motion: stabilised methods fall
 * from it. A gap that grows exponentially rises by the same factor in each quarter.
 * @param {import("./history.js").History} history
 * @param {number} m
 * @param {number} shown index of the frame shown
 */
function hasJumped(history, m, shown) {
  const t = history.t[shown];
  const [quarter, half, later] = [t / 4, t / 2, (3 * t) / 4].map((time) => history.indexAt(time));
  const third = history.worst(m, "gap", half, later);
  const rise = history.worst(m, "gap", later, shown) / third;
  const before = third / history.worst(m, "gap", quarter, half);
  return rise > JUMP && !(rise <= before * before);
}

/**
 * Returns how the loop gap develops until the frame shown.
 * @typedef {{word: string, arrow: string, tone: "calm" | "warn" | "bad"}} Trend
 * @param {import("./history.js").History} history
 * @param {number} m
 * @param {number} shown index of the frame shown
 * @returns {Trend}
 */
export function trendOf(history, m, shown) {
  const t = history.t[shown];
  if (history.ended[m] <= t) {
    return { word: `stopped at ${seconds(history.ended[m])}`, arrow: "⇥", tone: "bad" };
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
  const now = history.columns[m].gap[shown];
  if (late > GROWTH * early && now >= FALLEN * late && !hasJumped(history, m, shown)) {
    return { word: "growing", arrow: "↗", tone: "warn" };
  }
  return late < early / GROWTH
    ? { word: "shrinking", arrow: "↘", tone: "calm" }
    : { word: "held", arrow: "→", tone: "calm" };
}

/**
 * Sizes that the verdict rests on, all of them the worst until the frame shown.
 * @param {import("./store.js").Data} data
 * @param {number} m
 * @param {number} shown
 */
function measure(data, m, shown) {
  const { reference, scene } = data;
  const errors = errorsOf(data)[m];
  const length = scene?.length || 1;
  const energyScale = reference?.state === "ready" ? reference.energyScale : NaN;
  const [gap, off, energy] = ["worstGap", "worstOff", "worstEnergy"].map((n) => errors[n][shown]);
  return {
    gap,
    off,
    energy,
    gapShare: gap / length,
    offShare: off / length,
    energyShare: energyScale > 0 ? energy / energyScale : 0,
    loops: (scene?.m ?? 0) > 0,
    known: !Number.isNaN(off),
  };
}

/** Words for the loop where something else is worse. */
function closedWords({ loops, gap, gapShare }) {
  if (!loops) {
    return "";
  }
  if (gapShare > VISIBLE) {
    return `open by ${quantity(gap, "m")}`;
  }
  return gapShare <= CLOSED ? "closed" : `closed to ${gapWords(gap)}`;
}

/** A closed loop does not make a motion right, and an open one is one fault more. */
const besides = (size, second) => {
  const first = closedWords(size);
  const joint = size.gapShare > VISIBLE ? " and" : ", but";
  return first ? `${first}${joint} ${second}` : second;
};

/**
 * An open loop, and its distance from the reference where that can be seen. A gap that grows is
 * said as it is now, one that does not as the largest so far.
 * @param {ReturnType<typeof measure>} size
 * @param {number} now [m] the gap of the frame shown
 * @param {boolean} grows
 */
function openWords(size, now, grows) {
  const far = size.known && size.offShare > VISIBLE ? quantity(size.off, "m") : "";
  if (grows) {
    return `open by ${quantity(now, "m")} and growing${far && `, ${far} off`}`;
  }
  return `open by ${quantity(size.gap, "m")}${far && ` and ${far} from the true motion`}`;
}

/**
 * Digits that are right, by the worse of motion and energy; no more than the reference has. `more`:
 * the reference bounds them, and the motion may have more.
 */
function rightDigits({ offShare, energyShare }, reference) {
  const share = Math.max(offShare, energyShare, 10 ** -MOST_DIGITS);
  const most = Math.floor(Math.min(MOST_DIGITS, reference.digits));
  const own = Math.floor(-Math.log10(share));
  return { digits: Math.min(most, own), more: most < own };
}

/** Returns what is said of an error without a reference. @param {any} data @param {number} m */
const unknownWords = (data, m) =>
  Number.isFinite(data.latest?.methods[m]?.error_estimate?.q)
    ? "error only estimated"
    : "error unknown";

/**
 * @typedef {{words: string, tone: "calm" | "warn" | "bad", badness: number}} Verdict
 * badness: for sorting, the worst is the largest
 * @param {import("./store.js").Data} data
 * @param {number} m
 * @param {number} shown index of the frame shown
 * @returns {Verdict}
 */
export function verdictAt(data, m, shown) {
  const { history, reference } = data;
  const trend = trendOf(history, m, shown);
  if (trend.tone === "bad") {
    const cause = incidentOf(history.causes[m])?.name;
    const words = cause ? `${trend.word}: ${cause}` : trend.word;
    return { words, tone: "bad", badness: 1e6 };
  }
  if (shown < EARLIEST) {
    return { words: "starts closed", tone: "calm", badness: 0 };
  }

  const size = measure(data, m, shown);
  const grows = trend.word === "growing";
  const open = () => {
    const words = openWords(size, history.columns[m].gap[shown], grows);
    return { words, tone: /** @type {const} */ ("bad"), badness: 1000 + size.gapShare };
  };
  if (size.loops && size.gapShare > OPEN) {
    return open();
  }
  if (size.known && size.offShare > WRONG) {
    const words = besides(size, `${quantity(size.off, "m")} from the true motion`);
    return { words, tone: "bad", badness: 100 + size.offShare };
  }
  if (size.energyShare > WRONG) {
    const words = besides(size, `${quantity(size.energy, "J")} off in energy`);
    return { words, tone: "bad", badness: 100 + size.energyShare };
  }
  if (size.loops && size.gapShare > VISIBLE) {
    return open();
  }

  const drifts = size.loops && grows ? `, gap ${quantity(size.gap, "m")} and growing` : "";
  if (!size.known) {
    const asked = reference?.state === "asked" ? "not compared yet" : unknownWords(data, m);
    const closed = drifts ? drifts.slice(2) : closedWords(size);
    const words = [closed, asked].filter(Boolean).join(", ");
    return { words, tone: drifts ? "warn" : "calm", badness: drifts ? 10 : 1 };
  }
  const { digits, more } = rightDigits(size, reference);
  const words = `right to ${digits} digits${more ? " or more" : ""}${drifts}`;
  return { words, tone: drifts ? "warn" : "calm", badness: drifts ? 10 : -digits };
}

/** "a", "a and b", "a, b and c" @param {string[]} list */
export const listed = (list) =>
  list.length < 2 ? list.join("") : `${list.slice(0, -1).join(", ")} and ${list[list.length - 1]}`;

/**
 * One sentence per verdict, with the methods that share it; the worst first. No method is left out.
 * @param {import("./store.js").Data} data
 * @param {number} shown
 * @returns {{text: string, tone: Verdict["tone"]}[]}
 */
export function sentences(data, shown) {
  const { history, methods, view } = data;
  if (!history || shown < 0) {
    return [];
  }
  /** @type {Map<string, {labels: string[], verdict: Verdict}>} */
  const groups = new Map();
  methods.forEach(({ label }, m) => {
    if (view.hidden.has(m)) {
      return;
    }
    const verdict = verdictAt(data, m, shown);
    const group = groups.get(verdict.words) ?? { labels: [], verdict };
    group.labels.push(label);
    groups.set(verdict.words, group);
  });
  return [...groups.values()]
    .sort((a, b) => b.verdict.badness - a.verdict.badness)
    .map(({ labels, verdict }) => ({
      text: `${listed(labels)}: ${verdict.words}`,
      tone: verdict.tone,
    }));
}
