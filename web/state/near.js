// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Names that a misspelt one may stand for.

const MOST = 3;

/**
 * Returns how many signs must be put in, taken out or changed. @param {string} a @param {string} b
 */
function distance(a, b) {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; i++) {
    const next = [i];
    for (let j = 1; j <= b.length; j++) {
      const change = row[j - 1] + Number(a[i - 1] !== b[j - 1]);
      next.push(Math.min(change, row[j] + 1, next[j - 1] + 1));
    }
    row = next;
  }
  return row[b.length];
}

/**
 * The names nearest to a word, the nearest first: those that it begins or that hold it, and those
 * that differ in a third of its signs at most.
 * @param {string} word
 * @param {string[]} names
 */
export function nearest(word, names) {
  const wanted = word.toLowerCase().slice(0, 60);
  const scored = names.flatMap((name) => {
    const holds = wanted.length > 1 && name.toLowerCase().includes(wanted);
    const away = holds ? 0 : distance(wanted, name.toLowerCase());
    return holds || away <= Math.max(1, wanted.length / 3) ? [{ name, away }] : [];
  });
  return scored
    .sort((a, b) => a.away - b.away)
    .slice(0, MOST)
    .map(({ name }) => name);
}
