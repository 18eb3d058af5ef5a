// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Asks the server what the joints carry, while somebody looks: one question at a time, for the
// selected method at the time shown.
import { Problem, api, sentenceOf } from "../api/client.js";
import { namedState, pointAt } from "./reactions.js";
import { sourceOf } from "./store.js";

const PAUSE = 100; // [ms] between an answer and the next question while the mechanism moves

/** The hand of a frame, as a request says it. */
const holdOf = ({ point, to, stiffness, damping }) => ({ point, to, stiffness, damping });

/** @param {import("./store.js").Store} store @returns {() => void} ends it */
export function createReactionFeed(store) {
  const data = store.data;
  let asking = false;
  let timer = 0;
  let answered = "";
  let refusedFor = -1; // the run: what the scene cannot tell at one time it cannot at another

  function wanted() {
    const { history, view } = data;
    const last = (history?.count ?? 0) - 1;
    const index = view.shown < 0 ? last : Math.min(view.shown, last);
    const m = view.selected;
    const key = `${data.run} ${m} ${history?.lastFrame} ${index}`;
    const asked = (view.reactions || view.arrows) && data.scene && index >= 0 && data.methods[m];
    return asked && key !== answered && refusedFor !== data.run ? { index, m, key } : null;
  }

  /** @param {{index: number, m: number}} what */
  async function ask({ index, m }) {
    const { history, scene, settings, run } = data;
    const { q, v } = history.stateAt(m, index);
    const points = history.pointsAt(m, index).slice();
    const t = history.t[index];
    const pull = history.pullAt(index);
    try {
      const answer = await api.terms({
        scene: sourceOf(data),
        parameters: settings,
        t,
        state: namedState(scene.coordinates, q, v),
        reactions: true,
        ...(pull ? { pull: holdOf(pull) } : {}),
      });
      const list = answer.reactions.map((item) => ({
        ...item,
        point: pointAt(points, item.place, scene.length),
      }));
      return {
        method: m,
        t,
        list,
        efforts: answer.efforts,
        mark: answer.lambda_mark ?? "",
        reason: answer.reason ?? "",
      };
    } catch (error) {
      if (error instanceof Problem && error.status === 422) {
        refusedFor = run;
      }
      return { method: m, t, list: [], efforts: [], mark: "", reason: sentenceOf(error) };
    }
  }

  async function look() {
    timer = 0;
    const what = asking ? null : wanted();
    if (!what) {
      return;
    }
    asking = true;
    const { run } = data;
    const answer = await ask(what);
    asking = false;
    if (run === data.run) {
      answered = what.key;
      data.reactions = answer;
      store.emit("reactions");
    }
    timer = window.setTimeout(look, PAUSE);
  }

  function poke() {
    if (!timer && !asking) {
      look();
    }
  }

  const off = ["frame", "view", "methods"].map((name) => store.on(name, poke));
  const forget = store.on("scene", () => {
    data.reactions = null;
    answered = "";
    store.emit("reactions");
  });
  return () => {
    clearTimeout(timer);
    [...off, forget].forEach((remove) => remove());
  };
}
