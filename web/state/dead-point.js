// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Dead points: configurations where one coordinate turns back while the mechanism moves on, and
// singular configurations, in words for the card of a method.
import { quantity, seconds } from "./format.js";
import { cardOf } from "./spelling.js";
import { listed, verdictAt } from "./verdict.js";
import { sentenceCase } from "./words.js";

/** Share of its own greatest velocity so far: a coordinate that is slower does not move on. */
const MOVES_ON = 0.05;
/** A coordinate that never was faster [rad/s or m/s] does not move at all. */
const MOVES = 1e-6;
const NEAR = 0.5; // [s] before the moment shown: it is asked about
const SINGULAR = ["near-singular", "rank-loss"];
const UNIT = { angle: "rad/s", length: "m/s" };

/**
 * The coordinate that moves on: the input where it does, else the one that is nearest to its own
 * greatest velocity; -1: the whole mechanism turns back.
 * @param {import("./types.js").Scene} scene @param {number[]} v @param {number[]} greatest
 */
function leader(scene, v, greatest) {
  const share = v.map((x, k) => (greatest[k] > MOVES ? Math.abs(x) / greatest[k] : 0));
  const input = scene.coordinates.findIndex(({ actuated, pinned }) => actuated || pinned);
  const at = share[input] > MOVES_ON ? input : share.indexOf(Math.max(...share));
  return share[at] > MOVES_ON ? at : -1;
}

/** The coordinate whose velocity changes its sign first between two frames, and where. */
function turning(before, v, greatest) {
  let at = -1;
  let share = 1;
  for (let k = 0; k < v.length; k++) {
    const where = before[k] / (before[k] - v[k]);
    if (before[k] * v[k] < 0 && greatest[k] > MOVES && where < share) {
      [at, share] = [k, where];
    }
  }
  return { at, share };
}

/**
 * The place up to which each recording was searched, and what was found: frames that come later are
 * looked at once, until the recording keeps every second frame only.
 * @type {WeakMap<object, {stride: number, of: {next: number, greatest: number[],
 *   found: DeadPoint[]}[]}>}
 */
const walked = new WeakMap();

/**
 * @param {import("./history.js").History} history
 * @param {number} m @param {number} n coordinates
 */
function walkOf(history, m, n) {
  const { stride } = history;
  const known = walked.get(history);
  const walks = known?.stride === stride ? known : { stride, of: [] };
  walked.set(history, walks);
  return (walks.of[m] ??= { next: 1, greatest: Array(n).fill(0), found: [] });
}

/**
 * The dead points until the frame shown of a mechanism with one degree of freedom, in the order of
 * time: the velocity of a coordinate changes its sign while another coordinate moves on. There the
 * null vector of J has a zero in that place, so J without that column is singular.
 * @typedef {{coordinate: number, t: number, frame: number, leads: number, speed: number}} DeadPoint
 * frame: index of the first frame after it, leads: the coordinate that moves on, speed: its
 * velocity [rad/s or m/s]
 * @param {import("./store.js").Data} data @param {number} m @param {number} shown
 * @returns {DeadPoint[]}
 */
export function deadPointsOf({ history, scene }, m, shown) {
  if (scene?.dof !== 1 || !(scene.m > 0)) {
    return [];
  }
  const walk = walkOf(history, m, scene.coordinates.length);
  const { greatest, found } = walk;
  for (; walk.next <= shown && !(history.ended[m] <= history.t[walk.next]); walk.next++) {
    const i = walk.next;
    const [before, v] = [history.stateAt(m, i - 1).v, history.stateAt(m, i).v];
    greatest.forEach((speed, k) => (greatest[k] = Math.max(speed, Math.abs(v[k]))));
    const { at, share } = turning(before, v, greatest);
    if (at >= 0) {
      const there = Array.from(v, (x, k) => before[k] + share * (x - before[k]));
      const leads = leader(scene, there, greatest);
      const t = history.t[i - 1] + share * (history.t[i] - history.t[i - 1]);
      if (leads >= 0) {
        found.push({ coordinate: at, t, frame: i, leads, speed: there[leads] });
      }
    }
  }
  return found.filter(({ frame }) => frame <= shown);
}

/**
 * Returns what is true at every dead point. @param {string} name of the coordinate that turns back
 */
const atDeadPoint = (name) =>
  `A force along ${name} moves nothing then, and ${name} does not determine the configuration`;

/**
 * The methods whose motion is the mechanism's own until the frame shown, the best first: a run that
 * is torn, far off or wrong in its energy turns back where the mechanism does not.
 * @param {import("./store.js").Data} data @param {number} shown
 */
function soundMethods(data, shown) {
  return data.methods
    .map((_, m) => ({ m, verdict: verdictAt(data, m, shown) }))
    .filter(({ verdict }) => verdict.tone !== "bad")
    .sort((a, b) => a.verdict.badness - b.verdict.badness)
    .map(({ m }) => m);
}

/**
 * The method that stayed right the longest, and the last frame of that: where none is right any
 * more, its dead points until then are the mechanism's own.
 * @param {import("./store.js").Data} data @param {number} shown a frame where none is right
 */
function longestSound(data, shown) {
  const lasts = data.methods.map((_, m) => {
    let [good, bad] = [0, shown]; // what was once wrong stays so
    while (bad - good > 1) {
      const middle = (good + bad) >> 1;
      [good, bad] = verdictAt(data, m, middle).tone === "bad" ? [good, middle] : [middle, bad];
    }
    return good;
  });
  const until = Math.max(...lasts);
  return { list: [lasts.indexOf(until)], until };
}

/**
 * Returns what became of the methods where none is right: how many stopped, how many run on and are
 * wrong.
 * @param {import("./store.js").Data} data @param {number} shown a frame where none is right
 */
