// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Actions that open a scene: at the start, from the menu, from a link. Makes the link to what is
// shown.
import { Problem, api, sentenceOf } from "../api/client.js";
import { limits, readIndex, studyKinds } from "../state/catalogue.js";
import { plain } from "../state/format.js";
import { LONGEST_NOTE, decodeLink, encodeLink, fits, isLessonAddress } from "../state/link.js";
import { sourceOf } from "../state/store.js";
import { showLesson, showLinked, shownOf } from "../state/shown.js";
import { noStudy } from "../state/studies.js";
import { nearest } from "../state/near.js";
import { isProgram } from "../state/program-card.js";
import { cardOf, parseSpelling, settingOf, withSetting } from "../state/spelling.js";
import { isStart } from "../state/start.js";
import { createKeeper } from "./keeper.js";
import { SHORT, firstSpeed } from "./speeds.js";

const FIRST_SCENE = "four-bar";
const FIRST_METHODS = [
  "index1@rk4:h=0.02",
  "baumgarte:alpha=5,beta=5@rk4:h=0.02",
  "projection@rk4:h=0.02",
  "nullspace@rk4:h=0.02",
  "reduced@rk4:h=0.02",
];

/** @param {{pulls?: number[][]}} [link] */
const pullsOf = (link) => (link?.pulls?.length ? { pulls: link.pulls } : {});

/** @param {{spelling: string}} method */
const spellingOf = ({ spelling }) => spelling;

/**
 * Takes the parameters that the scene does not have, or not with that value, out of a link.
 * @param {{settings: Record<string, number>}} left
 * @param {import("../state/store.js").Parameter[]} parameters of the scene
 * @returns {string[]} a sentence for each
 */
export function dropUnknown(left, parameters) {
  return Object.entries(left.settings).flatMap(([name, value]) => {
    const known = parameters.find((one) => one.name === name);
    if (isStart(name)) {
      return []; // the server names a coordinate that is not there
    }
    if (known && value >= known.min && value <= known.max) {
      return [];
    }
    delete left.settings[name];
    return [
      known
        ? `${name} is ${plain(value)}; ${plain(known.min)} to ${plain(known.max)} is allowed`
        : `the scene has no parameter '${name}'`,
    ];
  });
}

/**
 * Takes the entry that the server refused out of what a link wants: one parameter, one method, or
 * all parameters where none is named.
 * @param {{settings: Record<string, number>, methods: string[]}} left
 * @param {unknown} error
 * @returns {boolean} false: there is nothing to take out
 */
export function dropRefused(left, error) {
  const pointer = error instanceof Problem ? (error.errors[0]?.pointer ?? "") : "";
  const [, kind, name] = pointer.split("/");
  const start = /\/start\/moved\/(.+)$/.exec(pointer);
  if (start && `start.${start[1]}` in left.settings) {
    delete left.settings[`start.${start[1]}`];
    return true;
  }
  if (kind === "parameters" && name in left.settings) {
    delete left.settings[name];
    return true;
  }
  if (kind === "methods" && Number(name) in left.methods) {
    left.methods.splice(Number(name), 1);
    return true;
  }
  const some = Object.keys(left.settings).length > 0;
  left.settings = {};
  return some;
}

/**
 * Is a document the shown scene's own, edited elsewhere than in its list of methods?
 * @param {any} before @param {any} after @param {string} id of the scene that is shown
 */
export const keepsMethods = (before, after, id) =>
  before?.name === id &&
  after?.name === id &&
  JSON.stringify(before.methods) === JSON.stringify(after.methods);

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 * @param {(text: string) => void} notice
 */
