// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Undo and redo of changes that start the runs anew (methods, parameters, the start, the scene) and
// of what a hand pulled.
import { sentenceOf } from "../api/client.js";
import { plain } from "../state/format.js";
import { isStart } from "../state/start.js";
import { madeOf } from "../state/store.js";
import { listed } from "../state/verdict.js";

const MOST = 100; // changes that are remembered
const TOGETHER = 1000; // [ms] between changes of one value, as by a slider: they are one change
const MOST_NAMED = 3; // values that a tip names

/**
 * Returns what differs between two snapshots. Each choice of a shipped scene is a difference of its
 * own.
 * @param {string} a @param {string} b
 */
function differenceOf(a, b) {
  const [one, other] = [a, b].map((text) => JSON.parse(text));
  const names = new Set([...Object.keys(one.settings), ...Object.keys(other.settings)]);
  const changed = [...names].filter((name) => one.settings[name] !== other.settings[name]);
  const same = (name) => JSON.stringify(one[name]) === JSON.stringify(other[name]);
  return [
    same("scene") ? "" : `scene ${typeof other.scene === "string" ? other.scene : ""}`,
    same("methods") ? "" : "methods",
    // pulls that are forgotten never go on the pull before them
    same("pulls") ? "" : other.pulls.length > 0 ? "pulls" : "no pulls",
    same("end") ? "" : "end",
    ...changed,
  ].join();
}

/** Returns which values changed, in words; "" where none did. */
function settingWords(one, other) {
  const names = [...new Set([...Object.keys(one), ...Object.keys(other)])];
  const changed = names.filter((name) => one[name] !== other[name]);
  const values = changed.filter((name) => !isStart(name));
  const start = values.length < changed.length ? ["the start"] : [];
  if (values.length === 1 && start.length === 0) {
    const [name] = values;
    const from = name in one ? ` from ${plain(one[name])}` : "";
    return `${name}${from}${name in other ? ` to ${plain(other[name])}` : ""}`;
  }
  const named = values.length > MOST_NAMED ? [`${values.length} parameters`] : values;
  return listed([...named, ...start]);
}

/**
 * Returns what was changed between two snapshots, in words.
 * @param {any} one @param {any} other
 */
export function changeWords(one, other) {
  const same = (name) => JSON.stringify(one[name]) === JSON.stringify(other[name]);
  const nameOf = ({ scene }) => (typeof scene === "string" ? scene : (scene.name ?? "yours"));
  if (!same("scene")) {
    return nameOf(one) === nameOf(other)
      ? `the change of the document ${nameOf(other)}`
      : `the choice of the scene ${nameOf(other)}`;
  }
  const changed = [
    settingWords(one.settings, other.settings),
    same("methods") ? "" : "the methods",
    same("end") ? "" : "the end of the run",
  ].filter(Boolean);
  return changed.length > 0 ? `the change of ${listed(changed)}` : "the pull";
}

/**
 * @param {import("../state/store.js").Store} store
 * @param {(what: any) => Promise<void>} apply makes what was there before
 * @param {(text: string) => void} notice
 */
export function createUndo(store, apply, notice) {
  const data = store.data;
  /** what was there, as text, the newest last @type {string[]} */
  let past = [];
  /** @type {string[]} */
  let future = [];
  let present = "";
  let busy = false;
  let last = { what: "", at: 0 };

  const snapshot = () => JSON.stringify(madeOf(data));

  function tell() {
    const [before, now, after] = [past.at(-1), present, future.at(-1)].map((text) =>
      text ? JSON.parse(text) : null,
    );
    data.undo = {
      past: past.length,
      future: future.length,
      undoes: before ? changeWords(before, now) : "",
      redoes: after ? changeWords(now, after) : "",
    };
    store.emit("undo");
  }

  function remember() {
    const now = data.scene ? snapshot() : "";
    if (busy || now === present) {
      return;
    }
    if (present) {
      const what = differenceOf(present, now);
      const goesOn = what === last.what && performance.now() - last.at < TOGETHER;
      last = { what, at: performance.now() };
      past = goesOn ? past : [...past, present].slice(-MOST);
      future = [];
    }
    present = now;
    tell();
  }

  store.on("methods", remember);
  // the log of a hand that let go; runs without any pull are told by "methods"
  store.on("hand", () => data.pulls.length > 0 && !data.hand && remember());

  /**
   * @param {string[]} from @param {string[]} to
   * @param {string} word @param {string} done the same word, when it is done
   */
  async function move(from, to, word, done) {
    const what = word === "undo" ? data.undo.undoes : data.undo.redoes;
    const wanted = from.pop();
    if (busy || !wanted) {
      notice(`there is nothing to ${word}`);
      return;
    }
    busy = true;
    to.push(present);
    try {
      const before = JSON.parse(wanted);
      await apply(before);
      data.pulls = before.pulls;
      present = snapshot();
      store.emit("hand");
      notice(`${done}: ${what}`);
    } catch (error) {
      to.pop();
      from.push(wanted); // nothing was changed, and it can be asked for again
      notice(sentenceOf(error));
    }
    busy = false;
    tell();
  }

  return {
    undo: () => move(past, future, "undo", "undone"),
    redo: () => move(future, past, "redo", "redone"),
  };
}
