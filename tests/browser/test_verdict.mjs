// SPDX-License-Identifier: GPL-3.0-or-later
// The words about a run, without a browser: its history, the verdict, incidents, cards.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { seconds } from "../../web/state/format.js";
import { createHistory, thin } from "../../web/state/history.js";
import { findJump } from "../../web/state/jump.js";
import { limits, readIndex } from "../../web/state/catalogue.js";
import { singularWords } from "../../web/state/dead-point.js";
import { cardOfMethod, groupIncidents, tryOfRemedy, whenWords } from "../../web/state/cards.js";
import { sentences, trendOf, verdictAt } from "../../web/state/verdict.js";
import { passedAt, predictionAt, stopReason } from "../../web/state/words.js";

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

test("a zoomed plot has all frames of its part, and one more on either side", () => {
  const history = createHistory(1, 1);
  for (let k = 0; k <= 60; k++) {
    history.push(frame(k, 1));
  }
  const inSight = (zoom) => history.inSight(zoom);
  assert.deepEqual(inSight(null), [0, 61]);
  assert.deepEqual(inSight([10 / 60, 20 / 60]), [9, 22]);
  assert.deepEqual(inSight([0, 59.8 / 60]), [0, 61]);
  assert.deepEqual(inSight([2, 3]), [59, 61], "nothing has come there yet");
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
  assert.equal(verdictOf({ gap: () => 2e-6, known: false }), "closed to 2.0 µm, error unknown");
  assert.equal(verdictOf({ gap: rounding, known: false, loops: 0 }), "error unknown");

  // an estimate stands beside it: it is not said that nothing is known
  const data = judged({ gap: rounding, known: false });
  const latest = { methods: [{ error_estimate: { q: 2e-7 } }] };
  assert.equal(verdictAt({ ...data, latest }, 0, 600).words, "closed, error only estimated");
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

  // a run lists the first five of a code, and counts all
  const counted = [1, 2, 3, 4, 5].map((t) => ({ ...one(0, "near-singular", t), times: 12 }));
  const [group] = groupIncidents([...counted, { ...one(1, "gap-open", 6), times: 1 }]).slice(1);
  assert.deepEqual([group.count, group.listed, group.last], [12, 5, 5]);
  assert.equal(whenWords(group, 10), "1.00 s to 5.00 s and later, 12 times");
  assert.equal(whenWords(groups[0], 10), "1.00 s to 4.00 s, 3 times");
  assert.equal(whenWords(groups[1], 10), "2.00 s");
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
  const radau = { label: "ggl@radau5:rtol=1e-6", method: "ggl@radau5:rtol=1e-06" };
  assert.deepEqual(tryOfRemedy("ggl@radau5:rtol=1e-06"), radau, "numbers as people write them");
  assert.deepEqual(tryOfRemedy("look at the start"), { label: "look at the start" });
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
  data.incidents.push({ code: "near-singular", method: 0, t: 0.76, value: 1e-5, message: "" });
  assert.equal(predictionAt(data, 54), "", "it is not ahead any more");
  assert.equal(
    passedAt(data, 54),
    "the mechanism passed a singular configuration at 0.76 s",
    "the engine does not say how",
  );
  data.incidents.push({ code: "rank-ahead", method: 1, t: 0.3, value: 0.4 });
  assert.equal(predictionAt(data, 30), "singular configuration in 0.20 s: J loses rank");
  data.view.hidden.add(1);
  assert.equal(predictionAt(data, 30), "singular configuration in 0.25 s: J loses rank");
});

test("constraints that are dependent from the start on are no singular configuration passed", () => {
  const history = createHistory(1, 1);
  [0, 30, 60].forEach((k) => history.push(frame(k, 1)));
  const incident = { code: "rank-loss", method: 0, message: "1 of 3 depend on the others" };
  const data = { history, duration: 10, incidents: [{ ...incident, t: 0 }] };
  assert.equal(singularWords(data, 0, 2), "");
  data.incidents.push({ ...incident, t: 0.5 });
  assert.equal(
    singularWords(data, 0, 2),
    "Singular configuration at 0.50 s: 1 of 3 depend on the others.",
  );
});

