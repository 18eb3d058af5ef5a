// SPDX-License-Identifier: GPL-3.0-or-later
// The page's own modules, without a browser: keys, numbers, spellings, history, words.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import {
  bound,
  magnification,
  niceAbove,
  niceBelow,
  parseQuantity,
  plain,
  powerOfTen,
  quantity,
  scientific,
  withPowers,
} from "../../web/state/format.js";
import { evaluate } from "../../web/state/formula.js";
import { createHistory, thin } from "../../web/state/history.js";
import { KEYS, bindingOf, findKey, isCharacter } from "../../web/state/keys.js";
import {
  formatSpelling,
  labelsOf,
  parseSpelling,
  settingOf,
  withSetting,
} from "../../web/state/spelling.js";
import { incidentOf, limits, readIndex } from "../../web/state/catalogue.js";
import { cardOfMethod, groupIncidents, tryOfRemedy } from "../../web/state/cards.js";
import { sentences, trendOf, verdictAt } from "../../web/state/verdict.js";
import { predictionAt, stopReason } from "../../web/state/words.js";
import { choosePartner, faultOf, misfit, misfitsOf } from "../../web/state/pairs.js";
import { decodeLink, encodeLink, fits } from "../../web/state/link.js";

const CATALOGUE = {
  formulations: [
    { name: "index1", options: [] },
    {
      name: "baumgarte",
      options: [
        { key: "alpha", default: 5 },
        { key: "beta", default: 5 },
      ],
    },
  ],
  integrators: [{ name: "rk4", options: [{ key: "h", default: null }] }],
};

test("no key is bound twice in a context", () => {
  const bindings = KEYS.map(bindingOf);
  assert.deepEqual(bindings, [...new Set(bindings)]);
});

test("the browser keeps Tab, and Control keeps its meanings", () => {
  assert.ok(KEYS.every(({ key }) => key !== "Tab"));
  const event = { key: "-", shiftKey: false, ctrlKey: true, altKey: false, metaKey: false };
  assert.equal(findKey(event, true), undefined);
});

test("a single character can be switched off, Space and the arrows stay", () => {
  const press = (key, letters) =>
    findKey({ key, shiftKey: false, ctrlKey: false, altKey: false, metaKey: false }, letters)
      ?.action;
  assert.equal(press("3", true), "select");
  assert.equal(press("3", false), undefined);
  assert.equal(press("-", false), undefined);
  assert.equal(press(" ", false), "toggle");
  assert.equal(press("ArrowRight", false), "step");
  assert.equal(KEYS.filter(isCharacter).length, 18);
});

test("a number is read as people type it, and only in its unit", () => {
  const cases = [
    ["0,02", "s", 0.02],
    ["2e-2 s", "s", 0.02],
    ["20 ms", "s", 0.02],
    ["20ms", "s", 0.02],
    [" 5 ", "1/s", 5],
    ["−3", "1/s", -3],
    [".5", "", 0.5],
    ["0", "s", 0],
    ["9.8 m/s^2", "m/s²", 9.8],
    ["20 m", "s", NaN],
    ["45 cm", "m", 0.45],
    ["10 in", "m", 0.254],
    ["30 deg", "rad", Math.PI / 6],
    ["30°", "rad", Math.PI / 6],
    ["60 rpm", "rad/s", 2 * Math.PI],
    ["500 g", "kg", 0.5],
    ["2 lb", "kg", 0.90718474],
    ["30 deg", "m", NaN],
    ["two", "s", NaN],
    ["", "s", NaN],
    ["1 2", "s", NaN],
    ["0x10", "s", NaN],
  ];
  for (const [text, unit, value] of cases) {
    assert.ok(
      Object.is(parseQuantity(text, unit), value) ||
        Math.abs(parseQuantity(text, unit) - value) < 1e-15,
      `${text} [${unit}]`,
    );
  }
});

test("a quantity has one to three digits before the point", () => {
  assert.equal(quantity(0.0042, "m"), "4.2 mm");
  assert.equal(quantity(1.3e-6, "s"), "1.3 µs");
  assert.equal(quantity(0.9996, "m"), "1.0 m");
  assert.equal(quantity(999.6e-6, "m", 3), "1.00 mm");
  assert.equal(quantity(-0.57, "J"), "−570 mJ");
  assert.equal(quantity(73, "J"), "73 J");
  assert.equal(quantity(0, "m"), "0 m");
  assert.equal(quantity(4.4e-16, "m"), "4.4×10⁻¹⁶ m");
  assert.equal(quantity(NaN, "m"), "–");
  for (let e = -11; e <= 11; e++) {
    for (const lead of [1, 2.34, 5.5, 9.9, 9.94]) {
      assert.match(quantity(lead * 10 ** e, "m"), /^\d{1,3}(\.\d)? ?[fpnµmkMG]?m$/);
    }
  }
});