function fatesWords({ history, methods }, shown) {
  const all = methods.length;
  const stopped = methods.filter((_, m) => history.ended[m] <= history.t[shown]).length;
  const have = (count) => `${count} ${count === 1 ? "has" : "have"}`;
  if (stopped > 0 && stopped < all) {
    return `of ${all} methods ${have(stopped)} stopped and ${have(all - stopped)} left the true motion`;
  }
  return `${all === 1 ? "the" : "every"} method has ${stopped ? "stopped" : "left the true motion"}`;
}

/**
 * Dead points as lines of the record of incidents, by coordinate: those of the methods that are
 * right; where none is, those of the time when one still was. Methods that find the same number
 * share a line, with the times of the best of them; `of` names them where others find another
 * number, and is "" where all agree.
 * @param {import("./store.js").Data} data @param {number} shown
 * @returns {{
 *   name: string, of: string, count: number, first: number, last: number, words: string,
 * }[]}
 */
export function deadPointLines(data, shown) {
  const sound = soundMethods(data, shown);
  const { list, until } =
    sound.length > 0 || shown < 1 ? { list: sound, until: shown } : longestSound(data, shown);
  const found = list.map((m) => ({ m, all: deadPointsOf(data, m, until) }));
  const end =
    until < shown
      ? ` Dead points are listed until ${seconds(data.history.t[until], data.duration)}: ${fatesWords(data, shown)} since.`
      : "";
  return data.scene.coordinates.flatMap(({ name }, k) => {
    const own = found.map(({ m, all }) => ({
      label: data.methods[m].label,
      times: all.filter(({ coordinate }) => coordinate === k).map(({ t }) => t),
    }));
    const words = `${name} turns back there while the mechanism moves on. ${atDeadPoint(name)}.${end}`;
    const counts = [...new Set(own.map(({ times }) => times.length))];
    return counts
      .filter((count) => count > 0)
      .map((count) => {
        const same = own.filter(({ times }) => times.length === count);
        const [{ times }] = same;
        const of = counts.length > 1 ? listed(same.map(({ label }) => label)) : "";
        return { name, of, count, first: times[0], last: times[count - 1], words };
      });
  });
}

/**
 * Why the record lists no dead point until the frame shown; "" where a mechanism has no loop, and
 * so none.
 * @param {import("./store.js").Data} data @param {number} shown
 */
export function noDeadPointWords(data, shown) {
  const { scene, history, duration } = data;
  if (!(scene?.m > 0) || shown < 1) {
    return "";
  }
  if (scene.dof !== 1) {
    return `Dead points are listed for mechanisms with one degree of freedom; this one has ${scene.dof}.`;
  }
  const sound = soundMethods(data, shown).length > 0;
  const until = sound ? shown : longestSound(data, shown).until;
  const none =
    `No dead point until ${seconds(history.t[until], duration)}: ` +
    "no coordinate turned back while the mechanism moved on.";
  return sound
    ? none
    : `${none} None is listed after that: ${fatesWords(data, shown)} since. A smaller step lists more.`;
}

/** Returns how a method fares at a dead point of a coordinate. */
function fateWords({ formulation, label }) {
  if (formulation === "partitioning") {
    return `${label} takes another coordinate before it comes there.`;
  }
  return formulation === "reduced"
    ? `${label} integrates another coordinate, so it passes.`
    : `${label} passes: J as a whole keeps its rank there.`;
}

/**
 * Returns what happens at dead points, and which coordinate loses its grip; null where there was
 * none. `isNear`: it was passed a moment ago. `tries`: a method that integrates the very coordinate
 * that turned back, and stops there.
 * @param {import("./store.js").Data} data @param {number} m @param {number} shown
 * @returns {{
 *   title: string, words: string, isNear: boolean, tries: import("./cards.js").Try[],
 * } | null}
 */
export function deadPointAt(data, m, shown) {
  const point = deadPointsOf(data, m, shown).at(-1);
  if (!point || data.history.ended[m] <= data.history.t[shown]) {
    return null;
  }
  const { name } = data.scene.coordinates[point.coordinate];
  const other = data.scene.coordinates[point.leads];
  const speed = quantity(Math.abs(point.speed), UNIT[other.kind] ?? "1/s");
  const { spelling, integrator } = data.methods[m];
  const how = spelling.slice(spelling.indexOf("@") + 1);
  const method = `reduced:coordinate=${point.coordinate + 1}@${how}`;
  const fits = cardOf(data.catalogue, "formulation", "reduced")?.integrators.includes(integrator);
  return {
    title: `Dead point of ${name} at ${seconds(point.t, data.duration)}`,
    isNear: data.history.t[shown] - point.t < NEAR,
    words:
      `${name} turns back there while ${other.name} moves on at ${speed}. ` +
      `${atDeadPoint(name)}; ${other.name} does. ${fateWords(data.methods[m])}`,
    tries:
      fits && !data.methods.some((one) => one.spelling === method)
        ? [{ label: `reduced with ${name}: it stops there`, method }]
        : [],
  };
}

/**
 * The last singular configuration that a run passed until the frame shown, as the engine words it;
 * "" where there was none. Constraints that are dependent from the start on are no such place.
 * @param {import("./store.js").Data} data @param {number} m @param {number} shown
 */
export function singularWords({ incidents, history, duration }, m, shown) {
  const last = incidents
    .filter(
      ({ code, method, t }) =>
        method === m && SINGULAR.includes(code) && t > 0 && t <= history.t[shown],
    )
    .sort((a, b) => a.t - b.t)
    .at(-1);
  return last
    ? `Singular configuration at ${seconds(last.t, duration)}: ${sentenceCase(last.message)}`
    : "";
}
