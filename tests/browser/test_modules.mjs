// SPDX-License-Identifier: GPL-3.0-or-later
// The page's own modules, without a browser: keys, numbers, spellings, pairs, the index.
import assert from "node:assert/strict";
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
import { keepsMethods } from "../../web/session/scenes.js";
import { changeWords, createUndo } from "../../web/session/undo.js";
import { GLOSSARY } from "../../web/state/glossary.js";
import { otherSteps } from "../../web/state/own-step.js";
import { quantityNamed } from "../../web/state/quantities.js";
import { createStore } from "../../web/state/store.js";
import { evaluate } from "../../web/state/formula.js";
import { KEYS, bindingOf, findKey, isCharacter } from "../../web/state/keys.js";
import {
  formatSpelling,
  labelsOf,
  parseSpelling,
  settingOf,
  withSetting,
} from "../../web/state/spelling.js";
import { incidentOf, limits, readIndex } from "../../web/state/catalogue.js";
import { choosePartner, faultOf, misfit, misfitsOf } from "../../web/state/pairs.js";
import { fits } from "../../web/state/link.js";
import { CATALOGUE } from "./catalogue.mjs";

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

test("an undo that fails changes nothing and can be asked for again", async () => {
  const store = createStore();
  Object.assign(store.data, { scene: { id: "four-bar" }, methods: [{ spelling: "index1@rk4" }] });
  let fails = true;
  const apply = async () => {
    if (fails) {
      throw new Error("no server");
    }
  };
  let told = "";
  const { undo } = createUndo(store, apply, (text) => (told = text));
  const counts = () => [store.data.undo.past, store.data.undo.future];
  store.emit("methods");
  store.data.settings = { l1: 2 };
  store.emit("methods");
  assert.deepEqual(counts(), [1, 0]);
  assert.equal(store.data.undo.undoes, "the change of l1 to 2");
  await undo();
  assert.deepEqual(counts(), [1, 0]);
  assert.equal(told, "no server");
  fails = false;
  await undo();
  assert.deepEqual(counts(), [0, 1]);
  assert.equal(told, "undone: the change of l1 to 2");
  assert.equal(store.data.undo.undoes, "");
});

test("a change that can be undone is named", () => {
  const one = { scene: "four-bar", settings: { l1: 0.5 }, methods: ["index1@rk4"], pulls: [] };
  const words = (change) => changeWords(one, { ...one, ...change });
  assert.equal(words({ settings: { l1: 0.55 } }), "the change of l1 from 0.5 to 0.55");
  assert.equal(words({ settings: {} }), "the change of l1 from 0.5");
  assert.equal(words({ settings: { l1: 1, l2: 2 } }), "the change of l1 and l2");
  assert.equal(words({ settings: { l1: 1, a: 1, b: 1, c: 1 } }), "the change of 4 parameters");
  assert.equal(words({ settings: { l1: 0.5, "start.th1": 1 } }), "the change of the start");
  assert.equal(words({ methods: [] }), "the change of the methods");
  assert.equal(
    words({ methods: [], settings: { l1: 1 } }),
    "the change of l1 from 0.5 to 1 and the methods",
  );
  assert.equal(words({ pulls: [[1]] }), "the pull");
  assert.equal(words({ scene: "stewart" }), "the choice of the scene stewart");
  assert.equal(words({ scene: { name: "four-bar" } }), "the change of the document four-bar");
});

test("the methods stay while the shown scene's document is edited, not where another one comes", () => {
  const document = { name: "four-bar", methods: ["index1@rk4:h=0.01"], gravity: [0, -9.81] };
  const edited = { ...document, gravity: [0, 0] };
  assert.equal(keepsMethods(document, edited, "four-bar"), true);
  assert.equal(keepsMethods(document, edited, "stewart"), false, "it is not shown");
  assert.equal(keepsMethods(document, { ...edited, name: "own" }, "four-bar"), false);
  assert.equal(keepsMethods(document, { ...edited, methods: [] }, "four-bar"), false);
  assert.equal(keepsMethods(null, document, "four-bar"), false);
});

test("methods that run at another step than the scene's texts tell of are named", () => {
  const says = (...steps) =>
    otherSteps({
      scene: { step: 0.01 },
      catalogue: CATALOGUE,
      methods: steps.map((h, i) => ({ spelling: `index1@rk4:h=${h}`, label: `m${i}` })),
    }).slice("The figures in these texts hold for the scene's own step of 0.01 s; ".length);
  assert.equal(says(0.01, 0.01), "");
  assert.equal(says(0.02, 0.02), "the methods run at 0.02 s now, so theirs differ.");
  assert.equal(says(0.01, 0.0028), "m1 runs at 0.0028 s now, so theirs differ.");
  assert.equal(
    says(0.02, 0.02, 0.0028),
    "m0 and m1 run at 0.02 s and m2 runs at 0.0028 s now, so theirs differ.",
  );
});

test("tips say where α has its limit, and that a dip can lie between two frames", () => {
  assert.match(GLOSSARY.alpha.means, /must stay below the integrator's stability limit: 2\.8/);
  for (const name of ["sigma_min", "pivot_ratio"]) {
    assert.match(quantityNamed(name).about, /the least value lies between two frames/);
  }
});

test("a typed decimal stays one in another unit, with no rounding behind it", () => {
  assert.notEqual(57 * 0.01, 0.57, "a plain product has one");
  assert.equal(parseQuantity("1.1 in", "m"), 0.02794);
  assert.equal(parseQuantity("57 cm", "m"), 0.57);
  assert.equal(parseQuantity("8.2 mm", "m"), 0.0082);
  assert.equal(parseQuantity("30 deg", "rad"), Math.PI / 6, "as near as a double comes");
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
  assert.equal(quantity(1.1e-11, "m"), "1.1×10⁻¹¹ m");
  for (let e = -9; e <= 11; e++) {
    for (const lead of [1, 2.34, 5.5, 9.9, 9.94]) {
      assert.match(quantity(lead * 10 ** e, "m"), /^\d{1,3}(\.\d)? ?[nµmkMG]?m$/);
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
    "program:mine.py@rk4:h=0.01",
    "program:a=b.py@own:h=0.01",
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
    ["10⁻¹³ m", "2×10⁻¹³ m", "10⁻¹² m", "10⁻¹² m", "2×10⁻¹¹ m", "2×10⁻¹¹ m", "5 mm"],
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

test("a number without a unit has no prefix", () => {
  const cases = { 0.8: "0.80", "-0.0123": "−0.012", 7: "7.0", 12: "12", 1234: "1200", 0: "0" };
  for (const [value, words] of Object.entries(cases)) {
    assert.equal(quantity(Number(value), ""), words);
  }
  assert.deepEqual(
    [2.5e6, 99999, 4e-5].map((value) => quantity(value, "")),
    ["2.5×10⁶", "1.0×10⁵", "4.0×10⁻⁵"],
  );
  assert.equal(quantity(0.8, "m"), "800 mm");
});