test("powers, round numbers and magnifications", () => {
  assert.equal(powerOfTen(-16), "10⁻¹⁶");
  assert.equal(scientific(-4.44e-16), "−4.4×10⁻¹⁶");
  assert.deepEqual([0.99, 1, 1.7, 2, 4.9, 5, 9.9, 10].map(niceBelow), [0.5, 1, 1, 2, 2, 5, 5, 10]);
  assert.deepEqual([0.99, 1, 1.7, 2, 4.9, 5, 9.9, 10].map(niceAbove), [1, 1, 2, 2, 5, 5, 10, 10]);
  assert.equal(magnification(20), "×20");
  assert.equal(magnification(5e6), "×5·10⁶");
  assert.equal(plain(0.02), "0.02");
  assert.equal(plain(1e-6), "1e-6");
});

test("a spelling taken apart and put together is the same", () => {
  for (const spelling of [
    "index1@rk4:h=1e-3",
    "baumgarte:alpha=20,beta=5@rk4:h=0.01",
    "reduced@dop853:rtol=1e-10",
  ]) {
    assert.equal(formatSpelling(parseSpelling(spelling)), spelling);
  }
});

test("one setting changes and the others stay", () => {
  assert.equal(
    withSetting(CATALOGUE, "baumgarte:beta=7@rk4:h=1e-3", "alpha", "20"),
    "baumgarte:beta=7,alpha=20@rk4:h=1e-3",
  );
  assert.equal(withSetting(CATALOGUE, "index1@rk4:h=1e-3", "alpha", "20"), "index1@rk4:h=1e-3");
  assert.equal(settingOf(CATALOGUE, "baumgarte@rk4:h=1e-3", "alpha").value, 5);
  assert.equal(settingOf(CATALOGUE, "baumgarte:alpha=8@rk4:h=1e-3", "alpha").value, 8);
});

test("methods that share a short name are told apart", () => {
  const methods = [
    { short: "index-1", spelling: "index1@rk4:h=1e-3" },
    { short: "index-1", spelling: "index1@euler:h=1e-3" },
    { short: "reduced", spelling: "reduced@rk4:h=1e-3" },
  ];
  assert.deepEqual(labelsOf(methods), ["index-1 rk4", "index-1 euler", "reduced"]);
});

const frame = (k, gap, extra = {}) => ({
  frame: k,
  t: k / 60,
  methods: [
    {
      state: "running",
      t: k / 60,
      points: [k, 0, 0],
      gap,
      velocity_gap: gap,
      energy_change: 0,
      ops: k,
      evals: k,
      cpu: k,
      steps: k,
      ...extra,
    },
  ],
});

test("a history takes each frame once, in order", () => {
  const history = createHistory(1, 1);
  assert.deepEqual(
    [0, 1, 1, 0, 2].map((k) => history.push(frame(k, 1))),
    [true, true, false, false, true],
  );
  assert.equal(history.count, 3);
});

test("a full history keeps the whole span at half the resolution", () => {
  const history = createHistory(1, 1);
  for (let k = 0; k < 20000; k++) {
    history.push(frame(k, k));
  }
  assert.ok(history.count <= 8192);
  assert.equal(history.t[0], 0);
  assert.ok(history.t[history.count - 1] > 19990 / 60);
  for (let i = 0; i < history.count; i++) {
    assert.equal(history.columns[0].gap[i], i * history.stride);
    assert.equal(history.pointsAt(0, i)[0], i * history.stride);
  }
});

test("a failed method ends with its last good values, has no curve after it, and keeps its points", () => {
  const failed = (k) => ({
    ...frame(k, 1),
    methods: [{ state: "failed", t: 0.01, gap: 9, steps: 1 }],
  });
  const history = createHistory(1, 1);
  history.push(frame(0, 1));
  history.push(failed(1));
  history.push(failed(2));
  assert.equal(history.columns[0].gap[1], 9);
  assert.ok(Number.isNaN(history.columns[0].gap[2]));
  assert.deepEqual([...history.pointsAt(0, 2)], [0, 0, 0]);
  assert.equal(history.ended[0], 0.01);
});

