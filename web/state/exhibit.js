// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The actions of an exhibit of a lesson: run its comparison, open its scene, its study.
// Where an exhibit gives a command alone, the command says which.

/**
 * `act`: what its button does, "" where there is none; `study`: the kind that is opened; `time`
 * [s], 0: as the scene suggests.
 * @typedef {{
 *   scene: string, methods: string[], settings: Record<string, number>, time: number,
 *   act: "" | "run" | "scene" | "study", study: string,
 * }} Exhibit
 */

/** Commands on one scene that show what the page shows of it. */
const OF_A_SCENE = ["inspect", "terms", "reference", "export"];

/** "l1=1.2" as [name, number]. @param {string} text @returns {[string, number]} */
function readSetting(text) {
  const [name, value] = text.split("=");
  return [name, Number(value)];
}

/** @param {unknown} list words in one string, or a list @returns {string[]} */
const wordsIn = (list) =>
  (Array.isArray(list) ? list : String(list ?? "").split(/\s+/)).filter(Boolean);

/**
 * The words behind every option of a command: {"": before the first one, "--set": ["k=1", "c=2"]}.
 * @param {string[]} words
 */
function byOption(words) {
  /** @type {Record<string, string[]>} */
  const found = { "": [] };
  let option = "";
  for (const word of words) {
    if (word.startsWith("--")) {
      option = word;
      found[option] ??= [];
    } else {
      found[option].push(word);
    }
  }
  return found;
}

/** @param {string} command @returns {Exhibit} */
function readCommand(command) {
  const [name = "", ...words] = wordsIn(command.replace(/^holonom /, ""));
  const { "": plain, ...options } = byOption(words);
  const [scene = "", kind = ""] = plain;
  const found = {
    scene,
    methods: options["--methods"] ?? [],
    settings: Object.fromEntries((options["--set"] ?? []).map(readSetting)),
    time: Number(options["--time"]?.[0]) || 0,
    study: "",
  };
  if (name === "compare" && scene) {
    return { ...found, act: "run" };
  }
  if (name === "study" && kind) {
    return { ...found, act: "study", study: kind };
  }
  return OF_A_SCENE.includes(name) && scene
    ? { ...found, act: "scene" }
    : { ...found, scene: "", act: "" };
}

/** @param {Record<string, any>} block of a lesson @returns {Exhibit} */
export function exhibitOf({ scene, methods, set, time, command }) {
  if (!scene) {
    return readCommand(command ?? "");
  }
  const settings = Object.fromEntries(wordsIn(set).map(readSetting));
  return {
    scene,
    methods: wordsIn(methods),
    settings,
    time: Number(time) || 0,
    act: "run",
    study: "",
  };
}
