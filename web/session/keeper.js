// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Remembers the session in this browser, and offers it when the page is opened again.
import { decodeLink } from "../state/link.js";
import { lastSession, rememberSession } from "../state/last-session.js";
import { listen } from "../state/store.js";

const PAUSE = 500; // [ms] after a change

/**
 * @param {import("../state/store.js").Store} store
 * @param {() => string} fragmentOf the link to what is shown
 */
export function createKeeper(store, fragmentOf) {
  const data = store.data;
  let timer = 0;
  let opened = ""; // what the page showed at first: nobody needs to continue that

  function keep() {
    timer = 0;
    const now = data.scene && !data.document && data.state !== "running" ? fragmentOf() : "";
    if (opened && now && now !== opened) {
      rememberSession(now);
    }
  }

  function keepSoon() {
    clearTimeout(timer);
    timer = window.setTimeout(keep, PAUSE);
  }

  function endOffer() {
    if (data.offer) {
      data.offer = "";
      store.emit("offer");
    }
  }

  const stop = listen(store, {
    methods: keepSoon,
    view: keepSoon,
    note: keepSoon,
    // a step of a recording that stands; what plays is kept when it stands
    frame: () => {
      if (data.state !== "running") {
        keepSoon();
      }
    },
    state: () => {
      keepSoon();
      if (opened && data.state === "running") {
        endOffer();
      }
    },
  });

  return {
    keepSoon,
    endOffer,
    /** The page shows its first scene. @param {boolean} isPlain no link was asked for */
    begin(isPlain) {
      opened = fragmentOf();
      const last = isPlain ? lastSession() : "";
      const { scene } = decodeLink(last).link;
      if (last !== opened && data.scenes.some(({ id }) => id === scene)) {
        data.offer = last;
        store.emit("offer");
      }
    },
    dispose() {
      keep();
      clearTimeout(timer);
      stop();
    },
  };
}