test("thinning keeps the largest value and the order of time", () => {
  const n = 5000;
  const t = Float64Array.from({ length: n }, (_, i) => i);
  const y = Float64Array.from({ length: n }, (_, i) => (i === 3333 ? 100 : Math.sin(i)));
  const [tt, yy] = thin(t, [y], n, 100, (v) => v);
  assert.ok(tt.length <= 200);
  assert.ok(tt.every((v, i) => i === 0 || v > tt[i - 1]));
  assert.equal(Math.max(...yy), 100);
});

test("growth with time and with its square is growth, an oscillation is not", () => {
  const trend = (gap) => {
    const history = createHistory(1, 1);
    for (let k = 0; k <= 600; k++) {
      history.push(frame(k, gap(k / 60)));
    }
    return trendOf(history, 0, 600).word;
  };
  assert.equal(
    trend((t) => 1e-8 * t * t),
    "growing",
  );
  assert.equal(
    trend((t) => 1e-8 * t),
    "growing",
  );
  assert.equal(
    trend((t) => 1e-8 * (1.1 + Math.sin(4 * t))),
    "held",
  );
  assert.equal(
    trend((t) => 1e-3 * Math.exp(-t)),
    "shrinking",
  );
  assert.equal(
    trend(() => 4e-16),
    "closed",
  );
  // what Baumgarte holds at a small step is truncation, not rounding
  assert.equal(
    trend(() => 6e-13),
    "held",
  );
});

/** Data of one method whose gap, error and energy are given over 10 s. */
function judged({ gap, off = () => 0, energy = () => 0, loops = 2, known = true }) {
  const history = createHistory(1, 1);
  for (let k = 0; k <= 600; k++) {
    const one = frame(k, gap(k / 60));
    one.methods[0].points = [off(k / 60), 0, 0];
    one.methods[0].energy_change = energy(k / 60);
    history.push(one);
  }
  const samples = Array.from({ length: 601 });
  const reference = {
    state: "ready",
    digits: 12.4,
    own: 1e-12,
    energyScale: 10,
    stride: 1,
    points: samples.map(() => Float64Array.from([0, 0, 0])),
    energy: samples.map(() => 14),
  };
  return {
    history,
    methods: [{ label: "raw" }],
    scene: { m: loops, length: 1 },
    reference: known ? reference : { state: "none" },
    view: { hidden: new Set() },
  };
}

const verdictOf = (what) => verdictAt(judged(what), 0, 600).words;
const rounding = () => 4e-16;

test("the verdict takes the worst of gap, error and energy", () => {
  assert.equal(verdictOf({ gap: (t) => 3.2e-3 * t * t }), "open by 320 mm and growing");
  assert.equal(
    verdictOf({ gap: rounding, off: () => 0.99 }),
    "closed, but 990 mm from the true motion",
  );
  assert.equal(
    verdictOf({ gap: () => 2e-3, off: (t) => 0.034 * t }),
    "open by 2.0 mm and 340 mm from the true motion",
  );
  assert.equal(
    verdictOf({ gap: rounding, energy: (t) => 0.71 * t }),
    "closed, but 7.1 J off in energy",
  );
  assert.equal(verdictOf({ gap: rounding, off: () => 3e-6 }), "right to 5 digits");
  assert.equal(verdictOf({ gap: rounding, off: () => 0 }), "right to 12 digits");
  assert.equal(verdictOf({ gap: () => 3e-3 }), "open by 3.0 mm");
  assert.equal(
    verdictOf({ gap: () => 9e-4, off: () => 0.34 }),
    "closed to 900 µm, but 340 mm from the true motion",
  );
  // it has grown, and falls now
  assert.equal(verdictOf({ gap: (t) => (t < 8 ? 1e-4 * t : 4e-4) }), "right to 12 digits");
  assert.equal(
    verdictOf({ gap: (t) => 4.3e-8 * t * t, off: () => 3e-6 }),
    "right to 5 digits, gap 4.3 µm and growing",
  );
});

