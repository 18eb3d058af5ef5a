// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The one spelling of a method: FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...]. The server
// checks it; the page only takes it apart to change a setting. A program of one's own is spelled
// program:FILE@INTEGRATOR; its file is part of its name.
import { cardOfProgram, isProgram, ownSteps } from "./program-card.js";

/**
 * A setting without "=" has no value: the file of `program:FILE`.
 * @typedef {{name: string, settings: [string, string | undefined][]}} Part
 * @typedef {{formulation: Part, integrator: Part}} Spelling
 */

/** @param {string} text @returns {Part} */
function parsePart(text) {
  const colon = text.indexOf(":");
  const name = colon < 0 ? text : text.slice(0, colon);
  const rest = colon < 0 ? "" : text.slice(colon + 1);
  const settings = rest
    .split(",")
    .filter((item) => item !== "")
    .map((item) => {
      const equals = item.indexOf("=");
      const value = equals < 0 ? undefined : item.slice(equals + 1).trim();
      return /** @type {[string, string | undefined]} */ ([item.split("=")[0].trim(), value]);
    });
  return { name: name.trim(), settings };
}

/** @param {string} text @returns {Spelling} */
export function parseSpelling(text) {
  const at = text.indexOf("@");
  const left = at < 0 ? text : text.slice(0, at);
  return {
    formulation: isProgram(left) ? { name: left.trim(), settings: [] } : parsePart(left),
    integrator: parsePart(at < 0 ? "" : text.slice(at + 1)),
  };
}

/** @param {[string, string | undefined]} setting */
function formatSetting([key, value]) {
  return value === undefined ? key : `${key}=${value}`;
}

/** @param {Part} part */
function formatPart(part) {
  const list = part.settings.map(formatSetting).join(",");
  return list ? `${part.name}:${list}` : part.name;
}

/** @param {Spelling} spelling */
export function formatSpelling(spelling) {
  const right = formatPart(spelling.integrator);
  return `${formatPart(spelling.formulation)}${right ? `@${right}` : ""}`;
}

/**
 * Returns what is known of a formulation or an integrator; a program of one's own has a card too.
 * @param {{formulations: any[], integrators: any[]}} catalogue
 * @param {"formulation" | "integrator"} kind
 * @param {string} name
 */
export function cardOf(catalogue, kind, name) {
  if (kind === "formulation" && isProgram(name)) {
    return cardOfProgram(catalogue, name);
  }
  if (kind === "integrator" && name === ownSteps.name) {
    return ownSteps;
  }
  return (kind === "formulation" ? catalogue.formulations : catalogue.integrators).find(
    (card) => card.name === name,
  );
}

/**
 * Returns what the catalogue says of a setting that this method has; undefined when it has none of
 * that key.
 */
export function settingOf(catalogue, spelling, key) {
  const parsed = parseSpelling(spelling);
  for (const kind of /** @type {const} */ (["formulation", "integrator"])) {
    const card = cardOf(catalogue, kind, parsed[kind].name);
    const info = card?.options.find((setting) => setting.key === key);
    if (info) {
      const written = parsed[kind].settings.find(([name]) => name === key);
      return { kind, info, value: written ? Number(written[1]) : info.default };
    }
  }
  return undefined;
}

/** The spelling with one setting changed; the same spelling when the method has no such setting. */
export function withSetting(catalogue, spelling, key, value) {
  const found = settingOf(catalogue, spelling, key);
  if (!found) {
    return spelling;
  }
  const parsed = parseSpelling(spelling);
  const part = parsed[found.kind];
  const written = part.settings.find(([name]) => name === key);
  if (written) {
    written[1] = value;
  } else {
    part.settings.push([key, value]);
  }
  return formatSpelling(parsed);
}

/**
 * A name for each method that no other shares: the short name, with what sets it apart behind it.
 * @param {{short: string, spelling: string}[]} methods
 */
export function labelsOf(methods) {
  return methods.map((method) => {
    const twins = methods.filter((other) => other !== method && other.short === method.short);
    if (twins.length === 0) {
      return method.short;
    }
    const words = wordsOf(method.spelling);
    const own = words.filter((word) =>
      twins.some((twin) => !wordsOf(twin.spelling).includes(word)),
    );
    return own.length ? `${method.short} ${own.join(" ")}` : method.short;
  });
}

/** @param {string} spelling */
function wordsOf(spelling) {
  const { formulation, integrator } = parseSpelling(spelling);
  return [integrator.name, ...formulation.settings.concat(integrator.settings).map(formatSetting)];
}
