// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The scene as a document beside the drawing. Typed text runs as soon as it is a scene; until
// then the last good one goes on, and every fault is named at its line.
import { Problem, sentenceOf } from "../../api/client.js";
import { documents } from "../../api/documents.js";
import { offersAt } from "../../state/completion.js";
import { caretIn, lineOf, parseText, placeOf, placesOf } from "../../state/json-text.js";
import { NEW_SCENE, writeScene } from "../../state/scene-parts.js";
import { listen, madeOf } from "../../state/store.js";
import { counted } from "../../state/format.js";
import { h, say, set } from "../../widgets/dom.js";
import { saveFile } from "../../widgets/save.js";
import { createChooser, isModel, sortFiles } from "./files.js";
import { createOffers } from "./offers.js";
import { createEditorTools } from "./tools.js";

const PAUSE = 450; // [ms] after the last key before the server is asked
const MOST_UNDONE = 100;
const LINE = 20; // [px] the height of a line of the document
const LINES_ABOVE = 5; // a line that is to be seen

/**
 * @param {HTMLElement} el
 * @param {import("../../state/store.js").Store} store
 * @param {import("../../session/session.js").Session} actions
 * @param {Parameters<typeof createEditorTools>[1]} drawing
 */
export function createEditor(el, store, actions, drawing) {
  const data = store.data;
  let schema = null;
  let lastGood = /** @type {any} */ (null);
  let timer = 0;
  let asked = 0;
  /** texts before changes by the mouse, and what ran then @type {{text: string, ran: any}[]} */
  const before = [];

  const field = h("textarea", {
    id: "editor-text",
    class: "editor-text",
    spellcheck: "false",
    autocomplete: "off",
    wrap: "off",
    "aria-label": "Scene document",
    "aria-describedby": "editor-state",
    oninput: onInput,
    onkeydown: onKey,
    onscroll: () => {
      gutter.scrollTop = field.scrollTop;
    },
    onblur: () => offers.close(),
  });
  const gutter = h("div", { class: "editor-lines", "aria-hidden": "true" });
  const state = h("p", { id: "editor-state", role: "status", class: "about" });
  const faults = h("ul", { class: "editor-faults" });
  const offers = createOffers(field, findOffers, takeOffer);
  const tools = createEditorTools(data, drawing, {
    change,
    tell: (text) => say(state, text),
    begin: () => actions.reset(),
  });
  const file = createChooser((files) => openFiles(files));
  const button = (word, tip, onclick) =>
    h("button", { type: "button", class: "quiet", "data-tip": tip, onclick }, word);
  const panel = h(
    "section",
    { class: "editor", "aria-label": "Scene document", hidden: true },
    h(
      "div",
      { class: "card-head" },
      h("h2", {}, "Scene document"),
      tools.node,
      h(
        "div",
        { class: "choices" },
        button("undo", "takes back what was added with the mouse", undo),
        button("new", "a document with one bar", () => put(NEW_SCENE)),
        button(
          "open",
          "a scene, MJCF or URDF file, or a model with its loop file; or drop them on the page",
          () => file.click(),
        ),
        button("save", "the document as a file", save),
        button("close", "the scene goes on running", close),
      ),
    ),
    h("div", { class: "editor-field" }, gutter, field),
    offers.list,
    h("div", { class: "editor-foot" }, state, faults, file),
  );
  el.append(panel);

  function showLines() {
    const count = field.value.split("\n").length;
    const bad = new Set(
      [...faults.querySelectorAll("[data-line]")].map((one) =>
        Number(one.getAttribute("data-line")),
      ),
    );
    gutter.replaceChildren(
      ...Array.from({ length: count }, (_, i) =>
        h("div", { class: bad.has(i + 1) ? "bad" : "" }, String(i + 1)),
      ),
    );
    gutter.scrollTop = field.scrollTop;
  }

  /** @param {{message: string, hint?: string, offset: number}[]} list */
  function showFaults(list) {
    faults.replaceChildren(
      ...list.map(({ message, hint, offset }) => {
        const { line } = lineOf(field.value, offset);
        const go = () => {
          field.focus();
          field.setSelectionRange(offset, offset);
          scrollTo(line);
        };
        return h(
          "li",
          { "data-line": String(line) },
          h("button", { type: "button", class: "quiet", onclick: go }, `line ${line}`),
          h("span", {}, hint ? `${message} (${hint})` : message),
        );
      }),
    );
    set(field, { "aria-invalid": list.length ? "true" : null });
    showLines();
  }

  /** The faults that the server found, each at its place in the text. @param {unknown} error */
  function faultsOf(error) {
    const places = placesOf(field.value);
    const list = error instanceof Problem ? error.errors : [];
    return list.length
      ? list.map(({ detail, hint, pointer = "" }) => ({
          message: detail,
          hint,
          offset: placeOf(places, pointer.replace(/^\/scene/, "")),
        }))
      : [{ message: sentenceOf(error), offset: 0 }];
  }

  /** Runs what stands there, or says why it does not. */
  async function run() {
    clearTimeout(timer);
    if (isModel(field.value)) {
      await importText(field.value, "pasted");
      return;
    }
    const number = ++asked;
    const { value, fault } = parseText(field.value);
    if (fault) {
      showFaults([fault]);
      say(state, "not a scene yet: the last good one runs");
      return;
    }
    say(state, "asking the server");
    try {
      await actions.loadDocument(value, undefined, lastGood);
      if (number === asked) {
        lastGood = value;
        showFaults([]);
        say(state, `runs: ${data.scene.caption}`);
      }
    } catch (error) {
      if (number === asked) {
        showFaults(faultsOf(error));
        say(state, "not a scene yet: the last good one runs");
      }
    }
  }

  function onInput() {
    showLines();
    clearTimeout(timer);
    asked++;
    timer = window.setTimeout(run, PAUSE);
    const caret = field.selectionStart;
    if (/["\w]/.test(field.value[caret - 1] ?? "")) {
      offers.open();
    } else {
      offers.close();
    }
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    if (offers.takeKey(event)) {
      event.preventDefault();
    } else if (event.key === "Escape") {
      close();
    }
  }

  function findOffers() {
    const caret = caretIn(field.value, field.selectionStart);
    return schema ? offersAt(schema, lastGood, caret) : [];
  }

  /** @param {import("../../state/completion.js").Offer} offer */
  function takeOffer({ text, quoted }) {
    const at = field.selectionStart;
    const { from, key } = caretIn(field.value, at);
    const opened = field.value[from - 1] === '"';
    const closed = field.value[at] === '"';
    const whole = quoted ? `${opened ? "" : '"'}${text}${closed ? "" : '"'}` : text;
    const after = field.value.slice(at + Number(closed)).trimStart();
    field.setRangeText(
      `${whole}${key && !after.startsWith(":") && !closed ? ": " : ""}`,
      from,
      at,
      "end",
    );
    if (closed && quoted) {
      field.selectionStart += 1;
    }
    onInput();
    offers.close();
  }

  /** @param {number} line counted from 1 */
  function scrollTo(line) {
    field.scrollTop = Math.max(0, (line - LINES_ABOVE) * LINE);
    gutter.scrollTop = field.scrollTop;
  }

  /** @param {string} text @param {number} [line] that is to be seen */
  function put(text, line = 1) {
    before.push({ text: field.value, ran: madeOf(data) });
    before.splice(0, before.length - MOST_UNDONE);
    field.value = text;
    showLines();
    scrollTo(line);
    return run();
  }

  /** The text before, and what ran with it: the shipped scene, its parameters and the steps. */
  async function undo() {
    const last = before.pop();
    if (!last) {
      return say(state, "nothing to take back");
    }
    clearTimeout(timer); // what was typed last is no longer wanted
    field.value = last.text;
    showFaults([]);
    try {
      await actions.bringBack(last.ran);
      lastGood = parseText(last.text).value ?? lastGood;
      say(state, `taken back; it runs as before: ${data.scene.caption}`);
    } catch (error) {
      say(state, sentenceOf(error));
    }
  }

  /** A part added with the mouse. @param {(scene: any) => any} make */
  function change(make) {
    const { value, fault } = parseText(field.value);
    if (fault || !Array.isArray(value.bodies) || !Array.isArray(value.joints)) {
      say(state, "parts can be added to a document of bodies and joints that has no fault");
      return;
    }
    try {
      const text = `${writeScene(make(value))}\n`;
      const old = writeScene(value).split("\n");
      put(text, 1 + text.split("\n").findIndex((line, i) => line !== old[i]));
    } catch (error) {
      say(state, `this document repeats parts: write the new one by hand (${sentenceOf(error)})`);
    }
  }

  function save() {
    const name = parseText(field.value).value?.name ?? "scene";
    saveFile(new Blob([field.value], { type: "application/json" }), `${name}.json`);
  }

  /** A scene, a model of another program, or a model with its loop file. @param {File[]} files */
  async function openFiles(files) {
    show();
    const { scene, model, loops, fault } = await sortFiles(files);
    if (model) {
      await importText(model.text, model.name, loops);
    } else if (scene) {
      await put(scene.text);
    } else {
      showFaults([]);
      say(state, String(fault));
    }
  }

  /**
   * Puts a model of another program there as a scene, with what was left out.
   * @param {string} text XML @param {string} source a file's name, or what it is called
   * @param {{name: string, text: string}} [loops] the loop file of a model
   */
  async function importText(text, source, loops) {
    const number = ++asked;
    say(state, "asking the server for this model as a scene");
    try {
      const name = source.replace(/\.[^.]*$/, "").replace(/\W+/g, "-");
      const {
        format,
        document: scene,
        notes,
      } = await documents.importModel(text, name, loops?.text);
      if (number !== asked) {
        return; // something else was typed meanwhile
      }
      await put(scene);
      say(
        state,
        `${format}: ${counted(notes.length, "note")} on what is not, or not literally, in the scene`,
      );
      faults.append(
        ...notes.map(({ outcome, line, where, what }) =>
          h("li", {}, h("span", {}, `${outcome}, line ${line} of the file, ${where}: ${what}`)),
        ),
      );
    } catch (error) {
      const list = error instanceof Problem ? error.errors : [];
      const both = loops ? ` with the loop file '${loops.name}'` : "";
      say(state, `the model '${source}'${both} was not read: ${sentenceOf(error)}`);
      faults.replaceChildren(
        ...list.slice(1).map(({ detail }) => h("li", {}, h("span", {}, detail))),
      );
    }
  }

  /** The document of the scene that is shown. */
  async function fill() {
    try {
      const text = data.document
        ? `${writeScene(data.document)}\n`
        : await documents.scene(data.scene.id);
      field.value = text;
      lastGood = parseText(text).value;
      showFaults([]);
      say(state, "this scene as a document: change it, and it runs");
    } catch (error) {
      say(state, sentenceOf(error));
    }
  }

  function show() {
    if (data.view.panel !== "editor") {
      actions.setView({ panel: "editor" });
    }
    obey();
  }
  function close() {
    actions.setView({ panel: "" });
  }
  let isOpen = false;

  /** Opens or closes as the view says. */
  function obey() {
    const wanted = data.view.panel === "editor";
    if (wanted === isOpen) {
      return;
    }
    isOpen = wanted;
    panel.hidden = !wanted;
    document.body.classList.toggle("edits", wanted);
    if (!wanted) {
      tools.choose("");
      document.getElementById("play")?.focus({ preventScroll: true });
    }
  }

  let id = data.scene?.id;
  listen(store, {
    view: obey,
    scene: () => {
      const other = !data.document && data.scene?.id !== id;
      id = data.document ? "" : data.scene?.id;
      const another = data.document && JSON.stringify(data.document) !== JSON.stringify(lastGood);
      const asks = parseText(field.value);
      const typed = asks.fault ? "" : JSON.stringify(asks.value);
      if (!panel.hidden && (other || (another && typed !== JSON.stringify(data.document)))) {
        fill();
      }
    },
  });

  return {
    /** @param {File[]} [dropped] */
    async open(dropped) {
      schema ??= await documents.schema().catch(() => null);
      if (dropped) {
        await openFiles(dropped);
        return;
      }
      show();
      await fill();
      field.focus();
      field.setSelectionRange(0, 0);
      scrollTo(1);
    },
  };
}