test("verdicts are those of the terminal, by the cases that both tests read", () => {
  const file = new URL("../support/verdicts.json", import.meta.url);
  readIndex({
    limits: { methods: 8 },
    studies: [],
    incidents: [{ code: "diverged", name: "diverged", rule: "" }],
  });
  const { cases } = JSON.parse(readFileSync(file, "utf8"));
  assert.ok(cases.length > 20);
  for (const one of cases) {
    const { gap, off, energy, loops = true, length = 1, energy_scale = 10, digits = 12.4 } = one;
    const { ended = Infinity, shown = gap.length - 1 } = one;
    const history = createHistory(1, 1);
    gap.forEach((value, k) => {
      const method = frame(k, value).methods[0];
      const failed = k >= ended;
      history.push({
        frame: k,
        t: k,
        methods: [
          {
            ...method,
            state: failed ? "failed" : "running",
            t: failed ? ended : k,
            failure: failed ? { code: one.cause } : null,
            gap: value,
            energy_change: energy[k],
            points: [off[k] ?? NaN, 0, 0],
          },
        ],
      });
    });
    const known = off.some((value) => value !== null);
    const none = { state: one.asked ? "asked" : "none" };
    const data = {
      history,
      methods: [{ label: "raw" }],
      scene: { m: loops ? 2 : 0, length },
      reference: known
        ? {
            state: "ready",
            digits,
            own: 0,
            energyScale: energy_scale,
            stride: 1,
            points: gap.map(() => Float64Array.from([0, 0, 0])),
          }
        : none,
      view: { hidden: new Set() },
    };
    const verdict = verdictAt(data, 0, shown);
    assert.equal(verdict.words, one.text, one.name);
    assert.equal(verdict.tone, one.tone, one.name);
    assert.equal(trendOf(history, 0, shown).arrow, one.arrow, one.name);
  }
});

test("a closed loop is no praise: without a reference the error is unknown", () => {
  assert.equal(verdictOf({ gap: rounding, known: false }), "closed, error unknown");
  assert.equal(verdictOf({ gap: () => 2e-6, known: false }), "closed to 2 µm, error unknown");
  assert.equal(verdictOf({ gap: rounding, known: false, loops: 0 }), "error unknown");
});

test("sentences leave out no method, and methods of one verdict share a sentence", () => {
  const data = judged({ gap: rounding, off: () => 3e-6 });
  const history = createHistory(3, 1);
  for (let k = 0; k <= 600; k++) {
    const one = (gap, x) => ({ ...frame(k, gap).methods[0], points: [x, 0, 0] });
    history.push({
      ...frame(k, 0),
      methods: [one(4e-16, 3e-6), one(3.2e-3 * (k / 60) ** 2, 3e-6), one(4e-16, 3e-6)],
    });
  }
  const methods = ["projection", "raw", "reduced"].map((label) => ({ label }));
  assert.deepEqual(
    sentences({ ...data, history, methods }, 600).map(({ text }) => text),
    ["raw: open by 320 mm and growing", "projection and reduced: right to 5 digits"],
  );
});

test("incidents of one cause are one line with a count", () => {
  const one = (method, code, t) => ({ method, code, t, remedies: [], message: code });
  const groups = groupIncidents([
    one(0, "energy-jump", 1),
    one(1, "gap-open", 2),
    one(0, "energy-drift", 3),
    one(0, "energy-jump", 4),
  ]);
  assert.deepEqual(
    groups.map(({ count, first, last, newest }) => [newest.method, count, first, last]),
    [
      [0, 3, 1, 4],
      [1, 1, 2, 2],
    ],
  );
});

test("of a stopped run the card offers what the engine found, and nothing that has stopped as well", () => {
  const data = judged({ gap: rounding });
  const ended = createHistory(2, 1);
  const state = (gap, failed) => ({
    ...frame(1, gap).methods[0],
    points: [0, 0, 0],
    state: failed ? "failed" : "running",
  });
  for (let k = 0; k <= 60; k++) {
    ended.push({ ...frame(k, 0), methods: [state(1, k > 30), state(1, k > 40)] });
  }
  const method = (formulation) => ({
    formulation,
    spelling: `${formulation}@rk4:h=0.1`,
    title: formulation,
    label: formulation,
    rule: "",
    drift: "",
  });
  const remedies = ["h=0.025", "projection@rk4:h=0.1", "reduced@rk4:h=0.1"];
  const card = cardOfMethod(
    {
      ...data,
      catalogue: { formulations: [], integrators: [] },
      history: ended,
      duration: 10,
      methods: [method("index1"), method("projection")],
      incidents: [{ method: 0, code: "diverged", t: 0.5, remedies, message: "" }],
    },
    0,
    60,
  );
  assert.deepEqual(
    card.remedies.map(({ label }) => label),
    ["h = 0.025", "reduced@rk4:h=0.1"],
  );
  assert.deepEqual(card.tries, [], "no guesses beside them");
});

