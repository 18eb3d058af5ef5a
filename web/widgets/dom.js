// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Small helpers to build elements; no template language, no framework.

const SVG = "http://www.w3.org/2000/svg";

/** @param {Element} node @param {Record<string, any>} attributes */
export function set(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) {
      node.addEventListener(name.slice(2), value);
    } else if (value === false || value === null || value === undefined) {
      node.removeAttribute(name);
    } else {
      node.setAttribute(name, value === true ? "" : String(value));
    }
  }
  return node;
}

/**
 * @template {keyof HTMLElementTagNameMap} T
 * @param {T} tag
 * @param {Record<string, any>} [attributes] `onclick` and the like are listeners
 * @param {...(Node | string)} children
 * @returns {HTMLElementTagNameMap[T]}
 */
export function h(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  set(node, attributes);
  node.append(...children);
  return node;
}

/**
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...(Node | string)} children
 * @returns {any}
 */
export function s(tag, attributes = {}, ...children) {
  const node = document.createElementNS(SVG, tag);
  set(node, attributes);
  node.append(...children);
  return node;
}

/**
 * Text that changes often: touched only when it really changed.
 * @param {Element} node
 * @param {string} text
 */
export function say(node, text) {
  if (node.textContent !== text) {
    node.textContent = text;
  }
}

/**
 * A style sheet of a view that is opened: fetched once.
 * @param {string} href
 * @returns {Promise<void>} when it is here
 */
export function loadStyle(href) {
  if (document.querySelector(`link[href="${href}"]`)) {
    return Promise.resolve();
  }
  return new Promise((resolve, reject) => {
    const failed = () => reject(new Error(`${href} cannot be loaded`));
    document.head.append(
      h("link", { rel: "stylesheet", href, onload: () => resolve(), onerror: failed }),
    );
  });
}

const ICONS = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 5h4v14h-4zM13.5 5h4v14h-4z",
  forward: "M5 5l9 7-9 7zM16 5h3v14h-3z",
  back: "M19 5l-9 7 9 7zM5 5h3v14H5z",
  start: "M20 5l-7 7 7 7zM12 5l-7 7 7 7zM3 5h2v14H3z",
  edit: "M5 16.5V19h2.5L17 9.5 14.500 7zM15.5 6l2.500 2.500 1.300-1.300a1 1 0 0 0 0-1.400l-1.100-1.100a1 1 0 0 0-1.400 0z",
  plus: "M11 5h2v6h6v2h-6v6h-2v-6H5v-2h6z",
  table: "M4 5h16v14H4zM6 10v3h5v-3zM13 10v3h5v-3zM6 15v2h5v-2zM13 15v2h5v-2z",
};

/** @param {keyof typeof ICONS} name */
export function icon(name) {
  return s(
    "svg",
    { viewBox: "0 0 24 24", "aria-hidden": "true", class: "icon" },
    s("path", { d: ICONS[name], "fill-rule": "evenodd" }),
  );
}