export function createSceneActions(store, exchange, notice) {
  const data = store.data;

  /** The methods that the scene suggests, else the first ones that this server knows. */
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

  /** The programs of one's own stay when another scene is opened, at the step of its methods. */
  function withPrograms(methods) {
    const step = methods
      .map((spelling) => settingOf(data.catalogue, spelling, "h"))
      .find((held) => held && held.value > 0)?.value;
    const programs = data.methods
      .map(spellingOf)
      .filter(isProgram)
      .map((text) => (step ? withSetting(data.catalogue, text, "h", String(step)) : text))
      .filter((text) => !methods.includes(text));
    return [...methods.slice(0, limits().methods - programs.length), ...programs];
  }

  /** @param {import("../state/link.js").Linked} link */
  async function runLinked({ frame, selected, hidden }) {
    await exchange.compute(frame);
    const n = data.methods.length;
    data.view.hidden = new Set(hidden.filter((m) => m < n));
    data.view.selected = Math.min(selected, n - 1);
  }

  /**
   * Opens a scene as a link wants it. An entry that the server refuses is left out and named; the
   * others stay.
   * @param {string} id
   * @param {import("../state/link.js").Linked | null} link null: as the scene suggests
   * @param {string[]} faults gets a sentence for every entry left out
   */
  async function loadLinked(id, link, faults) {
    if (!link) {
      await actions.loadScene(id);
      return;
    }
    const left = {
      settings: { ...link.settings },
      methods: [...link.methods],
      speed: link.speed,
      pulls: link.pulls,
    };
    if (Object.keys(left.settings).length > 0) {
      faults.push(...dropUnknown(left, (await api.scene(id)).parameters));
    }
    for (;;) {
      try {
        await actions.loadScene(id, left);
        faults.push(...data.refused.map((one) => `${one.spelling}: ${one.reason}`));
        return;
      } catch (error) {
        faults.push(sentenceOf(error));
        if (!dropRefused(left, error)) {
          await actions.loadScene(id);
          return;
        }
      }
    }
  }

  /** The link to what is shown, without the address. */
  function fragmentOf() {
    const { view, history } = data;
    const last = (history?.count ?? 0) - 1;
    const live = data.latest?.frame ?? 0;
    return encodeLink({
      scene: data.scene.id,
      settings: data.settings,
      methods: data.methods.map(({ spelling }) => spelling),
      frame: view.shown < 0 ? live : history.frameAt(Math.min(view.shown, last)),
      selected: view.selected,
      hidden: [...view.hidden],
      ...shownOf(data),
      pulls: data.pulls,
      note: data.note,
      build: data.build,
    });
  }

  /** A link too long to be sent becomes a file that opens it. @param {string} fragment */
  function saveAsFile(fragment) {
    const address = `${location.origin}${location.pathname}#${fragment}`;
    const page = document.implementation.createHTMLDocument(`holonom: ${data.scene.title}`);
    const link = page.createElement("a");
    link.href = address;
    link.textContent = `Open this comparison: ${data.scene.title}`;
    page.body.append(link);
    const text = `<!doctype html>\n${page.documentElement.outerHTML}\n`;
    store.emit("file", { name: `${data.scene.id}-comparison.html`, type: "text/html", text });
    notice("the link is too long to be sent: it was saved as a file that opens this comparison");
  }

  const keeper = createKeeper(store, fragmentOf);
  const actions = {
    /**
     * Loads everything that the page needs before it can draw.
     * @param {string} fragment of the address: a scene, or a link
     */
    async start(fragment) {
      const [index, look, catalogue, list, lessons] = await Promise.all([
        api.index(),
        api.look(),
        api.methods(),
        api.scenes(),
        api.lessons(),
      ]);
      readIndex(index);
      data.build = index.build;
      data.look = look;
      data.catalogue = catalogue;
      data.scenes = list.scenes.filter((scene) => !scene.errors);
      data.lessons = lessons.lessons;
      data.studies = Object.fromEntries(studyKinds().map(({ name }) => [name, noStudy()]));
      store.emit("ready");
      await actions.openLink(fragment);
      keeper.begin(fragment === "");
    },
    /**
     * Opens the lesson of an address beside the scene that is open, or beside the first one.
     * @param {import("../state/link.js").Linked} link
     */
    async openLesson({ lesson }) {
      if (!data.scene) {
        await actions.loadScene(FIRST_SCENE);
      }
      const [fault] = showLesson(data, lesson);
      data.view.panel = "lessons";
      if (fault) {
        notice(`the link: ${fault}`);
      }
      store.emit("view");
    },
    /**
     * Opens a link. Its bad entries are named in the status line and stay as the scene has them.
     * @param {string} fragment
     */
    async openLink(fragment) {
      const { link, faults } = decodeLink(fragment);
      if (isLessonAddress(fragment)) {
        await actions.openLesson(link);
        return;
      }
      const ids = data.scenes.map(({ id }) => id);
      const id = [link.scene, FIRST_SCENE, ids[0]].find((one) => ids.includes(one)) ?? FIRST_SCENE;
      if (link.scene && id !== link.scene) {
        const near = nearest(link.scene, ids);
        const hint = near.length ? `; did you mean ${near.join(" or ")}?` : ".";
        faults.unshift(`no scene is called '${link.scene}'${hint} The page shows ${id}`);
      }
      if (link.build && link.build !== data.build) {
        faults.push(
          `it was made by build ${link.build}, this is ${data.build}: last digits may differ`,
        );
      }
      if (link.scene) {
        data.note = link.note;
        store.emit("note");
      }
      await loadLinked(id, id === link.scene ? link : null, faults);
      if (id === link.scene) {
        await runLinked(link);
        faults.push(...showLinked(data, link));
      }
      if (faults.length) {
        notice(`the link: ${faults.join("; ")}`);
      } else if (data.note) {
        notice(`notes of this link: ${data.note}`);
      }
      store.emit("view");
    },
    /** @param {string} text written beside the comparison */
    setNote(text) {
      data.note = text.slice(0, LONGEST_NOTE);
      keeper.keepSoon();
    },
    /** Shows what the page showed when it was open last. */
    continueLast() {
      const last = data.offer;
      keeper.endOffer();
      return actions.openLink(last).catch((error) => notice(sentenceOf(error)));
    },
    endOffer: keeper.endOffer,
    /** Copies the link to what is shown, and puts it into the address line. */
    async share() {
      if (data.document) {
        const text = `${JSON.stringify(data.document, null, 2)}\n`;
        store.emit("file", { name: `${data.scene.id}.json`, type: "application/json", text });
        notice("this scene is yours: it was saved as a file; drop it on the page to open it again");
        return;
      }
      const fragment = fragmentOf();
      if (!fits(fragment)) {
        saveAsFile(fragment);
        return;
      }
      window.history.replaceState(window.history.state, "", `#${fragment}`);
      await navigator.clipboard.writeText(location.href).then(
        () => notice("link copied"),
        () => notice("the browser did not let the link be copied: it stands in the address line"),
      );
    },
    /**
     * @param {string} id
     * @param {{settings: Record<string, number>, methods: string[], speed?: number,
     *   pulls?: number[][], end?: number}} [link] in place of what the scene suggests; end: the run
     *   lasts at least so long [s]
     */
    async loadScene(id, link) {
      data.view.lengths = false;
      data.view.hidden.clear();
      data.view.selected = 0;
      const suggested = () =>
        id === FIRST_SCENE ? chooseMethods(null) : api.scene(id).then(chooseMethods);
      const methods = link?.methods.length
        ? link.methods.slice(0, limits().methods)
        : withPrograms(await suggested());
      const duration = data.scenes.find((scene) => scene.id === id)?.duration ?? SHORT;
      const speed = link?.speed || firstSpeed(duration, data.scene?.duration ?? SHORT, data.speed);
      const parameters = link?.settings ?? {};
      const { end = 0 } = link ?? {};
      const longer = end > duration ? { duration: end } : {};
      await exchange.create({ scene: id, methods, speed, parameters, ...longer, ...pullsOf(link) });
    },
    /**
     * Opens a scene that is none of the shipped ones. The one that runs goes on when the server
     * refuses it. The methods on the page stay while a document is edited, with their steps;
     * another document brings its own.
     * @param {any} document
     * @param {{settings: Record<string, number>, methods: string[], pulls?: number[][]}} [link]
     * @param {any} [edited] the document before it was edited
     */
    async loadDocument(document, link, edited) {
      const present = data.methods.map(spellingOf);
      const suggested = document?.methods?.length ? document.methods : present;
      const stays = data.document || keepsMethods(edited, document, data.scene?.id);
      const wanted = link?.methods ?? (stays ? present : suggested);
      const methods = wanted.slice(0, limits().methods);
      const parameters = link?.settings ?? {};
      const { speed } = data;
      await exchange.create({ scene: document, methods, speed, parameters, ...pullsOf(link) });
    },
    endSession: keeper.dispose,
    equations: () => api.equations(sourceOf(data), data.settings),
    /** Every term of the equations at one state. @param {{t: number, state: object}} at */
    terms: (at) => api.terms({ scene: sourceOf(data), parameters: data.settings, ...at }),
  };
  return actions;
}
