// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Saves what is on the page: the recording as data, as a film and as a file that plays by itself,
// the drawing as a picture, the scene as a program.
import { sentenceOf } from "../api/client.js";
import { documents } from "../api/documents.js";
import { seconds } from "../state/format.js";
import { toCsv, toNdjson } from "../state/export.js";
import { toReplay } from "../state/replay.js";
import { shownIndex, sourceOf } from "../state/store.js";
import { verdictAt } from "../state/verdict.js";
import { canFilm, makeFilm } from "../widgets/film.js";
import { h, say } from "../widgets/dom.js";
import { baseOf } from "../widgets/pieces.js";
import { standAlone, toPng } from "../widgets/picture.js";
import { saveFile } from "../widgets/save.js";

/** Languages whose programs have no functions without a self-check. */
const WITHOUT_SKELETON = new Set(["modelica", "latex"]);
const PIXELS = 2; // of a picture for each pixel of the page

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {ReturnType<typeof import("./drawing/drawing.js").createDrawing>} mechanism
 */
export function createExportDialog(el, store, actions, mechanism) {
  const data = store.data;
  let stopped = false;
  const text = (make, type) => () => new Blob([make(data)], { type });
  const svg = () => /** @type {SVGSVGElement} */ (mechanism.frame.querySelector(".picture"));

  const solids = () => mechanism.solids(1);
  const picture = () =>
    standAlone(svg(), {
      below: mechanism.solids(PIXELS)?.toDataURL("image/png") ?? "",
      caption: caption(),
    });

  /**
   * Returns what the picture shows: scene, time, and each method that is drawn with its verdict.
   */
  function caption() {
    const { scene, history, methods, view, look, theme, reference } = data;
    const now = shownIndex(data);
    const drawn = methods.flatMap((method, m) => {
      const { [theme]: colour, dash } = look.slots[method.slot];
      const words = `${method.label}: ${verdictAt(data, m, now).words}`;
      return view.hidden.has(m) ? [] : [{ words, colour, dash }];
    });
    const known = view.reference && reference?.state === "ready";
    return {
      title: `${scene.title}, t = ${seconds(history.t[now], data.duration)}`,
      lines: [
        ...drawn,
        ...(known
          ? [{ words: "reference solution", colour: look.reference[theme], dash: [] }]
          : []),
      ],
    };
  }

  /** A film of the whole recording; afterwards the page shows what it showed. */
  async function film() {
    if (!canFilm()) {
      throw new Error("this browser records no film");
    }
    const { history, view } = data;
    const before = view.shown;
    stopped = false;
    try {
      return await makeFilm({
        svg: svg(),
        solids,
        caption,
        duration: history.t[history.count - 1],
        show: (t) => {
          actions.show(history.indexAt(t));
          mechanism.update();
        },
        told: (share) => say(done, `filming: ${Math.round(100 * share)} %`),
        stopped: () => stopped,
      });
    } finally {
      actions.show(before < 0 ? history.count : before);
    }
  }

  function replay() {
    const { stage } = mechanism;
    const { scene } = data;
    const { solid, marks } = baseOf(scene);
    return toReplay(data, {
      size: stage.size,
      point: stage.camera.point,
      radius: stage.pen.radius,
      fixed: [
        ...marks.map((shape) => stage.pen.mark(shape, scene.points)),
        ...solid.map((shape) => stage.pen.outline(shape, scene.points)),
      ],
      verdictAt: (m, i) => verdictAt(data, m, i).words,
    });
  }

  /** @type {{ending: string, word: string, about: string, make: () => Blob | Promise<Blob>}[]} */
  const FORMATS = [
    {
      ending: "csv",
      word: "CSV",
      about:
        "every frame of the recording, a row per method, units in the head: coordinates, " +
        "velocities, error, gap, energy, cost",
      make: text(toCsv, "text/csv"),
    },
    {
      ending: "ndjson",
      word: "NDJSON",
      about: "the same rows, one JSON object per line, in SI units",
      make: text(toNdjson, "application/x-ndjson"),
    },
    {
      ending: "svg",
      word: "SVG",
      about: "the drawing as it is shown now, with time and verdicts, for print",
      make: () => new Blob([picture().text], { type: "image/svg+xml" }),
    },
    {
      ending: "png",
      word: "PNG",
      about: "the same picture, at twice its size",
      make: () => toPng(picture(), PIXELS),
    },
    {
      ending: "webm",
      word: "WebM",
      about:
        "a film of the recording with time and verdicts; it takes as long as it lasts, 20 s at most",
      make: film,
    },
    {
      ending: "html",
      word: "HTML",
      about: "the recording as one file that plays without a server",
      make: () => new Blob([replay()], { type: "text/html" }),
    },
  ];
  const done = h("p", { role: "status", class: "about" });

  /** @param {string} ending @param {() => Blob | Promise<Blob>} make */
  async function write(ending, make) {
    const name = `${data.scene.id}.${ending}`;
    try {
      saveFile(await make(), name);
      say(done, `${name} was saved`);
    } catch (error) {
      say(done, `${name} was not saved: ${sentenceOf(error)}`);
    }
  }

  const rows = FORMATS.map(({ word, about, ending, make }) =>
    h(
      "li",
      {},
      h("button", { type: "button", class: "plain", onclick: () => write(ending, make) }, word),
      h("span", {}, about),
    ),
  );
  const languages = h("select", { id: "export-language", "aria-label": "Language" });
  const blanks = h("input", { type: "checkbox", id: "export-blanks" });
  const solvers = h("select", { id: "export-solver", "aria-label": "Solver" });
  const styles = h(
    "select",
    { id: "export-style", "aria-label": "Style" },
    h("option", { value: "full" }, "with its self-check"),
    h("option", { value: "skeleton" }, "without its self-check"),
  );
  const program = h(
    "li",
    { class: "program" },
    h("button", { type: "button", class: "plain", onclick: writeProgram }, "Program"),
    h("span", {}, "that runs this scene by itself: ", languages, solvers, styles),
    h("label", {}, blanks, " with blanks for students"),
  );
  const formats = h(
    "select",
    { id: "export-format", "aria-label": "Format of the model" },
    h("option", { value: "mjcf" }, "MuJoCo's MJCF"),
    h("option", { value: "urdf" }, "URDF: the tree, without loops"),
  );
  const model = h(
    "li",
    { class: "program" },
    h("button", { type: "button", class: "plain", onclick: writeModel }, "Model"),
    h(
      "span",
      {},
      "the mechanism for another program; its last lines name what it lacks: ",
      formats,
    ),
  );

  /**
   * @type {{name: string, suffix: string, about: string,
   *   solvers: {name: string, about: string}[]}[]}
   */
  let known = [];

  // the solvers of the chosen language; a program with blanks has the first, and keeps its check of
  // itself
  function offerChoices() {
    const chosen = known.find(({ name }) => name === languages.value);
    const before = solvers.value;
    const several = chosen?.solvers ?? [];
    solvers.replaceChildren(
      ...several.map(({ name, about }) => h("option", { value: name }, `${name}: ${about}`)),
    );
    if (several.some(({ name }) => name === before)) {
      solvers.value = before;
    }
    solvers.hidden = several.length === 0 || blanks.checked;
    styles.hidden = blanks.checked || WITHOUT_SKELETON.has(languages.value);
  }
  languages.addEventListener("change", offerChoices);
  blanks.addEventListener("change", offerChoices);

  function writeModel() {
    const format = formats.value;
    return write(format === "urdf" ? "urdf" : "xml", async () => {
      const text = await documents.program({
        scene: sourceOf(data),
        parameters: data.settings,
        format,
      });
      return new Blob([text], { type: "application/xml" });
    });
  }

  function writeProgram() {
    const chosen = known.find(({ name }) => name === languages.value);
    const body = {
      scene: sourceOf(data),
      parameters: data.settings,
      language: languages.value,
      blanks: blanks.checked,
      ...(solvers.hidden ? {} : { solver: solvers.value }),
      ...(styles.hidden ? {} : { style: styles.value }),
      method: data.methods[data.view.selected]?.spelling,
    };
    return write((chosen?.suffix ?? ".txt").slice(1), async () => {
      const code = await documents.program(body);
      return new Blob([code], { type: "text/plain" });
    });
  }

  async function fillLanguages() {
    try {
      known = (await documents.languages()).languages;
      languages.replaceChildren(
        ...known.map(({ name, about }) => h("option", { value: name }, about)),
      );
      offerChoices();
    } catch (error) {
      say(done, sentenceOf(error));
    }
  }

  const dialog = h(
    "dialog",
    {
      class: "dialog export",
      "aria-labelledby": "export-title",
      onclose: () => {
        stopped = true;
      },
    },
    h("h2", { id: "export-title" }, "Save"),
    h("ul", { class: "formats" }, ...rows, program, model),
    done,
    h("form", { method: "dialog", class: "actions" }, h("button", { class: "primary" }, "Close")),
  );
  el.append(dialog);
  return {
    async open() {
      if (data.scene) {
        await actions.pause();
        say(done, "");
        dialog.showModal();
        if (!known.length) {
          fillLanguages();
        }
      }
    },
  };
}
