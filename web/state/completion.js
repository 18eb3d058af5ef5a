// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Completions at the caret of a scene document: names and values of the schema, and names that
// the document itself gives.

/**
 * @typedef {{text: string, about: string, quoted: boolean}} Offer
 * @typedef {any} Schema
 */

const MOST = 40;

/** A schema with its references followed, and its alternatives beside it. @returns {Schema[]} */
function alternatives(root, schema, depth = 0) {
  if (!schema || depth > 8) {
    return [];
  }
  const own = schema.$ref
    ? alternatives(root, root.$defs[schema.$ref.split("/").pop()], depth + 1)
    : [];
  const more = [...(schema.oneOf ?? []), ...(schema.anyOf ?? []), ...(schema.allOf ?? [])];
  return [schema, ...own, ...more.flatMap((one) => alternatives(root, one, depth + 1))];
}

/** The schemas of the value at a path. @param {Schema} root @param {string[]} path */
function schemasAt(root, path) {
  return path.reduce(
    (list, part) =>
      list.flatMap((schema) => {
        const next = schema.properties?.[part] ?? (schema.items || schema.additionalProperties);
        return typeof next === "object" ? alternatives(root, next) : [];
      }),
    alternatives(root, root),
  );
}

/** Names that a member with this key may refer to. @param {any} scene */
function namesFor(key, scene) {
  const list = (value) => (Array.isArray(value) ? value : []);
  const bodies = list(scene?.bodies).map(({ name }) => name);
  const joints = list(scene?.joints);
  const known = {
    body: ["ground", ...bodies],
    joint: joints.map(({ name }) => name),
    coordinate: joints.flatMap(({ coordinate, coordinates = [] }) => [coordinate, ...coordinates]),
    coordinates: joints.flatMap(({ coordinate, coordinates = [] }) => [coordinate, ...coordinates]),
  };
  return (known[key] ?? []).filter((name) => typeof name === "string");
}

/**
 * @param {Schema} schema of scene files
 * @param {any} scene the last one that could be read
 * @param {import("./json-text.js").Caret} caret
 * @returns {Offer[]}
 */
export function offersAt(schema, scene, caret) {
  const here = schemasAt(schema, caret.path);
  /** @type {Map<string, Offer>} */
  const offers = new Map();
  const add = (text, about, quoted) => {
    if (!offers.has(text) || !offers.get(text)?.about) {
      offers.set(text, { text, about, quoted });
    }
  };
  if (caret.key) {
    for (const { properties = {} } of here) {
      for (const [name, inner] of Object.entries(properties)) {
        if (!caret.inside.includes(name)) {
          const about = alternatives(schema, inner).find(({ description }) => description);
          add(name, about?.description ?? "", true);
        }
      }
    }
    const block = caret.path[caret.path.length - 1];
    if (block === "positions" || block === "rates") {
      const field = block === "rates" ? "rate" : "coordinate";
      (scene?.joints ?? []).forEach((joint) => joint[field] && add(joint[field], "", true));
    }
  } else {
    for (const one of here) {
      (one.enum ?? []).forEach((value) => add(String(value), one.description ?? "", true));
      if (one.type === "boolean") {
        ["true", "false"].forEach((value) => add(value, one.description ?? "", false));
      }
    }
    const part = caret.path[caret.path.length - 1] ?? "";
    const key = /^\d+$/.test(part) ? caret.path[caret.path.length - 2] : part;
    namesFor(key, scene).forEach((name) =>
      add(name, `a ${key.replace(/s$/, "")} of this scene`, true),
    );
    Object.keys(scene?.parameters ?? {})
      .filter(() => here.some(({ type }) => Array.isArray(type)))
      .forEach((name) => add(name, "a parameter of this scene", true));
  }
  const typed = caret.typed.toLowerCase();
  return [...offers.values()]
    .filter(({ text }) => text.toLowerCase().includes(typed) && text !== caret.typed)
    .sort(
      (a, b) =>
        Number(b.text.toLowerCase().startsWith(typed)) -
        Number(a.text.toLowerCase().startsWith(typed)),
    )
    .slice(0, MOST);
}
