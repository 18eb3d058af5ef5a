// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Asks the server to make or change the comparison, one request after the other, and keeps the
// event stream open. A request that the server refuses changes nothing; its caller gets the
// Problem.
import { Problem, api, sentenceOf } from "../api/client.js";
import { createStream } from "../api/stream.js";
import { sourceOf } from "../state/store.js";
import { createReceiver } from "./receive.js";

/**
 * Index of the method that the server refused to run on the scene, or -1.
 * @param {unknown} error
 */
function refusedPlace(error) {
  const pointer = error instanceof Problem ? (error.errors[0]?.pointer ?? "") : "";
  const match = /^\/methods\/(\d+)$/.exec(pointer);
  return match ? Number(match[1]) : -1;
}

/**
 * Asks with a list of methods. Methods that the scene cannot serve are left out, each with the
 * server's reason, and the request is repeated with the others.
 * @template {{methods?: string[]}} Body
 * @param {Body} body
 * @param {(body: Body) => Promise<any>} ask
 */
async function withoutRefused(body, ask) {
  const refused = [];
  const methods = [...(body.methods ?? [])];
  for (;;) {
    try {
      const description = await ask({ ...body, methods });
      return { description, refused };
    } catch (error) {
      const at = refusedPlace(error);
      if (at < 0 || at >= methods.length || methods.length === 1) {
        throw error;
      }
      const [spelling] = methods.splice(at, 1);
      refused.push({ spelling, reason: sentenceOf(error) });
    }
  }
}

const FRAMES_AT_ONCE = 600; // of the clock, in one request

/** Is it a change of the clock alone, that can be made up for later? @param {object} change */
const isOfClock = (change) => Object.keys(change).every((key) => ["state", "speed"].includes(key));

/** Does a change start the runs anew? @param {object} change */
const startsAnew = (change) =>
  ["methods", "parameters", "reset", "pulls"].some((key) => Object.hasOwn(change, key));

/**
 * @param {import("../state/store.js").Store} store
 * @param {(text: string) => void} notice shows a sentence to the user
 */
