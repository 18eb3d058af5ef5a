// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Puts the page together: one store, one session, the views, the keys, one drawing per animation
// frame.
import { sentenceOf } from "./api/client.js";
import { createSession } from "./session/session.js";
import { createTrail } from "./session/trail.js";
import { createStore } from "./state/store.js";
import { findKey } from "./state/keys.js";
import { createControls } from "./views/controls.js";
import { createDrawing } from "./views/drawing/drawing.js";
import { createEquations } from "./views/equations.js";
import { createGuide } from "./views/guide.js";
import { createHappening } from "./views/happening.js";
import { createHeader } from "./views/header.js";
import { createLook } from "./views/look.js";
import { createMethods } from "./views/methods.js";
import { createNotes } from "./views/notes.js";
import { createParameters } from "./views/parameters.js";
import { createPlots } from "./views/plots.js";
import { createReactions } from "./views/reactions.js";
import { createStatus } from "./views/status.js";
import { createTear } from "./views/tear.js";
import { createTransport } from "./views/transport.js";
import { createUndoButtons } from "./views/undo.js";
import { createVerdictBar } from "./views/verdict-bar.js";
import { createWhyCard } from "./views/why-card.js";
import { acceptFiles } from "./widgets/drop.js";
import { loadStyle } from "./widgets/dom.js";
import { saveFile } from "./widgets/save.js";
import { createTheme } from "./widgets/theme.js";
import { createTips } from "./widgets/tips.js";

const store = createStore();
const session = createSession(store);
const theme = createTheme(store);
createTips(document.body);
/** @type {HTMLElement} */ (document.querySelector(".waiting")).textContent =
  "The page waits for the answer of the server.";
store.data.view.stepped = matchMedia("(prefers-reduced-motion: reduce)").matches;

/** @param {string} id */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/**
 * A view that is made when it is first opened; its modules are loaded then, not before.
 * @template {any[]} A
 * @param {() => Promise<{open: (...how: A) => void}>} make
 * @returns {(...how: A) => void} opens it
 */
function onDemand(make) {
  /** @type {Promise<{open: (...how: A) => void}> | null} */
  let made = null;
  return (...how) => {
    made ??= make();
    made
      .then((view) => view.open(...how))
      .catch((error) => {
        made = null;
        session.notice(sentenceOf(error));
      });
  };
}

const openMethod = onDemand(async () => {
  const { createMethodDialog } = await import("./views/method-dialog.js");
  return createMethodDialog(document.body, store, session);
});
const openKeys = onDemand(async () => {
  const { createKeysDialog } = await import("./views/keys-dialog.js");
  return createKeysDialog(document.body, store, session);
});
const openExport = onDemand(async () => {
  const { createExportDialog } = await import("./views/export-dialog.js");
  return createExportDialog(document.body, store, session, mechanism);
});
/** A view with a style sheet of its own. @param {string} sheet @param {() => Promise<any>} make */
const styled = (sheet, make) =>
  onDemand(async () => {
    const [view] = await Promise.all([make(), loadStyle(`style/${sheet}.css`)]);
    return view;
  });
const openGallery = styled("gallery", async () => {
  const { createGallery } = await import("./views/gallery.js");
  return createGallery(document.body, store, session);
});
const openStudy = onDemand(async () => {
  const { createStudies } = await import("./views/studies.js");
  return createStudies(document.body, store, session);
});

/** @param {string} study */
const showStudy = (study) => session.setView({ study });
/** Keys that open something; all others are actions of the session. */
const OPENERS = { help: openKeys, study: showStudy };
const guide = createGuide(store, session, { openStudy: showStudy });
const mechanism = createDrawing(at("mechanism"), store, session);
const openEditor = styled("editor", async () => {
  const { createEditor } = await import("./views/editor/editor.js");
  return createEditor(document.body, store, session, mechanism);
});
const openLessons = styled("lessons", async () => {
  const { createLessons } = await import("./views/lessons/lessons.js");
  return createLessons(document.body, store, session);
});
acceptFiles(document.body, openEditor);

