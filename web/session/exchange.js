// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Asks the server to make or change the comparison, one request after the other, and keeps the
// event stream open. A request that the server refuses changes nothing; its caller gets the
// Problem.
import { Problem, api, sentenceOf } from "../api/client.js";
import { createStream } from "../api/stream.js";
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

  /** @param {any} description of a comparison that was just made */
  function adopt(description) {
    stream?.dispose();
    stream = null;
    receiver.begin(description.id);
    receiver.applyDescription(description);
    stream = createStream(
      description.id,
      (name, detail, lastId) => {
        data.stream.id = lastId;
        if (receiver.take(name, detail, Number(lastId))) {
          stream?.rest();
        }
      },
      (state, id) => {
        data.stream = { state, id };
        store.emit("stream");
      },
    );
  }

  /** @param {{methods: string[], [key: string]: any}} body */
  async function create(body) {
    const old = data.id;
    const { description, refused } = await withoutRefused(body, (asked) =>
      api.createComparison({ paused: true, ...asked }),
    );
    data.refused = refused;
    adopt(description);
    if (old) {
      api
        .deleteComparison(old)
        .catch(() => notice("the server could not close the previous comparison"));
    }
  }

  /**
   * The server closes a comparison that nobody used for long: the same one is made again.
   * @param {object} change
   */
  async function changeOrRevive(change) {
    try {
      return await api.changeComparison(data.id, change);
    } catch (error) {
      if (!(error instanceof Problem) || error.status !== 404 || !data.scene) {
        throw error;
      }
      data.id = "";
      await create({
        scene: data.scene.id,
        parameters: data.settings,
        methods: data.methods.map((m) => m.spelling),
        speed: data.speed,
      });
      notice("the server had closed this comparison; it was started again");
      return api.changeComparison(data.id, change);
    }
  }

  /**
   * @param {() => object} ask the change to ask for, worked out when its turn has come
   * @returns {Promise<void>}
   */
  function inTurn(ask) {
    const done = queue.then(async () => {
      receiver.applyDescription(await changeOrRevive(ask()));
      if (data.state !== "finished") {
        stream?.reopen();
      }
    });
    queue = done.catch(() => undefined);
    return done;
  }

  /** @param {object} wanted */
  const change = (wanted) => inTurn(() => wanted);

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
    /** A change whose failure has no field of its own. @param {object} wanted */
    changeOrReport: (wanted) => change(wanted).catch((error) => notice(sentenceOf(error))),
    dispose() {
      stream?.dispose();
      if (data.id) {
        api.abandonComparison(data.id);
      }
    },
  };
}

/** @typedef {ReturnType<typeof createExchange>} Exchange */
