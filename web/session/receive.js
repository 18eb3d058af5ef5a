// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Puts into the store what the server reports: descriptions, states, frames, incidents.
import { createHistory } from "../state/history.js";
import { labelsOf, parseSpelling } from "../state/spelling.js";

const MOST_INCIDENTS = 200;

/**
 * A method of the comparison, with its spelling taken apart.
 * @param {any} entry of the comparison's methods
 * @returns {import("../state/store.js").Method}
 */
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

/**
 * A frame whose methods have what the stream adds beside them: the smallest singular value, the
 * condition number and the largest multiplier.
 * @param {any} frame
 * @returns {import("../state/store.js").Frame}
 */
function withExtras({ sigma_min: sigma, lambda, condition, ...frame }) {
  const largest = (list) =>
    list?.length ? Math.max(...list.map((x) => Math.abs(x ?? NaN))) : undefined;
  frame.methods.forEach((method, m) => {
    method.sigma_min = sigma?.[m];
    method.lambda_max = largest(lambda?.[m]);
    method.condition = condition?.[m];
  });
  return frame;
}

/** Do two incidents report the same event? The server repeats one when more is known about it. */
const isSame = (a, b) => a.method === b.method && a.code === b.code && a.t === b.t;

/**
 * @param {import("../state/store.js").Store} store
 * @param {(text: string) => void} notice
 */
export function createReceiver(store, notice) {
  const data = store.data;
  /** id of the newest event contained in an answer: the state in an older event is out of date */
  let covered = 0;
  /** id of the newest event that told a state: the state in an older answer is out of date */
  let stated = 0;
  /** generation whose slowness was shown */
  let slowTold = -1;

  /** The present run becomes the one "before" if only its methods or settings change. */
  function keepBefore(description) {
    if (data.scene?.id !== description.scene.id) {
      data.before = null;
    } else if (data.history?.count > 1) {
      data.before = { methods: data.methods, history: data.history };
    }
  }

  /** Forgets what was shown of methods that are no longer there. */
  function clearView() {
    data.view.shown = -1;
    data.view.why = -1;
    data.view.selected = Math.min(data.view.selected, data.methods.length - 1);
    for (const m of data.view.hidden) {
      if (m >= data.methods.length) {
        data.view.hidden.delete(m);
      }
    }
  }

  /** @param {any} description */
  function startHistory(description) {
    keepBefore(description);

    data.methods = description.comparison.methods.map(readMethod);
    const labels = labelsOf(data.methods);
    data.methods.forEach((method, m) => (method.label = labels[m]));

    data.scene = description.scene;
    const { drawing, coordinates } = description.scene;
    data.history = createHistory(data.methods.length, drawing.points, coordinates.length);
    data.run++;
    data.incidents = [];
    data.latest = null;
    clearView();
  }

  /** @param {boolean} pulled does a hand pull somewhere in this run? */
  function applyPulled(pulled) {
    if (!pulled) {
      data.pulls = [];
    }
    if (data.pulled !== pulled) {
      data.pulled = pulled;
      store.emit("hand");
    }
  }

  /** @param {{state?: string, speed?: number}} change */
  function applyState(change) {
    data.state = change.state ?? data.state;
    data.speed = change.speed ?? data.speed;
    store.emit("state");
  }

  /** @param {import("../state/store.js").Frame} frame */
  function applyFrame(frame) {
    if (frame.generation !== data.generation || !data.history?.push(frame)) {
      return;
    }
    data.latest = frame;
    store.emit("frame");
  }

  /**
   * The answer to a change and the stream arrive in any order: a description older than the newest
   * one changes nothing.
   * @param {any} description
   */
  function applyDescription(description) {
    if (description.last_event < covered) {
      return;
    }
    covered = description.last_event;
    const restarted = description.generation !== data.generation;
    data.generation = description.generation;
    data.settings = description.parameters ?? {};
    applyPulled(description.pulls > 0);
    data.frameDt = description.frame_dt ?? description.comparison.frame_dt;
    data.duration = description.duration ?? description.comparison.duration;
    if (restarted) {
      startHistory(description);
      store.emit("scene");
      store.emit("methods");
    }
    const { state, speed } = description;
    applyState(description.last_event < stated ? { speed } : { state, speed });
    if (restarted && description.latest?.frame === 0) {
      applyFrame(description.latest); // later frames come by the stream, none is left out
    }
  }

  /** @param {any} incident */
  function applyIncident(incident) {
    if (incident.generation !== undefined && incident.generation !== data.generation) {
      return;
    }
    const same = data.incidents.findIndex((other) => isSame(other, incident));
    if (same >= 0) {
      data.incidents[same] = incident; // the outcome of the run is known by now
    } else {
      data.incidents.push(incident);
      data.incidents.splice(0, data.incidents.length - MOST_INCIDENTS);
    }
    store.emit("incident", { incident, again: same >= 0 });
  }

  /** @type {Record<string, (detail: any, id: number) => boolean | void>} */
  const onEvent = {
    hello: ({ description }) => applyDescription(description),
    frame: (frame) => applyFrame(withExtras(frame)),
    slow: ({ generation, detail, hint }) => {
      if (generation === data.generation && slowTold !== generation) {
        slowTold = generation; // once a run: the events go on
        notice(`${detail}; ${hint}`);
      }
    },
    incident: applyIncident,
    reset: ({ description }) => applyDescription(description),
    state: (change, id) => {
      if (id > covered) {
        stated = id;
        applyState(change);
      }
    },
    gap: ({ from, to }) =>
      notice(`the server no longer has events ${from} to ${to}; the curves have a hole there`),
    end: ({ generation, deleted }, id) => {
      if (!deleted && generation !== data.generation) {
        return false;
      }
      stated = Math.max(stated, id);
      // a comparison that the server has closed is not finished: Play makes it again
      applyState({ state: deleted ? "paused" : "finished", speed: data.speed });
      return true;
    },
  };

  return {
    applyDescription,
    applyState,
    /**
     * The comparison made again and brought to where it stood: what was received stays.
     * @param {any} description
     */
    resume(description) {
      data.id = description.id;
      data.generation = description.generation;
      covered = description.last_event;
      stated = 0;
    },
    /** Another comparison: its events are counted from the beginning. @param {string} id */
    begin(id) {
      data.id = id;
      data.generation = -1;
      covered = 0;
      stated = 0;
    },
    /**
     * Takes one event of the stream.
     * @param {string} name
     * @param {any} detail
     * @param {number} id of the event
     * @returns {boolean} true: this was the last event of the comparison
     */
    take: (name, detail, id) => onEvent[name](detail, id) === true,
  };
}