/** The panels that are open over the page; once made, each follows the view by itself. */
let over = { study: "", panel: "", gallery: false };
store.on("view", () => {
  const { study, panel, gallery } = store.data.view;
  const before = over;
  over = { study, panel, gallery };
  if (study && study !== before.study) {
    openStudy(study);
  }
  if (panel && panel !== before.panel) {
    (panel === "lessons" ? openLessons : openEditor)();
  }
  if (gallery && !before.gallery) {
    openGallery();
  }
});
const views = [
  createHeader(at("top"), store, session, {
    toggleTheme: theme.toggle,
    openKeys,
    openStudy: showStudy,
    openExport,
    openGallery: () => session.setView({ gallery: true }),
    openEditor: () => session.setView({ panel: "editor" }),
    openLessons: () => session.setView({ panel: "lessons" }),
    openGuide: guide.open,
  }),
  mechanism,
  createTear(/** @type {HTMLElement} */ (document.querySelector(".stage")), store, mechanism.stage),
  createLook(at("mechanism"), store, session),
  createTransport(at("transport"), store, session),
  createMethods(at("method-list"), store, session, openMethod),
  createWhyCard(at("methods"), store, session),
  createControls(at("controls"), store, session),
  createParameters(
    { wide: at("methods"), narrow: /** @type {HTMLElement} */ (document.querySelector(".stage")) },
    /** @type {HTMLElement} */ (document.querySelector(".mechanism .choices")),
    store,
    session,
  ),
  createUndoButtons(
    /** @type {HTMLElement} */ (document.querySelector(".undo-tools")),
    store,
    session,
  ),
  createVerdictBar(at("verdict"), store),
  createHappening(at("happening"), store, session),
  createNotes(at("notes"), store, session),
  createPlots(at("plots"), store, session),
  createReactions(at("reactions"), store, session),
  createEquations(at("equations"), store, session),
  createStatus(at("status"), document.body, store, session),
];

store.on("file", ({ name, type, text }) => saveFile(new Blob([text], { type }), name));

let drawing = 0;
store.on("frame", () => {
  if (!drawing) {
    drawing = requestAnimationFrame(() => {
      drawing = 0;
      views.forEach((view) => view.update());
    });
  }
});

/**
 * Where a key means something of its own: the page keeps out of it.
 * @param {KeyboardEvent} event
 */
function takesKey(event) {
  const target = /** @type {HTMLElement} */ (event.target);
  if (target.closest("dialog, input:not([type=checkbox]), select, textarea, [contenteditable]")) {
    return true;
  }
  const pressable = target.closest("button, a, summary, input");
  return Boolean(pressable) && (event.key === " " || event.key === "Enter");
}

/** Control with Z and Y means the same wherever nothing is typed. @param {KeyboardEvent} event */
function undoes(event) {
  const on = (event.ctrlKey || event.metaKey) && !event.altKey && !takesKey(event);
  const key = event.key.toLowerCase();
  return !on
    ? ""
    : key === "y" || (key === "z" && event.shiftKey)
      ? "redo"
      : key === "z"
        ? "undo"
        : "";
}

addEventListener("keydown", (event) => {
  const move = undoes(event);
  if (move) {
    event.preventDefault();
    session[move]();
    return;
  }
  const key =
    event.defaultPrevented || takesKey(event) ? undefined : findKey(event, store.data.view.letters);
  if (key) {
    event.preventDefault();
    (OPENERS[key.action] ?? session[key.action])(key.argument);
  }
});
addEventListener("pagehide", (event) => {
  if (!event.persisted) {
    session.dispose();
  }
});

try {
  await session.start(location.hash.slice(1));
  createTrail(store, session);
  at("main").setAttribute("aria-busy", "false");
  guide.begin(/** @type {HTMLElement} */ (document.querySelector(".mechanism")));
  at("play").focus({ preventScroll: true });
} catch (error) {
  at("main").setAttribute("aria-busy", "false");
  document.body.prepend(theme.failure(sentenceOf(error)));
}

/** For whoever drives the page: the data it shows. */
Object.assign(globalThis, { holonom: { data: store.data } });