test("a remedy becomes a button only when it can be carried out", () => {
  assert.deepEqual(tryOfRemedy("h=0.005"), { label: "h = 0.005", key: "h", value: 0.005 });
  assert.equal(tryOfRemedy("projection@rk4:h=1e-3").method, "projection@rk4:h=1e-3");
  assert.deepEqual(tryOfRemedy("look at the start"), { label: "look at the start" });
});

test("formulas are evaluated with the rules of arithmetic; an unknown name gives no number", () => {
  const values = new Map(Object.entries({ x: 2, y: 3, th_1: 0.5 }));
  const cases = [
    ["1 + 2*3", 7],
    ["-x^2", -4],
    ["2^-1", 0.5],
    ["x - y - 1", -2],
    ["12/x/y", 2],
    ["2^3^x", 512],
    ["-(x + y)*2", -10],
    ["sin(th_1)^2 + cos(th_1)^2", 1],
    ["atan2(1, x - 1)", Math.PI / 4],
    ["1.5e-3*x", 3e-3],
    ["z + 1", NaN],
    ["x +", NaN],
    ["x y", NaN],
    ["foo(x)", NaN],
    ["(x", NaN],
  ];
  for (const [text, value] of cases) {
    const found = evaluate(text, values);
    assert.ok(Object.is(found, value) || Math.abs(found - value) < 1e-15, `${text}: ${found}`);
  }
});

test("limits and incidents are those of the server's index", () => {
  const rule = "A step beyond its stability limit multiplies errors.";
  readIndex({
    limits: { methods: 5 },
    incidents: [{ code: "diverged", name: "diverged", rule }],
    studies: [],
  });
  assert.equal(limits().methods, 5);
  assert.equal(incidentOf("diverged")?.rule, rule);
  assert.equal(incidentOf("another"), undefined);
});

test("typed powers are printed as such, and spellings stay as they are typed", () => {
  assert.equal(withPowers("grows like h^p t, then h^p t^2"), "grows like hᵖ t, then hᵖ t²");
  assert.equal(withPowers("M^-1; errors of 1e-01 to 1e-09"), "M⁻¹; errors of 10⁻¹ to 10⁻⁹");
  assert.equal(withPowers("exp(-alpha t), alpha = beta"), "exp(-α t), α = β");
  assert.equal(withPowers("baumgarte:alpha=5,beta=5@rk4"), "baumgarte:alpha=5,beta=5@rk4");
  assert.equal(withPowers("rk4:h=1e-10, 2.1e-10, a^b"), "rk4:h=1e-10, 2.1e-10, a^b");
});

test("a bound is told by one digit, and never below what it bounds", () => {
  assert.deepEqual(
    [9.2e-14, 1.3e-13, 0.7e-12, 1e-12, 1.07e-11, 2e-11, 3.3e-3].map((value) => bound(value, "m")),
    ["10⁻¹³ m", "2×10⁻¹³ m", "1 pm", "1 pm", "20 pm", "20 pm", "5 mm"],
  );
});

const PAIRS = {
  formulations: [
    { name: "index1", title: "index-1", form: "ode", limits: "", integrators: ["rk4", "dopri5"] },
    {
      name: "index3",
      title: "index 3",
      form: "index3",
      limits: "Gauss methods do not converge on it",
      integrators: ["hht", "radau5"],
    },
  ],
  integrators: [
    { name: "rk4", title: "Runge-Kutta 4", forms: ["ode"], order: 4, adaptive: false },
    { name: "dopri5", title: "Dormand-Prince", forms: ["ode"], order: 5, adaptive: true },
    { name: "hht", title: "HHT", forms: ["index3"], order: 2, adaptive: false },
    { name: "radau5", title: "Radau 5", forms: ["ode", "index3"], order: 5, adaptive: true },
  ],
};

