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
 *   held: string, moved: boolean, of: "" | "start" | "parameter",
 * }} Drag the last closed configuration; held: why it does not follow, or ""; of: what is dragged
 */

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

  /** @param {any} body */
  async function ask({ settings, of, ...body }) {
    const { drag } = data;
    if (!drag) {
      return;
    }
    try {
      const answer = await api.drag({
        scene: sourceOf(data),
        parameters: parametersOf(settings),
        state: drag.state,
        ...body,
      });
      if (data.drag) {
        const held = answer.reached ? "" : (answer.reason ?? "");
        const { points, state } = answer;
        put({ points, state, settings, held, of, moved: true });
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
      put({ points, state, settings: data.settings, held: "", of: "", moved: false });
      return true;
    },
    /** @param {number} point index of a drawn point @param {number[]} target [m] */
    dragPoint: (point, target) => follow({ point, target, settings: data.settings, of: "start" }),
    /** @param {string} name of a parameter @param {number} value */
    dragParameter(name, value) {
      const [first] = data.scene.coordinates;
      const target = [data.drag?.state[first.name] ?? 0];
      const settings = { ...data.settings, [name]: value };
      return follow({ coordinate: first.name, target, settings, of: "parameter" });
    },
    /**
     * Places of the drawn points at the start with other settings; null where the loops cannot be
     * closed.
     * @param {Record<string, number>} settings
     */
    pointsWith(settings) {
      const [first] = data.scene.coordinates;
      const body = { scene: data.scene.id, coordinate: first.name, target: [first.value] };
      return api.drag({ ...body, parameters: settings }).then(
        ({ points }) => points,
        () => null,
      );
    },
    /** Lets go: what is shown becomes the start. */
    async endDrag() {
      await asking;
      const { drag } = data;
      if (!drag) {
        return;
      }
      if (drag.moved) {
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
      const rates = data.scene.coordinates.some(({ rate }) => rate === name);
      if (rates) {
        const parameters = settingsWithStart(data.settings, { ...state, [name]: value });
        await exchange.restart({ parameters });
        return;
      }
      put({ points, state, settings: data.settings, held: "", of: "start", moved: false });
      const { settings } = data;
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
