// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The event stream of one comparison. One connection carries all methods; the id of the last event
// seen is kept, so that a drop, or a page that was hidden for a while, resumes without gap or
// repeat.
import { api } from "./client.js";

const EVENTS = ["hello", "frame", "slow", "incident", "reset", "state", "gap", "end"];
const RETRY_FIRST = 500; // [ms]
const RETRY_MOST = 2000;

/**
 * @typedef {"connecting" | "live" | "reconnecting" | "hidden" | "ended"} StreamState
 * @typedef {{
 *   onEvent: (name: string, data: any, lastId: string) => void,
 *   onState: (state: StreamState, lastId: string) => void,
 *   onForgotten: () => Promise<void>,
 * }} Listener onForgotten: the server is there and has no such comparison any more
 * @param {string} id of the comparison
 * @param {Listener} listener
 */
export function createStream(id, { onEvent, onState, onForgotten }) {
  /** @type {EventSource | null} */
  let source = null;
  let lastId = "";
  let retry = RETRY_FIRST;
  let timer = 0;
  let closed = false;
  /** all has been told: there is nothing to connect to until a change asks for it */
  let resting = false;

  /** @param {StreamState} state */
  const tell = (state) => onState(state, lastId);

  function drop() {
    clearTimeout(timer);
    source?.close();
    source = null;
  }

  /** @param {StreamState} state */
  function open(state) {
    if (closed) {
      return;
    }
    drop();
    tell(state);
    source = new EventSource(api.eventsAddress(id, lastId));
    source.onopen = () => {
      retry = RETRY_FIRST;
      tell("live");
    };
    source.onerror = onError;
    for (const name of EVENTS) {
      source.addEventListener(name, (event) => receive(name, /** @type {MessageEvent} */ (event)));
    }
  }

  /** @param {string} name @param {MessageEvent} event */
  function receive(name, event) {
    if (event.lastEventId) {
      lastId = event.lastEventId;
    }
    onEvent(name, JSON.parse(event.data), lastId);
  }

  // the browser's own retry would send the id of its own connection only; ours also survives a
  // closed source
  function onError() {
    drop();
    tell("reconnecting");
    timer = window.setTimeout(lookForServer, retry);
    retry = Math.min(2 * retry, RETRY_MOST);
  }

  /** Connects once the server answers; one that was started anew has forgotten the comparison. */
  async function lookForServer() {
    try {
      const ids = await api.comparisonIds();
      if (closed || resting || source || document.hidden) {
        return;
      }
      if (ids.includes(id)) {
        open("reconnecting");
      } else {
        await onForgotten();
      }
    } catch {
      if (!closed && !resting && !source && !document.hidden) {
        onError();
      }
    }
  }

  function onVisibility() {
    if (document.hidden && !resting) {
      drop();
      tell("hidden");
    } else if (!document.hidden && !source && !resting) {
      lookForServer();
    }
  }

  function onOnline() {
    if (!document.hidden && !resting) {
      drop();
      lookForServer();
    }
  }

  document.addEventListener("visibilitychange", onVisibility);
  window.addEventListener("online", onOnline);
  open("connecting");

  return {
    /** The comparison has come to its end. */
    rest() {
      drop();
      resting = true;
      tell("ended");
    },
    /** Opens again after the end of a comparison that was set back or changed. */
    reopen() {
      resting = false;
      if (!source && !document.hidden) {
        open("connecting");
      }
    },
    dispose() {
      closed = true;
      drop();
      document.removeEventListener("visibilitychange", onVisibility);
      window.removeEventListener("online", onOnline);
    },
  };
}
