// @ts-check
// What the page can do: actions that ask the server and put its answers into the store. A change that the server refuses
// changes nothing here either, and is handed back as a Problem for the field that asked.
import { Problem, api, sentenceOf } from "../api/client.js";
import { createStream } from "../api/stream.js";
import { niceBelow } from "./format.js";
import { createReactionFeed } from "./reaction-feed.js";
import { createReferenceFeed } from "./reference.js";
import { createStudyFeed } from "./studies.js";
import { decodeLink, encodeLink, fits } from "./link.js";
import { createHistory } from "./history.js";
import { cardOf, labelsOf, parseSpelling, withSetting } from "./spelling.js";

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];
const MOST_INCIDENTS = 200;
const SHORT = 2; // [s]: a run of less is shown slowly, so that there is something to see
const SHOWN_FOR = 5; // [s]
export const MOST_METHODS = 8;
const MOST_STEPS = 600; // frames that the server takes in one request
const PANELS = /** @type {const} */ (["labels", "traces", "reference", "arrows", "reactions"]);

const FIRST_SCENE = "four-bar";
const FIRST_METHODS = [
  "index1@rk4:h=1e-3",
  "baumgarte:alpha=5,beta=5@rk4:h=1e-3",
  "projection@rk4:h=1e-3",
  "nullspace@rk4:h=1e-3",
  "reduced@rk4:h=1e-3",
];

/** One press of Play when motion is unwelcome [s]. @param {number} duration of the run [s] */
export const stepSeconds = (duration) => Math.min(0.1, niceBelow(duration / 20 || 0.1));

/** The speed at which a run of this duration is shown first. @param {number} duration [s] @param {number} before [s] of the scene before @param {number} now */
const firstSpeed = (duration, before, now) =>
  duration < SHORT
    ? ([...SPEEDS].reverse().find((speed) => speed <= (1.3 * duration) / SHOWN_FOR) ?? SPEEDS[0])
    : before < SHORT
      ? 1
      : now;

/** Which of the methods the server refused to run on the scene, or -1. @param {unknown} error */
function refusedPlace(error) {
  const pointer = error instanceof Problem ? (error.errors[0]?.pointer ?? "") : "";
  const match = /^\/methods\/(\d+)$/.exec(pointer);
  return match ? Number(match[1]) : -1;
}