test("how the methods came through a singular configuration is said once for all of them", () => {
  const history = createHistory(2, 1);
  for (let k = 0; k <= 60; k++) {
    history.push({ ...frame(k, 1), methods: [frame(k, 1).methods[0], frame(k, 1).methods[0]] });
  }
  const at = (method, t, fate) => ({
    ...{ code: "near-singular", method, t, value: 1e-5 },
    message: `J almost loses rank; two branches of motion cross; the run ${fate}`,
  });
  const straight = "stayed on the smooth path";
  const data = {
    history,
    methods: [{ label: "raw" }, { label: "projection" }],
    incidents: [at(0, 0.6, straight), at(0, 0.76, straight), at(1, 0.76, straight)],
    view: { hidden: new Set() },
  };
  const passed = "the mechanism passed a singular configuration at 0.76 s: two branches of motion";
  assert.equal(passedAt(data, 54), `${passed} cross there; all methods stayed on the smooth path`);
  // another one that is ahead is a sentence of its own
  data.incidents.push({ code: "rank-ahead", method: 0, t: 0.8, value: 0.2 });
  assert.equal(predictionAt(data, 54), "singular configuration in 0.10 s: J loses rank (raw)");
  assert.equal(passedAt(data, 54), `${passed} cross there; all methods stayed on the smooth path`);
  // where branches cross the engine names a change point, and so does the page
  const named = data.incidents.slice(0, 3).map((incident) => ({
    ...incident,
    message: incident.message.replace("two branches", "change point: two branches"),
  }));
  assert.equal(
    passedAt({ ...data, incidents: named }, 54),
    "the mechanism passed a change point at 0.76 s: two branches of motion cross there; all methods stayed on the smooth path",
  );
  data.incidents[2] = at(1, 0.76, "left the smooth path there, by 0.4 rad");
  assert.equal(
    passedAt(data, 54),
    `${passed} cross there; raw stayed on the smooth path; projection left the smooth path there, by 0.4 rad`,
  );
  assert.equal(passedAt(data, 30), "", "it is not there yet");
});

test("a history keeps the state of each frame, and of a failed method its last one", () => {
  const history = createHistory(1, 1, 2);
  history.push(frame(0, 1, { q: [1, 2], v: [3, 4] }));
  history.push(frame(1, 1, { q: [5, 6], v: [7, 8] }));
  history.push({ ...frame(2, 1), methods: [{ state: "failed", t: 0.01 }] });
  assert.deepEqual([...history.stateAt(0, 0).q, ...history.stateAt(0, 0).v], [1, 2, 3, 4]);
  assert.deepEqual([...history.stateAt(0, 2).q, ...history.stateAt(0, 2).v], [5, 6, 7, 8]);
});

test("one event has one time: a step that failed is named by its end, a repeated time is left out", () => {
  assert.equal(
    stopReason("th3 = 0.81 at t = 1.1 s: the loop went over to its other mode", 1, 10),
    "in the step to 1.10 s, th3 = 0.81: the loop went over to its other mode",
  );
  assert.equal(stopReason("at t = 0.9 s the loops are open", 0.9, 10), "the loops are open");
  assert.equal(stopReason("the mass matrix is singular", 0.9, 10), "the mass matrix is singular");
});

test("a jump of the error is the largest growth within a window, beyond rounding", () => {
  const t = [0, 1, 2, 3, 4, 5, 6];
  const worst = [0, 1e-9, 1e-5, 2e-5, 2e-3, 3e-3, 1e-2];
  assert.deepEqual(findJump(t, worst, 6, 1, 1), { from: 3, to: 4, times: 100 });
  assert.equal(findJump(t, worst, 3, 1, 1), null, "not yet");
  assert.equal(findJump(t, worst, 6, 1, 1e3), null, "too small to matter");
});
