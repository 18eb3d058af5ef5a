// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The actions of the page. Every action asks the server and puts its answer into the store; a
// change that the server refuses changes nothing here either, and rejects with a Problem for the
// field that asked.
import { createReactionFeed } from "../state/reaction-feed.js";
import { createReferenceFeed } from "../state/reference.js";
import { sourceOf } from "../state/store.js";
import { createStudyFeed } from "../state/studies.js";
import { createDragActions } from "./drag.js";
import { createExchange } from "./exchange.js";
import { createMethodActions } from "./methods.js";
import { createPlayback } from "./playback.js";
import { createPullActions } from "./pull.js";
import { createSceneActions } from "./scenes.js";
import { createUndo } from "./undo.js";

/** @param {import("../state/store.js").Store} store */
export function createSession(store) {
  /** @param {string} text for the status line */
  function notice(text) {
    store.data.notice = text;
    store.emit("notice");
  }

  const exchange = createExchange(store, notice);
  const endReactions = createReactionFeed(store);
  const reference = createReferenceFeed(store);
  const studies = createStudyFeed(store);

  const scenes = createSceneActions(store, exchange, notice);

  /** Runs what ran before: scene, parameters, methods with their steps, pulls, to the same end. */
  const bringBack = ({ scene, settings, methods, pulls, end }) =>
    JSON.stringify(scene) === JSON.stringify(sourceOf(store.data)) && end === store.data.askedEnd
      ? exchange.restart({ parameters: settings, methods, pulls })
      : typeof scene === "string"
        ? scenes.loadScene(scene, { settings, methods, pulls, end })
        : scenes.loadDocument(scene, { settings, methods, pulls });
  const undo = createUndo(store, bringBack, notice);
  const pulls = createPullActions(store, exchange, notice);
  /** each shows what runs in place of what was refused, and returns whether something was
   * @type {Set<() => boolean>} */
  const entries = new Set();
  /** Undoes the changes that the server refused: they go first, alone. */
  function undoRefused() {
    const some = [...entries].filter((takeBack) => takeBack()).length > 0;
    if (some) {
      notice("the value that was refused is taken back; nothing else was changed");
    }
    return some;
  }
  /** A hand lets go first: what it did is the last change. @param {() => Promise<void>} move */
  const afterHand = (move) => pulls.letGo().then(move);

  return {
    ...scenes,
    ...createDragActions(store, exchange, notice),
    ...pulls,
    bringBack,
    undo: async () => undoRefused() || afterHand(undo.undo),
    redo: () => afterHand(undo.redo),
    /**
     * Fields whose refused values an undo takes back.
     * @param {() => boolean} takeBack
     * @returns {() => void} removes them
     */
    withRefusals(takeBack) {
      entries.add(takeBack);
      return () => entries.delete(takeBack);
    },
    ...createPlayback(store, exchange),
    ...createMethodActions(store, exchange, notice),
    studies,
    /** Computes a reference solution for parameters that have none stored. */
    computeReference: () => reference.compute(),
    notice,
    dispose() {
      scenes.endSession();
      endReactions();
      reference.dispose();
      studies.dispose();
      exchange.dispose();
    },
  };
}

/** @typedef {ReturnType<typeof createSession>} Session */
