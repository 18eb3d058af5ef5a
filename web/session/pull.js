// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A hand that holds a point by a spring while the methods run. The server keeps a log of what it
// does; a start anew does it again, to the same bits.
import { api, sentenceOf } from "../api/client.js";
import { seconds } from "../state/format.js";

const ENTRY = 7; // numbers of an entry of the log
const DIGITS = 5; // of a place: a pointer knows no more, and a link is shorter

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 * @param {(text: string) => void} notice
 */
export function createPullActions(store, exchange, notice) {
  const data = store.data;
  /** the newest place that was not asked for yet */
  let wish = /** @type {{point: number, to: number[]} | null} */ (null);
  let asking = /** @type {Promise<void> | null} */ (null);

  /** @param {import("../state/types.js").Hand | null} hand */
  function put(hand) {
    data.hand = hand;
    store.emit("hand");
  }

  /** One question at a time; a newer place replaces one that waits. */
  function follow() {
    asking ??= (async () => {
      while (wish) {
        const pull = wish;
        wish = null;
        await exchange.change({ pull });
      }
    })()
      .catch((error) => {
        wish = null;
        put(null);
        notice(sentenceOf(error));
      })
      .finally(() => {
        asking = null;
      });
    return asking;
  }

  /** The letting go that goes on, until its log is here. */
  let lettingGo = Promise.resolve();

  /** Fetches the log, so that a link and a new server do it again. */
  async function keepLog() {
    const { id } = data;
    const { pulls } = await api.pulls(id);
    if (data.id === id && pulls.every((entry) => entry.length === ENTRY)) {
      data.pulls = pulls;
      store.emit("hand");
    }
  }

  async function release() {
    wish = null;
    put(null);
    await asking;
    await exchange
      .change({ release: true })
      .then(keepLog)
      .catch((error) => notice(sentenceOf(error)));
  }

  return {
    /**
     * Holds a drawn point from a place of the world [m].
     * @param {number} point @param {number[]} place
     */
    pull(point, place) {
      const to = place.map((x) => Number(x.toPrecision(DIGITS)));
      wish = { point, to };
      put({ point, to });
      return follow();
    },
    /** Lets go. Done when the log is here, also where another call let go. */
    letGo() {
      if (data.hand) {
        lettingGo = release();
      }
      return lettingGo;
    },
    /** The methods stand, or a recording plays: says why nothing is pulled, and what to do. */
    refusePull() {
      if (data.state !== "finished" && !data.view.replaying) {
        notice("the methods stand: press Play, then pull. With pull off, a drag sets the start");
        return;
      }
      const end = seconds(data.history.t[data.history.count - 1], data.duration);
      notice(
        data.state === "finished"
          ? `this is a recording to ${end}, the end of the run: a hand cannot change it. Pause, then ` +
              "drag a joint to change the start"
          : `this is a recording to ${end}: a hand can pull only what comes after it, when it ` +
              "has been played to there",
      );
    },
    /** The motion without any hand, from the start. */
    forgetPulls() {
      put(null);
      return exchange.restart({ pulls: [] }).catch((error) => notice(sentenceOf(error)));
    },
  };
}
