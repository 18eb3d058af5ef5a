// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The browser's own history: every scene that is opened, and every view that lies over the page, is
// a place to which "back" returns. A scene comes back with the methods and parameters that it had.
import { sentenceOf } from "../api/client.js";
import { listen, sourceOf } from "../state/store.js";

/**
 * What lies over the page.
 * @typedef {{study: string, panel: string, gallery: boolean}} Over
 * @typedef {{scene: number, over: Over}} Place scene: a number of its own for each that was opened
 */

/** @param {Over} over */
const isPlain = ({ study, panel, gallery }) => !study && !panel && !gallery;
const PLAIN = { study: "", panel: "", gallery: false };

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./session.js").Session} actions
 */
export function createTrail(store, actions) {
  const data = store.data;
  /** @type {Map<number, {source: any, settings: Record<string, number>, methods: string[]}>} */
  const kept = new Map();
  /** @type {Place} */
  let place = { scene: 0, over: PLAIN };
  let source = sourceOf(data);
  let count = 0;
  let going = false; // the browser has moved: what changes then is no new place

  /** @returns {Over} */
  const overNow = () => {
    const { study, panel, gallery } = data.view;
    return { study, panel, gallery };
  };

  /** The present comparison, so that it can be opened again. */
  function keep() {
    const methods = data.methods.map(({ spelling }) => spelling);
    kept.set(place.scene, { source: sourceOf(data), settings: { ...data.settings }, methods });
  }

  /** @param {Place} next @param {string} [address] */
  function push(next, address) {
    // the gallery has led here: nobody wants to go back to it
    const act = place.over.gallery ? "replaceState" : "pushState";
    place = next;
    window.history[act](place, "", address);
  }

  function onMethods() {
    const now = sourceOf(data);
    const other = JSON.stringify(now) !== JSON.stringify(source);
    source = now;
    if (going) {
      return;
    }
    // an edited document is the same place; another scene is a new one
    const edits = typeof now === "object" && typeof kept.get(place.scene)?.source === "object";
    if (other && !edits) {
      const address = typeof now === "string" ? `#${now}` : undefined;
      push({ scene: ++count, over: { ...overNow(), gallery: false } }, address);
    }
    keep();
  }

  function onView() {
    const now = overNow();
    if (going || JSON.stringify(now) === JSON.stringify(place.over)) {
      return;
    }
    if (isPlain(now) && window.history.state?.opened) {
      place = { ...place, over: now };
      window.history.back(); // closed by hand: the place where it was open is left
      return;
    }
    if (isPlain(now)) {
      place = { ...place, over: now };
      window.history.replaceState(place, "");
      return;
    }
    const opened = isPlain(place.over);
    place = { ...place, over: now };
    window.history[opened ? "pushState" : "replaceState"](
      { ...place, opened: opened || Boolean(window.history.state?.opened) },
      "",
    );
  }

  /** @param {number} scene */
  async function restore(scene) {
    const what = kept.get(scene);
    if (!what) {
      await actions.openLink(location.hash.slice(1)); // of an earlier visit
    } else if (typeof what.source === "string") {
      await actions.loadScene(what.source, what);
    } else {
      await actions.loadDocument(what.source, what);
    }
  }

  /** @param {PopStateEvent} event */
  async function onMove(event) {
    const wanted = /** @type {Place | null} */ (event.state);
    going = true;
    try {
      if (!wanted) {
        place = { scene: ++count, over: PLAIN }; // a link was put into the address line
        await actions.openLink(location.hash.slice(1));
        place.over = overNow();
        window.history.replaceState(place, "");
      } else {
        const other = wanted.scene !== place.scene;
        place = { scene: wanted.scene, over: wanted.over };
        if (other) {
          await restore(wanted.scene);
        }
        if (JSON.stringify(overNow()) !== JSON.stringify(wanted.over)) {
          actions.setView({ ...wanted.over });
        }
      }
    } catch (error) {
      actions.notice(sentenceOf(error));
    }
    source = sourceOf(data);
    going = false;
    keep();
  }

  place.over = overNow();
  window.history.replaceState(place, "");
  keep();
  const stop = listen(store, { methods: onMethods, view: onView });
  addEventListener("popstate", onMove);
  return {
    dispose() {
      stop();
      removeEventListener("popstate", onMove);
    },
  };
}