export function createExchange(store, notice) {
  const data = store.data;
  const receiver = createReceiver(store, notice);
  /** @type {ReturnType<typeof createStream> | null} */
  let stream = null;
  /** changes go out one after the other, in the order of asking */
  let queue = Promise.resolve();
  /** what was asked of the clock while the server did not answer */
  let owed = {};

  /** @param {() => Promise<void>} task @returns {Promise<void>} */
  function inQueue(task) {
    const done = queue.then(task);
    queue = done.catch(() => undefined);
    return done;
  }

  /** Opens the event stream of the comparison. */
  function listen() {
    stream?.dispose();
    stream = createStream(data.id, {
      onEvent(name, detail, lastId) {
        data.stream.id = lastId;
        if (receiver.take(name, detail, Number(lastId))) {
          stream?.rest();
        }
      },
      onState(state, id) {
        data.stream = { state, id };
        store.emit("stream");
        if (state === "live" && Object.keys(owed).length > 0) {
          change(owed).catch((error) => notice(sentenceOf(error)));
          owed = {};
        }
      },
      onForgotten() {
        const { id } = data;
        return inQueue(async () => (data.id === id ? resume() : undefined));
      },
    });
  }

  /** @param {any} description of a comparison that was just made */
  function adopt(description) {
    stream?.dispose();
    stream = null;
    receiver.begin(description.id);
    receiver.applyDescription(description);
    listen();
  }

  /** @param {{methods: string[], [key: string]: any}} body */
  async function create(body) {
    const old = data.id;
    const { description, refused } = await withoutRefused(body, (asked) =>
      api.createComparison({ paused: true, ...asked }),
    );
    data.refused = refused;
    data.document = typeof body.scene === "object" ? body.scene : null;
    data.pulls = body.pulls ?? [];
    data.askedEnd = body.duration ?? 0;
    adopt(description);
    if (old) {
      api
        .deleteComparison(old)
        .catch(() => notice("the server could not close the previous comparison"));
    }
  }

  /** Returns what makes the present comparison again. */
  const presentBody = () => ({
    scene: sourceOf(data),
    parameters: data.settings,
    methods: data.methods.map((m) => m.spelling),
    speed: data.speed,
    ...(data.pulls.length ? { pulls: data.pulls } : {}),
    ...(data.askedEnd ? { duration: data.askedEnd } : {}),
  });

  /**
   * Runs a comparison that was made anew up to a frame of the clock.
   * @param {any} description @param {number} frame
   */
  async function catchUp(description, frame) {
    let now = description;
    while (now.frame < frame && now.state !== "finished") {
      const step = Math.min(FRAMES_AT_ONCE, frame - now.frame);
      now = await api.changeComparison(description.id, { step });
    }
    return now;
  }

  /**
   * The server has forgotten the comparison: it was started anew, or nobody looked for long. The
   * same one is made again and computed up to where it stood; what was received stays.
   */
  async function resume() {
    const { latest, state } = data;
    const made = await api.createComparison({ ...presentBody(), paused: true });
    const now = await catchUp(made, latest?.frame ?? 0);
    const states = (frame) => JSON.stringify(frame?.methods.map(({ q }) => q));
    data.id = "";
    if (states(now.latest) === states(latest)) {
      receiver.resume(now);
      listen();
      notice(`the server had forgotten this comparison; it was computed again and goes on`);
    } else {
      adopt(made);
      notice("the server has changed and computes other digits: the runs start again");
    }
    if (state === "running") {
      await changeNow({ state });
    }
  }

  /** @param {object} wanted */
  async function changeNow(wanted) {
    receiver.applyDescription(await api.changeComparison(data.id, wanted));
    if (data.state !== "finished") {
      stream?.reopen();
    }
  }

  /**
   * Makes a comparison that the server has forgotten again, changed from its start. Nothing is lost
   * where the server refuses the change: the recording stays, and so does its comparison's id.
   * @param {any} wanted
   */
  async function createChanged({ state, reset: _, ...changed }) {
    adopt(await api.createComparison({ ...presentBody(), ...changed, paused: true }));
    if (state) {
      await changeNow({ state });
    }
  }

  /**
   * A comparison that the server has forgotten is made again first.
   * @param {object} wanted
   */
  async function changeOrRevive(wanted) {
    try {
      await changeNow(wanted);
    } catch (error) {
      if (!(error instanceof Problem) || error.status !== 404 || !data.scene) {
        throw error;
      }
      if (startsAnew(wanted)) {
        await createChanged(wanted);
      } else {
        const { speed } = /** @type {{speed?: number}} */ (wanted);
        receiver.applyState({ speed: speed ?? data.speed }); // chosen now, before it is there again
        await resume();
        await changeNow(wanted);
      }
    }
  }

  /**
   * @param {() => object} ask the change to ask for, worked out when its turn has come
   * @returns {Promise<void>}
   */
  const inTurn = (ask) => inQueue(() => changeOrRevive(ask()));

  /** @param {object} wanted */
  const change = (wanted) => inTurn(() => wanted);

  /**
   * Play, pause or speed that nobody took: kept until the server is back.
   * @param {object} wanted @param {unknown} error
   */
  function keepForLater(wanted, error) {
    if (!(error instanceof Problem) || error.status !== 0 || !isOfClock(wanted)) {
      notice(sentenceOf(error));
      return;
    }
    owed = { ...owed, ...wanted };
    receiver.applyState(wanted);
    notice("the server does not answer: this will be done when it is back");
  }

  return {
    create,
    change,
    /**
     * A change that starts the runs anew: they move if the old ones did. "running" is asked for
     * outright, since the server may have come to an end that the page has not heard of.
     * @param {object} wanted
     */
    restart: (wanted) =>
      inTurn(() =>
        data.state !== "paused" && !data.view.stepped ? { ...wanted, state: "running" } : wanted,
      ),
    /** Computes frames of the clock, to the end of the run at most. @param {number} frames */
    async compute(frames) {
      for (let left = frames; left > 0 && data.state !== "finished"; left -= FRAMES_AT_ONCE) {
        await change({ step: Math.min(left, FRAMES_AT_ONCE) });
      }
    },
    /** A change whose failure has no field of its own. @param {object} wanted */
    changeOrReport: (wanted) => change(wanted).catch((error) => keepForLater(wanted, error)),
    dispose() {
      stream?.dispose();
      if (data.id) {
        api.abandonComparison(data.id);
      }
    },
  };
}

/** @typedef {ReturnType<typeof createExchange>} Exchange */