test("a pair that does not fit is told in the words of the cards, one that fits is not", () => {
  assert.equal(misfit(PAIRS, "index3", "hht"), null);
  assert.equal(misfit(PAIRS, "no-such", "hht"), null);
  assert.equal(
    misfit(PAIRS, "index3", "rk4"),
    "Runge-Kutta 4 takes an ordinary differential equation; index 3 gives the equations of index 3, " +
      "the loop at position level; Gauss methods do not converge on it",
  );
  assert.match(misfit(PAIRS, "index1", "radau5") ?? "", /^Radau 5 does not fit index-1/);
  assert.deepEqual(misfitsOf(PAIRS, "index3"), [
    { takes: "an ordinary differential equation", titles: ["Runge-Kutta 4", "Dormand-Prince"] },
  ]);
});

test("a formulation keeps the integrator at hand, else takes a neighbour's, else one that steps alike", () => {
  assert.equal(choosePartner(PAIRS, "index1", "dopri5", ["rk4"]), "dopri5");
  assert.equal(choosePartner(PAIRS, "index1", "hht", ["rk4"]), "rk4");
  assert.equal(choosePartner(PAIRS, "index3", "rk4", ["rk4"]), "hht");
  assert.equal(choosePartner(PAIRS, "index3", "dopri5", []), "radau5");
});

test("a setting outside its range, in another unit or not among the choices is told with what is allowed", () => {
  const h = { key: "h", unit: "s", min: 1e-12, max: 100 };
  assert.equal(faultOf(h, "20 ms"), "");
  assert.equal(faultOf(h, "0"), "a number from 1e-12 to 100 s is needed");
  assert.equal(faultOf(h, "3 m"), "a number from 1e-12 to 100 s is needed");
  const rule = { key: "rule", choices: ["given", "auto"] };
  assert.equal(faultOf(rule, "auto"), "");
  assert.equal(faultOf(rule, "often"), "one of given, auto");
});

test("what is seen coming is counted down until it is there, for the methods it is seen by", () => {
  const history = createHistory(2, 1);
  for (let k = 0; k <= 60; k++) {
    history.push({ ...frame(k, 1), methods: [frame(k, 1).methods[0], frame(k, 1).methods[0]] });
  }
  const data = {
    history,
    methods: [{ label: "raw" }, { label: "projection" }],
    incidents: [{ code: "rank-ahead", method: 0, t: 0.25, value: 0.5 }],
    view: { hidden: new Set() },
  };
  assert.equal(predictionAt(data, 6), "");
  assert.equal(predictionAt(data, 30), "singular configuration in 0.25 s: J loses rank (raw)");
  assert.equal(predictionAt(data, 54), "");
  data.incidents.push({ code: "near-singular", method: 0, t: 0.76, value: 1e-5 });
  assert.equal(predictionAt(data, 54), "the mechanism passed a singular configuration at 0.76 s");
  data.incidents.push({ code: "rank-ahead", method: 1, t: 0.3, value: 0.4 });
  assert.equal(predictionAt(data, 30), "singular configuration in 0.20 s: J loses rank");
  data.view.hidden.add(1);
  assert.equal(predictionAt(data, 30), "singular configuration in 0.25 s: J loses rank");
});

test("a history keeps the state of each frame, and of a failed method its last one", () => {
  const history = createHistory(1, 1, 2);
  history.push(frame(0, 1, { q: [1, 2], v: [3, 4] }));
  history.push(frame(1, 1, { q: [5, 6], v: [7, 8] }));
  history.push({ ...frame(2, 1), methods: [{ state: "failed", t: 0.01 }] });
  assert.deepEqual([...history.stateAt(0, 0).q, ...history.stateAt(0, 0).v], [1, 2, 3, 4]);
  assert.deepEqual([...history.stateAt(0, 2).q, ...history.stateAt(0, 2).v], [5, 6, 7, 8]);
});

test("a link says the same after it was read and written again", () => {
  let seed = 7;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const pick = (list) => list.filter(() => random() < 0.5);
  for (let k = 0; k < 2000; k++) {
    const text = encodeLink({
      scene: pick(["four", "bar", "6", "ä b&c=d"]).join("-") || "x",
      settings: Object.fromEntries(
        pick(["l1", "g", "th_0"]).map((name) => [
          name,
          (random() - 0.5) * 10 ** (12 * random() - 6),
        ]),
      ),
      methods: pick(["index1@rk4:h=1e-3", "baumgarte:alpha=5,beta=5@dopri5:rtol=1e-8", "ggl@ida"]),
      frame: Math.floor(random() * 5000),
      selected: Math.floor(random() * 8),
      hidden: pick([0, 1, 2, 3]),
      show: pick(["labels", "traces", "reference", "arrows", "reactions"]),
      study: ["", "work-precision", "stability", "budget"][k % 4],
      note: pick(["why?", "a=b&c", "ü\n2 %", "#"]).join(" "),
      build: "0.1.0 gcc 12.2.0",
    });
    const { link, faults } = decodeLink(text);
    assert.deepEqual(faults, []);
    assert.equal(encodeLink(link), text);
  }
  assert.ok(!fits("x".repeat(5000)));
});

