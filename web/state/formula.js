// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Evaluates the formulas that the server prints as text, at a state: sums, products, powers and
// functions of named numbers.

const FUNCTIONS = {
  sin: Math.sin,
  cos: Math.cos,
  tan: Math.tan,
  asin: Math.asin,
  acos: Math.acos,
  atan: Math.atan,
  atan2: Math.atan2,
  sinh: Math.sinh,
  cosh: Math.cosh,
  tanh: Math.tanh,
  exp: Math.exp,
  log: Math.log,
  sqrt: Math.sqrt,
  abs: Math.abs,
};
const TOKEN = /\s*(\d+\.?\d*(?:e[-+]?\d+)?|[A-Za-z_]\w*|[-+*/^(),])/y;

/** @param {string} text @returns {string[]} */
function tokensOf(text) {
  const out = [];
  TOKEN.lastIndex = 0;
  for (let match = TOKEN.exec(text); match; match = TOKEN.exec(text)) {
    out.push(match[1]);
  }
  return out;
}

/**
 * @param {string} text
 * @param {Map<string, number>} values by name
 * @returns {number} NaN where a name is unknown or the text is no formula
 */
export function evaluate(text, values) {
  const tokens = tokensOf(text);
  let at = 0;
  const take = (wanted) => tokens[at] === wanted && Boolean(++at);

  function sum() {
    let value = product();
    for (;;) {
      if (take("+")) {
        value += product();
      } else if (take("-")) {
        value -= product();
      } else {
        return value;
      }
    }
  }

  function product() {
    let value = signed();
    for (;;) {
      if (take("*")) {
        value *= signed();
      } else if (take("/")) {
        value /= signed();
      } else {
        return value;
      }
    }
  }

  /** A sign binds less than a power: -x^2 is -(x^2). */
  const signed = () => (take("-") ? -signed() : power());

  function power() {
    const base = atom();
    return take("^") ? base ** signed() : base;
  }

  function call(name) {
    const list = [sum()];
    while (take(",")) {
      list.push(sum());
    }
    const closed = take(")");
    const made = FUNCTIONS[name];
    return closed && made ? made(...list) : NaN;
  }

  function atom() {
    const token = tokens[at++];
    if (token === "(") {
      const value = sum();
      return take(")") ? value : NaN;
    }
    if (/^\d/.test(token ?? "")) {
      return Number(token);
    }
    return take("(") ? call(token) : (values.get(token ?? "") ?? NaN);
  }

  const value = sum();
  return at === tokens.length ? value : NaN;
}

/** Names in a formula. @param {string} text */
const namesIn = (text) =>
  tokensOf(text).filter((token) => /^[A-Za-z_]/.test(token) && !(token in FUNCTIONS));

/**
 * Accelerations of the velocities that the equations are written in, from those of the coordinates:
 * a velocity of the world is a sum of velocities of coordinates with constant factors, and its
 * acceleration is the same sum.
 * @param {{coordinates?: {name: string, is: string}[], speeds: string[]}} answer
 * @param {import("./types.js").Scene} scene
 * @param {number[]} a by coordinate
 * @returns {number[] | null} in the order of `speeds`; null where the relation is not such a sum
 */
export function accelerationsOf(answer, scene, a) {
  const zero = a.map(() => 0);
  const values = valuesAt(answer, scene, { t: 0, q: zero, v: a });
  const found = answer.speeds.map((name) => values.get(name) ?? NaN);
  return found.every(Number.isFinite) ? found : null;
}

/**
 * Values of all names at a state: parameters, coordinates, velocities, and the angles in the world
 * that the equations use in place of relative ones ("a2 = -th1 + theta_coupler").
 * @param {{coordinates?: {name: string, is: string}[], speeds: string[]}} answer
 * @param {import("./types.js").Scene} scene
 * @param {{t: number, q: ArrayLike<number>, v: ArrayLike<number>}} state
 * @returns {Map<string, number>}
 */
export function valuesAt({ coordinates = [], speeds }, scene, { t, q, v }) {
  const values = new Map([["t", t]]);
  /** rates, by the name of the angle or length they belong to */
  const rates = new Map();
  scene.parameters.forEach(({ name, value }) => values.set(name, value));
  scene.coordinates.forEach(({ name, rate }, i) => {
    values.set(name, q[i]).set(rate, v[i]);
    rates.set(name, v[i]);
  });
  // each line is linear in the one name that it adds; a line may wait for another one
  for (let round = 0; round < coordinates.length; round++) {
    coordinates.forEach(({ name, is }, k) => {
      const unknown = [...new Set(namesIn(is))].filter((one) => !values.has(one));
      const i = scene.coordinates.findIndex((one) => one.name === name);
      if (unknown.length !== 1 || i < 0) {
        return;
      }
      const solve = (known, target) => {
        const rest = evaluate(is, new Map([...known, [unknown[0], 0]]));
        return (target - rest) / (evaluate(is, new Map([...known, [unknown[0], 1]])) - rest);
      };
      values.set(unknown[0], solve(values, q[i]));
      const rate = solve(rates, v[i]);
      rates.set(unknown[0], rate);
      values.set(speeds[k], rate);
    });
  }
  return values;
}
