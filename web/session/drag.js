// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Dragging: the server closes the loops round the place that is pointed at, the page shows it, and
// where it is let go becomes the start of all methods. Lengths are dragged the same way.
import { api, sentenceOf } from "../api/client.js";
import { namedState } from "../state/reactions.js";
import { isStart, settingsWithStart } from "../state/start.js";
import { shownIndex, sourceOf } from "../state/store.js";

/**
 * @typedef {{
 *   points: number[], state: Record<string, number>, settings: Record<string, number>,
 *   held: string, moved: boolean, of: "" | "start" | "parameter", from: number[] | null,
 * }} Drag the last closed configuration; held: why it does not follow, or ""; of: what is dragged;
 *   from: the drawn points where it began, null: it is set by number
 */

/** Share of the scene's length: if every drawn point moves by less, the change cannot be seen. */
const UNSEEN = 1e-3;

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 * @param {(text: string) => void} notice
 */
export function createDragActions(store, exchange, notice) {
  const data = store.data;
  /** the newest wish that was not asked for yet */
  let wish = /** @type {object | null} */ (null);
  let asking = /** @type {Promise<void> | null} */ (null);

  /** @param {Drag | null} drag */
  function put(drag) {
    data.drag = drag;
    store.emit("drag");
  }

  /** Parameters without the start, which the state of the drag replaces. */
  const parametersOf = (settings) => settingsWithStart(settings, null);

  /**
   * Returns what a wish makes: of a start the configuration nearest to it, of a length the very
   * start that the run will have with it.
   * @param {Drag} drag @param {any} wish
   * @returns {Promise<Drag>}
   */
  async function answerTo(drag, { settings, of, ...body }) {
    if (of === "parameter") {
      const { points } = await api.assemble({ scene: sourceOf(data), parameters: settings });
      return { ...drag, points, settings, held: "", of, moved: true };
    }
    const parameters = parametersOf(settings);
    const asked = { scene: sourceOf(data), parameters, state: drag.state, ...body };
    const { points, state, reached, reason } = await api.drag(asked);
    return {
      ...drag,
      points,
      state,
      settings,
      held: reached ? "" : (reason ?? ""),
      of,
      moved: true,
    };
  }

  /** Is what is let go another start, or another length, than before? @param {Drag} drag */
  function isChange({ of, moved, settings, points, from }) {
    const { parameters, length } = data.scene;
    const apart = (i) => Math.hypot(...[0, 1, 2].map((k) => points[i + k] - (from?.[i + k] ?? 0)));
    return of === "parameter"
      ? parameters.some(({ name, value }) => name in settings && settings[name] !== value)
      : moved && (from === null || from.some((_, i) => i % 3 === 0 && apart(i) > UNSEEN * length));
  }

  /**
   * A state with one rate changed, the others so that the loops stay closed: the present motion,
   * and the motion of that rate alone as much as is missing.
   * @param {Record<string, number>} state @param {string} name of a rate @param {number} value
   */
  async function withRate(state, name, value) {
    const { coordinates } = data.scene;
    const rates = coordinates.map(({ rate }) => rate);
    const alone = Object.fromEntries(rates.map((rate) => [rate, Number(rate === name)]));
    const [first] = coordinates;
    const { state: motion } = await api.drag({
      scene: sourceOf(data),
      parameters: parametersOf(data.settings),
      state: { ...state, ...alone },
      coordinate: first.name,
      target: [state[first.name]],
    });
    if (!(motion[name] > 0)) {
      throw new Error(`${name} is 0 in every motion that keeps the loops closed here`);
    }
    const share = (value - state[name]) / motion[name];
    return {
      ...state,
      ...Object.fromEntries(rates.map((rate) => [rate, state[rate] + share * motion[rate]])),
    };
  }

  /** @param {any} wish */
  async function ask(wish) {
    if (!data.drag) {
      return;
    }
    try {
      const answer = await answerTo(data.drag, wish);
      if (data.drag) {
        put(answer);
      }
    } catch (error) {
      if (data.drag) {
        put({ ...data.drag, held: sentenceOf(error) }); // the last valid configuration stays
      }
    }
  }

  /** One question at a time; a newer wish replaces one that waits. @param {object} body */
  function follow(body) {
    wish = body;
    asking ??= (async () => {
      while (wish) {
        const next = wish;
        wish = null;
        await ask(next);
      }
      asking = null;
    })();
    return asking;
  }

  const actions = {
    /** Takes hold of the configuration that is shown of the selected method. */
    beginDrag() {
      const i = shownIndex(data);
      if (!data.scene || i < 0 || data.drag) {
        return false;
      }
      if (data.state === "running") {
        exchange.changeOrReport({ state: "paused" });
      }
      const { q, v } = data.history.stateAt(data.view.selected, i);
      const state = namedState(data.scene.coordinates, q, v);
      const points = [...data.history.pointsAt(data.view.selected, i)];
      const { settings } = data;
      put({ points, state, settings, held: "", of: "", moved: false, from: points });
      return true;
    },
    /** @param {number} point index of a drawn point @param {number[]} target [m] */
    dragPoint: (point, target) => follow({ point, target, settings: data.settings, of: "start" }),
    /** @param {string} name of a parameter @param {number} value */
    dragParameter: (name, value) =>
      follow({ settings: { ...data.settings, [name]: value }, of: "parameter" }),
    /**
     * Places of the drawn points at the start with other settings; null where the loops cannot be
     * closed.
     * @param {Record<string, number>} settings
     */
    pointsWith: (settings) =>
      api.assemble({ scene: sourceOf(data), parameters: settings }).then(
        ({ points }) => points,
        () => null,
      ),
    /** Lets go: what is shown becomes the start. */
    async endDrag() {
      await asking;
      const { drag } = data;
      if (!drag) {
        return;
      }
      if (isChange(drag)) {
        const parameters =
          drag.of === "parameter" ? drag.settings : settingsWithStart(drag.settings, drag.state);
        await exchange
          .change({ parameters, state: "paused" })
          .catch((error) => notice(sentenceOf(error)));
      }
      put(null);
    },
    cancelDrag() {
      wish = null;
      put(null);
    },
    /**
     * Sets a coordinate of the start; the others follow.
     * @param {string} name @param {number} value
     */
    async setStart(name, value) {
      const points = [];
      const first = data.history.stateAt(data.view.selected, 0);
      const state = namedState(data.scene.coordinates, first.q, first.v);
      if (data.scene.coordinates.some(({ rate }) => rate === name)) {
        const moved = await withRate(state, name, value);
        await exchange.restart({ parameters: settingsWithStart(data.settings, moved) });
        return;
      }
      const { settings } = data;
      put({ points, state, settings, held: "", of: "start", moved: false, from: null });
      await follow({ coordinate: name, target: [value], settings, of: "start" });
      const held = data.drag?.held;
      await actions.endDrag();
      if (held) {
        throw new Error(held);
      }
    },
    /** The scene's own start again. */
    resetStart: () => exchange.restart({ parameters: settingsWithStart(data.settings, null) }),
    hasOwnStart: () => Object.keys(data.settings).some(isStart),
  };
  store.on("scene", actions.cancelDrag);
  return actions;
}
