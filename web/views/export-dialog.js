// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Saves what is on the page: the recording as CSV or NDJSON, the drawing as SVG or PNG.
import { toCsv, toNdjson } from "../state/export.js";
import { sentenceOf } from "../api/client.js";
import { h, say } from "../widgets/dom.js";
import { standAlone, toPng } from "../widgets/picture.js";
import { saveFile } from "../widgets/save.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createExportDialog(el, store, actions) {
  const data = store.data;
  const text = (make, type) => () => new Blob([make(data)], { type });
  const picture = () =>
    standAlone(/** @type {SVGSVGElement} */ (document.querySelector(".stage .picture")));
  /** @type {{ending: string, word: string, about: string, make: () => Blob | Promise<Blob>}[]} */
  const FORMATS = [
    {
      ending: "csv",
      word: "CSV",
      about: "every frame of the recording, a row per method: coordinates, velocities, gap, energy",
      make: text(toCsv, "text/csv"),
    },
    {
      ending: "ndjson",
      word: "NDJSON",
      about: "the same rows, one JSON object per line",
      make: text(toNdjson, "application/x-ndjson"),
    },
    {
      ending: "svg",
      word: "SVG",
      about: "the drawing as it is shown now, for print",
      make: () => new Blob([picture().text], { type: "image/svg+xml" }),
    },
    {
      ending: "png",
      word: "PNG",
      about: "the drawing as it is shown now, at twice its size",
      make: () => toPng(picture()),
    },
  ];
  const done = h("p", { role: "status", class: "about" });

  /** @param {typeof FORMATS[number]} format */
  async function write({ ending, make }) {
    const name = `${data.scene.id}.${ending}`;
    try {
      saveFile(await make(), name);
      say(done, `${name} was saved`);
    } catch (error) {
      say(done, `${name} was not saved: ${sentenceOf(error)}`);
    }
  }

  const rows = FORMATS.map((format) =>
    h(
      "li",
      {},
      h("button", { type: "button", class: "plain", onclick: () => write(format) }, format.word),
      h("span", {}, format.about),
    ),
  );
  const dialog = h(
    "dialog",
    { class: "dialog export", "aria-labelledby": "export-title" },
    h("h2", { id: "export-title" }, "Save"),
    h("ul", { class: "formats" }, ...rows),
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
      }
    },
  };
}
