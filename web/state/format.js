// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Numbers as people read and type them.

const PREFIXES = { f: -15, p: -12, n: -9, µ: -6, u: -6, m: -3, "": 0, k: 3, M: 6, G: 9 };
const SHOWN = [
  [-15, "f"],
  [-12, "p"],
  [-9, "n"],
  [-6, "µ"],
  [-3, "m"],
  [0, ""],
  [3, "k"],
  [6, "M"],
  [9, "G"],
];
/** A number of so many digits is the same after it has been a double. */
const DECIMAL = 15;
const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/**
 * Below this a gap [m] is rounding: some hundred roundings of coordinates of a metre or so. What a
 * stabilised method holds
 * above it is truncation, however small, and is not called closed.
 */
export const ROUNDING = 1e-13;

/** The smallest prefix is nano; below it one would pretend to a size that can be pictured. */
const SMALLEST_PREFIXED = 1e-9;

/** 10 to the n, in words of one line: 10⁻⁴. @param {number} n */
export function powerOfTen(n) {
  const digits = [...String(Math.abs(n))].map((d) => SUPERSCRIPT[Number(d)]).join("");
  return `10${n < 0 ? "⁻" : ""}${digits}`;
}

const GREEK = { alpha: "α", beta: "β", gamma: "γ", lambda: "λ", omega: "ω", phi: "φ" };
/** A Greek letter by its name; not the name of an option, as in alpha=5. */
const GREEK_WORD = /(?<![\w:,])(alpha|beta|gamma|lambda|omega|phi)(?![\w=])/g;

const RAISED = { ...[...SUPERSCRIPT], p: "ᵖ", k: "ᵏ", n: "ⁿ", "-": "⁻", "+": "" };

/**
 * Powers that were typed, as they are printed: h^p t^2 becomes hᵖ t², and 1e-04 becomes 10⁻⁴.
 * @param {string} text
 */
export function withPowers(text) {
  return text
    .replace(/\^(-?\d+|[pkn]\b)/g, (_, power) => [...power].map((c) => RAISED[c]).join(""))
    .replace(GREEK_WORD, (_, word) => GREEK[word])
    .replace(/(?<![=\w.])1e([-+]\d\d)\b/g, (_, power) => powerOfTen(Number(power)));
}

/**
 * A bound, as the next 1, 2 or 5 times a power of ten: 20 pm, 10⁻¹³ m.
 * @param {number} value above 0
 * @param {string} unit
 */
export function bound(value, unit) {
  const [digit, power] = niceAbove(value).toExponential(0).split("e").map(Number);
  const prefixed = value > SMALLEST_PREFIXED / 2;
  const factor = digit === 1 ? "" : `${digit}×`;
  return prefixed
    ? quantity(digit * 10 ** power, unit, 1)
    : `${factor}${powerOfTen(power)} ${unit}`;
}

