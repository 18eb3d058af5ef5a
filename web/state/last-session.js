// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The last state of the page, kept in this browser alone: the fragment of its link.

const KEY = "holonom.last";

/** A browser may forbid storage: then nothing is remembered. @param {() => any} use */
function tried(use) {
  try {
    return use() ?? "";
  } catch {
    return "";
  }
}

/** The fragment that was kept, or "". */
export const lastSession = () => String(tried(() => localStorage.getItem(KEY)));

/** @param {string} fragment */
export const rememberSession = (fragment) => tried(() => localStorage.setItem(KEY, fragment));

export const forgetSession = () => tried(() => localStorage.removeItem(KEY));