/** @param {import("./store.js").Store} store */
export function createSession(store) {
  const data = store.data;
  /** @type {ReturnType<typeof createStream> | null} */
  let stream = null;
  /** changes go out one after the other, in the order of asking */
  let queue = Promise.resolve();
  /** the speed that was asked for and not answered yet, or 0: quick presses count from it */
  let asked = 0;
  /** the newest event that an answer takes in: what an older one tells of the state is past */
  let covered = 0;
  const endReactions = createReactionFeed(store);
  const reference = createReferenceFeed(store);
  const studies = createStudyFeed(store);
  const wantedSpeed = () => asked || data.speed;

  /** @param {string} text */
  function notice(text) {
    data.notice = text;
    store.emit("notice");
  }

  // ---- what the server tells ------------------------------------------------------------------------------------

  /** @param {any} entry of the comparison's methods @returns {import("./store.js").Method} */
  function readMethod(entry) {
    const spelling = entry.method.spelling;
    const parsed = parseSpelling(spelling);
    return {
      ...entry,
      spelling,
      title: entry.method.title,
      label: entry.short,
      formulation: parsed.formulation.name,
      integrator: parsed.integrator.name,
    };
  }

  /** @param {any} description */
  function startHistory(description) {
    if (data.scene?.id !== description.scene.id) {
      data.before = null;
    } else if (data.history?.count > 1) {
      data.before = { methods: data.methods, history: data.history };
    }
    data.methods = description.comparison.methods.map(readMethod);
    const labels = labelsOf(data.methods);
    data.methods.forEach((method, m) => (method.label = labels[m]));
    data.scene = description.scene;
    const { drawing, coordinates } = description.scene;
    data.history = createHistory(data.methods.length, drawing.points, coordinates.length);
    data.run++;
    data.incidents = [];
    data.latest = null;
    data.view.shown = -1;
    data.view.why = -1;
    data.view.selected = Math.min(data.view.selected, data.methods.length - 1);
    for (const m of data.view.hidden) {
      if (m >= data.methods.length) {
        data.view.hidden.delete(m);
      }
    }
  }

  /** The answer to a change and the stream come in any order: what is older than what is known says nothing. @param {any} description */
  function applyDescription(description) {
    if (description.last_event < covered) {
      return;
    }
    covered = description.last_event;
    const restarted = description.generation !== data.generation;
    data.generation = description.generation;
    data.settings = description.settings ?? {};
    data.frameDt = description.frame_dt ?? description.comparison.frame_dt;
    data.duration = description.duration ?? description.comparison.duration;
    if (restarted) {
      startHistory(description);
      store.emit("scene");
      store.emit("methods");
    }
    applyState(description);
    if (restarted && description.latest?.frame === 0) {
      applyFrame(description.latest); // later ones come by the stream, none left out
    }
  }

  /** @param {{state: string, speed: number}} change */
  function applyState(change) {
    data.state = change.state ?? data.state;
    data.speed = change.speed ?? data.speed;
    store.emit("state");
  }

  /** @param {import("./store.js").Frame} frame */
  function applyFrame(frame) {
    if (frame.generation !== data.generation || !data.history?.push(frame)) {
      return;
    }
    data.latest = frame;
    store.emit("frame");
  }

  /** @param {any} incident */
  function applyIncident(incident) {
    if (incident.generation !== undefined && incident.generation !== data.generation) {
      return;
    }
    const same = data.incidents.findIndex(
      ({ method, code, t }) =>
        method === incident.method && code === incident.code && t === incident.t,
    );
    if (same >= 0) {
      data.incidents[same] = incident; // what became of the run is known by now
    } else {
      data.incidents.push(incident);
      data.incidents.splice(0, data.incidents.length - MOST_INCIDENTS);
    }
    store.emit("incident", { incident, again: same >= 0 });
  }

  /** @type {Record<string, (detail: any, id: number) => void>} */
  const onEvent = {
    hello: ({ description }) => applyDescription(description),
    frame: applyFrame,
    incident: applyIncident,
    reset: ({ description }) => applyDescription(description),
    state: (change, id) => {
      if (id > covered) {
        applyState(change);
      }
    },
    gap: ({ from, to }) =>
      notice(`the server no longer has events ${from} to ${to}; the curves have a hole there`),
    end: ({ generation, deleted }) => {
      if (deleted || generation === data.generation) {
        stream?.rest();
        applyState({ state: "finished", speed: data.speed });
      }
    },
  };

  // ---- asking the server ----------------------------------------------------------------------------------------

  /** @param {any} description of a comparison that was just made */
  function adopt(description) {
    stream?.dispose();
    stream = null;
    data.id = description.id;
    data.generation = -1;
    covered = 0;
    applyDescription(description);
    stream = createStream(
      description.id,
      (name, detail, lastId) => {
        data.stream.id = lastId;
        onEvent[name](detail, Number(lastId));
      },
      (state, id) => {
        data.stream = { state, id };
        store.emit("stream");
      },
    );
  }

  /**
   * Asks with a list of methods; those that the scene cannot serve are left out, with their reasons, and the others go on.
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
        .catch(() => notice("the comparison before this one could not be ended"));
    }
  }

  /** The server forgets a comparison that nobody touched for long: the same one is made again. @param {object} change */
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
        settings: data.settings,
        methods: data.methods.map((m) => m.spelling),
        speed: data.speed,
      });
      notice("the server had closed this comparison; it was started again");
      return api.changeComparison(data.id, change);
    }
  }

  /** @param {() => object} ask what to ask for, told when its turn has come @returns {Promise<void>} */
  function inTurn(ask) {
    const done = queue.then(async () => {
      applyDescription(await changeOrRevive(ask()));
      if (data.state !== "finished") {
        stream?.reopen();
      }
    });
    queue = done.catch(() => undefined);
    return done;
  }

  /** @param {object} wanted */
  const change = (wanted) => inTurn(() => wanted);

  /**
   * A change that starts the runs anew: they move if the old ones did, to their end or until now. It is asked for outright,
   * since the server may have come to an end that the page has not heard of. @param {object} wanted
   */
  function restart(wanted) {
    return inTurn(() =>
      data.state !== "paused" && !data.view.stepped ? { ...wanted, state: "running" } : wanted,
    );
  }

  /** An action whose failure has no field of its own. @param {object} wanted */
  function changeOrTell(wanted) {
    return change(wanted).catch((error) => notice(sentenceOf(error)));
  }

  function chooseMethods(scene) {
    const known = FIRST_METHODS.filter((spelling) => {
      const parsed = parseSpelling(spelling);
      return (
        cardOf(data.catalogue, "formulation", parsed.formulation.name) &&
        cardOf(data.catalogue, "integrator", parsed.integrator.name)
      );
    });
    return scene?.methods?.length ? scene.methods : known;
  }

  /** What a link says; what it says wrongly is named, and stays as the scene has it. @param {string} fragment */
  async function openLink(fragment) {
    const { link, faults } = decodeLink(fragment);
    const ids = data.scenes.map(({ id }) => id);
    const id = [link.scene, FIRST_SCENE, ids[0]].find((one) => ids.includes(one)) ?? FIRST_SCENE;
    if (link.scene && id !== link.scene) {
      faults.unshift(`no scene is called '${link.scene}'`);
    }
    if (link.build && link.build !== data.build) {
      faults.push(`it was made by build ${link.build}, this is ${data.build}: last digits may differ`);
    }
    Object.assign(data.view, Object.fromEntries(PANELS.map((name) => [name, link.show.includes(name)])));
    try {
      await actions.loadScene(id, id === link.scene ? link : undefined);
    } catch (error) {
      faults.unshift(sentenceOf(error));
      await actions.loadScene(id);
    }
    if (id === link.scene) {
      await showLinked(link);
    }
    if (faults.length) {
      notice(`the link: ${faults.join("; ")}`);
    }
    store.emit("view");
  }

  /** @param {import("./link.js").Linked} link */
  async function showLinked({ frame, selected, hidden, study }) {
    for (let left = frame; left > 0; left -= MOST_STEPS) {
      await change({ step: Math.min(left, MOST_STEPS) });
      if (data.state === "finished") {
        break;
      }
    }
    const n = data.methods.length;
    data.view.hidden = new Set(hidden.filter((m) => m < n));
    data.view.selected = Math.min(selected, n - 1);
    data.view.study = study;
  }

  const actions = {
    /** Everything the page needs before it can draw. @param {string} fragment of the address: a scene, or a link */
    async start(fragment) {
      const [index, look, catalogue, list, lessons] = await Promise.all([
        api.index(),
        api.look(),
        api.methods(),
        api.scenes(),
        api.lessons(),
      ]);
      data.build = index.version ?? index.build ?? "";
      data.look = look;
      data.catalogue = catalogue;
      data.scenes = list.scenes.filter((scene) => !scene.errors);
      data.lessons = lessons.lessons;
      store.emit("ready");
      await openLink(fragment);
    },
    openLink,
    /** The address of what is shown: copied, and put where the browser keeps it. */
    async share() {
      const { view, history } = data;
      const last = (history?.count ?? 0) - 1;
      const fragment = encodeLink({
        scene: data.scene.id,
        settings: data.settings,
        methods: data.methods.map(({ spelling }) => spelling),
        frame: view.shown < 0 ? (data.latest?.frame ?? 0) : history.frameAt(Math.min(view.shown, last)),
        selected: view.selected,
        hidden: [...view.hidden],
        show: PANELS.filter((name) => view[name]),
        study: view.study,
        build: data.build,
      });
      if (!fits(fragment)) {
        notice("this comparison is too long for a link: take fewer methods or parameters");
        return;
      }
      window.history.replaceState(null, "", `#${fragment}`);
      await navigator.clipboard.writeText(location.href).then(
        () => notice("link copied"),
        () => notice("the browser did not let the link be copied: it stands in the address line"),
      );
    },
    /** @param {string} id @param {{settings: Record<string, number>, methods: string[]}} [link] in place of what the scene suggests */
    async loadScene(id, link) {
      data.view.hidden.clear();
      data.view.selected = 0;
      const suggested = () =>
        id === FIRST_SCENE ? chooseMethods(null) : api.scene(id).then(chooseMethods);
      const methods = link?.methods.length
        ? link.methods.slice(0, MOST_METHODS)
        : await suggested();
      const duration = data.scenes.find((scene) => scene.id === id)?.duration ?? SHORT;
      const speed = firstSpeed(duration, data.scene?.duration ?? SHORT, data.speed);
      await create({ scene: id, methods, speed, settings: link?.settings ?? {} });
    },
    play() {
      data.view.shown = -1;
      if (data.view.stepped && data.state !== "finished") {
        return actions.step(Math.max(1, Math.round(stepSeconds(data.duration) / data.frameDt)));
      }
      return changeOrTell(
        data.state === "finished"
          ? { reset: true, state: data.view.stepped ? "paused" : "running" }
          : { state: "running" },
      );
    },
    pause: () => changeOrTell({ state: "paused" }),
    toggle: () => (data.state === "running" ? actions.pause() : actions.play()),
    /** Through what was received while it lasts, then by asking for more. @param {number} frames */
    step(frames) {
      const last = (data.history?.count ?? 0) - 1;
      const shown = data.view.shown < 0 ? last : data.view.shown;
      if (data.state === "running") {
        return actions.pause();
      }
      if (frames < 0 || shown < last) {
        actions.show(shown + frames);
        return Promise.resolve();
      }
      return data.state === "finished" ? Promise.resolve() : changeOrTell({ step: frames });
    },
    /** Shows a kept frame. @param {number} index */
    show(index) {
      const last = (data.history?.count ?? 0) - 1;
      data.view.shown = index >= last ? -1 : Math.max(0, index);
      store.emit("frame");
    },
    /** @param {number} t [s] */
    async showTime(t) {
      if (data.state === "running") {
        await actions.pause();
      }
      if (data.history) {
        actions.show(data.history.indexAt(t));
      }
    },
    reset: () => changeOrTell({ reset: true, state: "paused" }),
    slower: () =>
      actions.setSpeed([...SPEEDS].reverse().find((speed) => speed < wantedSpeed()) ?? SPEEDS[0]),
    faster: () =>
      actions.setSpeed(SPEEDS.find((speed) => speed > wantedSpeed()) ?? SPEEDS[SPEEDS.length - 1]),
    /** @param {number} speed */
    async setSpeed(speed) {
      asked = speed;
      await changeOrTell({ speed });
      asked = asked === speed ? 0 : asked;
    },
    /** @param {string[]} spellings */
    async setMethods(spellings) {
      await restart({ methods: spellings });
      const there = data.methods.map(({ spelling }) => spelling);
      actions.setRefused(data.refused.filter(({ spelling }) => !there.includes(spelling)));
    },
    /** @param {import("./store.js").Refused[]} refused */
    setRefused(refused) {
      data.refused = refused;
      store.emit("view");
    },
    /** One setting of every method that has it. @param {string} key @param {number} value @param {string} [and] another key */
    setSetting(key, value, and) {
      const change = (spelling) => withSetting(data.catalogue, spelling, key, String(value));
      const changeBoth = (spelling) =>
        and ? withSetting(data.catalogue, change(spelling), and, String(value)) : change(spelling);
      return actions.setMethods(data.methods.map(({ spelling }) => changeBoth(spelling)));
    },
    /** @param {string} name @param {number} value */
    setParameter: (name, value) => restart({ settings: { ...data.settings, [name]: value } }),
    resetParameters: () => restart({ settings: {} }),
    /** A thing to try from a card. @param {import("./words.js").Try} item */
    async attempt(item) {
      if (item.key) {
        await actions
          .setSetting(item.key, Number(item.value), item.and)
          .catch((error) => notice(sentenceOf(error)));
        return;
      }
      if (item.method) {
        const wanted = parseSpelling(item.method).formulation.name;
        const spellings = data.methods.map(({ spelling }) => spelling);
        const same = data.methods.findIndex(({ formulation }) => formulation === wanted);
        const place = same >= 0 ? same : Math.min(spellings.length, MOST_METHODS - 1);
        spellings[place] = item.method;
        await actions.setMethods(spellings).catch((error) => notice(sentenceOf(error)));
        actions.select(place);
      }
    },
    /** @param {number} m */
    select(m) {
      if (m < data.methods.length) {
        data.view.selected = m;
        data.view.hidden.delete(m);
        store.emit("view");
      }
    },
    cycle: () => actions.select((data.view.selected + 1) % data.methods.length),
    /** @param {number} m @param {boolean} visible */
    setVisible(m, visible) {
      data.view.hidden[visible ? "delete" : "add"](m);
      store.emit("view");
    },
    /** @param {Partial<typeof data.view>} change */
    setView(change) {
      Object.assign(data.view, change);
      store.emit("view");
    },
    /** For parameters of one's own. */
    computeReference: () => reference.compute(),
    studies,
    equations: () => api.equations(data.scene?.id ?? "", data.settings),
    /** Every term at one state. @param {{t: number, state: Record<string, number>}} at */
    terms: (at) => api.terms({ scene: data.scene?.id ?? "", settings: data.settings, ...at }),
    notice,
    dispose() {
      endReactions();
      reference.dispose();
      studies.dispose();
      stream?.dispose();
      if (data.id) {
        api.abandonComparison(data.id);
      }
    },
  };
  return actions;
}

/** @typedef {ReturnType<typeof createSession>} Session */