/** Digits and a power of ten: 4.4×10⁻¹⁶. @param {number} value @param {number} [digits] */
export function scientific(value, digits = 2) {
  if (value === 0) {
    return "0";
  }
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${mantissa.replace("-", "−")}×${powerOfTen(Number(exponent))}`;
}

/** The range that is read at a glance without a power of ten. */
const BARE = [1e-3, 1e5];

/** A number without a unit. @param {number} value @param {number} rounded @param {number} digits */
function bare(value, rounded, digits) {
  if (rounded < BARE[0] || rounded >= BARE[1]) {
    return scientific(value, Math.min(2, digits));
  }
  const before = Math.floor(Math.log10(rounded) + 1e-9) + 1;
  const text = rounded.toFixed(Math.max(0, digits - before));
  return `${value < 0 ? "−" : ""}${text}`;
}

/**
 * With an SI prefix so that one to three digits stand before the point: 4.2 mm. Below 1e-9 as a
 * power of ten. A number without a unit has no prefix: 0.80, 1200, 3.0×10⁶.
 * @param {number | null | undefined} value
 * @param {string} unit
 * @param {number} [digits] significant
 */
export function quantity(value, unit, digits = 2) {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return "–";
  }
  const size = Math.abs(value);
  if (size === 0) {
    return `0 ${unit}`.trimEnd();
  }
  const rounded = Number(size.toPrecision(digits));
  if (!unit) {
    return bare(value, rounded, digits);
  }
  if (size < SMALLEST_PREFIXED || rounded >= 1e12) {
    return `${scientific(value, Math.min(2, digits))} ${unit}`;
  }
  const exponent = Math.floor(Math.log10(rounded) / 3 + 1e-9) * 3;
  const [power, prefix] = SHOWN.find(([e]) => e === exponent) ?? SHOWN[5];
  const scaled = rounded / 10 ** Number(power);
  const before = Math.floor(Math.log10(scaled) + 1e-9) + 1;
  const text = scaled.toFixed(Math.max(0, digits - before));
  return `${value < 0 ? "−" : ""}${text} ${prefix}${unit}`.trimEnd();
}

/**
 * A gap, or an energy change; near rounding it has one digit: more of them mean nothing.
 * @param {number} value @param {string} [unit]
 */
export const gapWords = (value, unit = "m") =>
  quantity(value, unit, Math.abs(value) < SMALLEST_PREFIXED ? 1 : 2);

/** "1 point", "3 points" @param {number} n @param {string} noun */
export const counted = (n, noun) => `${plain(n)} ${noun}${n === 1 ? "" : "s"}`;

/** A plain number as a person would type it back: 0.02, 5, 1e-6. @param {number} value */
export function plain(value) {
  const text = String(Number(value.toPrecision(12)));
  return Math.abs(value) < 1e-4 && value !== 0
    ? Number(value.toPrecision(12)).toExponential()
    : text;
}

/**
 * @param {number} t [s]
 * @param {number} [span] [s] of the whole run: the shorter, the more decimals
 */
export function seconds(t, span = 10) {
  const more = span > 0 && span < 2 ? Math.max(0, Math.ceil(0.5 - Math.log10(span))) : 0;
  return `${t.toFixed(2 + more)} s`;
}

/** m/s^2 as it is written by hand: m/s². @param {string} unit */
export function prettyUnit(unit) {
  return unit.replaceAll("^2", "²").replaceAll("^3", "³").replaceAll("*", "·");
}

/** Other units that people type, by the unit that is asked for, and how many of it they are. */
const TYPED = {
  m: { in: 0.0254, ft: 0.3048, cm: 0.01, dm: 0.1 },
  kg: { g: 1e-3, t: 1e3, lb: 0.45359237 },
  N: { lbf: 4.4482216152605 },
  "N·m": {
    Nm: 1,
    "N·cm": 0.01,
    "N·mm": 1e-3,
    "lb·in": 0.1129848290276167,
    "lbf·in": 0.1129848290276167,
    "lb·ft": 1.3558179483314,
    "lbf·ft": 1.3558179483314,
  },
  "N/m": { "N/mm": 1e3, "N/cm": 100, "lb/in": 175.126835246476, "lbf/in": 175.126835246476 },
  "N·m/rad": { "N·m/deg": 180 / Math.PI, "N·m/°": 180 / Math.PI },
  "kg·m²": { "kg·cm²": 1e-4, "g·cm²": 1e-7, "lb·in²": 2.92639653e-4, "lb·ft²": 0.0421401101 },
  s: { min: 60 },
  rad: { deg: Math.PI / 180, "°": Math.PI / 180 },
  "rad/s": { "deg/s": Math.PI / 180, "°/s": Math.PI / 180, rpm: Math.PI / 30 },
  "m/s": { "km/h": 1 / 3.6, "cm/s": 0.01 },
};

/**
 * Reads "0.02", "0,02", "2e-2 s", "20 ms", "45 cm", "30 deg", "5 lb in". The unit may be left out;
 * a unit of another quantity is refused.
 * @param {string} text
 * @param {string} unit
 * @returns {number} NaN when it is no number in this unit
 */
export function parseQuantity(text, unit) {
  const match = /^\s*([-+−]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+−]?\d+)?)\s*(\D?.*?)\s*$/.exec(
    text,
  );
  if (!match) {
    return NaN;
  }
  const value = Number(match[1].replace(",", ".").replaceAll("−", "-"));
  const tail = prettyUnit(match[2]).replace(/\s+/g, "·");
  if (tail === "" || tail === unit) {
    return value;
  }
  if (tail in (TYPED[unit] ?? {})) {
    return times(value, TYPED[unit][tail]);
  }
  const prefix = unit && tail.endsWith(unit) ? tail.slice(0, -unit.length) : null;
  return prefix !== null && prefix in PREFIXES ? times(value, 10 ** PREFIXES[prefix]) : NaN;
}

/**
 * A product of decimal numbers as by hand: 57 cm are 0.57 m, not 0.5700000000000001 m. A factor
 * that is no short decimal, as of degrees, keeps all its digits.
 * @param {number} value @param {number} factor
 */
function times(value, factor) {
  const short = factor === Number(factor.toPrecision(DECIMAL));
  return short ? Number((value * factor).toPrecision(DECIMAL)) : value * factor;
}

/** The largest of 1, 2, 5 times a power of ten that is not above x. @param {number} x > 0 */
export function niceBelow(x) {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-12);
  const lead = x / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

/** The smallest of 1, 2, 5 times a power of ten that is not below x. @param {number} x > 0 */
export function niceAbove(x) {
  const low = niceBelow(x);
  if (low >= x * (1 - 1e-9)) {
    return low;
  }
  const lead = Math.round(low / 10 ** Math.floor(Math.log10(low) + 1e-9));
  return low * (lead === 2 ? 2.5 : 2);
}

/** A magnification in one word: ×20, ×5 million is written ×5·10⁶. @param {number} m */
export function magnification(m) {
  if (m < 10000) {
    return `×${m}`;
  }
  const exponent = Math.floor(Math.log10(m) + 1e-9);
  const lead = Math.round(m / 10 ** exponent);
  return lead === 1 ? `×${powerOfTen(exponent)}` : `×${lead}·${powerOfTen(exponent)}`;
}
