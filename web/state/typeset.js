// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The text of exercises as it reads best: th1 and phi_2 with Greek letters and indices, powers
// raised. What stands in quotes and a line with a command are to be typed as they are, and stay so.

/** Names as they are typed, and their letters. "delta" may be a word, see SYMBOLS. */
const GREEK = {
  alpha: "α",
  beta: "β",
  gamma: "γ",
  theta: "θ",
  th: "θ",
  lambda: "λ",
  mu: "μ",
  rho: "ρ",
  sigma: "σ",
  tau: "τ",
  phi: "φ",
  psi: "ψ",
  omega: "ω",
  zeta: "ζ",
  delta: "δ",
  Phi: "Φ",
};

const SYMBOLS = new RegExp(
  [
    /"[^"\n]*"/, // quoted: as it is
    /(?<greek>GREEK)(?:_?(?<count>\d{1,2})|_(?<word>[a-z]{1,3}))?(?!\w)/,
    /(?<latin>[A-Za-z])(?:(?<number>\d{1,2})|_(?<index>[a-z]{1,3}|\d{1,2}))(?![\w.]\w|")/,
    /(?<dotted>[A-Za-z]|Phi)dot(?!\w)/,
    /delta(?= [A-Za-z]\b)/, // of a quantity; a delta robot stays
  ]
    .map(({ source }) => `(?<![\\w.])${source}`)
    .concat(/(?<=[\w)])\^(?<power>\d)(?!\d)/.source, "(?<= )(?<minus>-)(?= )")
    .join("|")
    .replace(
      "GREEK",
      Object.keys(GREEK)
        .filter((name) => name !== "delta")
        .join("|"),
    ),
  "g",
);
const COMMAND = /^\s*\$?\s*holonom\s/;

/**
 * A piece of text, and whether it stands as an index or as a power.
 * @typedef {{text: string, place: "" | "sub" | "sup"}} Piece
 */

/** @param {RegExpMatchArray} match @returns {Piece[]} */
function piecesOf({ 0: found, groups = {} }) {
  const { greek, count, word, latin, number, index, dotted, power, minus } = groups;
  const low = count ?? word ?? number ?? index;
  if (power) {
    return [{ text: power, place: "sup" }];
  }
  if (greek || latin) {
    /** @type {Piece} */
    const name = { text: GREEK[greek ?? ""] ?? latin, place: "" };
    return low ? [name, { text: low, place: "sub" }] : [name];
  }
  const letter = dotted && `${GREEK[dotted] ?? dotted}\u0307`;
  const sign = minus && "−";
  return [{ text: letter || sign || (found === "delta" ? GREEK.delta : found), place: "" }];
}

/** @param {string} line @returns {Piece[]} */
function setLine(line) {
  if (COMMAND.test(line)) {
    return [{ text: line, place: "" }];
  }
  /** @type {Piece[]} */
  const out = [];
  let from = 0;
  for (const match of line.matchAll(SYMBOLS)) {
    out.push({ text: line.slice(from, match.index), place: "" }, ...piecesOf(match));
    from = match.index + match[0].length;
  }
  return [...out, { text: line.slice(from), place: "" }];
}

/**
 * @param {string} text of an exercise
 * @returns {Piece[]} neighbours of one kind together
 */
export function typeset(text) {
  /** @type {Piece[]} */
  const out = [];
  for (const piece of text.split(/(?<=\n)/).flatMap(setLine)) {
    const last = out[out.length - 1];
    if (last && last.place === piece.place && !piece.place) {
      last.text += piece.text;
    } else if (piece.text) {
      out.push({ ...piece });
    }
  }
  return out;
}
