// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Folds products of sines and cosines in printed formulas: sin a sin b + cos a cos b is cos(a - b).

/**
 * The notation of a formula: what joins factors, and sine and cosine of a name.
 * @typedef {{times: string, sine: (name: string) => string, cosine: (name: string) => string,
 *   read: RegExp, sum: RegExp,
 *   of: (fn: string, a: string, sign: string, b: string) => string}} Writing
 * read: a sine or cosine; sum: what stands in brackets as a factor
 */

/** @type {Writing} */
export const TEX = {
  times: "\\, ",
  read: /^\\(sin|cos) (\\?[A-Za-z]\w*(?:_\{[^{}]*\})?)$/,
  sum: /^\\left\((.*)\\right\)$/,
  sine: (name) => `\\sin ${name}`,
  cosine: (name) => `\\cos ${name}`,
  of: (fn, a, sign, b) => `\\${fn}(${a} ${sign} ${b})`,
};
/** @type {Writing} */
export const PLAIN = {
  times: "*",
  read: /^(sin|cos)\((\w+)\)$/,
  sum: /^\((.*)\)$/,
  sine: (name) => `sin(${name})`,
  cosine: (name) => `cos(${name})`,
  of: (fn, a, sign, b) => `${fn}(${a} ${sign} ${b})`,
};

/** The parts of a sum outside all brackets, with their signs. @param {string} text */
function termsOf(text) {
  const terms = [];
  let depth = 0;
  let from = 0;
  let sign = "+";
  for (let i = 0; i < text.length; i++) {
    depth += "({".includes(text[i]) ? 1 : ")}".includes(text[i]) ? -1 : 0;
    const next = text.slice(i, i + 3);
    if (depth === 0 && (next === " + " || next === " - ")) {
      terms.push({ sign, text: text.slice(from, i) });
      sign = next[1];
      i += 2;
      from = i + 1;
    }
  }
  terms.push({ sign, text: text.slice(from) });
  const [first] = terms;
  if (first.text.startsWith("-")) {
    first.sign = "-";
    first.text = first.text.slice(1);
  }
  return terms;
}

/** The factors of a product outside all brackets. @param {string} text @param {string} times */
function factorsOf(text, times) {
  const factors = [];
  let depth = 0;
  let from = 0;
  for (let i = 0; i < text.length; i++) {
    depth += "({".includes(text[i]) ? 1 : ")}".includes(text[i]) ? -1 : 0;
    if (depth === 0 && text.startsWith(times, i)) {
      factors.push(text.slice(from, i));
      from = i + times.length;
      i = from - 1;
    }
  }
  return [...factors, text.slice(from)];
}

/**
 * A product: two functions of angles, and everything else.
 * @param {{sign: string, text: string}} term @param {Writing} writing
 */
function productOf({ sign, text }, { times, read }) {
  const factors = factorsOf(text, times);
  const found = factors.map((factor) => read.exec(factor));
  const angles = found.flatMap((match) => (match ? [{ fn: match[1], of: match[2] }] : []));
  const rest = factors.filter((_, i) => !found[i]);
  return { sign, text, angles, rest: rest.join(times), key: rest.toSorted().join(times) };
}

/**
 * A product of an angle's function and a sum, multiplied out; any other term as it is.
 * @param {{sign: string, text: string}} term @param {Writing} writing
 */
function multipliedOut(term, { times, read, sum }) {
  const factors = factorsOf(term.text, times);
  const k = factors.findIndex((factor) => sum.test(factor));
  if (k < 0 || !factors.some((factor) => read.test(factor))) {
    return [term];
  }
  const outside = factors.toSpliced(k, 1);
  const [, inside] = /** @type {RegExpExecArray} */ (sum.exec(factors[k]));
  return termsOf(inside).map(({ sign, text }) => ({
    sign: sign === term.sign ? "+" : "-",
    text: [...outside, text].join(times),
  }));
}

const COUNTED = /\b(?:sin|cos)\b/g;
/** @param {string} text */
const functionsIn = (text) => text.match(COUNTED)?.length ?? 0;

/** Returns what a pair of products is together, or "". */
function pairOf(a, b, writing) {
  if (a.angles.length !== 2 || b.angles.length !== 2 || a.key !== b.key) {
    return "";
  }
  const [one, two] = a.angles;
  const same = b.angles.find(({ of }) => of === one.of);
  const other = b.angles.find(({ of }) => of === two.of);
  if (!same || !other || one.of === two.of || one.fn === same.fn || two.fn === other.fn) {
    return "";
  }
  const alike = a.sign === b.sign;
  const lead = (x) => [a.rest, x].filter(Boolean).join(writing.times);
  if (one.fn === two.fn) {
    // cos cos + sin sin; the sign is that of cos cos
    const { sign } = one.fn === "cos" ? a : b;
    return `${sign} ${lead(writing.of("cos", one.of, alike ? "-" : "+", two.of))}`;
  }
  // sin x cos y - cos x sin y; x is the one whose sine stands in the first product
  const [x, y] = one.fn === "sin" ? [one.of, two.of] : [two.of, one.of];
  if (alike) {
    return `${a.sign} ${lead(writing.of("sin", x, "+", y))}`;
  }
  return `+ ${lead(a.sign === "+" ? writing.of("sin", x, "-", y) : writing.of("sin", y, "-", x))}`;
}

/**
 * @param {string} text a sum of products
 * @param {Writing} writing
 * @returns {string} the same value, folded where it can be
 */
export function foldAngles(text, writing) {
  const inner = text.replace(
    /(\\left\()([^()]*)(\\right\))/g,
    (_, open, sum, close) => `${open}${foldAngles(sum, writing)}${close}`,
  );
  const terms = termsOf(inner);
  const kept = foldTerms(terms, writing);
  const open = foldTerms(
    terms.flatMap((term) => multipliedOut(term, writing)),
    writing,
  );
  return functionsIn(open) < functionsIn(kept) ? open : kept;
}

/** @param {{sign: string, text: string}[]} terms @param {Writing} writing */
function foldTerms(terms, writing) {
  const products = terms.map((term) => productOf(term, writing));
  const out = [];
  while (products.length) {
    const first = /** @type {ReturnType<typeof productOf>} */ (products.shift());
    const k = products.findIndex((other) => pairOf(first, other, writing) !== "");
    out.push(
      k < 0 ? `${first.sign} ${first.text}` : pairOf(first, products.splice(k, 1)[0], writing),
    );
  }
  const whole = out.join(" ");
  return whole.startsWith("+ ") ? whole.slice(2) : whole.replace(/^- /, "-");
}
