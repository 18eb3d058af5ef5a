// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The browser's own history: every scene that is opened, and every view that lies over the page, is
// a place to which "back" returns; so is every lesson. A scene comes back with the methods and
// parameters that it had. The address names the lesson that is read, else the scene.
import { sentenceOf } from "../api/client.js";
import { isLessonAddress, lessonAddress } from "../state/link.js";
import { lessonOf } from "../state/shown.js";
import { listen, sourceOf } from "../state/store.js";

/**
 * The panels that lie over the page. `lesson`: the one that is read, or "".
 * @typedef {{study: string, panel: string, gallery: boolean, lesson: string}} Over
 * @typedef {{scene: number, over: Over}} Place scene: a number of its own for each that was opened
 */

/** @param {Over} over */
const isPlain = ({ study, panel, gallery }) => !study && !panel && !gallery;
const PLAIN = { study: "", panel: "", gallery: false, lesson: "" };

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
    return { study, panel, gallery, lesson: panel === "lessons" ? lessonOf(data) : "" };
  };

  /** The address of a place; a scene of one's own has none but the page's. @param {Over} over */
  function addressOf({ lesson }) {
    const id = sourceOf(data);
    const page = `${location.pathname}${location.search}`;
    return lesson ? `#${lessonAddress(lesson)}` : typeof id === "string" ? `#${id}` : page;
  }

  /** The present comparison, so that it can be opened again. */
  function keep() {
    const methods = data.methods.map(({ spelling }) => spelling);
    kept.set(place.scene, { source: sourceOf(data), settings: { ...data.settings }, methods });
  }

  /** @param {Place} next */
  function push(next) {
    // the gallery has led here: nobody wants to go back to it
    const act = place.over.gallery ? "replaceState" : "pushState";
    place = next;
    window.history[act](place, "", addressOf(next.over));
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
      push({ scene: ++count, over: { ...overNow(), gallery: false } });
    }
    keep();
  }

  function onView() {
    const now = overNow();
    if (going || JSON.stringify(now) === JSON.stringify(place.over)) {
      return;
    }
    const before = place.over;
    /** how many places lie between this one and the page without anything over it */
    const opened = Number(window.history.state?.opened ?? 0);
    place = { ...place, over: now };
    if (isPlain(now) && opened) {
      window.history.go(-opened); // closed by hand: the places where it was open are left
      return;
    }
    if (isPlain(now)) {
      const address = before.lesson ? addressOf(now) : undefined;
      window.history.replaceState(place, "", address);
      return;
    }
    const opens = isPlain(before);
    const turns = Boolean(before.lesson && now.lesson); // to another lesson
    const depth = opens ? 1 : turns && opened ? opened + 1 : opened;
    const changes = before.lesson || now.lesson;
    window.history[opens || turns ? "pushState" : "replaceState"](
      { ...place, opened: depth },
      "",
      changes ? addressOf(now) : undefined,
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
        const fragment = location.hash.slice(1); // a link was put into the address line
        const scene = isLessonAddress(fragment) ? place.scene : ++count;
        place = { scene, over: PLAIN };
        await actions.openLink(fragment);
        place.over = overNow();
        window.history.replaceState(
          place,
          "",
          place.over.lesson ? addressOf(place.over) : undefined,
        );
      } else {
        const other = wanted.scene !== place.scene;
        place = { scene: wanted.scene, over: wanted.over };
        if (other) {
          await restore(wanted.scene);
        }
        if (JSON.stringify(overNow()) !== JSON.stringify(wanted.over)) {
          const { lesson, ...over } = wanted.over;
          actions.setView(lesson ? { ...over, lesson } : over); // closed, it is remembered
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
  window.history.replaceState(place, "", place.over.lesson ? addressOf(place.over) : undefined);
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
