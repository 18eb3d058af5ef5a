// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged texts, the same each time.

const SIGNS = [..."=%@:,.#+-0x \u0000/é<", "%F", "%00", "set.", "__proto__", "NaN", "1e999"];

/** Whole numbers below n that look random. @param {number} seed @returns {(n: number) => number} */
export function randomFrom(seed) {
  let now = seed;
  return (n) => Math.floor(((now = (now * 48271) % 2147483647) / 2147483647) * n);
}

/**
 * A text with one place that something happened to.
 * @param {string} text @param {(n: number) => number} random
 */
export function damaged(text, random) {
  const at = random(text.length);
  const sign = SIGNS[random(SIGNS.length)];
  return [
    text.slice(0, at) + sign + text.slice(at),
    text.slice(0, at) + sign + text.slice(at + 1),
    text.slice(0, at) + text.slice(at + 1 + random(8)),
    text.slice(at),
    text + text,
  ][random(5)];
}