test("one event has one time: a step that failed is named by its end, a repeated time is left out", () => {
  assert.equal(
    stopReason("th3 = 0.81 at t = 1.1 s: the loop went over to its other mode", 1, 10),
    "in the step to 1.10 s, th3 = 0.81: the loop went over to its other mode",
  );
  assert.equal(stopReason("at t = 0.9 s the loops stand open", 0.9, 10), "the loops stand open");
  assert.equal(stopReason("the mass matrix is singular", 0.9, 10), "the mass matrix is singular");
});

test("10,000 tampered links: nothing throws, a damaged entry takes no other entry with it", () => {
  const whole = encodeLink({
    scene: "four-bar",
    settings: { l1: 0.52, th1_0: -1e-3 },
    methods: ["index1@rk4:h=0.02", "baumgarte:alpha=5,beta=20@rk4:h=0.02", "ggl@radau5:rtol=1e-6"],
    frame: 120,
    selected: 1,
    hidden: [2],
    show: ["labels", "arrows"],
    study: "stability",
    note: "predict first & say why: 50 %",
    build: "0.1.0 gcc 12.2.0",
  });
  const entries = whole.split("&");
  const signs = [..."=%@:,.#+-0x \u0000/é<", "%F", "%00", "set.", "__proto__", "NaN", "1e999"];
  let seed = 11;
  const random = (n) => Math.floor(((seed = (seed * 48271) % 2147483647) / 2147483647) * n);
  const damaged = (text) => {
    const at = random(text.length);
    const sign = signs[random(signs.length)];
    return [
      text.slice(0, at) + sign + text.slice(at),
      text.slice(0, at) + sign + text.slice(at + 1),
      text.slice(0, at) + text.slice(at + 1 + random(8)),
      text.slice(at),
      text + text,
    ][random(5)];
  };
  for (let k = 0; k < 10000; k++) {
    const at = random(entries.length);
    const others = entries.filter((_, i) => i !== at);
    const changed = entries.map((entry, i) => (i === at ? damaged(entry) : entry));
    const got = decodeLink(changed.join("&"));
    const want = decodeLink(others.join("&")).link;
    const name = entries[at].split("=")[0];
    for (const key of ["scene", "frame", "selected", "study", "note", "build"]) {
      // a damaged name may have become that of another entry, which comes later and counts
      if (key !== name && !changed[at].startsWith(`${key}=`)) {
        assert.equal(got.link[key], want[key], `${changed[at]} changes ${key}`);
      }
    }
    assert.ok(want.methods.every((method) => got.link.methods.includes(method)));
    Object.entries(want.settings).forEach(([key, value]) => {
      if (!changed[at].startsWith(`set.${key}=`)) {
        assert.equal(got.link.settings[key], value);
      }
    });
    assert.ok(got.link.methods.every((method) => method.includes("@")));
    assert.ok(Object.values(got.link.settings).every(Number.isFinite));
    assert.ok([got.link.frame, got.link.selected].every((n) => Number.isInteger(n) && n >= 0));
    assert.ok(got.faults.every((fault) => typeof fault === "string" && fault.length > 0));
  }
});

test("a link that was changed or cut off names the field, and the rest is read", () => {
  assert.equal(decodeLink("four-bar").link.scene, "four-bar");
  const { link, faults } = decodeLink(
    "scene=four-bar&set.l1=much&method=index1&method=index1@rk4:h=1e-3&frame=-2&show=labels,sound&colour=red&build=%E2%8",
  );
  assert.equal(link.scene, "four-bar");
  assert.deepEqual(link.methods, ["index1@rk4:h=1e-3"]);
  assert.deepEqual(link.settings, {});
  assert.deepEqual(
    faults.map((fault) => fault.split(" ").slice(0, 2).join(" ")),
    ["l1 is", "method has", "frame is", "show names", "no field", "'build=%E2%8' is"],
  );
});
