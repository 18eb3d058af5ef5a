// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
import { h } from "./dom.js";

const KEPT_FOR = 1000; // [ms] that the browser needs the address of a file

/** Hands a file to the browser. @param {Blob} blob @param {string} name */
export function saveFile(blob, name) {
  const url = URL.createObjectURL(blob);
  h("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), KEPT_FOR);
}
