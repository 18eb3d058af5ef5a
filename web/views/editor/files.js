// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The files that the editor opens: a scene, a model of another program, a model with its loop file.
import { h } from "../../widgets/dom.js";

const MODELS = /\.(xml|urdf|mjcf)$/i;

/** Returns whether a text is a model of another program. @param {string} text */
export const isModel = (text) => text.trimStart().startsWith("<");

/** A hidden field that chooses files. @param {(files: File[]) => void} open */
export function createChooser(open) {
  const field = h("input", {
    type: "file",
    accept: ".json,.xml,.urdf,.mjcf",
    multiple: true,
    class: "hidden",
    tabindex: "-1",
    "aria-label": "Scene, MJCF or URDF file",
    onchange: () => {
      const chosen = [...(field.files ?? [])];
      field.value = ""; // the same file can be chosen again
      if (chosen.length) {
        open(chosen);
      }
    },
  });
  return field;
}

/**
 * Tells by names and texts what each file is; `fault` says why they cannot be opened together.
 * @typedef {{name: string, text: string}} Read
 * @param {File[]} files
 * @returns {Promise<{scene?: Read, model?: Read, loops?: Read, fault?: string}>}
 */
export async function sortFiles(files) {
  const read = await Promise.all(
    files.map(async (one) => ({ name: one.name, text: await one.text() })),
  );
  const models = read.filter(({ name, text }) => MODELS.test(name) || isModel(text));
  const others = read.filter((one) => !models.includes(one));
  if (models.length + others.length === 1) {
    return { scene: others[0], model: models[0] };
  }
  if (models.length === 1 && others.length === 1) {
    return { model: models[0], loops: others[0] };
  }
  const names = read.map(({ name }) => `'${name}'`).join(", ");
  return { fault: `${names}: open one file, or a model with its loop file` };
}
